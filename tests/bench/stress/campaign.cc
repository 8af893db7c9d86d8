// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/stress/campaign.h"

#include <algorithm>
#include <chrono>

#include "core/scene/diagnostic.h"
#include "core/scene/scene.h"
#include "tests/bench/stress/minimise.h"

namespace flatlight::stress {
namespace {

bool Chosen(const std::vector<std::string>& names, const std::string& name) {
  return names.empty() || std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace

CampaignResult RunCampaign(const CampaignOptions& options, const CampaignListener& listener) {
  using Time = std::chrono::steady_clock;
  const auto since = [](Time::time_point begin) { return std::chrono::duration<double>(Time::now() - begin).count(); };
  CampaignResult result;
  const std::uint64_t end = options.first + options.scenes;
  for (std::uint64_t number = options.first; number < end; ++number) {
    for (const Family& family : Families()) {
      const std::uint64_t share = family.crowding == Crowding::kFew ? 1 : kCrowdedShare;
      if (!Chosen(options.families, family.name) || number % share != 0) continue;
      if (!listener.go_on()) return result;
      const SceneDescription scene = MakeScene(family, options.seed, number);
      ++result.scenes;
      const std::uint64_t count = number / share;
      for (const Check& check : Checks()) {
        if (!Chosen(options.checks, check.name) || family.crowding > check.most) continue;
        if (options.checks.empty() && count % static_cast<std::uint64_t>(check.every) != 0) continue;
        const std::uint64_t check_seed = Mixed(options.seed, number);
        CampaignLine& line = result.lines[{family.name, check.name}];
        listener.starting(scene, check);
        const auto begin = Time::now();
        const Failure failure = check.run(scene, check_seed, result.tally);
        line.seconds += since(begin);
        ++line.scenes;
        if (!failure) continue;
        ++result.failures;
        if (static_cast<int>(++line.failures) > options.most_minimised) continue;
        Tally ignored;
        FoundFailure found{family.name, check.name, number, check_seed, *failure, scene, *failure};
        found.minimised = Minimised(scene, [&](const SceneDescription& smaller) {
          if (since(begin) > options.minimising_seconds) return false;
          Diagnostics diagnostics;
          if (check.name != "builds" && BuildScene(smaller, diagnostics) == nullptr) return false;
          listener.starting(smaller, check);
          return check.run(smaller, check_seed, ignored).has_value();
        });
        found.what_minimised = check.run(found.minimised, check_seed, ignored).value_or("");
        listener.found(found);
        result.found.push_back(std::move(found));
      }
    }
  }
  return result;
}

}  // namespace flatlight::stress
