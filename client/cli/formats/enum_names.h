// SPDX-License-Identifier: Apache-2.0
// Enum values of the API as options and texts spell them: PATH_TRACING is "path-tracing". The names come from the
// descriptor, so a method that the API gains needs no change here.
#ifndef FLATLIGHT_CLIENT_CLI_FORMATS_ENUM_NAMES_H_
#define FLATLIGHT_CLIENT_CLI_FORMATS_ENUM_NAMES_H_

#include <optional>
#include <string>
#include <vector>

#include "google/protobuf/descriptor.h"
#include "google/protobuf/generated_enum_reflection.h"

namespace flatlight {

std::string OptionName(const google::protobuf::EnumDescriptor& type, int value);
// All but the unspecified one, in the order of the API.
std::vector<std::string> OptionNames(const google::protobuf::EnumDescriptor& type);
std::optional<int> OptionValue(const google::protobuf::EnumDescriptor& type, const std::string& name);

template <class Enum>
std::string OptionName(Enum value) {
  return OptionName(*google::protobuf::GetEnumDescriptor<Enum>(), value);
}

}  // namespace flatlight

#endif  // FLATLIGHT_CLIENT_CLI_FORMATS_ENUM_NAMES_H_
