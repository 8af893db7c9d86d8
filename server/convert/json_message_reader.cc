// SPDX-License-Identifier: Apache-2.0
#include "server/convert/json_message_reader.h"

#include <google/protobuf/descriptor.h>

#include <cmath>
#include <limits>
#include <utility>

#include "core/math/check.h"
#include "server/convert/text.h"

namespace flatlight {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

constexpr double kLargestCount = std::numeric_limits<std::uint32_t>::max();

std::string Wanted(const FieldDescriptor& field, bool element) {
  const bool array = field.is_repeated() && !element;
  switch (field.cpp_type()) {
    case FieldDescriptor::CPPTYPE_DOUBLE:
      return array ? "an array of numbers is wanted" : "a number is wanted";
    case FieldDescriptor::CPPTYPE_UINT32:
      return "a whole number from 0 to 4294967295 is wanted";
    case FieldDescriptor::CPPTYPE_BOOL:
      return "true or false is wanted";
    case FieldDescriptor::CPPTYPE_ENUM:
      return "one of " + Listed(EnumValueNames(*field.enum_type())) + " is wanted";
    case FieldDescriptor::CPPTYPE_MESSAGE:
      return (array ? "an array of objects" : "an object") + (" with " + Listed(FieldNames(*field.message_type()))) +
             " is wanted";
    default:
      return array ? "an array of strings is wanted" : "a string is wanted";
  }
}

std::vector<std::string> MemberNames(const google::protobuf::OneofDescriptor& oneof) {
  std::vector<std::string> names;
  names.reserve(static_cast<std::size_t>(oneof.field_count()));
  for (int i = 0; i < oneof.field_count(); ++i) names.push_back(oneof.field(i)->json_name());
  return names;
}

std::uint64_t Bit(const FieldDescriptor& field) { return std::uint64_t{1} << static_cast<unsigned>(field.index()); }

// The element that a mistake left out.
void AddPlaceholder(Message& message, const FieldDescriptor& field) {
  if (field.cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE) {
    message.GetReflection()->AddMessage(&message, &field);
  } else if (field.cpp_type() == FieldDescriptor::CPPTYPE_DOUBLE) {
    message.GetReflection()->AddDouble(&message, &field, std::numeric_limits<double>::quiet_NaN());
  }
}

}  // namespace

JsonMessageReader::JsonMessageReader(std::string what, Message& message, int max_depth,
                                     std::vector<UnusableNumber> unusable, Diagnostics& diagnostics)
    : what_(std::move(what)),
      root_(message),
      max_depth_(max_depth),
      unusable_(std::move(unusable)),
      diagnostics_(diagnostics) {}

std::string JsonMessageReader::Path() const {
  std::string path;
  for (const Level& level : levels_) {
    if (level.members == nullptr) {
      if (level.index >= 0) path += '[' + std::to_string(level.index) + ']';
    } else if (level.field != nullptr) {
      path = MemberPath(path, level.field->json_name());
    } else if (!unknown_path_.empty()) {
      path = unknown_path_;
    }
  }
  return path;
}

const JsonMessageReader::Members& JsonMessageReader::MembersOf(const Descriptor& type) {
  const auto [entry, added] = members_.try_emplace(&type);
  if (added) {
    FLATLIGHT_DCHECK(type.field_count() <= 64);
    for (int i = 0; i < type.field_count(); ++i) {
      entry->second.push_back({type.field(i)->json_name(), type.field(i)->name(), type.field(i)});
    }
  }
  return entry->second;
}

void JsonMessageReader::Complain(const std::string& message) {
  const std::string path = Path();
  diagnostics_.Add(path.empty() ? what_ : path, message);
}

