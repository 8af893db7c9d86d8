// SPDX-License-Identifier: Apache-2.0
// What a unary call costs beside gRPC itself: calls with a user's token against an empty call that does nothing.
//
//   calls [CSV]        the rows go to CSV (default: out/calls.csv) as well
//
// A flatlightd with a data folder and users, and a server of this program that answers the same message with an empty
// one, without interceptors, tokens or work: both on Unix sockets, asked in turns by the same connections and with the
// same number of calls under way. Callers and servers share the machine's processors. Every answer's status is checked.
#include <sys/types.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <ctime>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "tests/bench/bench_daemon.h"
#include "tests/bench/bench_report.h"
#include "tests/bench/call_peers.h"

namespace flatlight {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kChannels = 4;
constexpr int kUnderWay = 16;  // Of each channel.
constexpr int kTurns = 15;
constexpr std::chrono::milliseconds kTurn{500};
constexpr int kRequests = 1'000'000;  // A second: asked about with every call, never reached.

double CpuSecondsOf(pid_t process) {
  clockid_t clock;
  timespec time{};
  if (clock_getcpuclockid(process, &clock) != 0 || clock_gettime(clock, &time) != 0) Die("no clock of a server");
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

using Done = std::function<void(const grpc::Status&)>;
// Begins a call on a channel, by its number.
using Begin = std::function<void(int channel, Done done)>;

// A call of one kind, kept going: each that ends is followed by the next, until the time is over.
class Load {
 public:
  explicit Load(Begin begin) : begin_(std::move(begin)) {}

  // Calls a second.
  double Run(std::chrono::milliseconds time) {
    const Clock::time_point start = Clock::now();
    end_ = start + time;
    calls_ = 0;
    open_ = kChannels * kUnderWay;
    for (int i = 0; i < kChannels * kUnderWay; ++i) Next(i % kChannels);
    std::unique_lock lock(mutex_);
    over_.wait(lock, [this] { return open_ == 0; });
    return static_cast<double>(calls_) / std::chrono::duration<double>(Clock::now() - start).count();
  }
  double calls() const { return static_cast<double>(calls_); }

 private:
  void Next(int channel) {
    begin_(channel, [this, channel](const grpc::Status& status) {
      if (!status.ok()) Die("a call failed: " + std::to_string(status.error_code()) + " " + status.error_message());
      ++calls_;
      if (Clock::now() < end_) {
        Next(channel);
        return;
      }
      const std::lock_guard lock(mutex_);
      if (--open_ == 0) over_.notify_all();
    });
  }

  const Begin begin_;
  Clock::time_point end_;
  std::atomic<std::int64_t> calls_ = 0;
  std::mutex mutex_;
  std::condition_variable over_;
  int open_ = 0;
};

template <class Request, class Response>
struct OneCall {
  CallContext context;
  Request request;
  Response response;
};

struct Kind {
  std::string name;
  pid_t server;
  Load load;
  std::vector<double> rates;
  double cpu_seconds = 0;
  double calls = 0;
};

void Measure(Kind& kind) {
  const double before = CpuSecondsOf(kind.server);
  kind.rates.push_back(kind.load.Run(kTurn));
  kind.cpu_seconds += CpuSecondsOf(kind.server) - before;
  kind.calls += kind.load.calls();
}

int Run(const std::string& self, const std::string& csv) {
  CallPeers peers(self, kRequests);
  const BenchDaemon& echo = peers.echo();
  const BenchDaemon& daemon = peers.daemon();
  const std::string& token = peers.authorization();
  const std::string job = peers.EndedJob();

  std::vector<std::unique_ptr<v1::ServerService::Stub>> echo_stubs;
  std::vector<std::unique_ptr<v1::ServerService::Stub>> server_stubs;
  std::vector<std::unique_ptr<v1::RenderService::Stub>> render_stubs;
  for (int i = 0; i < kChannels; ++i) {
    echo_stubs.push_back(v1::ServerService::NewStub(echo.Connect()));
    const auto channel = daemon.Connect();
    server_stubs.push_back(v1::ServerService::NewStub(channel));
    render_stubs.push_back(v1::RenderService::NewStub(channel));
  }
  const auto capabilities = [&](const auto& stubs, const std::string& authorization) {
    return [&stubs, authorization](int channel, Done done) {
      auto call = std::make_shared<OneCall<v1::GetCapabilitiesRequest, v1::GetCapabilitiesResponse>>();
      if (!authorization.empty()) call->context.AddMetadata("authorization", authorization);
      stubs[static_cast<std::size_t>(channel)]->async()->GetCapabilities(
          &call->context, &call->request, &call->response,
          [call, done = std::move(done)](const grpc::Status& status) { done(status); });
    };
  };
  const auto get_job = [&](int channel, Done done) {
    auto call = std::make_shared<OneCall<v1::GetJobRequest, v1::Job>>();
    call->context.AddMetadata("authorization", token);
    call->request.set_name(job);
    render_stubs[static_cast<std::size_t>(channel)]->async()->GetJob(
        &call->context, &call->request, &call->response,
        [call, done = std::move(done)](const grpc::Status& status) { done(status); });
  };
  std::vector<std::unique_ptr<Kind>> kinds;
  const auto add = [&](const std::string& name, const BenchDaemon& server, Begin begin) {
    kinds.emplace_back(new Kind{name, server.pid(), Load(std::move(begin)), {}, 0, 0});
  };
  add("empty call, no token", echo, capabilities(echo_stubs, ""));
  add("GetCapabilities with a token", daemon, capabilities(server_stubs, token));
  add("GetJob with a token", daemon, get_job);
  for (const auto& kind : kinds) kind->load.Run(kTurn);  // Connections, caches.
  for (int turn = 0; turn < kTurns; ++turn) {
    for (const auto& kind : kinds) Measure(*kind);
  }

  BenchTable table({"call", "turns", "calls/s, quartiles", "", "", "server us/call", "% of empty, median", "goal", ""});
  for (const auto& kind : kinds) {
    table.Add(CallRow(kind->name, kind->rates, kinds.front()->rates, {Short(1e6 * kind->cpu_seconds / kind->calls)}));
  }
  return table.Report(csv) ? 0 : 1;
}

}  // namespace
}  // namespace flatlight

int main(int argc, char** argv) {
  if (const int status = flatlight::MaybeServeEcho(argc, argv); status >= 0) return status;
  return flatlight::Run(argv[0], argc > 1 ? argv[1] : "out/calls.csv");
}
