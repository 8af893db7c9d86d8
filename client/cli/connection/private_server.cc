// SPDX-License-Identifier: Apache-2.0
#include "client/cli/connection/private_server.h"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/random.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

#include "absl/strings/escaping.h"

namespace flatlight {
namespace {

namespace fs = std::filesystem;
using std::chrono::milliseconds;
using std::chrono::steady_clock;

constexpr std::chrono::duration<int, std::milli> kStopPatience{4000};  // The server's own is 3 s.
constexpr milliseconds kLook{100};                                     // From one look at how it gets on to the next.
constexpr std::uint32_t kMostThreads = 1024;                           // That flatlightd accepts.
constexpr const char* kTokenVariable = "FLATLIGHT_TOKEN";

absl::Status Failed(const std::string& what) {
  return absl::UnavailableError("cannot start a private server: " + what);
}

std::string RandomToken() {
  std::array<unsigned char, 32> bytes{};
  if (getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size())) return "";
  return absl::BytesToHexString({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

// The path of a socket has at most 107 bytes, so a long TMPDIR won't do.
std::string MakeFolder() {
  const char* wanted = std::getenv("TMPDIR");
  const std::string parent = wanted != nullptr && *wanted == '/' && std::strlen(wanted) < 60 ? wanted : "/tmp";
  std::string folder = parent + "/flatlight-XXXXXX";
  return mkdtemp(folder.data()) == nullptr ? "" : folder;
}

bool Connects(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::strncpy(address.sun_path, path.c_str(), sizeof address.sun_path - 1);
  const int fd = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const bool connected = connect(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
  close(fd);
  return connected;
}

std::vector<std::string> Environment(const std::string& token) {
  std::vector<std::string> variables;
  const std::string prefix = std::string(kTokenVariable) + "=";
  for (char** variable = environ; *variable != nullptr; ++variable)
    if (std::strncmp(*variable, prefix.c_str(), prefix.size()) != 0) variables.emplace_back(*variable);
  variables.push_back(prefix + token);
  return variables;
}

std::vector<char*> Pointers(std::vector<std::string>& texts) {
  std::vector<char*> pointers;
  pointers.reserve(texts.size() + 1);
  for (std::string& text : texts) pointers.push_back(text.data());
  pointers.push_back(nullptr);
  return pointers;
}

std::string LastLines(const std::string& path) {
  std::ifstream file(path);
  std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  text.erase(text.find_last_not_of('\n') + 1);
  return text.size() > 2000 ? text.substr(text.size() - 2000) : text;
}

}  // namespace

absl::StatusOr<std::unique_ptr<PrivateServer>> PrivateServer::Start(std::uint32_t threads) {
  std::error_code error;
  const fs::path self = fs::read_symlink("/proc/self/exe", error);
  const std::string program = (self.parent_path() / "flatlightd").string();
  if (access(program.c_str(), X_OK) != 0)
    return Failed(program + ": " + std::strerror(errno) + " (or name a server with --server)");
  const std::string token = RandomToken();
  if (token.empty()) return Failed("no random bytes");
  const std::string folder = MakeFolder();
  if (folder.empty()) return Failed(std::string("no temporary folder: ") + std::strerror(errno));
  std::unique_ptr<PrivateServer> server(new PrivateServer(program, folder, token));
  if (absl::Status status = server->Spawn(threads); !status.ok()) return status;
  return server;
}

PrivateServer::PrivateServer(std::string program, std::string folder, std::string token)
    : program_(std::move(program)),
      folder_(std::move(folder)),
      socket_(folder_ + "/socket"),
      log_(folder_ + "/log"),
      token_(std::move(token)) {}

absl::Status PrivateServer::Spawn(std::uint32_t threads) {
  std::array<int, 2> pipe{};
  if (pipe2(pipe.data(), O_CLOEXEC) != 0) return Failed(std::strerror(errno));
  lifeline_ = pipe[1];

  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_adddup2(&files, pipe[0], 0);
  posix_spawn_file_actions_addopen(&files, 1, log_.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0600);
  posix_spawn_file_actions_adddup2(&files, 1, 2);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  // Its own process group: Ctrl-C in a terminal is for us, who then cancel the job and end the server in good order.
  posix_spawnattr_setpgroup(&attributes, 0);
  sigset_t signals;
  sigemptyset(&signals);
  posix_spawnattr_setsigmask(&attributes, &signals);
  sigaddset(&signals, SIGPIPE);
  sigaddset(&signals, SIGXFSZ);
  posix_spawnattr_setsigdefault(&attributes, &signals);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);

  std::vector<std::string> arguments = {program_, "--listen", address(), "--exit-with-parent"};
  if (threads > 0) arguments.insert(arguments.end(), {"--threads", std::to_string(std::min(threads, kMostThreads))});
  std::vector<std::string> environment = Environment(token_);
  const int error = posix_spawn(&child_, program_.c_str(), &files, &attributes, Pointers(arguments).data(),
                                Pointers(environment).data());
  posix_spawn_file_actions_destroy(&files);
  posix_spawnattr_destroy(&attributes);
  close(pipe[0]);
  if (error == 0) return absl::OkStatus();
  child_ = -1;
  return Failed(program_ + ": " + std::strerror(error));
}

absl::Status PrivateServer::WaitUntilReady(Interruption& interruption, const std::function<void()>& tell_slow) {
  const steady_clock::time_point start = steady_clock::now();
  StartupWatch watch(start);
  for (steady_clock::time_point next_look = start; !Connects(socket_);) {
    if (absl::Status status = CheckAlive(); !status.ok()) return status;
    if (const steady_clock::time_point now = steady_clock::now(); now >= next_look) {
      next_look = now + kLook;
      const StartupWatch::Verdict verdict = watch.Look(now, ReadActivity(child_));
      if (verdict != StartupWatch::Verdict::kGoesOn) return NotListening(verdict, now - start);
      if (watch.WorthTelling(now)) tell_slow();
    }
    if (!interruption.Sleep(milliseconds(1))) return absl::CancelledError("interrupted");
  }
  return absl::OkStatus();
}

absl::Status PrivateServer::NotListening(StartupWatch::Verdict verdict, steady_clock::duration waited) const {
  const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(waited).count();
  std::string what = "after " + std::to_string(seconds) + " s " + program_ + " does not listen";
  what += verdict == StartupWatch::Verdict::kIdle
              ? ", and has done nothing for " + std::to_string(StartupWatch::kIdlePatience.count()) + " s"
              : ", though it works";
  const std::string log = LastLines(log_);
  return Failed(log.empty() ? what : what + "\n" + log);
}

absl::Status PrivateServer::CheckAlive() {
  if (child_ >= 0 && waitpid(child_, &exit_status_, WNOHANG) == 0) return absl::OkStatus();
  child_ = -1;
  std::string message = "the private server ended by itself, with ";
  message += WIFSIGNALED(exit_status_) ? std::string("signal ") + strsignal(WTERMSIG(exit_status_))
                                       : "status " + std::to_string(WEXITSTATUS(exit_status_));
  const std::string log = LastLines(log_);
  return absl::UnavailableError(log.empty() ? message : message + "\n" + log);
}

void PrivateServer::Stop() {
  if (lifeline_ >= 0) close(lifeline_);
  if (child_ < 0) return;
  const int handle =
      static_cast<int>(syscall(SYS_pidfd_open, child_, 0));  // Can be read from when the child has ended.
  pollfd ended{handle, POLLIN, 0};
  if (handle < 0 || poll(&ended, 1, kStopPatience.count()) != 1) kill(child_, SIGKILL);
  if (handle >= 0) close(handle);
  waitpid(child_, &exit_status_, 0);
  child_ = -1;
}

PrivateServer::~PrivateServer() {
  Stop();
  std::error_code ignored;
  fs::remove_all(folder_, ignored);
}

}  // namespace flatlight
