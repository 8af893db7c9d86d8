// SPDX-License-Identifier: Apache-2.0
#include "server/convert/text.h"

#include <algorithm>
#include <cstddef>

namespace flatlight {
namespace {

constexpr std::size_t kLongest = 40;

bool IsIdentifier(std::string_view name) {
  const auto letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; };
  if (name.empty() || name.size() > kLongest || !letter(name.front())) return false;
  return std::all_of(name.begin(), name.end(), [&](char c) { return letter(c) || (c >= '0' && c <= '9'); });
}

bool ContinuesCharacter(char c) { return (static_cast<unsigned char>(c) & 0xc0U) == 0x80U; }

}  // namespace

std::string Shortened(std::string_view text) {
  std::size_t end = text.size();
  if (end > kLongest) {
    end = kLongest;
    while (end > 0 && ContinuesCharacter(text[end])) --end;
  }
  std::string result;
  for (const char c : text.substr(0, end)) {
    const auto byte = static_cast<unsigned char>(c);
    result += byte < 0x20 || byte == 0x7f ? '?' : c;
  }
  if (end < text.size()) result += "...";
  return result;
}

std::string Quoted(std::string_view text) { return '"' + Shortened(text) + '"'; }

std::string Listed(const std::vector<std::string>& names) {
  std::string result;
  for (const std::string& name : names) result += (result.empty() ? "" : ", ") + name;
  return result;
}

std::vector<std::string> FieldNames(const google::protobuf::Descriptor& type) {
  std::vector<std::string> names;
  names.reserve(static_cast<std::size_t>(type.field_count()));
  for (int i = 0; i < type.field_count(); ++i) names.push_back(type.field(i)->json_name());
  return names;
}

std::vector<std::string> EnumValueNames(const google::protobuf::EnumDescriptor& type) {
  std::vector<std::string> names;
  for (int i = 0; i < type.value_count(); ++i) {
    if (type.value(i)->number() != 0) names.push_back(type.value(i)->name());
  }
  return names;
}

std::string MemberPath(const std::string& path, std::string_view name) {
  if (!IsIdentifier(name)) return path + '[' + Quoted(name) + ']';
  return path.empty() ? std::string(name) : path + '.' + std::string(name);
}

}  // namespace flatlight
