// SPDX-License-Identifier: Apache-2.0
// What is on disk: versions, blobs, and who may use the folder.
#include "server/store/storage.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>

#include "server/store/backup.h"
#include "server/store/error.h"
#include "server/store/job_archive.h"
#include "server/store/schema.h"
#include "tests/support/status/status_matchers.h"
#include "tests/support/status/temporary_folder.h"

namespace flatlight {
namespace {

namespace fs = std::filesystem;
using ::testing::_;
using ::testing::HasSubstr;
using testing::IsOk;
using testing::StatusIs;

const std::string kLarge(Storage::kMostInlineBytes + 1, 'x');

class StorageTest : public ::testing::Test {
 protected:
  std::unique_ptr<Storage> Open() {
    auto storage = Storage::Open(folder_.path());
    EXPECT_THAT(storage, IsOk());
    return storage.ok() ? *std::move(storage) : nullptr;
  }
  std::size_t Files() const {
    std::size_t files = 0;
    for (const auto& entry : fs::recursive_directory_iterator(Storage::BlobFolder(folder_.path()))) {
      files += entry.is_regular_file() ? 1 : 0;
    }
    return files;
  }
  static JobId Insert(JobArchive& archive, const std::string& request,
                      const std::optional<RequestKey>& key = std::nullopt) {
    const JobId id = JobId::Random();
    const auto made =
        archive.Insert(id, "me", "message", {request, "", nullptr}, key, std::chrono::system_clock::now());
    EXPECT_THAT(made, IsOk());
    return made.ok() ? *made : JobId();
  }
  static absl::Status End(JobArchive& archive, const JobId& id, const std::string& result) {
    return archive.End(id,
                       {.message = "ended", .sequence = 5, .result = result, .time = std::chrono::system_clock::now()});
  }