std::optional<JsonMessageReader::Slot> JsonMessageReader::NextSlot(const std::string& found) {
  if (skipped_levels_ > 0) return std::nullopt;
  if (levels_.empty()) {
    Complain("is " + found + "; an object with " + Listed(FieldNames(*root_.GetDescriptor())) + " is wanted");
    return std::nullopt;
  }
  Level& level = levels_.back();
  if (level.field == nullptr) return std::nullopt;
  const bool element = level.members == nullptr;
  if (element) ++level.index;
  return Slot{level.message, level.field, element};
}

void JsonMessageReader::Refuse(const Slot& slot, const std::string& found) {
  Complain("is " + found + "; " + Wanted(*slot.field, slot.element));
  if (slot.element) AddPlaceholder(*slot.message, *slot.field);
}

bool JsonMessageReader::null() {
  if (const auto slot = NextSlot("null")) Refuse(*slot, "null");
  return true;
}

bool JsonMessageReader::boolean(bool value) {
  const std::string found = value ? "true" : "false";
  const auto slot = NextSlot(found);
  if (!slot) return true;
  if (slot->field->cpp_type() == Field::CPPTYPE_BOOL && !slot->field->is_repeated()) {
    slot->message->GetReflection()->SetBool(slot->message, slot->field, value);
  } else {
    Refuse(*slot, found);
  }
  return true;
}

bool JsonMessageReader::number_integer(std::int64_t value) {
  Number(static_cast<double>(value), skipped_levels_ > 0 ? "" : std::to_string(value));
  return true;
}

bool JsonMessageReader::number_unsigned(std::uint64_t value) {
  Number(static_cast<double>(value), skipped_levels_ > 0 ? "" : std::to_string(value));
  return true;
}

bool JsonMessageReader::number_float(double value, const std::string& text) {
  Number(value, text);
  return true;
}

void JsonMessageReader::Number(double value, std::string_view text) {
  const std::size_t index = next_number_++;
  const UnusableNumber* unusable = nullptr;
  if (next_unusable_ < unusable_.size() && unusable_[next_unusable_].index == index) {
    unusable = &unusable_[next_unusable_++];
  }
  const auto slot = NextSlot("a number");
  if (!slot) return;
  Message* const message = slot->message;
  const Field& field = *slot->field;
  const auto* const reflection = message->GetReflection();
  const bool one_wanted = slot->element || !field.is_repeated();
  if (unusable != nullptr) {
    Refuse(*slot, unusable->found);
  } else if (field.cpp_type() == Field::CPPTYPE_DOUBLE && slot->element) {
    reflection->AddDouble(message, &field, value);
  } else if (field.cpp_type() == Field::CPPTYPE_DOUBLE && one_wanted) {
    reflection->SetDouble(message, &field, value);
  } else if (field.cpp_type() == Field::CPPTYPE_UINT32 && one_wanted && value >= 0 && value <= kLargestCount &&
             value == std::floor(value)) {
    reflection->SetUInt32(message, &field, static_cast<std::uint32_t>(value));
  } else {
    Refuse(*slot, (field.cpp_type() == Field::CPPTYPE_UINT32 ? "" : "the number ") + Shortened(text));
  }
}

bool JsonMessageReader::string(const std::string& value) {
  const auto slot = NextSlot("a string");
  if (!slot) return true;
  const Field& field = *slot->field;
  const auto* const reflection = slot->message->GetReflection();
  if (field.cpp_type() == Field::CPPTYPE_STRING && !field.is_repeated()) {
    reflection->SetString(slot->message, &field, value);
  } else if (field.cpp_type() == Field::CPPTYPE_ENUM && !field.is_repeated()) {
    const auto* const known = field.enum_type()->FindValueByName(value);
    if (known != nullptr && known->number() != 0) {
      reflection->SetEnum(slot->message, &field, known);
    } else {
      Refuse(*slot, Quoted(value));
    }
  } else {
    Refuse(*slot, "the string " + Quoted(value));
  }
  return true;
}

bool JsonMessageReader::binary(const nlohmann::json::binary_t&) { return true; }  // Not in JSON.

