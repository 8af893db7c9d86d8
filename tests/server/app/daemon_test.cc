// SPDX-License-Identifier: Apache-2.0
// flatlightd as a child process.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "grpcpp/create_channel.h"
#include "server/service/build_version.h"
#include "tests/support/loopback/loopback_server.h"

namespace flatlight {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;
using testing::TestContext;

class Daemon {
 public:
  explicit Daemon(std::vector<std::string> arguments, const std::vector<std::string>& environment = {}) {
    std::array<int, 2> in;
    std::array<int, 2> err;
    EXPECT_EQ(pipe2(in.data(), O_CLOEXEC), 0);
    EXPECT_EQ(pipe2(err.data(), O_CLOEXEC), 0);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, in[0], STDIN_FILENO);
    posix_spawn_file_actions_adddup2(&actions, err[1], STDERR_FILENO);
    arguments.insert(arguments.begin(), FLATLIGHTD);
    std::vector<char*> argv;
    for (std::string& argument : arguments) argv.push_back(argument.data());
    argv.push_back(nullptr);
    std::vector<std::string> variables = environment;
    for (char** variable = environ; *variable != nullptr; ++variable) variables.emplace_back(*variable);
    std::vector<char*> envp;
    for (std::string& variable : variables) envp.push_back(variable.data());
    envp.push_back(nullptr);
    EXPECT_EQ(posix_spawn(&pid_, FLATLIGHTD, &actions, nullptr, argv.data(), envp.data()), 0);
    posix_spawn_file_actions_destroy(&actions);
    close(in[0]);
    close(err[1]);
    stdin_ = in[1];
    stderr_ = fdopen(err[0], "r");
  }
  ~Daemon() {
    if (pid_ > 0) {
      kill(pid_, SIGKILL);
      Wait();
    }
    CloseStdin();
    std::fclose(stderr_);
  }

  // The next line of standard error; empty at its end.
  std::string Line() {
    std::string line;
    for (int c = std::getc(stderr_); c != EOF && c != '\n'; c = std::getc(stderr_)) line += static_cast<char>(c);
    return line;
  }
  // Waits until it serves.
  std::string Address() {
    const std::string line = Line();
    const std::size_t at = line.rfind(' ');
    EXPECT_THAT(line, StartsWith("flatlightd " + BuildVersion() + " listening on "));
    return at == std::string::npos ? "" : line.substr(at + 1);
  }
  void Signal(int signal) const { kill(pid_, signal); }
  void CloseStdin() {
    if (stdin_ >= 0) close(stdin_);
    stdin_ = -1;
  }
  // The exit status; -1 if it did not exit by itself.
  int Wait() {
    int status = 0;
    waitpid(pid_, &status, 0);
    pid_ = -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

 private:
  pid_t pid_ = -1;
  int stdin_ = -1;
  std::FILE* stderr_ = nullptr;
};

std::shared_ptr<grpc::Channel> Connect(const std::string& address) {
  return grpc::CreateChannel(address, grpc::InsecureChannelCredentials());
}

grpc::Status AskVersion(const std::string& address, const std::string& token, std::string& version) {
  TestContext context;
  if (!token.empty()) context.AddMetadata("authorization", "Bearer " + token);
  v1::GetCapabilitiesResponse response;
  const grpc::Status status =
      v1::ServerService::NewStub(Connect(address))->GetCapabilities(&context, v1::GetCapabilitiesRequest(), &response);
  version = response.version();
  return status;
}

// A folder that goes away with the test.
class TestFolder {
 public:
  TestFolder() { EXPECT_NE(mkdtemp(path_.data()), nullptr); }
  ~TestFolder() { std::filesystem::remove_all(path_); }
  std::string operator/(const std::string& name) const { return path_ + "/" + name; }

