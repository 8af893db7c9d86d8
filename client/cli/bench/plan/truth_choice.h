// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CLIENT_CLI_BENCH_PLAN_TRUTH_CHOICE_H_
#define FLATLIGHT_CLIENT_CLI_BENCH_PLAN_TRUTH_CHOICE_H_

#include <cstdint>
#include <optional>
#include <string>

#include "flatlight/v1/result.pb.h"
#include "flatlight/v1/server_service.pb.h"
#include "flatlight/v1/settings.pb.h"

namespace flatlight {

// What errors of a scene's runs are against.
struct TruthChoice {
  std::string name;                    // Of the column `truth`; "exact".
  std::optional<v1::Settings> render;  // How to render it; absent if it is a file's.
  const v1::RenderResult* file = nullptr;
  std::optional<std::uint32_t> max_bounces;  // Of the runs; absent: all.
  std::string note;                          // What the user should know; may be empty.
};

struct TruthQuestion {
  double max_reflectance = 0;                // Of the scene.
  bool reference = true;                     // Whether method `reference` takes it, with the bounces.
  std::optional<std::uint32_t> max_bounces;  // As the user wants it.
  const v1::RenderResult* file = nullptr;    // The user's truth for the scene, if there is one.
  std::string file_name;                     // "file 0123456789ab".
  std::optional<std::uint32_t> samples;      // Of --truth-samples.
};

// The best truth that there is: the user's own; else many samples, if the user wants so; else `exact`, where all
// light is direct; else the server's `reference`, where it can do the scene; else `exact` all the same, and if bounces
// were not asked for the runs then are, too. Bounces that nothing gives the truth of are bad usage: the message is in
// `note`, and neither `render` nor `file` is set.
TruthChoice ChooseTruth(const TruthQuestion& question, const v1::GetCapabilitiesResponse& server);

}  // namespace flatlight

#endif  // FLATLIGHT_CLIENT_CLI_BENCH_PLAN_TRUTH_CHOICE_H_
