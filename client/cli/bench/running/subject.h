// SPDX-License-Identifier: Apache-2.0
// A scene of a benchmark, with the methods that are to run on it and the truth that they are measured against.
#ifndef FLATLIGHT_CLIENT_CLI_BENCH_RUNNING_SUBJECT_H_
#define FLATLIGHT_CLIENT_CLI_BENCH_RUNNING_SUBJECT_H_

#include <memory>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "client/cli/bench/plan/truth_choice.h"
#include "client/cli/connection/connection.h"
#include "client/cli/options/bench_options.h"
#include "client/cli/scenes/scene_file.h"

namespace flatlight {

// A method with its settings in one scene; its runs add samples and seed.
struct BenchMethod {
  std::string name;
  v1::Settings settings;  // Of the request.
  std::string text;       // Of the column `settings`.
  std::uint32_t threads = 0;
  bool takes_samples = false;
  bool takes_seed = false;
  bool takes_photons = false;  // As many as go with the samples.
};

struct Subject {
  SceneArgument argument;
  v1::SceneSource source;
  std::string hash;  // Of the column `sceneHash`.
  TruthChoice truth;
  std::vector<BenchMethod> methods;
};

// Scenes and truths that were prepared, and what the user should know of them.
struct Subjects {
  std::vector<Subject> subjects;
  std::vector<std::unique_ptr<v1::RenderResult>> truths;  // Files that the subjects' choices point to.
  std::vector<std::string> notes;
};

// `settings` are those of all methods. Reads and uploads files; every mistake is found before the first run: bad
// scenes, scenes given twice, truths of no scene, methods that cannot do what is asked.
absl::StatusOr<Subjects> PrepareSubjects(Connection& connection, const BenchOptions& options,
                                         const v1::Settings& settings);

}  // namespace flatlight

#endif  // FLATLIGHT_CLIENT_CLI_BENCH_RUNNING_SUBJECT_H_
