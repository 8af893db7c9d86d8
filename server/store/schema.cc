// SPDX-License-Identifier: Apache-2.0
#include "server/store/schema.h"

#include "server/store/error.h"

namespace flatlight {
namespace {

// Bytes of any length, by their hash, once each; what is large lies in files of that name (bytes is null). `uses`
// counts the columns that name it.
constexpr char kJobs[] = R"sql(
CREATE TABLE blobs(
  sha256 TEXT PRIMARY KEY,
  bytes BLOB,
  uses INTEGER NOT NULL
) WITHOUT ROWID;
CREATE TABLE jobs(
  number INTEGER PRIMARY KEY AUTOINCREMENT,  -- In the order of creation.
  uuid TEXT NOT NULL UNIQUE,
  owner TEXT NOT NULL,
  request TEXT NOT NULL REFERENCES blobs DEFERRABLE INITIALLY DEFERRED,  -- What made it: a CreateJobRequest.
  scene TEXT REFERENCES blobs DEFERRABLE INITIALLY DEFERRED,             -- The uploaded file that the request names.
  message BLOB NOT NULL,                   -- The Job as it was accepted, or as it ended.
  sequence INTEGER NOT NULL,               -- Of that state; 0: it has not ended.
  end_time INTEGER,                        -- s since 1970; null: it has not ended.
  result TEXT REFERENCES blobs DEFERRABLE INITIALLY DEFERRED,            -- A RenderResult.
  checkpoint TEXT REFERENCES blobs DEFERRABLE INITIALLY DEFERRED,        -- Of one that has not ended.
  build TEXT NOT NULL                      -- Of Flatlight, when this row was written last.
);
CREATE INDEX jobs_by_end ON jobs(end_time);
CREATE TABLE requests(
  caller TEXT NOT NULL,
  method TEXT NOT NULL,
  request_id TEXT NOT NULL,
  fingerprint TEXT NOT NULL,
  uuid TEXT NOT NULL,     -- Of the job that it made, which may be gone.
  time INTEGER NOT NULL,  -- s since 1970.
  PRIMARY KEY(caller, method, request_id)
) WITHOUT ROWID;
CREATE INDEX requests_by_time ON requests(time);
)sql";

constexpr char kScenes[] = R"sql(
CREATE TABLE scenes(
  number INTEGER PRIMARY KEY AUTOINCREMENT,  -- In the order of completion.
  sha256 TEXT NOT NULL UNIQUE REFERENCES blobs DEFERRABLE INITIALLY DEFERRED,
  title TEXT NOT NULL,
  size INTEGER NOT NULL
);
)sql";

constexpr char kUsers[] = R"sql(
CREATE TABLE users(
  name TEXT PRIMARY KEY,
  role TEXT NOT NULL CHECK(role IN ('student', 'grader', 'instructor', 'admin')),
  token_sha256 TEXT UNIQUE  -- Null: revoked.
) WITHOUT ROWID;
CREATE TABLE memberships(
  user TEXT NOT NULL REFERENCES users,
  group_name TEXT NOT NULL,
  PRIMARY KEY(user, group_name)
) WITHOUT ROWID;
)sql";

constexpr char kPauses[] = "ALTER TABLE jobs ADD COLUMN paused INTEGER NOT NULL DEFAULT 0;";

// Who besides its owner may use something, which is named as callers name it.
constexpr char kGrants[] = R"sql(
CREATE TABLE grants(
  resource TEXT NOT NULL,  -- jobs/{uuid}.
  grantee TEXT NOT NULL,   -- user:NAME, group:NAME, course.
  access TEXT NOT NULL CHECK(access IN ('read', 'control')),
  PRIMARY KEY(resource, grantee)
) WITHOUT ROWID;
CREATE INDEX grants_by_grantee ON grants(grantee);
CREATE TRIGGER jobs_drop_grants AFTER DELETE ON jobs BEGIN
  DELETE FROM grants WHERE resource = 'jobs/' || OLD.uuid;
END;
)sql";

