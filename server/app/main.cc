// SPDX-License-Identifier: Apache-2.0
// flatlightd: the server as a program.
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <string>
#include <utility>
#include <variant>

#include "core/execution/thread_pool.h"
#include "server/app/options.h"
#include "server/app/shutdown_signals.h"
#include "server/app/spare_memory.h"
#include "server/app/token.h"
#include "server/service/build_version.h"
#include "server/service/server.h"
#include "server/store/backup.h"

namespace flatlight {
namespace {

constexpr int kCannotServe = 1;
constexpr int kBadUsage = 2;
constexpr std::chrono::seconds kDrainGrace{3};
// With what was written until then the next process goes on as well: it is safe at any moment.
constexpr unsigned kHardStopSeconds = 25;

int Fail(const absl::Status& why, int exit_status) {
  std::fprintf(stderr, "flatlightd: %s\n", std::string(why.message()).c_str());
  return exit_status;
}

// Each watcher is a file: as many as the system lets this process have.
void RaiseFileLimit() {
  rlimit files{};
  if (getrlimit(RLIMIT_NOFILE, &files) != 0) return;
  files.rlim_cur = files.rlim_max;
  setrlimit(RLIMIT_NOFILE, &files);
}

int Run(const DaemonOptions& options) {
  if (!options.back_up_to.empty() || !options.restore_from.empty()) {
    const absl::Status done = !options.back_up_to.empty() ? BackUp(options.data, options.back_up_to)
                                                          : RestoreBackup(options.restore_from, options.data);
    return done.ok() ? 0 : Fail(done, kCannotServe);
  }
  if (options.user.action != UserCommand::Action::kNone) {
    const auto text = RunUserCommand(options.user, options.data);
    if (!text.ok()) return Fail(text.status(), absl::IsInvalidArgument(text.status()) ? kBadUsage : kCannotServe);
    if (std::fputs(text->c_str(), stdout) >= 0 && std::fflush(stdout) == 0) return 0;
    std::perror("flatlightd: cannot write to standard output");
    return kCannotServe;
  }
  ServerOptions server_options;
  server_options.address = options.listen;
  server_options.tls = {options.tls_cert, options.tls_key, options.tls_client_ca};
  server_options.threads = options.threads;
  server_options.data = options.data;
  server_options.metrics_address = options.metrics;
  server_options.log = options.log;
  server_options.quotas = options.quotas;
  server_options.retention = options.retention;
  server_options.webhook_rules = options.webhook_rules;
  server_options.checkpoint_interval =
      std::chrono::milliseconds(static_cast<std::int64_t>(1000 * options.checkpoint_interval));
  server_options.token = TakeTokenFromEnvironment();
  if (!options.token_file.empty()) {
    auto token = ReadTokenFile(options.token_file);
    if (!token.ok()) return Fail(token.status(), kBadUsage);
    server_options.token = *std::move(token);
  }
  RaiseFileLimit();
  const ShutdownSignals signals;
  const auto server = Server::Start(server_options);
  if (!server.ok()) {
    return Fail(server.status(), absl::IsInvalidArgument(server.status()) ? kBadUsage : kCannotServe);
  }
  // Programs that start this one read the address from this line.
  std::fprintf(stderr, "flatlightd %s listening on %s\n", BuildVersion().c_str(), (*server)->address().c_str());
  if (!options.metrics.empty()) {
    std::fprintf(stderr, "flatlightd metrics at http://%s/metrics\n", (*server)->metrics_address().c_str());
  }
  const auto reopen_logs = [&] {
    const absl::Status reopened = (*server)->ReopenLogs();
    if (!reopened.ok()) Fail(reopened, kCannotServe);
  };
  const auto tidy = [cpu_seconds = 0.0]() mutable {
    constexpr double kRestSeconds = 0.1;  // Of processor time since the last time.
    const double now = static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
    GiveBackSpareMemory(now - std::exchange(cpu_seconds, now) < kRestSeconds);
  };
  signals.Await(options.exit_with_parent, reopen_logs, tidy);
  std::signal(SIGALRM, [](int) { _exit(0); });
  alarm(kHardStopSeconds);
  (*server)->Drain(kDrainGrace);
  return 0;
}

}  // namespace
}  // namespace flatlight

int main(int argc, char** argv) {
  // gRPC's own log lines would come between ours; its errors reach us as results.
  setenv("GRPC_VERBOSITY", "NONE", 0);
  umask(0077);  // A Unix socket is for its owner.
  const auto options = flatlight::ParseDaemonOptions(argc, argv, flatlight::ThreadPool::AvailableProcessors(),
                                                     flatlight::BuildVersion());
  if (const int* exit_status = std::get_if<int>(&options)) return *exit_status;
  return flatlight::Run(std::get<flatlight::DaemonOptions>(options));
}
