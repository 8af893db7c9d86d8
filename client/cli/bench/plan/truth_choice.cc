// SPDX-License-Identifier: Apache-2.0
#include "client/cli/bench/plan/truth_choice.h"

#include <algorithm>

#include "client/cli/bench/plan/budgets.h"
#include "client/cli/formats/enum_names.h"

namespace flatlight {
namespace {

// The method, if both the server and this program know it.
std::optional<v1::Settings::Method> Offered(const v1::GetCapabilitiesResponse& server, const std::string& name) {
  if (std::find(server.methods().begin(), server.methods().end(), name) == server.methods().end()) return std::nullopt;
  const auto value = OptionValue(*google::protobuf::GetEnumDescriptor<v1::Settings::Method>(), name);
  if (!value) return std::nullopt;
  return static_cast<v1::Settings::Method>(*value);
}

TruthChoice Rendered(const std::string& name, v1::Settings::Method method, std::optional<std::uint32_t> max_bounces) {
  TruthChoice choice;
  choice.name = name;
  choice.render.emplace().set_method(method);
  choice.max_bounces = max_bounces;
  if (max_bounces) choice.render->set_max_bounces(*max_bounces);
  return choice;
}

// The runs follow the bounces of a stored result, if it says how many.
TruthChoice Stored(const TruthQuestion& question) {
  TruthChoice choice;
  choice.name = question.file_name;
  choice.file = question.file;
  choice.max_bounces = question.max_bounces;
  const v1::Settings& settings =
      question.file->has_plan() ? question.file->plan().settings() : question.file->settings();
  if (!choice.max_bounces && settings.has_max_bounces()) choice.max_bounces = settings.max_bounces();
  return choice;
}

}  // namespace

TruthChoice ChooseTruth(const TruthQuestion& question, const v1::GetCapabilitiesResponse& server) {
  if (question.file != nullptr) return Stored(question);
  if (question.samples) {
    TruthChoice choice =
        Rendered("path-tracing " + std::to_string(*question.samples), v1::Settings::PATH_TRACING, question.max_bounces);
    choice.render->set_samples(*question.samples);
    choice.render->set_seed(kTruthSeed);
    return choice;
  }
  const bool reflects = question.max_reflectance > 0;
  const auto exact = Offered(server, "exact");
  if (exact && (!reflects || question.max_bounces == 0U)) return Rendered("exact", *exact, question.max_bounces);
  if (const auto reference = Offered(server, "reference"); reference && question.reference)
    return Rendered("reference", *reference, question.max_bounces);
  TruthChoice choice;
  if (exact && !question.max_bounces) {
    choice = Rendered("exact", *exact, 0);
    choice.note =
        "direct light only, of which exact gives the truth; for reflected light give --truth FILE.json or"
        " --truth-samples N";
  } else if (exact) {
    choice.note = "it reflects, and nothing gives the truth of " + std::to_string(*question.max_bounces) +
                  " bounces: give --max-bounces 0, --truth FILE.json or --truth-samples N";
  } else {
    choice.note = "the server offers no method that gives the truth: give --truth FILE.json or --truth-samples N";
  }
  return choice;
}

}  // namespace flatlight
