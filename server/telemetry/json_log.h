// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_TELEMETRY_JSON_LOG_H_
#define FLATLIGHT_SERVER_TELEMETRY_JSON_LOG_H_

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>

#include "absl/base/thread_annotations.h"
#include "absl/status/statusor.h"
#include "nlohmann/json.hpp"

namespace flatlight {

// A file to which lines are added, each of which is one JSON object that begins with its time. Lines are whole: each is
// one write. What cannot be written is counted and dropped: a full disk stops no work. Safe to use from any thread.
class JsonLog {
 public:
  using Line = nlohmann::ordered_json;

  // Adds to the file, or makes it (readable by its owner alone); "-" is standard error. An error if it cannot.
  static absl::StatusOr<std::unique_ptr<JsonLog>> Open(const std::string& path);
  ~JsonLog();
  JsonLog(const JsonLog&) = delete;
  JsonLog& operator=(const JsonLog&) = delete;

  // Adds {"time": …, then the members of `line`}. Bytes that are not UTF-8 are replaced.
  void Write(const Line& line);
  // Opens the file of that name anew: after it was moved away by a rotation of logs. The old one is kept on an error.
  absl::Status Reopen();
  std::uint64_t lost_lines() const { return lost_lines_; }

 private:
  JsonLog(std::string path, int fd) : path_(std::move(path)), fd_(fd) {}

  const std::string path_;
  std::mutex mutex_;
  int fd_ ABSL_GUARDED_BY(mutex_);
  std::atomic<std::uint64_t> lost_lines_ = 0;
};

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_TELEMETRY_JSON_LOG_H_
