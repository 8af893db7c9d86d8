// SPDX-License-Identifier: Apache-2.0
// Messages as JSON, as DESIGN and the API define it: lowerCamelCase names, enum values by name, doubles with as many
// digits as they need to come back, absent fields absent.
#ifndef FLATLIGHT_CLIENT_CLI_FORMATS_JSON_TEXT_H_
#define FLATLIGHT_CLIENT_CLI_FORMATS_JSON_TEXT_H_

#include <string>
#include <string_view>

#include "absl/status/statusor.h"
#include "flatlight/v1/result.pb.h"
#include "google/protobuf/message.h"

namespace flatlight {

// A member a line, arrays of numbers on one line; ends with a newline.
std::string ToJson(const google::protobuf::Message& message);

// The same on one line, without spaces.
std::string ToJsonLine(const google::protobuf::Message& message);

// The same layout for any compact JSON text.
std::string LayOutJson(std::string_view compact);

// A RenderResult from a file, of this version or a later one (fields not known here are left out). `source` names the
// file in errors. Counts and channels that are absent are taken from the length of the irradiance.
absl::StatusOr<v1::RenderResult> ResultFromJson(const std::string& json, const std::string& source);

}  // namespace flatlight

#endif  // FLATLIGHT_CLIENT_CLI_FORMATS_JSON_TEXT_H_
