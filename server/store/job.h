// SPDX-License-Identifier: Apache-2.0
// A job: what was asked for (never changes) and how far it is (a value, replaced as a whole).
#ifndef FLATLIGHT_SERVER_STORE_JOB_H_
#define FLATLIGHT_SERVER_STORE_JOB_H_

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "core/render/field.h"
#include "core/render/plan.h"
#include "core/render/rendering.h"
#include "server/store/job_class.h"
#include "server/store/job_id.h"
#include "server/store/scene_outline.h"

namespace flatlight {

using WallTime = std::chrono::system_clock::time_point;

struct JobSpec {
  JobId id;
  std::string owner;  // The caller that made it.
  JobClass job_class = JobClass::kInteractive;
  std::shared_ptr<const SceneOutline> scene;  // Of the scene itself, only a job that has not ended has a share.
  Settings settings;                          // As requested.
  Plan plan;
  std::string job_key;  // Names what decides the bits of the result. Not known of a job that waits to be restored.
  // With whom it may share indexes and what is solved of its world: with jobs of the same name here.
  std::string sharers;
  // Jobs of equal ones do the same work, and may tell of each other by sharing it. Empty: this one does its own.
  std::string work_key;
  std::optional<std::string> records_checksum;  // Of those that the request brought.
  std::string webhook;                          // The URL that is told of the job's end; empty: none is.
  WallTime create_time;
};

enum class JobPhase : std::uint8_t { kQueued, kRunning, kPaused, kSucceeded, kFailed, kCancelled };

inline bool HasEnded(JobPhase phase) { return phase > JobPhase::kPaused; }

// Why and how long a queued job waits.
struct QueuePlace {
  enum class Reason : std::uint8_t {
    kServerFull,  // As many jobs run as the server has places for.
    kOwnJobs,     // Its owner's jobs hold as many places as are left for others.
    kDayUsedUp    // Its owner's jobs have had the processor time that they may have in a day.
  };
  Reason reason = Reason::kServerFull;
  std::size_t ahead = 0;                   // Jobs that begin before it, if no others come.
  std::optional<WallTime> expected_start;  // A forecast by the pace of late.

  friend bool operator==(const QueuePlace&, const QueuePlace&) = default;
};

// When values last changed: for each probe, for each run of kPoints points, the sequence of the state that brought the
// present values. So a reader that knows the state of some sequence is told only what is newer.
struct FieldVersions {
  static constexpr std::size_t kPoints = 512;
  std::vector<std::vector<std::uint64_t>> changed;
  // Of the log of records: what each state that made it longer brought its length to. Radii change with it.
  struct Growth {
    std::uint64_t sequence = 0;
    std::size_t records = 0;
  };
  std::vector<Growth> log;

  // The length of the log in the state of a sequence.
  std::size_t RecordsAt(std::uint64_t sequence) const {
    std::size_t records = 0;
    for (const Growth& growth : log)
      if (growth.sequence <= sequence) records = growth.records;
    return records;
  }
};

struct JobState {
  std::uint64_t sequence = 1;  // Grows by one with every state of the job.
  JobPhase phase = JobPhase::kQueued;
  RenderProgress progress;
  double elapsed_seconds = 0;  // Since the job started.
  double cpu_seconds = 0;      // Processor time of all threads that worked for the job.
  std::optional<WallTime> start_time;
  std::optional<WallTime> end_time;
  std::optional<WallTime> expire_time;  // Of a job that has ended, and is not kept for ever (Retention).
  std::optional<QueuePlace> queue;      // Of a job that is queued.
  std::optional<EndReason> end_reason;  // Of a job that succeeded.
  absl::Status error;                   // Of a job that failed.
  std::shared_ptr<const Field> field;   // Null before the first picture.
  FieldVersions versions;               // Of `field`.
  bool shared_work = false;             // `field` is what another job found that does, or did, the same work.
};

struct JobRecord {
  std::shared_ptr<const JobSpec> spec;
  std::shared_ptr<const JobState> state;
};

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_STORE_JOB_H_
