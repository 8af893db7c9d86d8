// SPDX-License-Identifier: Apache-2.0
// A real server for benchmark programs, reached by the public API alone.
#ifndef FLATLIGHT_TESTS_BENCH_BENCH_DAEMON_H_
#define FLATLIGHT_TESTS_BENCH_BENCH_DAEMON_H_

#include <sys/types.h>

#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "flatlight/v1/render_service.grpc.pb.h"
#include "flatlight/v1/server_service.grpc.pb.h"
#include "grpcpp/channel.h"
#include "grpcpp/client_context.h"

namespace flatlight {

// Ends the program with status 2.
[[noreturn]] void Die(const std::string& why);

// The flatlightd of the build that `self` (argv[0] of a bench) belongs to.
std::string DaemonBesides(const std::string& self);

// A folder of its own under the system's for temporary files; removed with all in it when it goes out of scope.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

// A flatlightd with 2 threads on a Unix socket in `folder`; killed when it goes out of scope.
class BenchDaemon {
 public:
  BenchDaemon(const std::string& program, const std::string& folder, const std::vector<std::string>& arguments = {});
  ~BenchDaemon() { Kill(); }
  BenchDaemon(const BenchDaemon&) = delete;
  BenchDaemon& operator=(const BenchDaemon&) = delete;

  // SIGKILL, and waits until it is gone.
  void Kill();
  pid_t pid() const { return pid_; }
  const std::string& address() const { return address_; }  // "unix:PATH".
  // A connection that shares nothing with others, and tries again soon.
  std::shared_ptr<grpc::Channel> Connect() const;
  v1::RenderService::Stub& render() { return *render_; }
  v1::ServerService::Stub& server() { return *server_; }

 private:
  std::string address_;
  pid_t pid_ = 0;
  int input_ = -1;  // The daemon ends when this one is closed.
  std::unique_ptr<v1::RenderService::Stub> render_;
  std::unique_ptr<v1::ServerService::Stub> server_;
};

// Of a call that waits for the server to come up, and is over after `limit`.
struct CallContext : grpc::ClientContext {
  explicit CallContext(std::chrono::milliseconds limit = std::chrono::seconds(120)) {
    set_wait_for_ready(true);
    set_deadline(std::chrono::system_clock::now() + limit);
  }
};

// From the API's JSON.
v1::CreateJobRequest RequestFromJson(const std::string& json);

}  // namespace flatlight

#endif  // FLATLIGHT_TESTS_BENCH_BENCH_DAEMON_H_
