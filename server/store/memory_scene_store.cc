// SPDX-License-Identifier: Apache-2.0
#include "server/store/memory_scene_store.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "server/store/error.h"

namespace flatlight {
namespace {

constexpr std::chrono::minutes kIdle{1};
constexpr std::chrono::milliseconds kRetryAfter{10'000};

absl::Status BadUpload(const std::string& reason, const std::string& message) {
  return MakeError(absl::StatusCode::kInvalidArgument, reason, message);
}

}  // namespace

absl::StatusOr<std::uint64_t> MemorySceneStore::Upload(const std::string& owner, const std::string& sha256,
                                                       std::uint64_t total_bytes, std::uint64_t offset,
                                                       std::string_view data, const std::optional<SceneRoom>& room) {
  if (!IsSha256(sha256)) return BadUpload("BAD_HASH", "sha256 must be 64 lower-case hexadecimal digits");
  if (total_bytes == 0 || total_bytes > limits_.max_scene_bytes) {
    return BadUpload("SCENE_TOO_BIG", "total_bytes is " + std::to_string(total_bytes) + "; allowed: 1 to " +
                                          std::to_string(limits_.max_scene_bytes));
  }
  std::shared_ptr<PartialUpload> upload;
  {
    const std::lock_guard lock(mutex_);
    if (const Entry* entry = Find(sha256); entry != nullptr && entry->owners.count(owner) > 0) {
      const std::uint64_t there = entry->scene.bytes->size();
      if (there == total_bytes) return there;
      return BadUpload("TOTAL_CHANGED", "the scene with this hash has " + std::to_string(there) +
                                            " bytes, not total_bytes = " + std::to_string(total_bytes));
    }
    if (data.empty() && uploads_.count({owner, sha256}) == 0) return std::uint64_t{0};
    auto opened = OpenUpload({owner, sha256}, total_bytes, room);
    if (!opened.ok()) return opened.status();
    upload = *opened;
  }
  const std::lock_guard lock(upload->mutex);
  const std::uint64_t there = upload->bytes ? upload->bytes->size() : 0;
  if (upload->closed) {
    return MakeError(absl::StatusCode::kAborted, "UPLOAD_CLOSED",
                     "this upload has just ended; ask how many bytes are there");
  }
  if (upload->total_bytes != total_bytes) {
    return BadUpload("TOTAL_CHANGED", "total_bytes is " + std::to_string(total_bytes) + "; earlier calls said " +
                                          std::to_string(upload->total_bytes));
  }
  if (data.empty()) return there;
  // Said again, by a client that heard no answer; the hash of the whole tells whether it was the same.
  if (offset < there && data.size() <= there - offset) return there;
  if (offset != there) {
    return MakeError(absl::StatusCode::kOutOfRange, "WRONG_OFFSET",
                     "offset is " + std::to_string(offset) + "; " + std::to_string(there) + " bytes are there");
  }
  if (data.size() > total_bytes - there) {
    return BadUpload("TOO_MANY_BYTES", "data has " + std::to_string(data.size()) + " bytes; " +
                                           std::to_string(total_bytes - there) + " are missing");
  }
  if (absl::Status reserved = Reserve({owner, sha256}, room, data.size()); !reserved.ok()) return reserved;
  upload->bytes->append(data);
  upload->hash.Add(data);
  if (upload->bytes->size() == total_bytes) return Complete({owner, sha256}, *upload);
  return std::uint64_t{upload->bytes->size()};
}

absl::StatusOr<std::shared_ptr<MemorySceneStore::PartialUpload>> MemorySceneStore::OpenUpload(
    const UploadName& name, std::uint64_t total_bytes, const std::optional<SceneRoom>& room) {
  const Clock::Time now = clock_.Now();
  if (const auto found = uploads_.find(name); found != uploads_.end()) {
    found->second->last_use = now;
    return found->second;
  }
  if (room) {
    if (absl::Status fits = CheckRoom(name, *room, total_bytes); !fits.ok()) return fits;
  }
  if (scenes_.size() >= limits_.max_scenes) {
    return MakeQuotaError("TOO_MANY_SCENES", "max_scenes",
                          "the server holds " + std::to_string(scenes_.size()) + " scenes; delete one first",
                          kRetryAfter);
  }
  if (uploads_.size() >= limits_.max_uploads) {
    const auto idlest = std::min_element(uploads_.begin(), uploads_.end(), [](const auto& a, const auto& b) {
      return a.second->last_use < b.second->last_use;
    });
    if (now - idlest->second->last_use < kIdle || !GiveWay(idlest)) {
      return MakeQuotaError(
          "TOO_MANY_UPLOADS", "max_uploads",
          std::to_string(uploads_.size()) + " uploads are under way; allowed: " + std::to_string(limits_.max_uploads),
          kRetryAfter);
    }
  }
  auto upload = std::make_shared<PartialUpload>();
  upload->total_bytes = total_bytes;
  upload->last_use = now;
  uploads_[name] = upload;
  return upload;
}

bool MemorySceneStore::GiveWay(std::map<UploadName, std::shared_ptr<PartialUpload>>::iterator upload) {
  const std::shared_ptr<PartialUpload> victim = upload->second;
  // One whose mutex is held elsewhere is in use, not idle.
  const std::unique_lock lock(victim->mutex, std::try_to_lock);
  if (!lock) return false;
  victim->closed = true;
  used_bytes_ -= victim->bytes->size();
  TakeBytes(upload->first.first, victim->bytes->size());
  uploads_.erase(upload);
  return true;
}

absl::Status MemorySceneStore::CheckRoom(const UploadName& name, const SceneRoom& room, std::uint64_t bytes) {
  const std::string& owner = name.first;
  const auto used = [&] {
    const auto own = bytes_of_.find(owner);
    return room.elsewhere + (own == bytes_of_.end() ? 0 : own->second);
  };
  const Clock::Time now = clock_.Now();
  auto upload = uploads_.lower_bound({owner, ""});
  while (used() + bytes > room.allowed && upload != uploads_.end() && upload->first.first == owner) {
    const auto next = std::next(upload);
    // (The upload itself is locked by its caller.)
    if (upload->first != name && now - upload->second->last_use >= kIdle) GiveWay(upload);
    upload = next;
  }
  if (used() + bytes <= room.allowed) return absl::OkStatus();
  return StorageUsedUp(used(), room.allowed, bytes);
}

void MemorySceneStore::AddBytes(const std::string& owner, std::uint64_t bytes) { bytes_of_[owner] += bytes; }

void MemorySceneStore::TakeBytes(const std::string& owner, std::uint64_t bytes) {
  const auto own = bytes_of_.find(owner);
  if (own == bytes_of_.end()) return;
  own->second -= std::min(own->second, bytes);
  if (own->second == 0) bytes_of_.erase(own);
}

std::uint64_t MemorySceneStore::BytesOf(const std::string& owner) {
  const std::lock_guard lock(mutex_);
  const auto own = bytes_of_.find(owner);
  return own == bytes_of_.end() ? 0 : own->second;
}

absl::Status MemorySceneStore::Reserve(const UploadName& name, const std::optional<SceneRoom>& room,
                                       std::uint64_t bytes) {
  const std::lock_guard lock(mutex_);
  if (room) {
    if (absl::Status fits = CheckRoom(name, *room, bytes); !fits.ok()) return fits;
  }
  if (used_bytes_ + bytes > limits_.max_total_bytes) {
    // How many there are would tell whether what was just uploaded is kept already.
    return MakeQuotaError("SCENE_STORE_FULL", "max_total_bytes",
                          "uploaded scenes fill the " + std::to_string(limits_.max_total_bytes) +
                              " bytes that are allowed for all; delete one first",
                          kRetryAfter);
  }
  used_bytes_ += bytes;
  AddBytes(name.first, bytes);
  return absl::OkStatus();
}

absl::StatusOr<std::uint64_t> MemorySceneStore::Complete(const UploadName& name, PartialUpload& upload) {
  const auto& [owner, sha256] = name;
  upload.closed = true;
  const std::string actual = upload.hash.Finish();
  const std::lock_guard lock(mutex_);
  const std::uint64_t size = upload.bytes->size();
  uploads_.erase(name);
  TakeBytes(owner, size);
  if (actual != sha256) {
    used_bytes_ -= size;
    upload.bytes.reset();
    return BadUpload("HASH_MISMATCH", "the bytes hash to " + actual + ", not to " + sha256 + "; they were thrown away");
  }
  used_bytes_ -= size;
  if (Find(sha256) == nullptr) AddLocked({sha256, "", std::move(upload.bytes)});
  upload.bytes.reset();
  AddOwnerLocked(owner, sha256, "");
  return size;
}

MemorySceneStore::Entry* MemorySceneStore::Find(const std::string& sha256) {
  const auto number = numbers_.find(sha256);
  return number == numbers_.end() ? nullptr : &scenes_.at(number->second);
}

MemorySceneStore::Ownership* MemorySceneStore::FindOwnership(const std::string& owner, const std::string& sha256) {
  Entry* entry = Find(sha256);
  if (entry == nullptr) return nullptr;
  const auto found = entry->owners.find(owner);
  return found == entry->owners.end() ? nullptr : &found->second;
}

void MemorySceneStore::AddLocked(StoredScene scene) {
  used_bytes_ += scene.bytes->size();
  const std::uint64_t number = next_number_++;
  numbers_[scene.sha256] = number;
  scenes_[number].scene = std::move(scene);
}

void MemorySceneStore::AddOwnerLocked(const std::string& owner, const std::string& sha256, const std::string& title) {
  Entry* entry = Find(sha256);
  if (entry == nullptr || entry->owners.count(owner) > 0) return;
  auto& owned = owned_[owner];
  const std::uint64_t number = owned.empty() ? 1 : owned.rbegin()->first + 1;
  owned[number] = {sha256, title};
  AddBytes(owner, entry->scene.bytes->size());
  entry->owners[owner] = {number};
}

void MemorySceneStore::ForgetOwned(const std::string& owner, std::uint64_t number) {
  const auto owned = owned_.find(owner);
  TakeBytes(owner, Find(owned->second.at(number).sha256)->scene.bytes->size());
  owned->second.erase(number);
  if (owned->second.empty()) owned_.erase(owned);
}

void MemorySceneStore::Erase(const std::string& sha256) {
  const auto number = numbers_.find(sha256);
  const auto scene = scenes_.find(number->second);
  for (const auto& [owner, ownership] : scene->second.owners) ForgetOwned(owner, ownership.number);
  used_bytes_ -= scene->second.scene.bytes->size();
  scenes_.erase(scene);
  numbers_.erase(number);
}

void MemorySceneStore::Add(StoredScene scene) {
  const std::lock_guard lock(mutex_);
  if (Find(scene.sha256) == nullptr) AddLocked(std::move(scene));
}

void MemorySceneStore::AddOwner(const std::string& owner, const std::string& sha256, const std::string& title) {
  const std::lock_guard lock(mutex_);
  AddOwnerLocked(owner, sha256, title);
}

absl::StatusOr<StoredScene> MemorySceneStore::Get(const std::string& sha256) {
  const std::lock_guard lock(mutex_);
  const Entry* entry = Find(sha256);
  if (entry == nullptr) return NoSuchScene(sha256);
  return entry->scene;
}

bool MemorySceneStore::Owns(const std::string& owner, const std::string& sha256) {
  const std::lock_guard lock(mutex_);
  const Entry* entry = Find(sha256);
  return entry != nullptr && entry->owners.count(owner) > 0;
}

bool MemorySceneStore::SetTitle(const std::string& reader, const std::string& sha256, const std::string& title) {
  const std::lock_guard lock(mutex_);
  Entry* entry = Find(sha256);
  if (entry == nullptr) return false;
  bool news = std::exchange(entry->scene.title, title) != title;
  if (const auto own = entry->owners.find(reader); own != entry->owners.end()) {
    news |= std::exchange(owned_.at(reader).at(own->second.number).title, title) != title;
  }
  return news;
}

ScenePage MemorySceneStore::List(const std::optional<std::string>& owner, std::optional<std::uint64_t> before,
                                 std::size_t limit) {
  const std::lock_guard lock(mutex_);
  ScenePage page;
  const auto list = [&](const auto& all, const auto& scene_of) {
    auto scene = before ? all.lower_bound(*before) : all.end();
    while (scene != all.begin() && page.scenes.size() < limit) {
      --scene;
      page.scenes.push_back(scene_of(scene->second));
    }
    if (scene != all.begin()) page.next_before = scene->first;
  };
  if (!owner) {
    list(scenes_, [](const Entry& entry) { return entry.scene; });
  } else if (const auto owned = owned_.find(*owner); owned != owned_.end()) {
    list(owned->second, [&](const Owned& own) {
      return StoredScene{own.sha256, own.title, Find(own.sha256)->scene.bytes};
    });
  }
  return page;
}

ScenePage MemorySceneStore::ListShared(const std::vector<Grantee>& who, const std::string& reader,
                                       std::optional<std::uint64_t> before, std::size_t limit) {
  const std::lock_guard lock(mutex_);
  ScenePage page;
  std::uint64_t last = 0;
  auto scene = before ? scenes_.lower_bound(*before) : scenes_.end();
  while (scene != scenes_.begin()) {
    --scene;
    const auto& [number, entry] = *scene;
    if (entry.owners.count(reader) > 0) continue;
    bool shared = false;
    std::string title;
    for (const auto& [owner, ownership] : entry.owners) {
      if (!AccessOf(ownership.grants, who)) continue;
      shared = true;
      if (title.empty()) title = owned_.at(owner).at(ownership.number).title;
    }
    if (!shared) continue;
    if (page.scenes.size() == limit) {
      page.next_before = last;
      break;
    }
    page.scenes.push_back({entry.scene.sha256, std::move(title), entry.scene.bytes});
    last = number;
  }
  return page;
}

std::vector<std::string> MemorySceneStore::OwnersOf(const std::string& sha256) {
  const std::lock_guard lock(mutex_);
  std::vector<std::string> owners;
  if (const Entry* entry = Find(sha256)) {
    for (const auto& [owner, ownership] : entry->owners) owners.push_back(owner);
  }
  return owners;
}

absl::Status MemorySceneStore::Share(const std::string& owner, const std::string& sha256, const Grant& grant) {
  const std::lock_guard lock(mutex_);
  Ownership* ownership = FindOwnership(owner, sha256);
  return ownership == nullptr ? NoSuchScene(sha256) : AddGrant("scenes/" + sha256, grant, ownership->grants);
}

absl::Status MemorySceneStore::Unshare(const std::string& owner, const std::string& sha256, const Grantee& grantee) {
  const std::lock_guard lock(mutex_);
  Ownership* ownership = FindOwnership(owner, sha256);
  return ownership == nullptr ? NoSuchScene(sha256) : RemoveGrant("scenes/" + sha256, grantee, ownership->grants);
}

std::vector<Grant> MemorySceneStore::GrantsOf(const std::string& owner, const std::string& sha256) {
  const std::lock_guard lock(mutex_);
  const Ownership* ownership = FindOwnership(owner, sha256);
  return ownership == nullptr ? std::vector<Grant>() : ownership->grants;
}

std::map<std::string, Access> MemorySceneStore::SharedBy(const std::string& sha256, const std::vector<Grantee>& who) {
  const std::lock_guard lock(mutex_);
  std::map<std::string, Access> shared;
  if (const Entry* entry = Find(sha256)) {
    for (const auto& [owner, ownership] : entry->owners) {
      if (const auto access = AccessOf(ownership.grants, who)) shared[owner] = *access;
    }
  }
  return shared;
}

absl::Status MemorySceneStore::Disown(const std::string& owner, const std::string& sha256) {
  const std::lock_guard lock(mutex_);
  Entry* entry = Find(sha256);
  if (entry == nullptr || entry->owners.count(owner) == 0) return NoSuchScene(sha256);
  if (entry->owners.size() == 1) {
    Erase(sha256);
    return absl::OkStatus();
  }
  ForgetOwned(owner, entry->owners.at(owner).number);
  entry->owners.erase(owner);
  return absl::OkStatus();
}

absl::Status MemorySceneStore::Delete(const std::string& sha256) {
  const std::lock_guard lock(mutex_);
  if (Find(sha256) == nullptr) return NoSuchScene(sha256);
  Erase(sha256);
  return absl::OkStatus();
}

}  // namespace flatlight