// Times are ms since 1970.
constexpr char kRooms[] = R"sql(
CREATE TABLE rooms(
  number INTEGER PRIMARY KEY AUTOINCREMENT,  -- In the order of creation.
  uuid TEXT NOT NULL UNIQUE,
  epoch INTEGER NOT NULL,            -- Of its sequence.
  owner TEXT NOT NULL,
  title TEXT NOT NULL,
  create_time INTEGER NOT NULL,
  close_time INTEGER,                -- Null: it is open.
  sequence INTEGER NOT NULL,
  notes INTEGER NOT NULL DEFAULT 0,
  note_bytes INTEGER NOT NULL DEFAULT 0,  -- Of all their texts.
  job TEXT,                          -- What is looked at: jobs/{uuid}, which may be gone.
  probe TEXT NOT NULL DEFAULT '',
  point INTEGER,
  exposure REAL NOT NULL DEFAULT 0,
  tone_mapping TEXT NOT NULL CHECK(tone_mapping IN ('photographic', 'linear'))
);
CREATE INDEX rooms_by_owner ON rooms(owner);
CREATE INDEX rooms_by_job ON rooms(job);
CREATE TABLE notes(
  room INTEGER NOT NULL,  -- Its number.
  sequence INTEGER NOT NULL,
  author TEXT NOT NULL,
  time INTEGER NOT NULL,
  text TEXT NOT NULL,
  x REAL,
  y REAL,
  job TEXT,
  request_id TEXT NOT NULL,
  PRIMARY KEY(room, sequence)
) WITHOUT ROWID;
CREATE UNIQUE INDEX notes_by_request ON notes(room, author, request_id) WHERE request_id != '';
CREATE TRIGGER rooms_drop_rest AFTER DELETE ON rooms BEGIN
  DELETE FROM notes WHERE room = OLD.number;
  DELETE FROM grants WHERE resource = 'rooms/' || OLD.uuid;
END;
)sql";

// Scenes that were uploaded before this have no owner: staff reads them, and who uploads them again.
constexpr char kSceneOwners[] = R"sql(
CREATE TABLE scene_owners(
  number INTEGER PRIMARY KEY AUTOINCREMENT,  -- In the order of completion.
  owner TEXT NOT NULL,
  sha256 TEXT NOT NULL REFERENCES scenes(sha256) DEFERRABLE INITIALLY DEFERRED,
  title TEXT NOT NULL,  -- Empty until the owner has read the file.
  UNIQUE(owner, sha256)
);
CREATE INDEX scene_owners_by_scene ON scene_owners(sha256);
)sql";

// A page of somebody's jobs costs by its length, however many jobs others have.
constexpr char kJobsByOwner[] = "CREATE INDEX jobs_by_owner ON jobs(owner, number);";

// An owner's shares of a scene, granted on scenes/{sha256}/owners/{owner}, go with the upload.
constexpr char kSceneGrants[] = R"sql(
CREATE TRIGGER scene_owners_drop_grants AFTER DELETE ON scene_owners BEGIN
  DELETE FROM grants WHERE resource = 'scenes/' || OLD.sha256 || '/owners/' || OLD.owner;
END;
)sql";

// What users have had: see CpuLedger. Of jobs: how much room their requests and results take; null: not measured yet.
constexpr char kQuotas[] = R"sql(
CREATE TABLE cpu_days(
  user TEXT NOT NULL,
  day INTEGER NOT NULL,  -- Of UTC, since 1970.
  seconds REAL NOT NULL,
  PRIMARY KEY(user, day)
) WITHOUT ROWID;
ALTER TABLE jobs ADD COLUMN stored_bytes INTEGER;
)sql";

// Whom to tell of the end of which job, and how far that is. Times are ms since 1970.
constexpr char kWebhooks[] = R"sql(
CREATE TABLE webhooks(
  number INTEGER PRIMARY KEY AUTOINCREMENT,
  job TEXT NOT NULL UNIQUE,              -- Its uuid.
  owner TEXT NOT NULL,
  url TEXT NOT NULL,
  body TEXT,                             -- What is to be sent; null: the job has not ended, or all is done.
  due INTEGER,                           -- When it is; null likewise.
  attempts INTEGER NOT NULL DEFAULT 0,
  error TEXT NOT NULL DEFAULT '',        -- Of the last attempt.
  end_time INTEGER,                      -- Since when all is done; null: it is not.
  detached INTEGER NOT NULL DEFAULT 0    -- Its job is gone: when all is done, so is this.
);
CREATE INDEX webhooks_by_due ON webhooks(due) WHERE due IS NOT NULL;
CREATE INDEX webhooks_that_are_open ON webhooks(owner) WHERE end_time IS NULL;
CREATE TRIGGER jobs_detach_webhooks AFTER DELETE ON jobs BEGIN
  DELETE FROM webhooks WHERE job = OLD.uuid AND due IS NULL;
  UPDATE webhooks SET detached = 1 WHERE job = OLD.uuid;
