// SPDX-License-Identifier: Apache-2.0
#include "client/cli/formats/json_text.h"

#include "client/cli/formats/result_shape.h"
#include "client/cli/status/exit_code.h"
#include "google/protobuf/util/json_util.h"

namespace flatlight {
namespace {

// Position behind the string that starts at `begin` (on its opening quote).
std::size_t SkipString(std::string_view text, std::size_t begin) {
  std::size_t i = begin + 1;
  while (i < text.size() && text[i] != '"') i += text[i] == '\\' ? 2 : 1;
  return std::min(i + 1, text.size());
}

// Whether the array that starts at `begin` holds no objects, arrays or strings.
bool IsFlatArray(std::string_view text, std::size_t begin) {
  return text[text.find_first_of("[]{}\"", begin + 1)] == ']';
}

}  // namespace

std::string LayOutJson(std::string_view compact) {
  std::string out;
  out.reserve(compact.size() + compact.size() / 8);
  std::size_t depth = 0;
  const auto break_line = [&] { out += '\n' + std::string(2 * depth, ' '); };
  for (std::size_t i = 0; i < compact.size();) {
    const char c = compact[i];
    std::size_t next = i + 1;
    if (c == '"') {
      next = SkipString(compact, i);
      out += compact.substr(i, next - i);
    } else if (c == '[' && IsFlatArray(compact, i)) {
      next = compact.find(']', i) + 1;
      out += compact.substr(i, next - i);
    } else if ((c == '{' || c == '[') && compact[next] != (c == '{' ? '}' : ']')) {
      out += c;
      ++depth;
      break_line();
    } else if ((c == '}' || c == ']') && compact[i - 1] != (c == '}' ? '{' : '[')) {
      --depth;
      break_line();
      out += c;
    } else {
      out += c;
      if (c == ',') break_line();
      if (c == ':') out += ' ';
    }
    i = next;
  }
  out += '\n';
  return out;
}

std::string ToJsonLine(const google::protobuf::Message& message) {
  std::string compact;
  // Cannot fail: the API has no Any but in google.rpc.Status, whose details are linked into the program.
  if (!google::protobuf::util::MessageToJsonString(message, &compact).ok()) compact = "{}";
  return compact + '\n';
}

std::string ToJson(const google::protobuf::Message& message) {
  const std::string line = ToJsonLine(message);
  return LayOutJson(std::string_view(line).substr(0, line.size() - 1));
}

absl::StatusOr<v1::RenderResult> ResultFromJson(const std::string& json, const std::string& source) {
  google::protobuf::util::JsonParseOptions options;
  options.ignore_unknown_fields = true;
  v1::RenderResult result;
  const auto status = google::protobuf::util::JsonStringToMessage(json, &result, options);
  if (!status.ok()) {
    // What follows on further lines is the place, of a file whose lines may be very long.
    const std::string reason = status.message().ToString();
    return UsageError(source + " is not a result in JSON form: " + reason.substr(0, reason.find('\n')));
  }
  if (result.probes().empty()) return UsageError(source + " holds no probes: is it a result in JSON form?");
  for (v1::ProbeResult& probe : *result.mutable_probes()) {
    if (!probe.has_channels()) probe.set_channels(1);
    if (!probe.has_count() && probe.channels() > 0)
      probe.set_count(static_cast<unsigned>(probe.irradiance_size()) / probe.channels());
  }
  const std::string defect = FindResultDefect(result);
  if (!defect.empty()) return UsageError(source + ": " + defect);
  return result;
}

}  // namespace flatlight
