// SPDX-License-Identifier: Apache-2.0
// Scene after scene, every check on each.
#ifndef FLATLIGHT_TESTS_BENCH_STRESS_CAMPAIGN_H_
#define FLATLIGHT_TESTS_BENCH_STRESS_CAMPAIGN_H_

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "core/scene/description.h"
#include "tests/bench/stress/checks.h"
#include "tests/bench/stress/families.h"
#include "tests/bench/stress/tally.h"

namespace flatlight::stress {

struct CampaignOptions {
  std::uint64_t seed = 1;
  std::uint64_t first = 0;            // Number of the first scene of each family.
  std::uint64_t scenes = 1000;        // Of each family; of crowded ones 1 in kCrowdedShare.
  std::vector<std::string> families;  // Only these; empty: all.
  std::vector<std::string> checks;    // Only these; empty: all. Those that are named look at every scene.
  int most_minimised = 2;             // Failures of each check in each family that are minimised; the rest counts.
  double minimising_seconds = 2;      // For each of them.
};

struct FoundFailure {
  std::string family;
  std::string check;
  std::uint64_t number = 0;  // Of the scene.
  std::uint64_t check_seed = 0;
  std::string what;
  SceneDescription minimised;
  std::string what_minimised;
};

struct CampaignLine {
  std::uint64_t scenes = 0;
  std::uint64_t failures = 0;
  double seconds = 0;
};

struct CampaignResult {
  std::uint64_t scenes = 0;
  std::uint64_t failures = 0;
  std::vector<FoundFailure> found;
  std::map<std::pair<std::string, std::string>, CampaignLine> lines;  // By family and check.
  Tally tally;
};

inline constexpr std::uint64_t kCrowdedShare = 50;

// What a campaign tells on its way.
struct CampaignListener {
  std::function<bool()> go_on = [] { return true; };  // Asked before each scene.
  std::function<void(const SceneDescription&, const Check&)> starting = [](const auto&, const auto&) {};
  std::function<void(const FoundFailure&)> found = [](const auto&) {};
};

// Goes through the families again and again, so that a campaign cut short has seen all alike.
CampaignResult RunCampaign(const CampaignOptions& options, const CampaignListener& listener = {});

}  // namespace flatlight::stress

#endif  // FLATLIGHT_TESTS_BENCH_STRESS_CAMPAIGN_H_
