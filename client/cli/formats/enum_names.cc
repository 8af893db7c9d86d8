// SPDX-License-Identifier: Apache-2.0
#include "client/cli/formats/enum_names.h"

#include <algorithm>

namespace flatlight {
namespace {

std::string Spelled(const std::string& name) {
  std::string spelled = name;
  for (char& c : spelled) c = c == '_' ? '-' : (c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c);
  return spelled;
}

}  // namespace

std::string OptionName(const google::protobuf::EnumDescriptor& type, int value) {
  const auto* known = type.FindValueByNumber(value);
  return known == nullptr ? "unknown" : Spelled(known->name());
}

std::vector<std::string> OptionNames(const google::protobuf::EnumDescriptor& type) {
  std::vector<std::string> names;
  for (int i = 0; i < type.value_count(); ++i)
    if (type.value(i)->number() != 0) names.push_back(Spelled(type.value(i)->name()));
  return names;
}

std::optional<int> OptionValue(const google::protobuf::EnumDescriptor& type, const std::string& name) {
  for (int i = 0; i < type.value_count(); ++i)
    if (type.value(i)->number() != 0 && Spelled(type.value(i)->name()) == name) return type.value(i)->number();
  return std::nullopt;
}

}  // namespace flatlight
