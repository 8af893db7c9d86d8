// SPDX-License-Identifier: Apache-2.0
#include "server/store/job_archive.h"

#include <functional>
#include <utility>

#include "server/store/error.h"
#include "server/store/grant_table.h"
#include "server/store/webhook_table.h"

namespace flatlight {
namespace {

using Writing = Storage::Writing;

constexpr char kColumns[] = "SELECT uuid, owner, message, sequence, result, number, paused FROM jobs ";

std::int64_t SecondsOf(WallTime time) {
  return std::chrono::duration_cast<std::chrono::seconds>(time.time_since_epoch()).count();
}

ArchivedJob JobOf(const Statement& row) {
  ArchivedJob job;
  job.id = *JobId::FromName("jobs/" + row.Bytes(0));
  job.owner = row.Bytes(1);
  job.message = row.Bytes(2);
  job.sequence = static_cast<std::uint64_t>(row.Integer(3));
  job.result = row.OptionalBytes(4);
  job.paused = !job.ended() && row.Integer(6) != 0;
  return job;
}

// The number of a job; NOT_FOUND if there is none.
absl::StatusOr<std::int64_t> NumberOf(Database& database, const JobId& id) {
  Statement number = database.Prepare("SELECT number FROM jobs WHERE uuid = ?");
  number.Bind(std::string_view(id.uuid()));
  const auto row = number.Step();
  if (!row.ok()) return row.status();
  if (!*row) return NoSuchJob(id);
  return number.Integer(0);
}

absl::StatusOr<std::optional<JobId>> Find(Database& database, const RequestKey& key) {
  Statement request =
      database.Prepare("SELECT fingerprint, uuid FROM requests WHERE caller = ? AND method = ? AND request_id = ?");
  request.Bind(std::string_view(key.caller)).Bind(std::string_view(key.method)).Bind(std::string_view(key.request_id));
  const auto row = request.Step();
  if (!row.ok()) return row.status();
  if (!*row) return std::optional<JobId>();
  const auto id = JobId::FromName("jobs/" + request.Bytes(1));
  if (request.Bytes(0) != key.fingerprint) return RequestIdReused(key, *id);
  return id;
}

std::int64_t FirstNumber(std::optional<std::uint64_t> before) {
  return before ? static_cast<std::int64_t>(*before) : INT64_MAX;
}

using Query = std::function<Statement(Database&)>;  // Of kColumns.

absl::StatusOr<std::vector<ArchivedJob>> JobsOf(Storage& storage, const Query& query) {
  std::vector<ArchivedJob> jobs;
  absl::Status read = storage.Read([&](Database& database) {
    return query(database).ForEachRow([&](const Statement& row) { jobs.push_back(JobOf(row)); });
  });
  if (!read.ok()) return read;
  return jobs;
}

// Of a query that gives up to one job more than `limit`.
absl::StatusOr<JobArchive::Page> ReadPage(Storage& storage, std::size_t limit, const Query& query) {
  JobArchive::Page page;
  const absl::Status read = storage.Read([&](Database& database) -> absl::Status {
    Statement jobs = query(database);
    while (true) {
      const auto row = jobs.Step();
      if (!row.ok()) return row.status();
      if (!*row) return absl::OkStatus();
      if (page.jobs.size() == limit) {
        page.next_before = page.positions.back();
        return absl::OkStatus();
      }
      page.jobs.push_back(JobOf(jobs));
      page.positions.push_back(static_cast<std::uint64_t>(jobs.Integer(5)));
    }
  });
  if (!read.ok()) return read;
  return page;
}

}  // namespace

absl::StatusOr<std::optional<JobId>> JobArchive::FindRequest(const RequestKey& key, WallTime now) {
  if (absl::Status dropped = DropRequests(now - kRequestMemory); !dropped.ok()) return dropped;
  absl::StatusOr<std::optional<JobId>> found;
  const absl::Status read = storage_.Read([&](Database& database) {
    found = Find(database, key);
    return found.status();
  });
  return read.ok() ? found : absl::StatusOr<std::optional<JobId>>(read);
}

absl::StatusOr<JobId> JobArchive::Insert(const JobId& id, const std::string& owner, std::string message,
                                         const Submission& submission, const std::optional<RequestKey>& key,
                                         WallTime now) {
  const auto request = storage_.Prepare(submission.request);
  if (!request.ok()) return request.status();
  std::optional<Blob> scene;
  if (submission.scene != nullptr) {
    auto prepared = storage_.Prepare(submission.scene_sha256, submission.scene);
    if (!prepared.ok()) return prepared.status();
    scene = *std::move(prepared);
  }
  const auto stored_bytes = static_cast<std::int64_t>(request->bytes->size());
  JobId made = id;
  const absl::Status written = storage_.Write([&](Writing& writing) -> absl::Status {
    if (key) {
      const auto earlier = Find(writing.database(), *key);
      if (!earlier.ok()) return earlier.status();
      if (*earlier) {
        made = **earlier;
        return absl::OkStatus();
      }
      Statement note = writing.Prepare("INSERT INTO requests VALUES(?, ?, ?, ?, ?, ?)");
      note.Bind(std::string_view(key->caller)).Bind(std::string_view(key->method));
      note.Bind(std::string_view(key->request_id)).Bind(std::string_view(key->fingerprint));
      note.Bind(std::string_view(id.uuid())).Bind(SecondsOf(now));
      if (absl::Status noted = note.Run(); !noted.ok()) return noted;
    }
    if (absl::Status used = writing.Use(*request); !used.ok()) return used;
    if (scene) {
      if (absl::Status used = writing.Use(*scene); !used.ok()) return used;
    }
    Statement job = writing.Prepare(
        "INSERT INTO jobs(uuid, owner, request, scene, message, sequence, build, stored_bytes) "
        "VALUES(?, ?, ?, ?, ?, 0, ?, ?)");
    job.Bind(std::string_view(id.uuid())).Bind(std::string_view(owner)).Bind(std::string_view(request->sha256));
    job.Bind(scene ? std::optional(scene->sha256) : std::nullopt).BindBlob(message).Bind(std::string_view(build_));
    if (absl::Status inserted = job.Bind(stored_bytes).Run(); !inserted.ok()) return inserted;
    if (submission.webhook.empty()) return absl::OkStatus();
    return InsertWebhook(writing.database(), id, owner, submission.webhook);
  });
  if (!written.ok()) return written;
  if (made == id) AddStoredBytes(owner, stored_bytes);
  return made;
}

absl::Status JobArchive::SaveCheckpoint(const JobId& id, std::string checkpoint) {
  const auto blob = storage_.Prepare(std::move(checkpoint));
  if (!blob.ok()) return blob.status();
  return storage_.Write([&](Writing& writing) -> absl::Status {
    Statement job = writing.Prepare("SELECT number, checkpoint FROM jobs WHERE uuid = ? AND sequence = 0");
    job.Bind(std::string_view(id.uuid()));
    const auto row = job.Step();
    if (!row.ok()) return row.status();
    if (!*row) return NoSuchJob(id);
    if (absl::Status used = writing.Use(*blob); !used.ok()) return used;
    if (absl::Status less = writing.Release(job.OptionalBytes(1)); !less.ok()) return less;
    return writing.Prepare("UPDATE jobs SET checkpoint = ?, build = ? WHERE number = ?")
        .Bind(std::string_view(blob->sha256))
        .Bind(std::string_view(build_))
        .Bind(job.Integer(0))
        .Run();
  });
}

absl::Status JobArchive::SavePause(const JobId& id, bool paused) {
  return storage_.Write([&](Writing& writing) {
    return writing.Prepare("UPDATE jobs SET paused = ? WHERE uuid = ? AND sequence = 0")
        .Bind(std::int64_t{paused})
        .Bind(std::string_view(id.uuid()))
        .Run();
  });
}

absl::Status JobArchive::End(const JobId& id, JobEnd end) {
  std::optional<Blob> blob;
  if (end.result) {
    auto prepared = storage_.Prepare(*std::move(end.result));
    if (!prepared.ok()) return prepared.status();
    blob = *std::move(prepared);
  }
  const std::int64_t stored_bytes = blob ? static_cast<std::int64_t>(blob->bytes->size()) : 0;
  std::string owner;
  bool webhook_is_due = false;
  absl::Status written = storage_.Write([&](Writing& writing) -> absl::Status {
    const auto number = NumberOf(writing.database(), id);
    if (!number.ok()) return number.status();
    if (blob) {
      if (absl::Status used = writing.Use(*blob); !used.ok()) return used;
    }
    Statement old = writing.Prepare("SELECT result, checkpoint, scene, owner FROM jobs WHERE number = ?");
    old.Bind(*number);
    if (const auto row = old.Step(); !row.ok()) return row.status();
    owner = old.Bytes(3);
    for (int column = 0; column < 3; ++column) {
      if (absl::Status less = writing.Release(old.OptionalBytes(column)); !less.ok()) return less;
    }
    if (!end.event.empty()) {
      const auto due = MakeWebhookDue(writing.database(), id, end.event);
      if (!due.ok()) return due.status();
      webhook_is_due = *due;
    }
    return writing
        .Prepare(
            "UPDATE jobs SET message = ?, sequence = ?, end_time = ?, result = ?, checkpoint = NULL, scene = NULL, "
            "build = ?, stored_bytes = stored_bytes + ?, job_class = ?, work_key = ? WHERE number = ?")
        .BindBlob(end.message)
        .Bind(static_cast<std::int64_t>(end.sequence))
        .Bind(SecondsOf(end.time))
        .Bind(blob ? std::optional(blob->sha256) : std::nullopt)
        .Bind(std::string_view(build_))
        .Bind(stored_bytes)
        .Bind(static_cast<std::int64_t>(end.job_class))
        .Bind(end.work_key.empty() ? std::nullopt : std::optional(end.work_key))
        .Bind(*number)
        .Run();
  });
  if (written.ok()) AddStoredBytes(owner, stored_bytes);
  if (written.ok() && webhook_is_due) webhook_due_();
  return written;
}

absl::Status JobArchive::Delete(const JobId& id) {
  std::string owner;
  std::int64_t stored_bytes = 0;
  absl::Status written = storage_.Write([&](Writing& writing) -> absl::Status {
    const auto number = NumberOf(writing.database(), id);
    if (!number.ok()) return number.status();
    Statement job =
        writing.Prepare("SELECT request, scene, result, checkpoint, owner, stored_bytes FROM jobs WHERE number = ?");
    if (const auto row = job.Bind(*number).Step(); !row.ok()) return row.status();
    owner = job.Bytes(4);
    stored_bytes = job.Integer(5);
    for (int column = 0; column < 4; ++column) {
      if (absl::Status less = writing.Release(job.OptionalBytes(column)); !less.ok()) return less;
    }
    return writing.Prepare("DELETE FROM jobs WHERE number = ?").Bind(*number).Run();
  });
  if (written.ok()) AddStoredBytes(owner, -stored_bytes);
  return written;
}

absl::StatusOr<std::vector<JobId>> JobArchive::EndedBefore(JobClass job_class, WallTime before, std::size_t skip,
                                                           std::size_t limit) {
  std::vector<JobId> ids;
  absl::Status read = storage_.Read([&](Database& database) -> absl::Status {
    Statement jobs = database.Prepare(
        "SELECT uuid FROM jobs WHERE job_class = ? AND end_time < ? ORDER BY end_time, number LIMIT ? OFFSET ?");
    jobs.Bind(static_cast<std::int64_t>(job_class)).Bind(SecondsOf(before));
    jobs.Bind(static_cast<std::int64_t>(limit)).Bind(static_cast<std::int64_t>(skip));
    return jobs.ForEachRow([&](const Statement& row) {
      if (const auto id = JobId::FromName("jobs/" + row.Bytes(0))) ids.push_back(*id);
    });
  });
  if (!read.ok()) return read;
  return ids;
}

absl::StatusOr<std::optional<JobId>> JobArchive::FindDone(const std::string& work_key) {
  std::optional<JobId> done;
  absl::Status read = storage_.Read([&](Database& database) -> absl::Status {
    Statement job = database.Prepare("SELECT uuid FROM jobs WHERE work_key = ? ORDER BY number DESC LIMIT 1");
    const auto row = job.Bind(std::string_view(work_key)).Step();
    if (row.ok() && *row) done = JobId::FromName("jobs/" + job.Bytes(0));
    return row.status();
  });
  if (!read.ok()) return read;
  return done;
}

absl::StatusOr<std::vector<ArchivedJob>> JobArchive::WithoutClass(std::size_t limit) {
  return JobsOf(storage_, [&](Database& database) {
    Statement jobs =
        database.Prepare(std::string(kColumns) + "WHERE job_class IS NULL AND end_time IS NOT NULL LIMIT ?");
    jobs.Bind(static_cast<std::int64_t>(limit));
    return jobs;
  });
}

absl::Status JobArchive::Classify(const std::vector<std::pair<JobId, JobClass>>& classes) {
  if (classes.empty()) return absl::OkStatus();
  return storage_.Write([&](Writing& writing) -> absl::Status {
    for (const auto& [id, job_class] : classes) {
      absl::Status written = writing.Prepare("UPDATE jobs SET job_class = ? WHERE uuid = ?")
                                 .Bind(static_cast<std::int64_t>(job_class))
                                 .Bind(std::string_view(id.uuid()))
                                 .Run();
      if (!written.ok()) return written;
    }
    return absl::OkStatus();
  });
}

std::uint64_t JobArchive::StoredBytesOf(const std::string& owner) {
  const std::lock_guard lock(stored_mutex_);
  const auto stored = stored_bytes_.find(owner);
  return stored == stored_bytes_.end() ? 0 : static_cast<std::uint64_t>(stored->second);
}

void JobArchive::AddStoredBytes(const std::string& owner, std::int64_t bytes) {
  const std::lock_guard lock(stored_mutex_);
  const auto stored = stored_bytes_.try_emplace(owner).first;
  stored->second += bytes;
  if (stored->second <= 0) stored_bytes_.erase(stored);
}

absl::Status JobArchive::DropRequests(WallTime before) {
  bool any = false;
  absl::Status looked = storage_.Read([&](Database& database) {
    const auto row = database.Prepare("SELECT 1 FROM requests WHERE time < ?").Bind(SecondsOf(before)).Step();
    any = row.ok() && *row;
    return row.status();
  });
  if (!looked.ok() || !any) return looked;
  return storage_.Write([&](Writing& writing) {
    return writing.Prepare("DELETE FROM requests WHERE time < ?").Bind(SecondsOf(before)).Run();
  });
}

absl::StatusOr<ArchivedJob> JobArchive::Get(const JobId& id) {
  ArchivedJob found;
  const absl::Status read = storage_.Read([&](Database& database) -> absl::Status {
    Statement job = database.Prepare(std::string(kColumns) + "WHERE uuid = ?");
    job.Bind(std::string_view(id.uuid()));
    const auto row = job.Step();
    if (!row.ok()) return row.status();
    if (!*row) return NoSuchJob(id);
    found = JobOf(job);
    return absl::OkStatus();
  });
  if (!read.ok()) return read;
  return found;
}

absl::StatusOr<JobArchive::Page> JobArchive::List(const std::optional<std::string>& owner,
                                                  std::optional<std::uint64_t> before, std::size_t limit) {
  return ReadPage(storage_, limit, [&](Database& database) {
    Statement jobs = database.Prepare(std::string(kColumns) + (owner ? "WHERE owner = ? AND " : "WHERE ") +
                                      "number < ? ORDER BY number DESC LIMIT ?");
    if (owner) jobs.Bind(std::string_view(*owner));
    jobs.Bind(FirstNumber(before)).Bind(static_cast<std::int64_t>(limit) + 1);
    return jobs;
  });
}

absl::StatusOr<JobArchive::Page> JobArchive::ListShared(const std::vector<Grantee>& who, const std::string& owner,
                                                        std::optional<std::uint64_t> before, std::size_t limit) {
  return ReadPage(storage_, limit, [&](Database& database) {
    // By what is shared, which is little, and not by all jobs: hence the plus.
    Statement jobs =
        database.Prepare(std::string(kColumns) + "WHERE uuid IN (SELECT substr(resource, 6) FROM " + ResourcesOf(who) +
                         ") AND +number < ? AND owner != ? ORDER BY number DESC LIMIT ?");
    BindGrantees(who, jobs);
    jobs.Bind(FirstNumber(before)).Bind(std::string_view(owner));
    jobs.Bind(static_cast<std::int64_t>(limit) + 1);
    return jobs;
  });
}

absl::Status JobArchive::Share(const JobId& id, const Grant& grant) {
  const std::lock_guard lock(grants_mutex_);
  grants_.erase(id);
  return storage_.Write([&](Writing& writing) -> absl::Status {
    if (const auto number = NumberOf(writing.database(), id); !number.ok()) return number.status();
    return InsertGrant(writing.database(), id.Name(), grant);
  });
}

absl::Status JobArchive::Unshare(const JobId& id, const Grantee& grantee) {
  const std::lock_guard lock(grants_mutex_);
  grants_.erase(id);
  return storage_.Write([&](Writing& writing) -> absl::Status {
    if (const auto number = NumberOf(writing.database(), id); !number.ok()) return number.status();
    return DeleteGrant(writing.database(), id.Name(), grantee);
  });
}

absl::StatusOr<std::vector<Grant>> JobArchive::GrantsOf(const JobId& id) {
  const std::lock_guard lock(grants_mutex_);
  if (const auto known = grants_.find(id); known != grants_.end()) return known->second;
  absl::StatusOr<std::vector<Grant>> grants;
  absl::Status read = storage_.Read([&](Database& database) {
    grants = ReadGrants(database, id.Name());
    return grants.status();
  });
  if (!read.ok()) return read;
  if (grants_.size() >= kMostGranted) grants_.clear();
  return grants_[id] = *std::move(grants);
}

absl::StatusOr<std::vector<ArchivedJob>> JobArchive::Unfinished() {
  return JobsOf(storage_, [](Database& database) {
    return database.Prepare(std::string(kColumns) + "WHERE end_time IS NULL ORDER BY number");
  });
}

absl::StatusOr<Submission> JobArchive::FetchSubmission(const JobId& id) {
  std::string request;
  std::optional<std::string> scene;
  const absl::Status read = storage_.Read([&](Database& database) -> absl::Status {
    Statement job = database.Prepare("SELECT request, scene FROM jobs WHERE uuid = ?");
    job.Bind(std::string_view(id.uuid()));
    const auto row = job.Step();
    if (!row.ok()) return row.status();
    if (!*row) return NoSuchJob(id);
    request = job.Bytes(0);
    scene = job.OptionalBytes(1);
    return absl::OkStatus();
  });
  if (!read.ok()) return read;
  Submission submission;
  auto bytes = storage_.Fetch(request);
  if (!bytes.ok()) return bytes.status();
  submission.request = *std::move(bytes);
  if (scene) {
    auto file = storage_.Fetch(*scene);
    if (!file.ok()) return file.status();
    submission.scene_sha256 = *scene;
    submission.scene = std::make_shared<const std::string>(*std::move(file));
  }
  return submission;
}

absl::StatusOr<std::optional<std::string>> JobArchive::FetchCheckpoint(const JobId& id) {
  std::optional<std::string> checkpoint;
  const absl::Status read = storage_.Read([&](Database& database) -> absl::Status {
    Statement job = database.Prepare("SELECT checkpoint FROM jobs WHERE uuid = ?");
    job.Bind(std::string_view(id.uuid()));
    const auto row = job.Step();
    if (!row.ok()) return row.status();
    if (*row) checkpoint = job.OptionalBytes(0);
    return absl::OkStatus();
  });
  if (!read.ok()) return read;
  if (!checkpoint) return checkpoint;
  auto bytes = storage_.Fetch(*checkpoint);
  if (!bytes.ok()) return bytes.status();
  return std::optional(*std::move(bytes));
}

}  // namespace flatlight
