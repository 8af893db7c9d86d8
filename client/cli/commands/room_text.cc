// SPDX-License-Identifier: Apache-2.0
#include "client/cli/commands/room_text.h"

#include <algorithm>

#include "client/cli/commands/job_text.h"
#include "client/cli/formats/enum_names.h"
#include "client/cli/formats/timestamp.h"
#include "client/cli/text/numbers.h"
#include "client/cli/text/text_table.h"
#include "google/protobuf/util/time_util.h"

namespace flatlight {
namespace {

using google::protobuf::util::TimeUtil;

std::string Uuid(const v1::Room& room) { return room.name().substr(room.name().find('/') + 1); }

std::string TimeText(google::protobuf::Timestamp time) {
  time.set_nanos(0);
  return TimeUtil::ToString(time);
}

}  // namespace

std::string RoomListText(const std::vector<v1::Room>& rooms, double now) {
  if (rooms.empty()) return "no rooms\n";
  std::vector<std::vector<std::string>> rows = {{"ROOM", "OWNER", "STATE", "NOTES", "AGE", "TITLE"}};
  for (const v1::Room& room : rooms)
    rows.push_back({Uuid(room), Printable(room.owner()), room.has_close_time() ? "closed" : "open",
                    std::to_string(room.notes()), FormatSeconds(std::max(0.0, now - SecondsOf(room.create_time()))),
                    Printable(room.title())});
  return FormatTable(rows);
}

std::string ViewText(const v1::View& view) {
  if (view.job().empty()) return "nothing";
  std::string text = Printable(view.job());
  if (!view.probe().empty()) text += ' ' + Printable(view.probe());
  if (view.has_point()) text += " point " + std::to_string(view.point());
  if (view.exposure() != 0) text += (view.exposure() > 0 ? ", +" : ", ") + FormatExactly(view.exposure()) + " stops";
  return text + ", " + OptionName(view.tone_mapping());
}

std::string NoteText(const v1::Note& note) {
  std::string text = TimeText(note.time()) + ' ' + Printable(note.author()) + ": " + Printable(note.text());
  if (note.has_place()) text += " (at " + FormatExactly(note.place().x()) + ',' + FormatExactly(note.place().y()) + ')';
  return text + '\n';
}

std::string RoomText(const v1::Room& room) {
  std::vector<std::vector<std::string>> rows = {{"room", room.name()},
                                                {"title", Printable(room.title())},
                                                {"owner", Printable(room.owner())},
                                                {"created", TimeText(room.create_time())}};
  if (room.has_close_time()) rows.push_back({"closed", TimeText(room.close_time())});
  if (!room.shares().empty()) rows.push_back({"shared", SharesText(room.shares())});
  rows.push_back({"looks at", ViewText(room.view())});
  rows.push_back({"notes", std::to_string(room.notes())});
  return FormatTable(rows);
}

}  // namespace flatlight
