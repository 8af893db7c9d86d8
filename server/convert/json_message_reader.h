// SPDX-License-Identifier: Apache-2.0
// Turns the events of a JSON parser into a protobuf message, strictly.
#ifndef FLATLIGHT_SERVER_CONVERT_JSON_MESSAGE_READER_H_
#define FLATLIGHT_SERVER_CONVERT_JSON_MESSAGE_READER_H_

#include <google/protobuf/message.h>

#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "core/scene/diagnostic.h"

namespace flatlight {

// Where and why the parser gave up.
struct JsonSyntaxError {
  std::size_t end = 0;    // Bytes read, the offending token included.
  std::string token;      // As the parser quotes it.
  std::string message;    // The parser's.
  bool overflow = false;  // A number larger than any double.
};

// A number that the caller took out of the text, because the parser could not have gone on past it.
struct UnusableNumber {
  std::size_t index = 0;  // Among all numbers of the text, from 0.
  std::string found;      // What it was, for the message.
};

// The event handler of nlohmann::json::sax_parse. It writes into the message as the events come, by reflection, and
// keeps a stack of its own, so that neither deep nor long input costs more than its size. A mistake is reported and
// skipped, with all that is in it; the reading goes on. In an array an element that is skipped leaves an empty message
// or a NaN, so that the indices of the others stay true.
class JsonMessageReader {
 public:
  // `what` stands for the path of the whole. `unusable` is in the order of the text.
  JsonMessageReader(std::string what, google::protobuf::Message& message, int max_depth,
                    std::vector<UnusableNumber> unusable, Diagnostics& diagnostics);

  const std::optional<JsonSyntaxError>& syntax_error() const { return syntax_error_; }
  // Of the value that was read last, or is being read; empty at the top.
  std::string Path() const;

  // The parser's events. The names are the parser's.
  bool null();
  bool boolean(bool value);
  bool number_integer(std::int64_t value);
  bool number_unsigned(std::uint64_t value);
  bool number_float(double value, const std::string& text);
  bool string(const std::string& value);
  bool binary(const nlohmann::json::binary_t& value);
  bool start_object(std::size_t size);
  bool key(const std::string& name);
  bool end_object();
  bool start_array(std::size_t size);
  bool end_array();
  bool parse_error(std::size_t position, const std::string& token, const nlohmann::json::exception& error);

 private:
  using Message = google::protobuf::Message;
  using Field = google::protobuf::FieldDescriptor;

  // The members that a type of object may have, under both of their names.
  struct Member {
    std::string name;
    std::string snake_name;
    const Field* field = nullptr;
  };
  using Members = std::vector<Member>;

  // An object or an array that is being read.
  struct Level {
    Message* message = nullptr;
    const Members* members = nullptr;  // Null: an array.
    const Field* field = nullptr;      // The array's field, or the member being read; null if that is unknown.
    std::int64_t index = -1;           // Of the array's element.
    std::uint64_t seen = 0;            // Bit i: member i was there.
  };

  // Where the next value belongs: a member, or an element of an array.
  struct Slot {
    Message* message = nullptr;
    const Field* field = nullptr;
    bool element = false;
  };

  const Members& MembersOf(const google::protobuf::Descriptor& type);
  // The member that was there and cannot be together with this one.
  static const Member* SeenRival(const Level& level, const Member& member);
  std::optional<Slot> NextSlot(const std::string& found);
  void Number(double value, std::string_view text);
  void Refuse(const Slot& slot, const std::string& found);
  void Complain(const std::string& message);
  // Leaves out the object or array that just began; counts its levels.
  void Skip() { ++skipped_levels_; }
  void Enter();
  bool Leave();

  std::string what_;
  Message& root_;
  int max_depth_;
  std::vector<UnusableNumber> unusable_;
  Diagnostics& diagnostics_;
  std::unordered_map<const google::protobuf::Descriptor*, Members> members_;
  std::vector<Level> levels_;
  std::string unknown_path_;  // Of the unknown or repeated member being skipped.
  std::size_t next_number_ = 0;
  std::size_t next_unusable_ = 0;
  std::size_t skipped_levels_ = 0;
  std::size_t depth_ = 0;
  bool too_deep_ = false;  // Reported for the value being skipped.
  std::optional<JsonSyntaxError> syntax_error_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_CONVERT_JSON_MESSAGE_READER_H_
