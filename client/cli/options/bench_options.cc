// SPDX-License-Identifier: Apache-2.0
#include "client/cli/options/bench_options.h"

#include <algorithm>
#include <charconv>
#include <limits>
#include <sstream>

#include "client/cli/formats/enum_names.h"
#include "client/cli/options/settings_options.h"
#include "client/cli/status/exit_code.h"
#include "flatlight/v1/settings.pb.h"

namespace flatlight {
namespace {

using Text = std::optional<std::string>;

constexpr std::uint32_t kMostRuns = 10'000;  // Of a point.

// The pieces between commas, empty ones too.
std::vector<std::string> Pieces(const std::string& text) {
  std::vector<std::string> pieces;
  std::istringstream in(text + ",");
  for (std::string piece; std::getline(in, piece, ',');) pieces.push_back(piece);
  return pieces;
}

bool ParseCount(const std::string& text, std::uint32_t high, std::uint32_t& count) {
  const char* end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, count);
  return error == std::errc() && rest == end && count >= 1 && count <= high;
}

class Reader {
 public:
  void Count(const std::string& option, const Text& text, std::uint32_t high, std::uint32_t& count) {
    if (text && !ParseCount(*text, high, count))
      Refuse(option, *text, "a whole number from 1 to " + std::to_string(high));
  }

  void Number(const std::string& option, const Text& text, Zero zero, double high, std::optional<double>& number) {
    if (!text) return;
    const auto value = ParseNumber(option, *text, zero, high);
    if (value.ok()) number = *value;
    if (!value.ok()) Add(std::string(value.status().message().data(), value.status().message().size()));
  }

  void Budgets(const Text& text, std::vector<std::uint32_t>& budgets) {
    if (!text) return;
    for (const std::string& piece : Pieces(*text))
      if (!ParseCount(piece, std::numeric_limits<std::uint32_t>::max(), budgets.emplace_back()))
        return Refuse("--budgets", *text, "numbers of samples with commas between, each from 1 to 4294967295");
    std::sort(budgets.begin(), budgets.end());
    const auto twice = std::adjacent_find(budgets.begin(), budgets.end());
    if (twice != budgets.end()) Add("--budgets: " + std::to_string(*twice) + " is there twice");
  }

  void Methods(const Text& text, std::vector<std::string>& methods) {
    if (!text) return;
    const auto& type = *google::protobuf::GetEnumDescriptor<v1::Settings::Method>();
    for (const std::string& name : Pieces(*text)) {
      if (!OptionValue(type, name)) {
        std::string allowed;
        for (const std::string& known : OptionNames(type)) allowed += (allowed.empty() ? "" : ", ") + known;
        return Refuse("--methods", *text, "one or more of " + allowed + ", with commas between");
      }
      if (std::find(methods.begin(), methods.end(), name) != methods.end())
        return Add("--methods: " + name + " is there twice");
      methods.push_back(name);
    }
  }

  void Add(const std::string& mistake) { mistakes_ += (mistakes_.empty() ? "" : "\n") + mistake; }
  const std::string& mistakes() const { return mistakes_; }

 private:
  void Refuse(const std::string& option, const std::string& text, const std::string& allowed) {
    Add(option + ": '" + text + "'; must be " + allowed);
  }

  std::string mistakes_;
};

}  // namespace

absl::StatusOr<BenchOptions> ParseBenchOptions(const BenchTexts& texts) {
  BenchOptions options;
  options.scenes = texts.scenes;
  options.truths = texts.truths;
  options.gallery = texts.gallery;
  options.force = texts.force;
  Reader reader;
  reader.Methods(texts.methods, options.methods);
  reader.Budgets(texts.budgets, options.budgets);
  reader.Count("--seeds", texts.seeds, kMostRuns, options.seeds);
  reader.Count("--repeats", texts.repeats, kMostRuns, options.repeats);
  reader.Number("--time-limit", texts.time_limit, Zero::kRefused, std::numeric_limits<double>::max(),
                options.time_limit);
  if (texts.truth_samples)
    reader.Count("--truth-samples", texts.truth_samples, std::numeric_limits<std::uint32_t>::max(),
                 options.truth_samples.emplace());
  std::optional<double> least;
  reader.Number("--least", texts.least, Zero::kAllowed, 1, least);
  options.least = least.value_or(options.least);
  if (!options.truths.empty() && options.truth_samples)
    reader.Add("--truth-samples: there is --truth already; give one of them");
  if (!reader.mistakes().empty()) return UsageError(reader.mistakes());
  return options;
}

}  // namespace flatlight
