// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/bench_daemon.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "google/protobuf/util/json_util.h"
#include "grpcpp/create_channel.h"

namespace flatlight {

void Die(const std::string& why) {
  std::fprintf(stderr, "%s\n", why.c_str());
  std::exit(2);
}

std::string DaemonBesides(const std::string& self) {
  const std::string folder = std::filesystem::path(self).parent_path().string();
  return (folder.empty() ? "." : folder) + "/../bin/flatlightd";
}

TemporaryFolder::TemporaryFolder()
    : path_((std::filesystem::temp_directory_path() / "flatlight-bench-XXXXXX").string()) {
  if (mkdtemp(path_.data()) == nullptr) Die("cannot make " + path_);
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

BenchDaemon::BenchDaemon(const std::string& program, const std::string& folder,
                         const std::vector<std::string>& arguments)
    : address_("unix:" + folder + "/socket") {
  std::vector<std::string> words = {program, "--listen", address_, "--threads", "2", "--exit-with-parent"};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  // It ends with its standard input: also when this program dies.
  int input[2];
  if (pipe2(input, O_CLOEXEC) != 0) Die("cannot make a pipe");
  posix_spawn_file_actions_adddup2(&actions, input[0], STDIN_FILENO);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  if (posix_spawn(&pid_, program.c_str(), &actions, nullptr, argv.data(), environ) != 0) Die("cannot run " + program);
  posix_spawn_file_actions_destroy(&actions);
  close(input[0]);
  input_ = input[1];
  const auto channel = Connect();
  render_ = v1::RenderService::NewStub(channel);
  server_ = v1::ServerService::NewStub(channel);
}

void BenchDaemon::Kill() {
  if (pid_ <= 0) return;
  kill(pid_, SIGKILL);
  waitpid(pid_, nullptr, 0);
  close(input_);
  pid_ = 0;
}

std::shared_ptr<grpc::Channel> BenchDaemon::Connect() const {
  grpc::ChannelArguments arguments;
  for (const char* wait :
       {GRPC_ARG_INITIAL_RECONNECT_BACKOFF_MS, GRPC_ARG_MIN_RECONNECT_BACKOFF_MS, GRPC_ARG_MAX_RECONNECT_BACKOFF_MS}) {
    arguments.SetInt(wait, 20);
  }
  arguments.SetInt(GRPC_ARG_USE_LOCAL_SUBCHANNEL_POOL, 1);
  return grpc::CreateCustomChannel(address_, grpc::InsecureChannelCredentials(), arguments);
}

v1::CreateJobRequest RequestFromJson(const std::string& json) {
  v1::CreateJobRequest request;
  if (!google::protobuf::util::JsonStringToMessage(json, &request).ok()) Die("bad request " + json);
  return request;
}

}  // namespace flatlight
