// SPDX-License-Identifier: Apache-2.0
// How messages about bad input show the input.
#ifndef FLATLIGHT_SERVER_CONVERT_TEXT_H_
#define FLATLIGHT_SERVER_CONVERT_TEXT_H_

#include <google/protobuf/descriptor.h>

#include <string>
#include <string_view>
#include <vector>

namespace flatlight {

// The text without control characters and cut to some 40 bytes, never inside a UTF-8 character.
std::string Shortened(std::string_view text);

// Shortened, in double quotes.
std::string Quoted(std::string_view text);

// "a, b, c".
std::string Listed(const std::vector<std::string>& names);

// The names of a message's fields in a scene file, and of an enum's values but for 0, which stands for "not given".
std::vector<std::string> FieldNames(const google::protobuf::Descriptor& type);
std::vector<std::string> EnumValueNames(const google::protobuf::EnumDescriptor& type);

// `path.name`, or `path["na me"]` where the name is no identifier. `path` may be empty.
std::string MemberPath(const std::string& path, std::string_view name);

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_CONVERT_TEXT_H_
