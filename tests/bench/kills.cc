// SPDX-License-Identifier: Apache-2.0
// Kills a server at random moments, starts it again on the same folder, and counts what is lost or altered at the end:
//   kills FLATLIGHTD [KILLS [SEED]]
// Jobs of several methods and sizes are submitted all the while, each with a request id, and sent again if the server
// was killed before it answered. In the end each must be there once, with the bits of a server that was not killed.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "google/protobuf/util/message_differencer.h"
#include "tests/bench/bench_daemon.h"

namespace flatlight {
namespace {

using std::chrono::milliseconds;

std::vector<v1::CreateJobRequest> Requests() {
  const std::string picture =
      R"("probes": [{"name": "view", "fluence": {"min": {"x": 0.1, "y": 0.1}, "max": {"x": 0.9, "y": 0.9}, "width": 48, "height": 48}}])";
  return {
      RequestFromJson(
          R"({"scene": {"name": "scenes/cornell"}, "settings": {"method": "PATH_TRACING", "samples": 128}})"),
      RequestFromJson(
          R"({"scene": {"name": "scenes/cornell"}, "settings": {"method": "PATH_TRACING", "samples": 1024}})"),
      RequestFromJson(
          R"({"scene": {"name": "scenes/cornell"}, "settings": {"method": "PATH_TRACING", "targetError": 0.1}})"),
      RequestFromJson(
          R"({"scene": {"name": "scenes/cornell"}, "settings": {"method": "RAY_TRACING", "samples": 256}})"),
      RequestFromJson(R"({"scene": {"name": "scenes/penumbra"}, "settings": {"method": "EXACT", "maxBounces": 0}})"),
      RequestFromJson(R"({"scene": {"name": "scenes/penumbra"}, "settings": {"method": "REFERENCE"}})"),
      RequestFromJson(R"({"scene": {"name": "scenes/penumbra"}, "settings": {"method": "IRRADIANCE_CACHING"}})"),
      RequestFromJson(R"({"scene": {"name": "scenes/cornell"}, "settings": {"method": "IRRADIANCE_CACHING", )"
                      R"("gather": "FROM_PHOTON_MAP", "maxRecords": 60}})"),
      RequestFromJson(
          R"({"scene": {"name": "scenes/cornell"}, "settings": {"method": "PHOTON_MAPPING", "photons": 200000}})"),
      RequestFromJson(R"({"scene": {"name": "scenes/cornell", )" + picture +
                      R"(}, "settings": {"method": "PATH_TRACING", "samples": 64}})"),
      RequestFromJson(R"({"scene": {"name": "scenes/cornell", )" + picture +
                      R"(}, "settings": {"method": "PATH_TRACING", "targetError": 0.5}})"),
  };
}

// The result without what tells of the time that it took; empty if it cannot be had.
std::string FetchResult(v1::RenderService::Stub& render, const std::string& job) {
  CallContext context;
  v1::GetResultRequest request;
  request.set_name(job);
  const auto reader = render.GetResult(&context, request);
  std::string bytes;
  for (v1::GetResultResponse chunk; reader->Read(&chunk);) bytes += chunk.data();
  v1::RenderResult result;
  if (!reader->Finish().ok() || !result.ParseFromString(bytes)) return {};
  result.mutable_statistics()->clear_wall_seconds();
  result.mutable_statistics()->clear_cpu_seconds();
  return result.SerializeAsString();
}

std::string Differences(const std::string& expected, const std::string& result) {
  v1::RenderResult a, b;
  a.ParseFromString(expected);
  b.ParseFromString(result);
  std::string report;
  google::protobuf::util::MessageDifferencer differencer;
  differencer.ReportDifferencesToString(&report);
  differencer.Compare(a, b);
  return report.substr(0, 1000);
}

// Watches to the end; the state in which it ended. On a busy machine what the kills have left over takes long.
v1::Job::State AwaitEnd(v1::RenderService::Stub& render, const std::string& job) {
  CallContext context(std::chrono::minutes(30));
  v1::WatchJobRequest request;
  request.set_name(job);
  const auto reader = render.WatchJob(&context, request);
  v1::Job::State state = v1::Job::STATE_UNSPECIFIED;
  for (v1::WatchJobResponse update; reader->Read(&update);) {
    if (update.has_job()) state = update.job().state();
  }
  return reader->Finish().ok() ? state : v1::Job::STATE_UNSPECIFIED;
}

std::set<std::string> ListAll(v1::RenderService::Stub& render) {
  std::set<std::string> names;
  v1::ListJobsRequest request;
  while (true) {
    CallContext context;
    v1::ListJobsResponse page;
    if (!render.ListJobs(&context, request, &page).ok()) Die("cannot list jobs");
    for (const v1::Job& job : page.jobs()) names.insert(job.name());
    if (page.next_page_token().empty()) return names;
    request.set_page_token(page.next_page_token());
  }
}

void AwaitAnswer(v1::ServerService::Stub& server) {
  CallContext context;
  v1::GetCapabilitiesResponse capabilities;
  if (!server.GetCapabilities(&context, {}, &capabilities).ok()) Die("the server does not come up");
}

struct Submitted {
  std::size_t request = 0;  // Which.
  bool anew = true;
  std::string request_id;
  std::string job;  // Empty until the server has said so.
};

// Until the server is gone. Whatever was not answered before goes first.
void Submit(v1::RenderService::Stub& render, const std::vector<v1::CreateJobRequest>& requests, std::mt19937_64& random,
            std::vector<Submitted>& submitted) {
  while (true) {
    if (submitted.empty() || !submitted.back().job.empty()) {
      submitted.push_back({random() % requests.size(), random() % 8 == 0, std::to_string(random()), ""});
    }
    Submitted& last = submitted.back();
    v1::CreateJobRequest request = requests[last.request];
    request.set_request_id(last.request_id);
    request.set_anew(last.anew);
    CallContext context(std::chrono::seconds(2));
    v1::Job job;
    if (!render.CreateJob(&context, request, &job).ok()) return;
    last.job = job.name();
    std::this_thread::sleep_for(milliseconds(random() % 400));
  }
}

int Run(const std::string& program, int kills, std::uint64_t seed) {
  const std::vector<v1::CreateJobRequest> requests = Requests();
  const TemporaryFolder folder;
  const std::vector<std::string> kept = {"--data", folder.path() + "/data", "--checkpoint-interval", "0.05"};
  std::vector<std::string> expected;
  {
    BenchDaemon daemon(program, folder.path());
    for (const v1::CreateJobRequest& request : requests) {
      CallContext context;
      v1::Job job;
      const grpc::Status created = daemon.render().CreateJob(&context, request, &job);
      if (!created.ok()) Die(created.error_message());
      AwaitEnd(daemon.render(), job.name());
      expected.push_back(FetchResult(daemon.render(), job.name()));
      if (expected.back().empty()) Die("no result of " + request.ShortDebugString());
    }
  }

  std::mt19937_64 random(seed);
  std::vector<Submitted> submitted;
  for (int i = 0; i < kills; ++i) {
    BenchDaemon daemon(program, folder.path(), kept);
    const milliseconds life(random() % 800);
    // One in four counts from the start, the others from the first answer: on a busy machine no server would live else.
    if (random() % 4 != 0) AwaitAnswer(daemon.server());
    std::thread killer([&] {
      std::this_thread::sleep_for(life);
      daemon.Kill();
    });
    Submit(daemon.render(), requests, random, submitted);
    killer.join();
  }
  if (!submitted.empty() && submitted.back().job.empty()) submitted.pop_back();  // Never answered: it may be there.

  BenchDaemon daemon(program, folder.path(), kept);
  const std::set<std::string> listed = ListAll(daemon.render());
  std::set<std::string> names;
  int lost = 0, altered = 0;
  for (const Submitted& one : submitted) {
    names.insert(one.job);
    const bool is_listed = listed.count(one.job) > 0;
    const auto end = is_listed ? AwaitEnd(daemon.render(), one.job) : v1::Job::STATE_UNSPECIFIED;
    if (end != v1::Job::SUCCEEDED) {
      std::printf("lost: %s, %s, %s\n", one.job.c_str(), is_listed ? v1::Job::State_Name(end).c_str() : "not listed",
                  requests[one.request].ShortDebugString().c_str());
      ++lost;
    } else if (const std::string result = FetchResult(daemon.render(), one.job); result != expected[one.request]) {
      std::printf("altered: %s, %s\n%s", one.job.c_str(), requests[one.request].ShortDebugString().c_str(),
                  Differences(expected[one.request], result).c_str());
      ++altered;
    }
  }
  // The one that was never answered.
  const int doubled = static_cast<int>(submitted.size() - names.size()) +
                      static_cast<int>(listed.size() > names.size() + 1 ? listed.size() - names.size() - 1 : 0);
  std::printf("%d kills, %zu jobs accepted: %d lost, %d altered, %d doubled\n", kills, submitted.size(), lost, altered,
              doubled);
  return lost + altered + doubled == 0 && submitted.size() * 4 > static_cast<std::size_t>(kills) ? 0 : 1;
}

}  // namespace
}  // namespace flatlight

int main(int argc, char** argv) {
  const std::string program = argc > 1 ? argv[1] : flatlight::DaemonBesides(argv[0]);
  const int kills = argc > 2 ? std::atoi(argv[2]) : 200;
  const std::uint64_t seed = argc > 3 ? std::strtoull(argv[3], nullptr, 10) : 1;
  return flatlight::Run(program, kills, seed);
}
