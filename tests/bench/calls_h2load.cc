// SPDX-License-Identifier: Apache-2.0
// As calls, by a client that has nothing of gRPC or of this project: h2load, of Debian's nghttp2-client.
//
//   calls_h2load [CSV]        the rows go to CSV (default: out/calls_h2load.csv) as well
//
// h2load takes every HTTP status 200 for a success, and gRPC says what went wrong behind that. So the bytes of the
// answers are counted: an error has none, and answers to one request are as long as the one that a gRPC client gets and
// checks; but for a few that say that no request is taken, so that less than one answer may be missing in all.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "tests/bench/bench_report.h"
#include "tests/bench/call_peers.h"

namespace flatlight {
namespace {

constexpr int kCalls = 4000;  // A turn.
constexpr int kTurns = 11;
// A second, and ten times as many at once: more than are made in all, however fast, and few enough that some are always
// taken, which the answers of GetCapabilities say.
constexpr int kRequests = 10'000;
static_assert(2 * (kTurns + 1) * kCalls < 10 * kRequests);

std::string OutputOf(const std::string& command) {
  std::FILE* const output = popen(command.c_str(), "r");
  std::string text;
  for (int c = std::getc(output); c != EOF; c = std::getc(output)) text += static_cast<char>(c);
  if (pclose(output) != 0) Die("cannot run h2load (Debian's nghttp2-client): " + command);
  return text;
}

// The number in front of `after`, which ends at `before` or at the text's beginning.
double NumberBetween(const std::string& text, const std::string& before, const std::string& after) {
  const std::size_t end = text.find(after);
  const std::size_t start = end == std::string::npos ? end : text.rfind(before, end);
  if (start == std::string::npos) Die("h2load says nothing in front of \"" + after + "\":\n" + text);
  return std::atof(text.c_str() + start + before.size());
}

// A message as gRPC frames it.
std::string Framed(const std::string& message) {
  std::string frame(1, '\0');
  for (int shift = 24; shift >= 0; shift -= 8) frame += static_cast<char>((message.size() >> shift) & 0xff);
  return frame + message;
}

struct Kind {
  std::string name;
  std::string command;
  std::size_t answer_bytes = 0;  // Each, framed.
  std::vector<double> rates = {};
};

Kind MakeKind(const std::string& name, const BenchDaemon& server, const std::string& method,
              const std::string& authorization, const std::string& body_file, std::size_t answer_bytes) {
  std::string command = "h2load -n " + std::to_string(kCalls) +
                        " -c 4 -m 16 -t 1 -H 'content-type: application/grpc' -H 'te: trailers' -d " + body_file +
                        " --base-uri=" + server.address();
  if (!authorization.empty()) command += " -H 'authorization: " + authorization + "'";
  return {name, command + " http://localhost/flatlight.v1." + method, answer_bytes};
}

// One turn; ends the program if any call did not answer what it should.
void Measure(Kind& kind) {
  const std::string text = OutputOf(kind.command);
  const double succeeded = NumberBetween(text, ", ", " succeeded");
  const double data = NumberBetween(text, "(", ") data");
  const auto answer = static_cast<double>(kind.answer_bytes);
  if (succeeded != kCalls || std::abs(data - answer * kCalls) >= answer) {
    Die(kind.name + ": not every call was answered with " + std::to_string(kind.answer_bytes) + " bytes:\n" + text);
  }
  kind.rates.push_back(NumberBetween(text, ", ", " req/s"));
}

int Run(const std::string& self, const std::string& csv) {
  CallPeers peers(self, kRequests);
  const TemporaryFolder folder;
  const auto write_body = [&](const std::string& name, const std::string& message) {
    const std::string path = folder.path() + "/" + name;
    std::ofstream(path, std::ios::binary) << Framed(message);
    return path;
  };
  v1::GetJobRequest get_job;
  get_job.set_name(peers.EndedJob());
  v1::Job job;
  const auto authorized = [&](grpc::ClientContext& context) -> grpc::ClientContext* {
    context.AddMetadata("authorization", peers.authorization());
    return &context;
  };
  CallContext of_job;
  const grpc::Status got = peers.daemon().render().GetJob(authorized(of_job), get_job, &job);
  if (!got.ok()) Die("GetJob: " + got.error_message());
  const auto capabilities = [&] {
    CallContext context;
    v1::GetCapabilitiesResponse response;
    const grpc::Status told = peers.daemon().server().GetCapabilities(authorized(context), {}, &response);
    if (!told.ok()) Die("GetCapabilities: " + told.error_message());
    return response;
  };
  // The job that has just ended, and its watch, count for a moment yet, and are told until then.
  for (v1::Quotas own = capabilities().quotas(); own.jobs().used() + own.watches().used() > 0;) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    own = capabilities().quotas();
  }
  std::size_t most_capabilities = 0;  // With a request taken.
  for (int i = 0; i < 100; ++i) {
    most_capabilities = std::max(most_capabilities, Framed(capabilities().SerializeAsString()).size());
  }

  const std::string empty = write_body("empty", "");
  std::vector<Kind> kinds;
  kinds.push_back(
      MakeKind("empty call, no token", peers.echo(), "ServerService/GetCapabilities", "", empty, Framed("").size()));
  kinds.push_back(MakeKind("GetCapabilities with a token", peers.daemon(), "ServerService/GetCapabilities",
                           peers.authorization(), empty, most_capabilities));
  kinds.push_back(MakeKind("GetJob with a token", peers.daemon(), "RenderService/GetJob", peers.authorization(),
                           write_body("job", get_job.SerializeAsString()), Framed(job.SerializeAsString()).size()));
  for (Kind& kind : kinds) Measure(kind);  // Caches.
  for (Kind& kind : kinds) kind.rates.clear();
  for (int turn = 0; turn < kTurns; ++turn) {
    for (Kind& kind : kinds) Measure(kind);
  }

  BenchTable table({"call, by h2load", "turns", "calls/s, quartiles", "", "", "% of empty, median", "goal", ""});
  for (const Kind& kind : kinds) table.Add(CallRow(kind.name, kind.rates, kinds.front().rates));
  return table.Report(csv) ? 0 : 1;
}

}  // namespace
}  // namespace flatlight

int main(int argc, char** argv) {
  if (const int status = flatlight::MaybeServeEcho(argc, argv); status >= 0) return status;
  return flatlight::Run(argv[0], argc > 1 ? argv[1] : "out/calls_h2load.csv");
}