  testing::TemporaryFolder folder_;
};

TEST_F(StorageTest, WhatIsCommittedIsThereAgain) {
  JobId small, large;
  {
    const auto storage = Open();
    JobArchive archive(*storage, "build");
    small = Insert(archive, "small");
    large = Insert(archive, kLarge);
    ASSERT_THAT(archive.SaveCheckpoint(large, "one"), IsOk());
    ASSERT_THAT(archive.SaveCheckpoint(large, "two"), IsOk());
    ASSERT_THAT(End(archive, small, kLarge + "result"), IsOk());
  }
  const auto storage = Open();
  JobArchive archive(*storage, "build");
  const auto unfinished = archive.Unfinished();
  ASSERT_THAT(unfinished, IsOk());
  ASSERT_EQ(unfinished->size(), 1u);
  EXPECT_EQ(unfinished->front().id, large);
  EXPECT_EQ(archive.FetchSubmission(large)->request, kLarge);
  EXPECT_EQ(*archive.FetchCheckpoint(large), "two");
  const auto ended = archive.Get(small);
  ASSERT_THAT(ended, IsOk());
  EXPECT_EQ(ended->message, "ended");
  EXPECT_EQ(ended->sequence, 5u);
  EXPECT_EQ(*archive.Fetch(*ended->result), kLarge + "result");
}

TEST_F(StorageTest, BytesThatNothingNamesAreRemoved) {
  const auto storage = Open();
  JobArchive archive(*storage, "build");
  const JobId first = Insert(archive, kLarge);
  const JobId second = Insert(archive, kLarge);
  EXPECT_EQ(Files(), 1u);  // The same bytes are there once.
  ASSERT_THAT(archive.SaveCheckpoint(first, kLarge + "1"), IsOk());
  ASSERT_THAT(archive.SaveCheckpoint(first, kLarge + "2"), IsOk());
  EXPECT_EQ(Files(), 2u);
  ASSERT_THAT(archive.Delete(first), IsOk());
  EXPECT_EQ(Files(), 1u);
  EXPECT_EQ(archive.FetchSubmission(second)->request, kLarge);
  ASSERT_THAT(archive.Delete(second), IsOk());
  EXPECT_EQ(Files(), 0u);
  EXPECT_THAT(archive.Delete(second), StatusIs(absl::StatusCode::kNotFound, HasSubstr(second.Name())));
}

TEST_F(StorageTest, WhatWasBrokenOffIsSweptAtTheStart) {
  {
    const auto storage = Open();
    JobArchive archive(*storage, "build");
    Insert(archive, kLarge);
    ASSERT_THAT(storage->Prepare(kLarge + "never used"), IsOk());
    std::ofstream(Storage::BlobFolder(folder_.path()) + "/half.part") << "half";
    EXPECT_EQ(Files(), 3u);
  }
  const auto storage = Open();
  EXPECT_EQ(Files(), 1u);
}

TEST_F(StorageTest, DamagedBytesAreNotGivenOut) {
  const auto storage = Open();
  JobArchive archive(*storage, "build");
  const JobId id = Insert(archive, kLarge);
  for (const auto& entry : fs::recursive_directory_iterator(Storage::BlobFolder(folder_.path()))) {
    if (!entry.is_regular_file()) continue;
    std::fstream file(entry.path());
    file.seekp(1000);
    file.put('y');
  }
  const auto submission = archive.FetchSubmission(id);
  EXPECT_THAT(submission, StatusIs(absl::StatusCode::kDataLoss, HasSubstr(Storage::BlobFolder(folder_.path()))));
  EXPECT_EQ(ReasonOf(submission.status()), "STORAGE_DAMAGED");
}

TEST_F(StorageTest, OneServerAtATime) {
  auto storage = Open();
  const auto second = Storage::Open(folder_.path());
  EXPECT_THAT(second, StatusIs(absl::StatusCode::kUnavailable, HasSubstr("another server uses " + folder_.path())));
  storage.reset();
  EXPECT_THAT(Storage::Open(folder_.path()), IsOk());
}

TEST_F(StorageTest, TheSameRequestMakesOneJobAlsoAfterARestart) {
  const RequestKey key{"me", "CreateJob", "id", "body"};
  JobId first;
  {
    const auto storage = Open();
    JobArchive archive(*storage, "build");
    first = Insert(archive, "a", key);
  }
  const auto storage = Open();
  JobArchive archive(*storage, "build");
  EXPECT_EQ(Insert(archive, "b", key), first);
  const WallTime now = std::chrono::system_clock::now();
  EXPECT_EQ(*archive.FindRequest(key, now), first);
  RequestKey other = key;
  other.fingerprint = "another body";
  EXPECT_THAT(archive.FindRequest(other, now), StatusIs(absl::StatusCode::kAlreadyExists, HasSubstr(first.Name())));
  EXPECT_EQ(*archive.FindRequest(key, now + std::chrono::hours(25)), std::nullopt);
}

TEST_F(StorageTest, EveryOlderVersionIsBroughtUpToDate) {
  for (std::size_t version = 1; version < Migrations().size(); ++version) {
    const testing::TemporaryFolder old;
    {
      const auto database = Database::Open(Storage::DatabasePath(old.path()));
      ASSERT_THAT(database, IsOk());
      ASSERT_THAT(Migrate(**database, version), IsOk());
      ASSERT_THAT((*database)->Execute("INSERT INTO blobs VALUES('s', 'bytes', 1);"
                                       "INSERT INTO jobs(uuid, owner, request, message, sequence, build) VALUES("
                                       "'12345678-1234-4234-8234-123456789abc', 'me', 's', 'message', 0, 'old')"),
                  IsOk());
    }
    const auto storage = Storage::Open(old.path());
    ASSERT_THAT(storage, IsOk());
    JobArchive archive(**storage, "build");
    EXPECT_EQ(archive.Unfinished()->size(), 1u) << "from version " << version;
    EXPECT_THAT((*storage)->Read([](Database& database) { return database.Execute("SELECT title FROM scenes"); }),
                IsOk());
    EXPECT_THAT(
        (*storage)->Read([](Database& database) { return database.Execute("SELECT user FROM webhook_secrets"); }),
        IsOk());
  }
}

TEST_F(StorageTest, ALaterVersionIsRefused) {
  Open();
  {
    const auto database = Database::Open(Storage::DatabasePath(folder_.path()));
    ASSERT_THAT((*database)->Execute("PRAGMA user_version = 99"), IsOk());
  }
  EXPECT_THAT(Storage::Open(folder_.path()),
              StatusIs(absl::StatusCode::kFailedPrecondition, HasSubstr("has version 99; this Flatlight knows")));
}

// Files may not grow beyond a size while this lives: as on a full disk.
class FullDisk {
 public:
  explicit FullDisk(rlim_t bytes) {
    std::signal(SIGXFSZ, SIG_IGN);
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FullDisk() { setrlimit(RLIMIT_FSIZE, &before_); }

 private:
  rlimit before_{};
};

TEST_F(StorageTest, AFullDiskRefusesAndHarmsNothing) {
  const auto storage = Open();
  JobArchive archive(*storage, "build");
  const JobId kept = Insert(archive, kLarge);
  for (const std::string& bytes : {kLarge + "more", std::string("small")}) {
    {
      const FullDisk full(1000);
      const auto refused = archive.Insert(JobId::Random(), "me", "message", {bytes, "", nullptr}, std::nullopt,
                                          std::chrono::system_clock::now());
      EXPECT_THAT(refused, StatusIs(absl::StatusCode::kResourceExhausted, HasSubstr(folder_.path())));
      EXPECT_THAT(std::string(refused.status().message()), HasSubstr("free some space"));
      EXPECT_EQ(ReasonOf(refused.status()), "STORAGE_FULL");
      EXPECT_THAT(End(archive, kept, bytes), StatusIs(absl::StatusCode::kResourceExhausted, _));
    }
    EXPECT_EQ(archive.Unfinished()->size(), 1u);
    EXPECT_EQ(archive.FetchSubmission(kept)->request, kLarge);
    EXPECT_EQ(Files(), 1u);
  }
  ASSERT_THAT(End(archive, kept, "result"), IsOk());
}

TEST_F(StorageTest, ABackupIsWholeWhileJobsEnd) {
  const testing::TemporaryFolder elsewhere;
  const std::string backup = elsewhere.path() + "/backup", restored = elsewhere.path() + "/restored";
  const auto storage = Open();
  JobArchive archive(*storage, "build");
  const JobId ended = Insert(archive, kLarge);
  const JobId open = Insert(archive, kLarge + "open");
  ASSERT_THAT(archive.SaveCheckpoint(open, kLarge + "checkpoint"), IsOk());
  ASSERT_THAT(End(archive, ended, kLarge + "result"), IsOk());
  // At the worst moment, after the database has been copied, its files change.
  ASSERT_THAT(BackUp(folder_.path(), backup,
                     [&, first = true]() mutable {
                       if (!std::exchange(first, false)) return;
                       ASSERT_THAT(archive.SaveCheckpoint(open, kLarge + "later"), IsOk());
                       ASSERT_THAT(archive.Delete(ended), IsOk());
                     }),
              IsOk());
  EXPECT_THAT(BackUp(folder_.path(), backup), StatusIs(absl::StatusCode::kAlreadyExists, HasSubstr(backup)));
  ASSERT_THAT(RestoreBackup(backup, restored), IsOk());
  EXPECT_THAT(RestoreBackup(backup, folder_.path()), StatusIs(absl::StatusCode::kAlreadyExists, _));
  const auto again = Storage::Open(restored);
  ASSERT_THAT(again, IsOk());
  JobArchive copy(**again, "build");
  EXPECT_THAT(copy.Get(ended), StatusIs(absl::StatusCode::kNotFound, _));
  EXPECT_EQ(**copy.FetchCheckpoint(open), kLarge + "later");
  EXPECT_EQ(copy.FetchSubmission(open)->request, kLarge + "open");
}

TEST_F(StorageTest, ADamagedBackupIsNotRestored) {
  const testing::TemporaryFolder elsewhere;
  const std::string backup = elsewhere.path() + "/backup", restored = elsewhere.path() + "/restored";
  {
    const auto storage = Open();
    JobArchive archive(*storage, "build");
    Insert(archive, kLarge);
    ASSERT_THAT(BackUp(folder_.path(), backup), IsOk());
  }
  for (const auto& entry : fs::recursive_directory_iterator(Storage::BlobFolder(backup))) {
    if (entry.is_regular_file()) std::ofstream(entry.path(), std::ios::app) << "more";
  }
  EXPECT_THAT(RestoreBackup(backup, restored), StatusIs(absl::StatusCode::kDataLoss, HasSubstr(backup)));
  EXPECT_FALSE(fs::exists(Storage::DatabasePath(restored)));
  EXPECT_THAT(BackUp(elsewhere.path() + "/nothing", backup + "2"),
              StatusIs(absl::StatusCode::kNotFound, HasSubstr("nothing")));
}

}  // namespace
}  // namespace flatlight
