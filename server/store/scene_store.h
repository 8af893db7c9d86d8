// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_STORE_SCENE_STORE_H_
#define FLATLIGHT_SERVER_STORE_SCENE_STORE_H_

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"

namespace flatlight {

// A scene file that was uploaded whole.
struct StoredScene {
  std::string sha256;  // Of the bytes; its name is scenes/{sha256}.
  std::string title;   // The scene's own name; empty until somebody has read the file.
  std::shared_ptr<const std::string> bytes;
};

struct ScenePage {
  std::vector<StoredScene> scenes;           // Newest first.
  std::optional<std::uint64_t> next_before;  // Where the next page begins; absent on the last page.
};

// Uploaded scene files, by the hash of their bytes. Safe to use from any thread.
class SceneStore {
 public:
  virtual ~SceneStore() = default;

  // Appends a piece to an upload and returns how many bytes are there. Empty `data` only asks. `offset` must be that
  // number (OUT_OF_RANGE says what it is). The last piece completes the scene; if the bytes do not have the hash, they
  // are thrown away (INVALID_ARGUMENT). A scene that is there already stays: all of its bytes are there.
  virtual absl::StatusOr<std::uint64_t> Upload(const std::string& sha256, std::uint64_t total_bytes,
                                               std::uint64_t offset, std::string_view data) = 0;
  virtual absl::StatusOr<StoredScene> Get(const std::string& sha256) = 0;
  virtual void SetTitle(const std::string& sha256, const std::string& title) = 0;
  virtual ScenePage List(std::optional<std::uint64_t> before, std::size_t limit) = 0;
  virtual absl::Status Delete(const std::string& sha256) = 0;
};

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_STORE_SCENE_STORE_H_
