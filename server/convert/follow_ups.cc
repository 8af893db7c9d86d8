// SPDX-License-Identifier: Apache-2.0
#include "server/convert/follow_ups.h"

#include <google/protobuf/descriptor.h>
#include <google/protobuf/message.h>

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <string_view>

#include "server/convert/text.h"

namespace flatlight {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

// True if `inner` is `outer` or a part of it.
bool Contains(std::string_view outer, std::string_view inner) {
  return inner.starts_with(outer) &&
         (inner.size() == outer.size() || inner[outer.size()] == '.' || inner[outer.size()] == '[');
}

const FieldDescriptor* FindField(const Message& message, std::string_view json_name) {
  const auto* const type = message.GetDescriptor();
  for (int i = 0; i < type->field_count(); ++i) {
    if (type->field(i)->json_name() == json_name) return type->field(i);
  }
  return nullptr;
}

bool IsAbsent(const Message& message, const FieldDescriptor& field) {
  const auto* const reflection = message.GetReflection();
  return field.is_repeated() ? reflection->FieldSize(message, &field) == 0 : !reflection->HasField(message, &field);
}

// If the path leads to a field that its object cannot have: the absent fields of that object.
std::vector<std::string> AbsentSiblings(const Message& root, std::string_view path) {
  const Message* message = &root;
  std::string object;
  while (!path.empty()) {
    const std::size_t end = std::min(path.find_first_of(".["), path.size());
    const FieldDescriptor* const field = FindField(*message, path.substr(0, end));  // None also for ["odd name"].
    if (field == nullptr) {
      std::vector<std::string> absent;
      for (const std::string& name : FieldNames(*message->GetDescriptor())) {
        if (IsAbsent(*message, *FindField(*message, name))) absent.push_back(MemberPath(object, name));
      }
      return absent;
    }
    object = MemberPath(object, field->json_name());
    path.remove_prefix(end);
    int index = 0;
    if (path.starts_with('[') && !path.starts_with("[\"")) {
      const std::size_t close = std::min(path.find(']'), path.size() - 1);
      if (std::from_chars(path.data() + 1, path.data() + close, index).ec != std::errc()) return {};
      object += path.substr(0, close + 1);
      path.remove_prefix(close + 1);
    }
    if (path.empty() || field->cpp_type() != FieldDescriptor::CPPTYPE_MESSAGE || IsAbsent(*message, *field)) return {};
    const auto* const reflection = message->GetReflection();
    if (field->is_repeated()) {
      if (index < 0 || index >= reflection->FieldSize(*message, field)) return {};
      message = &reflection->GetRepeatedMessage(*message, field, index);
    } else {
      message = &reflection->GetMessage(*message, field);
    }
    if (path.starts_with('.')) path.remove_prefix(1);
  }
  return {};
}

// "plane.curves[3]" of "plane.curves[3].segment".
std::string_view ObjectOf(std::string_view path) {
  if (path.ends_with("\"]")) return path.substr(0, path.rfind("[\""));
  const std::size_t dot = path.rfind('.');
  return path.ends_with(']') || dot == std::string_view::npos ? std::string_view() : path.substr(0, dot);
}

}  // namespace

FollowUps::FollowUps(const v1::Scene& scene, const Diagnostics& earlier) {
  for (const Diagnostic& mistake : earlier.kept()) {
    doubtful_.push_back(mistake.path);
    for (std::string& path : AbsentSiblings(scene, mistake.path)) doubtful_.push_back(std::move(path));
  }
  // A list's names are in doubt if the list, one of its items as a whole, or an item's name is.
  const auto names_in_doubt = [this](std::string_view list) {
    return std::any_of(doubtful_.begin(), doubtful_.end(), [&](std::string_view path) {
      if (!Contains(list, path)) return Contains(path, list);
      const std::string_view item = path.substr(list.size());
      return item.ends_with("].name") || item.find('.') == std::string_view::npos;
    });
  };
  materials_in_doubt_ = names_in_doubt("plane.materials");
  curves_in_doubt_ = names_in_doubt("plane.curves");
}

bool FollowUps::InDoubt(const std::string& path) const {
  return std::any_of(doubtful_.begin(), doubtful_.end(), [&](const std::string& doubtful) {
    return Contains(doubtful, path) || ObjectOf(doubtful) == path;
  });
}

bool FollowUps::MayExplain(const std::string& path) const {
  if (InDoubt(path)) return true;
  if (materials_in_doubt_ && path.starts_with("plane.curves") && path.ends_with("].material")) return true;
  if (!path.starts_with("probes[")) return false;
  if (curves_in_doubt_ && path.ends_with("].curve")) return true;
  // What a probe may have besides depends on whether it names a curve.
  const std::string probe = path.substr(0, path.find(']') + 1);
  return std::find(doubtful_.begin(), doubtful_.end(), probe + ".curve") != doubtful_.end();
}

}  // namespace flatlight