 private:
  std::string path_ = "/tmp/flatlightd_test_XXXXXX";
};

TEST(Daemon, ServesOnAFreePort) {
  Daemon daemon({"--listen", "127.0.0.1:0"});
  std::string version;
  EXPECT_TRUE(AskVersion(daemon.Address(), "", version).ok());
  EXPECT_EQ(version, BuildVersion());
}

TEST(Daemon, SigtermDrainsAndExitsWith0) {
  Daemon daemon({"--listen", "127.0.0.1:0"});
  const auto stub = v1::RenderService::NewStub(Connect(daemon.Address()));
  v1::CreateJobRequest request;
  *request.mutable_scene()->mutable_scene() = testing::FloorAndLampProto({100});
  request.mutable_settings()->set_method(v1::Settings::PATH_TRACING);
  request.mutable_settings()->set_time_limit(1000);
  TestContext create_context;
  v1::Job job;
  const grpc::Status created = stub->CreateJob(&create_context, request, &job);
  ASSERT_TRUE(created.ok()) << created.error_message();
  v1::WatchJobRequest watch_request;
  watch_request.set_name(job.name());
  TestContext watch_context;
  const auto watch = stub->WatchJob(&watch_context, watch_request);
  v1::WatchJobResponse message;
  ASSERT_TRUE(watch->Read(&message));
  daemon.Signal(SIGTERM);
  while (watch->Read(&message)) {
  }
  EXPECT_TRUE(message.draining()) << "the last message says why";
  EXPECT_EQ(watch->Finish().error_code(), grpc::StatusCode::UNAVAILABLE);
  EXPECT_EQ(daemon.Wait(), 0);
}

TEST(Daemon, EndsWithItsParentIfAsked) {
  Daemon daemon({"--listen", "127.0.0.1:0", "--exit-with-parent"});
  std::string version;
  EXPECT_TRUE(AskVersion(daemon.Address(), "", version).ok());
  daemon.CloseStdin();
  EXPECT_EQ(daemon.Wait(), 0);
}

TEST(Daemon, ServesOnAUnixSocketOfItsOwner) {
  const TestFolder folder;
  const std::string path = folder / "socket";
  Daemon daemon({"--listen", "unix:" + path}, {"FLATLIGHT_TOKEN=secret"});
  EXPECT_EQ(daemon.Address(), "unix:" + path);
  struct stat info {};
  ASSERT_EQ(stat(path.c_str(), &info), 0);
  EXPECT_EQ(info.st_mode & 0077, 0u);
  std::string version;
  EXPECT_TRUE(AskVersion("unix:" + path, "secret", version).ok());
  EXPECT_EQ(AskVersion("unix:" + path, "guess", version).error_code(), grpc::StatusCode::UNAUTHENTICATED);

  Daemon second({"--listen", "unix:" + path});
  EXPECT_THAT(second.Line(), HasSubstr("cannot listen on unix:" + path));
  EXPECT_EQ(second.Wait(), 1);
  EXPECT_TRUE(AskVersion("unix:" + path, "secret", version).ok()) << "the first one still serves";
}

TEST(Daemon, AnOccupiedPortIsAnError) {
  Daemon first({"--listen", "127.0.0.1:0"});
  const std::string address = first.Address();
  Daemon second({"--listen", address});
  EXPECT_THAT(second.Line(), HasSubstr("flatlightd: cannot listen on " + address));
  EXPECT_EQ(second.Wait(), 1);
}

TEST(Daemon, BadUsageExitsWith2) {
  for (const std::vector<std::string>& arguments : std::vector<std::vector<std::string>>{
           {"--listen", "0.0.0.0:7000"}, {"--threads", "0"}, {"--unknown"}, {"--token-file", "/nonexistent"}}) {
    Daemon daemon(arguments);
    EXPECT_FALSE(daemon.Line().empty()) << arguments[0];
    EXPECT_EQ(daemon.Wait(), 2) << arguments[0];
  }
}

}  // namespace
}  // namespace flatlight
