// SPDX-License-Identifier: Apache-2.0
#include "server/convert/scene_reader.h"

#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "server/convert/json_message_reader.h"
#include "server/convert/json_syntax.h"

namespace flatlight {
namespace {

std::string_view WithoutByteOrderMark(std::string_view text) {
  constexpr std::string_view kMark = "\xef\xbb\xbf";
  return text.starts_with(kMark) ? text.substr(kMark.size()) : text;
}

// Reads the text up to the first NUL, which the parser would take for the end. True if the parser met a number that it
// cannot go on after.
bool StopsAtUnusableNumber(std::string_view text, std::vector<UnusableNumber> blanked, v1::Scene& scene,
                           Diagnostics& diagnostics) {
  const std::string_view whole = text.substr(0, text.find('\0'));
  JsonMessageReader reader("scene", scene, kMaxSceneDepth, std::move(blanked), diagnostics);
  nlohmann::json::sax_parse(whole.data(), whole.data() + whole.size(), &reader);
  if (!reader.syntax_error() && whole.size() == text.size()) return false;
  scene.Clear();
  const Diagnostic mistake =
      reader.syntax_error() ? DescribeSyntaxError(whole, *reader.syntax_error(), reader.Path()) : DescribeNul(whole);
  diagnostics.Add(mistake.path, mistake.message);
  return reader.syntax_error() && IsAboutUnusableNumber(whole, *reader.syntax_error());
}

}  // namespace

bool ReadSceneJson(std::string_view json, v1::Scene& scene, Diagnostics& diagnostics) {
  const std::string_view text = WithoutByteOrderMark(json);
  scene.Clear();
  const Diagnostics before = diagnostics;
  if (StopsAtUnusableNumber(text, {}, scene, diagnostics)) {
    std::string blanked(text);
    std::vector<UnusableNumber> unusable = BlankUnusableNumbers(blanked);
    diagnostics = before;
    StopsAtUnusableNumber(blanked, std::move(unusable), scene, diagnostics);
  }
  return diagnostics.count() == before.count();
}

}  // namespace flatlight
