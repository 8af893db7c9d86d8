// SPDX-License-Identifier: Apache-2.0
#include "client/cli/options/room_options.h"

#include <charconv>
#include <string_view>

#include "client/cli/formats/enum_names.h"
#include "client/cli/status/exit_code.h"

namespace flatlight {
namespace {

template <class Number>
bool Read(std::string_view text, Number& number) {
  const auto read = std::from_chars(text.data(), text.data() + text.size(), number);
  return read.ec == std::errc() && read.ptr == text.data() + text.size();
}

absl::Status ReadPlace(const std::string& text, v1::Point2& place) {
  const std::size_t comma = text.find(',');
  double x = 0, y = 0;
  if (comma == std::string::npos || !Read(std::string_view(text).substr(0, comma), x) ||
      !Read(std::string_view(text).substr(comma + 1), y)) {
    return UsageError("--at: '" + text + "'; must be X,Y in m, as 0.5,1");
  }
  place.set_x(x);
  place.set_y(y);
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<RoomOptions> ParseRoomOptions(const RoomTexts& texts) {
  RoomOptions options;
  options.room = texts.room;
  options.title = texts.title;
  options.note.set_text(texts.text);
  if (texts.at) {
    if (absl::Status read = ReadPlace(*texts.at, *options.note.mutable_place()); !read.ok()) return read;
  }
  v1::LookAtRequest& view = options.view;
  if (texts.job) view.set_job(*texts.job);
  if (texts.probe) view.set_probe(*texts.probe);
  if (texts.point) {
    std::uint32_t point = 0;
    if (!Read(*texts.point, point)) return UsageError("--point: '" + *texts.point + "'; must be a number from 0");
    view.set_point(point);
  }
  if (texts.exposure) {
    double exposure = 0;
    if (!Read(*texts.exposure, exposure))
      return UsageError("--exposure: '" + *texts.exposure + "'; must be a number of stops, as -1.5");
    view.set_exposure(exposure);
  }
  if (texts.tone_mapping) {
    const auto mapping = OptionValue(*v1::ToneMapping_descriptor(), *texts.tone_mapping);
    if (!mapping) return UsageError("--tone-mapping: '" + *texts.tone_mapping + "'; must be photographic or linear");
    view.set_tone_mapping(static_cast<v1::ToneMapping>(*mapping));
  }
  return options;
}

}  // namespace flatlight