END;
CREATE TABLE secrets(
  name TEXT PRIMARY KEY,
  value BLOB NOT NULL
) WITHOUT ROWID;
)sql";

// Of jobs that have ended: JobClass; null: an earlier Flatlight wrote them, and it is not known yet.
constexpr char kRetention[] = R"sql(
ALTER TABLE jobs ADD COLUMN job_class INTEGER;
CREATE INDEX jobs_by_class ON jobs(job_class, end_time);
DROP INDEX jobs_by_end;
CREATE INDEX jobs_that_run ON jobs(number) WHERE end_time IS NULL;
)sql";

// By JobSpec::work_key: of a job that succeeded, and whose values others may have.
constexpr char kDoneWork[] = R"sql(
ALTER TABLE jobs ADD COLUMN work_key TEXT;
CREATE INDEX jobs_by_work ON jobs(work_key, number) WHERE work_key IS NOT NULL;
)sql";

// A number that is another after every change of users, whoever makes it: see UserDirectory.
constexpr char kUsersVersion[] = R"sql(
CREATE TABLE users_version(version INTEGER NOT NULL);
INSERT INTO users_version VALUES(1);
CREATE TRIGGER users_added AFTER INSERT ON users BEGIN UPDATE users_version SET version = version + 1; END;
CREATE TRIGGER users_changed AFTER UPDATE ON users BEGIN UPDATE users_version SET version = version + 1; END;
CREATE TRIGGER users_removed AFTER DELETE ON users BEGIN UPDATE users_version SET version = version + 1; END;
CREATE TRIGGER members_added AFTER INSERT ON memberships BEGIN UPDATE users_version SET version = version + 1; END;
CREATE TRIGGER members_changed AFTER UPDATE ON memberships BEGIN UPDATE users_version SET version = version + 1; END;
CREATE TRIGGER members_removed AFTER DELETE ON memberships BEGIN UPDATE users_version SET version = version + 1; END;
)sql";

// Of who has rotated its secret. Before that a user's secret has generation 0: see WebhookSecret.
constexpr char kWebhookSecrets[] = R"sql(
CREATE TABLE webhook_secrets(
  user TEXT NOT NULL,
  generation INTEGER NOT NULL,
  expire_time INTEGER,  -- ms since 1970; null: it is the user's newest.
  PRIMARY KEY(user, generation)
) WITHOUT ROWID;
)sql";

absl::StatusOr<std::int64_t> VersionOf(Database& database) {
  Statement version = database.Prepare("PRAGMA user_version");
  const auto row = version.Step();
  if (!row.ok()) return row.status();
  return version.Integer(0);
}

}  // namespace

const std::vector<std::string>& Migrations() {
  static const std::vector<std::string> kMigrations = {
      kJobs,   kScenes,      kUsers,    kPauses,    kGrants,   kRooms,        kSceneOwners,   kJobsByOwner,
      kQuotas, kSceneGrants, kWebhooks, kRetention, kDoneWork, kUsersVersion, kWebhookSecrets};
  return kMigrations;
}

absl::Status Migrate(Database& database, std::size_t newest) {
  const auto version = VersionOf(database);
  if (!version.ok()) return version.status();
  if (*version > static_cast<std::int64_t>(newest)) {
    return MakeError(absl::StatusCode::kFailedPrecondition, "STORAGE_TOO_NEW",
                     database.path() + " has version " + std::to_string(*version) +
                         "; this Flatlight knows versions to " + std::to_string(newest) +
                         ": use the later one that wrote it");
  }
  for (auto step = static_cast<std::size_t>(*version); step < newest; ++step) {
    Transaction transaction(database);
    if (absl::Status begun = transaction.Begin(); !begun.ok()) return begun;
    const std::string sql = Migrations()[step] + "PRAGMA user_version = " + std::to_string(step + 1);
    if (absl::Status done = database.Execute(sql); !done.ok()) return done;
    if (absl::Status committed = transaction.Commit(); !committed.ok()) return committed;
  }
  return absl::OkStatus();
}

absl::StatusOr<std::unique_ptr<Database>> NewMemoryDatabase() {
  auto database = Database::Open(":memory:");
  if (!database.ok()) return database;
  if (absl::Status migrated = Migrate(**database); !migrated.ok()) return migrated;
  return database;
}

}  // namespace flatlight
