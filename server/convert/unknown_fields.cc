// SPDX-License-Identifier: Apache-2.0
#include "server/convert/unknown_fields.h"

#include <google/protobuf/descriptor.h>
#include <google/protobuf/unknown_field_set.h>

#include "server/convert/text.h"

namespace flatlight {
namespace {

using google::protobuf::EnumDescriptor;
using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

// A place in the message, made into text only when there is something to say.
struct Place {
  const Place* parent = nullptr;
  const FieldDescriptor* field = nullptr;
  int index = -1;  // In a repeated field.

  std::string Path(const std::string& root) const {
    if (field == nullptr) return root;
    std::string path = MemberPath(parent->Path(root), field->json_name());
    if (index >= 0) path += '[' + std::to_string(index) + ']';
    return path;
  }
};

class Search {
 public:
  Search(std::string root, Diagnostics& diagnostics) : root_(std::move(root)), diagnostics_(diagnostics) {}

  // The schema does not nest messages in themselves, so its depth bounds the recursion.
  void In(const Message& message, const Place& place) {
    const auto* const reflection = message.GetReflection();
    const auto& unknown = reflection->GetUnknownFields(message);
    for (int i = 0; i < unknown.field_count(); ++i) {
      const std::string number = std::to_string(unknown.field(i).number());
      const std::string path = place.Path(root_);
      diagnostics_.Add(path.empty() ? number : path + '.' + number,
                       "is a field number that this version does not know; allowed here: " +
                           Listed(FieldNames(*message.GetDescriptor())));
    }
    const auto* const type = message.GetDescriptor();
    for (int i = 0; i < type->field_count(); ++i) {
      const FieldDescriptor& field = *type->field(i);
      if (field.cpp_type() == FieldDescriptor::CPPTYPE_ENUM) {
        CheckEnum(field, reflection->GetEnumValue(message, &field), Place{&place, &field, -1});
      } else if (field.cpp_type() != FieldDescriptor::CPPTYPE_MESSAGE) {
        continue;
      } else if (field.is_repeated()) {
        const int size = reflection->FieldSize(message, &field);
        for (int j = 0; j < size; ++j) In(reflection->GetRepeatedMessage(message, &field, j), Place{&place, &field, j});
      } else if (reflection->HasField(message, &field)) {
        In(reflection->GetMessage(message, &field), Place{&place, &field, -1});
      }
    }
  }

 private:
  void CheckEnum(const FieldDescriptor& field, int value, const Place& place) {
    const EnumDescriptor& type = *field.enum_type();
    if (type.FindValueByNumber(value) != nullptr) return;
    diagnostics_.Add(place.Path(root_), "is the unknown value " + std::to_string(value) + "; one of " +
                                            Listed(EnumValueNames(type)) + " is wanted");
  }

  std::string root_;
  Diagnostics& diagnostics_;
};

}  // namespace

void ReportUnknownFields(const Message& message, const std::string& root, Diagnostics& diagnostics) {
  Search(root, diagnostics).In(message, Place{});
}

}  // namespace flatlight
