// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_STORE_SCENE_STORE_H_
#define FLATLIGHT_SERVER_STORE_SCENE_STORE_H_

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "server/store/grants.h"

namespace flatlight {

// A scene file that was uploaded whole.
struct StoredScene {
  std::string sha256;  // Of the bytes; its name is scenes/{sha256}.
  std::string title;   // The scene's own name; empty until somebody (in a list of one owner's: it) has read the file.
  std::shared_ptr<const std::string> bytes;
};

struct ScenePage {
  std::vector<StoredScene> scenes;           // Newest first.
  std::optional<std::uint64_t> next_before;  // Where the next page begins; absent on the last page.
};

// How much room one's uploads have: `allowed` bytes, of which `elsewhere` are used for something else.
struct SceneRoom {
  std::uint64_t allowed = 0;
  std::uint64_t elsewhere = 0;
};

// Uploaded scene files, by the hash of their bytes, and who uploaded them. The bytes are kept once. No answer to one
// user depends on what others have uploaded, as long as there is room. Safe to use from any thread.
class SceneStore {
 public:
  virtual ~SceneStore() = default;

  // Appends a piece to an upload of `owner` and returns how many of its bytes are there. Empty `data` only asks.
  // `offset` must be that number (OUT_OF_RANGE says what it is). The last piece completes the scene; if the bytes do
  // not have the hash, they are thrown away (INVALID_ARGUMENT). Of a scene that it has uploaded already all bytes are
  // there. RESOURCE_EXHAUSTED where the owner's `room` does not suffice, if there is an end of it; uploads of its own
  // that are unfinished and idle give way.
  virtual absl::StatusOr<std::uint64_t> Upload(const std::string& owner, const std::string& sha256,
                                               std::uint64_t total_bytes, std::uint64_t offset, std::string_view data,
                                               const std::optional<SceneRoom>& room) = 0;
  absl::StatusOr<std::uint64_t> Upload(const std::string& owner, const std::string& sha256, std::uint64_t total_bytes,
                                       std::uint64_t offset, std::string_view data) {
    return Upload(owner, sha256, total_bytes, offset, data, std::nullopt);
  }
  // Of all scenes and unfinished uploads of an owner, whoever else has them.
  virtual std::uint64_t BytesOf(const std::string& owner) = 0;
  // Whoever has it. NOT_FOUND.
  virtual absl::StatusOr<StoredScene> Get(const std::string& sha256) = 0;
  virtual bool Owns(const std::string& owner, const std::string& sha256) = 0;
  // `reader` has read the file. Whether that is news.
  virtual bool SetTitle(const std::string& reader, const std::string& sha256, const std::string& title) = 0;
  // At most `limit` scenes from the newest one, or from the newest one before `before`: those of `owner`, or all.
  // Positions of one owner's scenes are its own: they tell nothing of others.
  virtual ScenePage List(const std::optional<std::string>& owner, std::optional<std::uint64_t> before,
                         std::size_t limit) = 0;
  // The same, of scenes that others share with one of `who` and `reader` has not uploaded; with the title that one of
  // those who share it has read.
  virtual ScenePage ListShared(const std::vector<Grantee>& who, const std::string& reader,
                               std::optional<std::uint64_t> before, std::size_t limit) = 0;
  // All who have it, in order.
  virtual std::vector<std::string> OwnersOf(const std::string& sha256) = 0;

  // Each owner shares a scene for itself, as long as it has it. NOT_FOUND if it does not; else as AddGrant and
  // RemoveGrant.
  virtual absl::Status Share(const std::string& owner, const std::string& sha256, const Grant& grant) = 0;
  virtual absl::Status Unshare(const std::string& owner, const std::string& sha256, const Grantee& grantee) = 0;
  // None, of a scene that the owner does not have.
  virtual std::vector<Grant> GrantsOf(const std::string& owner, const std::string& sha256) = 0;
  // Which owners share it with one who is all of `who`, and what each allows.
  virtual std::map<std::string, Access> SharedBy(const std::string& sha256, const std::vector<Grantee>& who) = 0;

  // Takes it from one owner; it goes with the last one. NOT_FOUND if the owner does not have it.
  virtual absl::Status Disown(const std::string& owner, const std::string& sha256) = 0;
  // Takes it from all. NOT_FOUND.
  virtual absl::Status Delete(const std::string& sha256) = 0;
};

// NOT_FOUND.
absl::Status NoSuchScene(const std::string& sha256);
// RESOURCE_EXHAUSTED: of what one user may store, so much is used; `more` bytes were wanted (0: any).
absl::Status StorageUsedUp(std::uint64_t used, std::uint64_t allowed, std::uint64_t more);

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_STORE_SCENE_STORE_H_
