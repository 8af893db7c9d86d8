// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CLIENT_CLI_OPTIONS_COMMAND_LINE_H_
#define FLATLIGHT_CLIENT_CLI_OPTIONS_COMMAND_LINE_H_

#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "client/cli/options/bench_options.h"
#include "client/cli/options/room_options.h"
#include "client/cli/tls/tls.h"
#include "flatlight/v1/render_service.pb.h"
#include "flatlight/v1/scene.pb.h"
#include "flatlight/v1/settings.pb.h"

namespace flatlight {

struct CommandLine {
  std::string version;     // Of this program: release and commit.
  std::string command;     // "render", "bench compare", ... Empty if all that is wanted is `text`.
  std::string text;        // Help or version, to print.
  std::string server;      // Of --server; empty if not given.
  std::string token_file;  // Of --token-file; empty if not given.
  TlsArguments tls;        // Of --tls-ca, --tls-cert, --tls-key and --tls-name.
  bool json = false;
  bool quiet = false;
  std::string scene;                    // SCENE as written; of `scenes`, the name of one, or empty.
  std::string job;                      // JOB as written.
  bool cancel_on_disconnect = false;    // Of `render` and `watch`.
  bool records = false;                 // Of `watch`: print them as they are made.
  bool once = false;                    // Of `top`.
  std::optional<double> prune_seconds;  // Of `jobs`: delete those that ended longer ago.
  bool rotate = false;                  // Of `webhook-secret`: make a new one.
  std::optional<double> keep_seconds;   // With it: for how long the earlier ones are used.
  bool shared = false;                  // Of `jobs` and `scenes`: those of others that are shared with the caller.
  bool mine = false;                    // Of `jobs` and `scenes`: the caller's own alone.
  bool remove = false;                  // Of `scenes`: delete the one that is named.
  std::vector<std::string> grantees;    // Of `share` and `unshare`.
  bool control = false;                 // Of `share`.
  std::string figure;                   // Of `figure`: its name.
  v1::Settings settings;
  v1::JobClass job_class = v1::INTERACTIVE;  // Of `submit`.
  bool anew = false;                         // Of `render` and `submit`.
  std::string webhook;                       // Of `submit`: a URL; empty if not given.
  std::string known_records;                 // Of --records: a result file or jobs/UUID; empty if not given.
  std::vector<v1::Probe> probes;             // Of --picture: in place of the scene's own.
  std::vector<std::string> outputs;
  std::vector<std::string> results;  // The two files of `compare` and of `bench compare`.
  std::optional<double> tolerance;   // Of `compare`.
  RoomOptions room;                  // Of `room`.
  BenchOptions bench;                // Of `bench` and `bench compare`.
};

// Errors end with ExitCode::kUsage.
absl::StatusOr<CommandLine> ParseCommandLine(int argc, const char* const* argv, const std::string& version);

}  // namespace flatlight

#endif  // FLATLIGHT_CLIENT_CLI_OPTIONS_COMMAND_LINE_H_
