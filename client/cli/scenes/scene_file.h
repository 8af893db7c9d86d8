// SPDX-License-Identifier: Apache-2.0
// The SCENE of a command line.
#ifndef FLATLIGHT_CLIENT_CLI_SCENES_SCENE_FILE_H_
#define FLATLIGHT_CLIENT_CLI_SCENES_SCENE_FILE_H_

#include <cstddef>
#include <cstdint>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "client/cli/connection/interruption.h"

namespace flatlight {

inline constexpr std::size_t kHashDigits = 64;  // Of scenes/HASH.

// A scene of the server ("gallery:NAME" is scenes/NAME, and scenes/HASH an upload) or a file to upload ("-" is standard
// input).
struct SceneArgument {
  std::string label;  // For messages: as written, but "standard input" for "-".
  std::string name;   // "scenes/NAME"; empty for a file.
  std::string path;   // Of a file.
  bool from_server() const { return !name.empty(); }
};

absl::StatusOr<SceneArgument> ParseSceneArgument(const std::string& text);

// Whether the file can be read, as far as that can be known without reading it. Done before a server is started for it.
absl::Status CheckSceneFile(const SceneArgument& scene);

// The bytes of a file ("-" is standard input) that has at most `limit`. A longer one is refused before it is read (a
// pipe: when the limit is passed). `label` names it in errors. INTERRUPTED as soon as a signal comes, also while
// nothing comes from a pipe or a terminal.
absl::StatusOr<std::string> ReadFile(const std::string& path, const std::string& label, std::uint64_t limit,
                                     const Interruption& interruption);

}  // namespace flatlight

#endif  // FLATLIGHT_CLIENT_CLI_SCENES_SCENE_FILE_H_