void JsonMessageReader::Enter() {
  if (++depth_ <= static_cast<std::size_t>(max_depth_) || too_deep_) return;
  too_deep_ = true;
  Complain("is nested too deeply; at most " + std::to_string(max_depth_) + " levels are allowed");
}

bool JsonMessageReader::Leave() {
  --depth_;
  if (skipped_levels_ == 0) {
    levels_.pop_back();
  } else if (--skipped_levels_ == 0) {
    too_deep_ = false;
  }
  return true;
}

bool JsonMessageReader::start_object(std::size_t) {
  if (depth_ == 0) {
    levels_.push_back({&root_, &MembersOf(*root_.GetDescriptor()), nullptr, -1, 0});
    Enter();
    return true;
  }
  const auto slot = NextSlot("an object");
  if (!slot) {
    Skip();
  } else if (slot->field->cpp_type() == Field::CPPTYPE_MESSAGE && (slot->element || !slot->field->is_repeated())) {
    const auto* const reflection = slot->message->GetReflection();
    Message* const child = slot->element ? reflection->AddMessage(slot->message, slot->field)
                                         : reflection->MutableMessage(slot->message, slot->field);
    levels_.push_back({child, &MembersOf(*child->GetDescriptor()), nullptr, -1, 0});
  } else {
    Refuse(*slot, "an object");
    Skip();
  }
  Enter();
  return true;
}

bool JsonMessageReader::start_array(std::size_t) {
  const auto slot = NextSlot("an array");
  if (!slot) {
    Skip();
  } else if (slot->field->is_repeated() && !slot->element) {
    levels_.push_back({slot->message, nullptr, slot->field, -1, 0});
  } else {
    Refuse(*slot, "an array");
    Skip();
  }
  Enter();
  return true;
}

bool JsonMessageReader::end_object() { return Leave(); }

bool JsonMessageReader::end_array() { return Leave(); }

const JsonMessageReader::Member* JsonMessageReader::SeenRival(const Level& level, const Member& member) {
  const auto* const oneof = member.field->real_containing_oneof();
  if (oneof == nullptr) return nullptr;
  for (const Member& other : *level.members) {
    if (other.field->real_containing_oneof() == oneof && (level.seen & Bit(*other.field)) != 0) return &other;
  }
  return nullptr;
}

bool JsonMessageReader::key(const std::string& name) {
  if (skipped_levels_ > 0) return true;
  Level& level = levels_.back();
  level.field = nullptr;
  unknown_path_.clear();
  const Member* member = nullptr;
  for (const Member& candidate : *level.members) {
    if (candidate.name == name || candidate.snake_name == name) member = &candidate;
  }
  const auto refuse = [&](const std::string& shown, const std::string& message) {
    unknown_path_ = MemberPath(Path(), shown);
    Complain(message);
  };
  if (member == nullptr) {
    refuse(name, "is not a known field; allowed here: " + Listed(FieldNames(*level.message->GetDescriptor())));
    return true;
  }
  const std::uint64_t bit = Bit(*member->field);
  if ((level.seen & bit) != 0) {
    refuse(member->name, "is given twice" + (name == member->name ? "" : ", once as " + name) + "; once is allowed");
    return true;
  }
  if (const Member* const rival = SeenRival(level, *member)) {
    refuse(member->name, "comes after " + rival->name + "; only one of " +
                             Listed(MemberNames(*member->field->real_containing_oneof())) + " is allowed");
    level.seen |= bit;
    return true;
  }
  level.seen |= bit;
  level.field = member->field;
  return true;
}

bool JsonMessageReader::parse_error(std::size_t position, const std::string& token,
                                    const nlohmann::json::exception& error) {
  constexpr int kNumberOverflow = 406;  // The parser's number for it.
  syntax_error_ = JsonSyntaxError{position, token, error.what(), error.id == kNumberOverflow};
  return false;
}

}  // namespace flatlight
