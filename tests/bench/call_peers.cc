// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/call_peers.h"

#include <unistd.h>

#include <chrono>
#include <cstdio>

#include "grpcpp/server.h"
#include "grpcpp/server_builder.h"
#include "tests/bench/bench_report.h"

namespace flatlight {
namespace {

constexpr double kGoal = 70;  // % of the empty call's rate.

class Echo final : public v1::ServerService::CallbackService {
  grpc::ServerUnaryReactor* GetCapabilities(grpc::CallbackServerContext* context, const v1::GetCapabilitiesRequest*,
                                            v1::GetCapabilitiesResponse*) override {
    grpc::ServerUnaryReactor* reactor = context->DefaultReactor();
    reactor->Finish(grpc::Status::OK);
    return reactor;
  }
};

int ServeEcho(const std::string& address) {
  Echo echo;
  grpc::ServerBuilder builder;
  builder.AddListeningPort(address, grpc::InsecureServerCredentials());
  builder.RegisterService(&echo);
  const auto server = builder.BuildAndStart();
  if (server == nullptr) return 1;
  for (char discarded; read(STDIN_FILENO, &discarded, 1) > 0;) continue;
  server->Shutdown(std::chrono::system_clock::now());
  return 0;
}

// The first token of `flatlightd user add`.
std::string AddUser(const std::string& program, const std::string& data) {
  std::FILE* const output = popen((program + " user add --data " + data + " ada").c_str(), "r");
  std::string text;
  for (int c = std::getc(output); c != EOF; c = std::getc(output)) text += static_cast<char>(c);
  const std::size_t comma = text.rfind(',');
  if (pclose(output) != 0 || comma == std::string::npos) Die("cannot add a user");
  return text.substr(comma + 1, text.find_last_not_of('\n') - comma);
}

}  // namespace

int MaybeServeEcho(int argc, char** argv) {
  return argc > 2 && std::string(argv[1]) == "--listen" ? ServeEcho(argv[2]) : -1;
}

CallPeers::CallPeers(const std::string& self, int requests)
    : data_(folder_.path() + "/data"),
      authorization_("Bearer " + AddUser(DaemonBesides(self), data_)),
      echo_("/proc/self/exe", echo_folder_.path()),
      daemon_(DaemonBesides(self), folder_.path(),
              {"--data", data_, "--quota", "student.requests=" + std::to_string(requests)}) {}

std::string CallPeers::EndedJob() {
  CallContext context;
  context.AddMetadata("authorization", authorization_);
  v1::Job job;
  const grpc::Status created = daemon_.render().CreateJob(
      &context, RequestFromJson(R"({"scene": {"name": "scenes/unit-light"}, "settings": {"method": "EXACT"}})"), &job);
  if (!created.ok()) Die("CreateJob: " + created.error_message());
  CallContext watch_context;
  watch_context.AddMetadata("authorization", authorization_);
  v1::WatchJobRequest watch;
  watch.set_name(job.name());
  const auto reader = daemon_.render().WatchJob(&watch_context, watch);
  for (v1::WatchJobResponse update; reader->Read(&update);) continue;
  if (!reader->Finish().ok()) Die("WatchJob failed");
  return job.name();
}

std::vector<std::string> CallRow(const std::string& name, const std::vector<double>& rates,
                                 const std::vector<double>& empty_rates, const std::vector<std::string>& more) {
  std::vector<double> shares;
  for (std::size_t i = 0; i < rates.size(); ++i) shares.push_back(100 * rates[i] / empty_rates[i]);
  const Quartiles rate = QuartilesOf(rates);
  const double share = QuartilesOf(shares).median;
  std::vector<std::string> row = {name, std::to_string(rates.size()), Short(rate.lower), Short(rate.median),
                                  Short(rate.upper)};
  row.insert(row.end(), more.begin(), more.end());
  row.push_back(Short(share));
  const bool is_empty_call = &rates == &empty_rates;
  row.push_back(is_empty_call ? "" : Short(kGoal));
  row.push_back(is_empty_call ? "" : share >= kGoal ? "met" : "MISSED");
  return row;
}

}  // namespace flatlight
