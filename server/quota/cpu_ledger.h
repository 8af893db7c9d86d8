// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_QUOTA_CPU_LEDGER_H_
#define FLATLIGHT_SERVER_QUOTA_CPU_LEDGER_H_

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <unordered_map>
#include <utility>

#include "absl/base/thread_annotations.h"
#include "absl/status/status.h"
#include "server/store/storage.h"

namespace flatlight {

// The processor time that each user's jobs have had on each day of UTC, whatever becomes of the jobs. (How turns are
// shared is another matter, and forgotten: Accounts.) Written down every few seconds, so that a server that is killed
// loses no more than those. Safe to use from any thread.
class CpuLedger {
 public:
  using WallTime = std::chrono::system_clock::time_point;

  struct Options {
    std::chrono::milliseconds interval{3000};  // Between writings, at least.
    std::function<WallTime()> now = std::chrono::system_clock::now;
  };
  // `storage` outlives this; null: all ends with the process.
  CpuLedger(Storage* storage, Options options);
  // As Close.
  ~CpuLedger();

  // Gives what UsedToday would say now.
  double Charge(const std::string& user, double seconds);
  // What the user has had of the day that is. s.
  double UsedToday(const std::string& user);
  // The number of the day that is, since 1970.
  std::int64_t Today() const;
  // When the next one begins.
  WallTime EndOfToday() const;
  std::chrono::milliseconds UntilTomorrow() const;

  // Writes what has not been written. What cannot be stays to be written later.
  absl::Status Write();
  // For the last time.
  void Close();

 private:
  using Key = std::pair<std::int64_t, std::string>;  // Day and user.

  void Work();
  void TurnToToday() ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);

  Storage* const storage_;
  const Options options_;
  std::mutex writing_;  // One after the other. Taken before the other one.
  std::mutex mutex_;
  std::condition_variable wake_;
  bool closed_ ABSL_GUARDED_BY(mutex_) = false;
  std::int64_t day_ ABSL_GUARDED_BY(mutex_) = -1;
  std::unordered_map<std::string, double> used_ ABSL_GUARDED_BY(mutex_);  // On `day_`.
  std::map<Key, double> unwritten_ ABSL_GUARDED_BY(mutex_);
  std::thread writer_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_QUOTA_CPU_LEDGER_H_
