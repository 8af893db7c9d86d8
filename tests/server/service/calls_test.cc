// SPDX-License-Identifier: Apache-2.0
// The unary calls, GetResult, the guard and the limits over a real connection.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <thread>

#include "core/render/plan.h"
#include "grpcpp/impl/codegen/client_unary_call.h"
#include "server/service/build_version.h"
#include "server/store/sha256.h"
#include "tests/support/loopback/loopback_server.h"
#include "tests/support/rendering/fake_rendering.h"

namespace flatlight {
namespace {

using testing::DetailOf;
using testing::FakeRenderings;
using testing::FloorAndLampProto;
using ::testing::HasSubstr;
using testing::LoopbackServer;
using ::testing::Not;
using testing::ReasonOf;
using testing::TestContext;
using enum grpc::StatusCode;

class CallsTest : public ::testing::Test {
 protected:
  ~CallsTest() override { renderings_.Release(); }

  ServerOptions Options() {
    ServerOptions options;
    options.start_rendering = [this](std::shared_ptr<const Scene> scene, const Plan& plan) {
      return renderings_.Start(scene, plan);
    };
    return options;
  }

  static v1::CreateJobRequest NewJob() {
    v1::CreateJobRequest request;
    *request.mutable_scene()->mutable_scene() = FloorAndLampProto({10});
    request.mutable_settings()->set_method(v1::Settings::PATH_TRACING);
    return request;
  }
  static grpc::Status Create(LoopbackServer& server, const v1::CreateJobRequest& request, v1::Job& job) {
    TestContext context;
    return server.render().CreateJob(&context, request, &job);
  }
  static v1::Job Create(LoopbackServer& server, const v1::CreateJobRequest& request) {
    v1::Job job;
    const grpc::Status status = Create(server, request, job);
    EXPECT_TRUE(status.ok()) << status.error_message();
    return job;
  }
  static void AwaitEnd(LoopbackServer& server, const std::string& name) {
    v1::WatchJobRequest request;
    request.set_name(name);
    TestContext context;
    const auto reader = server.render().WatchJob(&context, request);
    v1::WatchJobResponse message;
    while (reader->Read(&message)) {
    }
    EXPECT_TRUE(reader->Finish().ok());
  }
  static grpc::Status GetResult(LoopbackServer& server, const std::string& name, std::string& bytes, int& chunks) {
    v1::GetResultRequest request;
    request.set_name(name);
    TestContext context;
    const auto reader = server.render().GetResult(&context, request);
    v1::GetResultResponse message;
    while (reader->Read(&message)) {
      bytes += message.data();
      ++chunks;
    }
    return reader->Finish();
  }

  FakeRenderings renderings_{3};
};

TEST_F(CallsTest, AResultHasAllThatMadeIt) {
  LoopbackServer server(Options());
  v1::CreateJobRequest request = NewJob();
  request.mutable_scene()->mutable_scene()->mutable_probes(0)->set_count(20'000);
  const v1::Job job = Create(server, request);
  AwaitEnd(server, job.name());
  std::string bytes;
  int chunks = 0;
  ASSERT_TRUE(GetResult(server, job.name(), bytes, chunks).ok());
  EXPECT_GT(chunks, 1);
  v1::RenderResult result;
  ASSERT_TRUE(result.ParseFromString(bytes));
  EXPECT_EQ(result.scene(), "floor and lamp");
  EXPECT_EQ(result.world_hash().size(), 64u);
  EXPECT_EQ(result.job_key().size(), 64u);
  EXPECT_EQ(result.build(), BuildVersion());
  EXPECT_EQ(result.end_reason(), v1::SAMPLES_DONE);
  EXPECT_EQ(result.settings().method(), v1::Settings::PATH_TRACING);
  EXPECT_TRUE(result.plan().settings().has_samples());
  EXPECT_EQ(result.probes(0).irradiance_size(), 20'000);
  EXPECT_GT(result.statistics().wall_seconds(), 0);
  EXPECT_GT(result.statistics().cpu_seconds(), 0);
  EXPECT_EQ(result.statistics().rays(), 300);
}

TEST_F(CallsTest, TheJobKeyNamesWhatDecidesTheBits) {
  LoopbackServer server(Options());
  const auto key = [&](const v1::CreateJobRequest& request) {
    const v1::Job job = Create(server, request);
    AwaitEnd(server, job.name());
    std::string bytes;
    int chunks = 0;
    EXPECT_TRUE(GetResult(server, job.name(), bytes, chunks).ok());
    v1::RenderResult result;
    EXPECT_TRUE(result.ParseFromString(bytes));
    return result.job_key();
  };
  const v1::CreateJobRequest request = NewJob();
  v1::CreateJobRequest other_name = request;
  other_name.mutable_scene()->mutable_scene()->set_name("another");
  other_name.mutable_settings()->set_threads(1);
  v1::CreateJobRequest other_seed = request;
  other_seed.mutable_settings()->set_seed(1);
  v1::CreateJobRequest other_probe = request;
  other_probe.mutable_scene()->mutable_scene()->mutable_probes(0)->set_count(11);
  const std::string first = key(request);
  EXPECT_EQ(key(other_name), first);
  EXPECT_NE(key(other_seed), first);
  EXPECT_NE(key(other_probe), first);
}

TEST_F(CallsTest, AJobThatHasNotEndedHasNoResult) {
  LoopbackServer server(Options());
  renderings_.Hold();
  const v1::Job job = Create(server, NewJob());
  std::string bytes;
  int chunks = 0;
  const grpc::Status status = GetResult(server, job.name(), bytes, chunks);
  EXPECT_EQ(status.error_code(), FAILED_PRECONDITION);
  EXPECT_EQ(ReasonOf(status), "JOB_NOT_ENDED");
}

TEST_F(CallsTest, EveryMistakeOfASceneIsReported) {
  LoopbackServer server(Options());
  v1::CreateJobRequest request = NewJob();
  v1::Scene& scene = *request.mutable_scene()->mutable_scene();
  scene.mutable_plane()->mutable_materials(0)->mutable_lambertian()->set_reflectance(0, 1.5);
  scene.mutable_plane()->mutable_curves(1)->set_material("nothing");
  request.mutable_settings()->set_samples(0);
  v1::Job job;
  const grpc::Status status = Create(server, request, job);
  EXPECT_EQ(status.error_code(), INVALID_ARGUMENT);
  EXPECT_EQ(ReasonOf(status), "BAD_SCENE");
  const auto bad = DetailOf<google::rpc::BadRequest>(status);
  ASSERT_TRUE(bad);
  std::string paths;
  for (const auto& violation : bad->field_violations()) paths += violation.field() + "\n";
  EXPECT_THAT(paths, HasSubstr("plane.materials[0].lambertian.reflectance[0]"));
  EXPECT_THAT(paths, HasSubstr("plane.curves[1].material"));
}

TEST_F(CallsTest, MistakesInSettingsAreReported) {
  LoopbackServer server(Options());
  v1::CreateJobRequest request = NewJob();
  request.mutable_settings()->set_samples(0);
  v1::Job job;
  const grpc::Status status = Create(server, request, job);
  EXPECT_EQ(ReasonOf(status), "BAD_SETTINGS");
  EXPECT_EQ(DetailOf<google::rpc::BadRequest>(status)->field_violations(0).field(), "settings.samples");
}

TEST_F(CallsTest, AThousandMistakesStillFitIntoAnAnswer) {
  LoopbackServer server(Options());
  v1::CreateJobRequest request = NewJob();
  v1::Scene& scene = *request.mutable_scene()->mutable_scene();
  for (int i = 0; i < 1000; ++i) {
    v1::Curve& curve = *scene.mutable_plane()->add_curves();
    curve = scene.plane().curves(0);
    curve.set_name("\xc3\xa9\xc3\xa9\xc3\xa9" + std::to_string(i));
    curve.set_material("nothing");
  }
  v1::Job job;
  const grpc::Status status = Create(server, request, job);
  ASSERT_EQ(status.error_code(), INVALID_ARGUMENT) << status.error_message();
  const auto bad = DetailOf<google::rpc::BadRequest>(status);
  ASSERT_TRUE(bad);
  EXPECT_GT(bad->field_violations_size(), 5);
  const auto info = DetailOf<google::rpc::ErrorInfo>(status);
  EXPECT_EQ(std::stoi(info->metadata().at("more_violations")) + bad->field_violations_size(), 1000);
}

TEST_F(CallsTest, AHugeProbeIsRefusedBeforeItIsBuilt) {
  LoopbackServer server(Options());
  v1::CreateJobRequest request = NewJob();
  request.mutable_scene()->mutable_scene()->mutable_probes(0)->set_count(4'294'967'295u);
  v1::Job job;
  const grpc::Status status = Create(server, request, job);
  EXPECT_EQ(status.error_code(), INVALID_ARGUMENT);
  EXPECT_THAT(status.error_message(), HasSubstr("1000000"));
}

TEST_F(CallsTest, AHugePictureIsRefusedBeforeItIsBuilt) {
  LoopbackServer server(Options());
  v1::CreateJobRequest request = NewJob();
  v1::FluencePicture& picture = *request.mutable_scene()->add_probes()->mutable_fluence();
  picture.set_width(4'294'967'295u);
  picture.set_height(4'294'967'295u);
  v1::Job job;
  const grpc::Status status = Create(server, request, job);
  EXPECT_EQ(status.error_code(), INVALID_ARGUMENT);
  EXPECT_THAT(status.error_message(), HasSubstr("2097152"));
}

// Of a scene by name and of one in the request; the scene itself is as it was.
TEST_F(CallsTest, ARequestMayAskForOtherProbes) {
  LoopbackServer server(Options());
  v1::CreateJobRequest request = NewJob();
  v1::Probe& probe = *request.mutable_scene()->add_probes();
  probe.set_name("light");
  probe.mutable_fluence()->set_width(3);
  probe.mutable_fluence()->set_height(2);
  for (const char* name : {"", "scenes/penumbra"}) {
    if (*name != '\0') request.mutable_scene()->set_name(name);
    TestContext context;
    v1::ExplainJobRequest explain;
    *explain.mutable_scene() = request.scene();
    v1::ExplainJobResponse response;
    const grpc::Status status = server.render().ExplainJob(&context, explain, &response);
    ASSERT_TRUE(status.ok()) << status.error_message();
    EXPECT_THAT(response.plan().summary(), HasSubstr("6 pixels"));
    explain.mutable_scene()->clear_probes();
    TestContext again;
    ASSERT_TRUE(server.render().ExplainJob(&again, explain, &response).ok());
    EXPECT_THAT(response.plan().summary(), Not(HasSubstr("pixel")));
  }
}

TEST_F(CallsTest, TheSameRequestIdMakesOneJob) {
  LoopbackServer server(Options());
  v1::CreateJobRequest request = NewJob();
  request.set_request_id("0f0e0d0c-0b0a-4908-8706-050403020100");
  std::vector<std::string> names(8);
  std::vector<std::thread> callers;
  for (std::string& name : names) {
    callers.emplace_back([&] { name = Create(server, request).name(); });
  }
  for (std::thread& caller : callers) caller.join();
  EXPECT_THAT(names, ::testing::Each(names[0]));
  request.mutable_settings()->set_seed(5);
  v1::Job job;
  const grpc::Status status = Create(server, request, job);
  EXPECT_EQ(status.error_code(), ALREADY_EXISTS);
  EXPECT_EQ(ReasonOf(status), "REQUEST_ID_REUSED");
}

TEST_F(CallsTest, JobsAreListedInPages) {
  LoopbackServer server(Options());
  std::vector<std::string> names;
  for (int i = 0; i < 3; ++i) names.insert(names.begin(), Create(server, NewJob()).name());
  v1::ListJobsRequest request;
  request.set_page_size(2);
  std::vector<std::string> listed;
  do {
    TestContext context;
    v1::ListJobsResponse response;
    ASSERT_TRUE(server.render().ListJobs(&context, request, &response).ok());
    for (const v1::Job& job : response.jobs()) listed.push_back(job.name());
    request.set_page_token(response.next_page_token());
  } while (!request.page_token().empty());
  EXPECT_EQ(listed, names);
  request.set_page_token("rubbish");
  TestContext context;
  v1::ListJobsResponse response;
  EXPECT_EQ(server.render().ListJobs(&context, request, &response).error_code(), INVALID_ARGUMENT);
}

TEST_F(CallsTest, APageOfLargeJobsHasFewerOfThem) {
  LoopbackServer server(Options());
  v1::CreateJobRequest request = NewJob();
  request.mutable_scene()->mutable_scene()->set_name(std::string(1000, 'x'));
  for (const std::string& name : SkipNames()) request.mutable_settings()->add_no_skip(name);
  constexpr int kPage = 1000;
  constexpr std::size_t kMostBytes = 1u << 20;
  std::vector<std::string> created;
  std::size_t bytes = 0;
  for (int i = 0; i < kPage; ++i) {
    const v1::Job job = Create(server, request);
    created.push_back(job.name());
    bytes += job.ByteSizeLong();
  }
  ASSERT_GT(bytes, kMostBytes + kMostBytes / 50) << "one page would hold them all";
  std::vector<std::string> listed;
  v1::ListJobsRequest list;
  list.set_page_size(kPage);
  do {
    TestContext context;
    v1::ListJobsResponse page;
    const grpc::Status status = server.render().ListJobs(&context, list, &page);
    ASSERT_TRUE(status.ok()) << status.error_message();
    EXPECT_LT(page.jobs_size(), kPage);
    EXPECT_LE(page.ByteSizeLong(), kMostBytes + kMostBytes / 50);  // With what frames each job, and the token.
    for (const v1::Job& job : page.jobs()) listed.push_back(job.name());
    list.set_page_token(page.next_page_token());
  } while (!list.page_token().empty());
  EXPECT_THAT(listed, ::testing::ElementsAreArray(created.rbegin(), created.rend()));
}

TEST_F(CallsTest, ASkipNamedOftenIsKeptOnce) {
  LoopbackServer server(Options());
  v1::CreateJobRequest request = NewJob();
  for (int i = 0; i < 1000; ++i) {
    for (const std::string& name : SkipNames()) request.mutable_settings()->add_no_skip(name);
  }
  const v1::Job job = Create(server, request);
  EXPECT_THAT(job.settings().no_skip(), ::testing::ElementsAreArray(SkipNames()));
  EXPECT_THAT(job.plan().settings().no_skip(), ::testing::ElementsAreArray(SkipNames()));
}

TEST_F(CallsTest, BadAndUnknownNamesAreErrors) {
  LoopbackServer server(Options());
  v1::GetJobRequest request;
  v1::Job job;
  for (const char* name : {"", "jobs/", "jobs/1", "scenes/penumbra"}) {
    request.set_name(name);
    TestContext context;
    EXPECT_EQ(server.render().GetJob(&context, request, &job).error_code(), INVALID_ARGUMENT) << name;
  }
  request.set_name("jobs/00000000-0000-4000-8000-000000000000");
  TestContext context;
  const grpc::Status status = server.render().GetJob(&context, request, &job);
  EXPECT_EQ(status.error_code(), NOT_FOUND);
  EXPECT_EQ(ReasonOf(status), "JOB_NOT_FOUND");
}

TEST_F(CallsTest, AnUploadedSceneCanBeReadAndRendered) {
  LoopbackServer server(Options());
  v1::GetSceneRequest get;
  get.set_name("scenes/penumbra");
  v1::GetSceneResponse scene;
  TestContext get_context;
  ASSERT_TRUE(server.scenes().GetScene(&get_context, get, &scene).ok());
  EXPECT_TRUE(scene.info().gallery());

  const std::string file = R"({"name":"lamp","plane":{"materials":[{"name":"m","lambertian":{"reflectance":[0.5]}}],
    "curves":[{"name":"floor","segment":{"a":{"x":-1,"y":0},"b":{"x":1,"y":0}},"material":"m"},
              {"name":"lamp","segment":{"a":{"x":1,"y":1},"b":{"x":-1,"y":1}},"material":"m","emission":{"radiance":[1]}}]},
    "probes":[{"name":"p","curve":"floor","count":4}]})";
  v1::UploadSceneRequest upload;
  upload.set_sha256(Sha256Of(file));
  upload.set_total_bytes(file.size());
  v1::UploadSceneResponse uploaded;
  while (uploaded.received_bytes() < file.size()) {
    upload.set_offset(uploaded.received_bytes());
    upload.set_data(file.substr(uploaded.received_bytes(), 100));
    TestContext context;
    const grpc::Status status = server.scenes().UploadScene(&context, upload, &uploaded);
    ASSERT_TRUE(status.ok()) << status.error_message();
  }
  v1::CreateJobRequest request;
  request.mutable_scene()->set_name(uploaded.name());
  request.mutable_settings()->set_method(v1::Settings::PATH_TRACING);
  EXPECT_EQ(Create(server, request).scene(), "lamp");

  TestContext list_context;
  v1::ListScenesResponse list;
  ASSERT_TRUE(server.scenes().ListScenes(&list_context, {}, &list).ok());
  const v1::SceneInfo& last = list.scenes(list.scenes_size() - 1);
  EXPECT_EQ(last.name(), uploaded.name());
  EXPECT_EQ(last.title(), "lamp");
  EXPECT_FALSE(last.gallery());
}

TEST_F(CallsTest, GalleryScenesStay) {
  LoopbackServer server(Options());
  v1::DeleteSceneRequest request;
  request.set_name("scenes/penumbra");
  TestContext context;
  v1::DeleteSceneResponse response;
  EXPECT_EQ(ReasonOf(server.scenes().DeleteScene(&context, request, &response)), "GALLERY_SCENE");
}

TEST_F(CallsTest, TheMachineIsTold) {
  LoopbackServer server(Options());
  TestContext context;
  v1::GetCapabilitiesResponse capabilities;
  ASSERT_TRUE(server.info().GetCapabilities(&context, {}, &capabilities).ok());
  EXPECT_GE(capabilities.processors(), 1U);
  EXPECT_LE(capabilities.processors(), std::thread::hardware_concurrency());
  EXPECT_GE(capabilities.threads(), 1U);
  EXPECT_EQ(capabilities.processor().find('\n'), std::string::npos);
}

TEST_F(CallsTest, AMessageOverTheLimitIsRefusedWithTheLimit) {
  LoopbackServer server(Options());
  TestContext info_context;
  v1::GetCapabilitiesResponse capabilities;
  ASSERT_TRUE(server.info().GetCapabilities(&info_context, {}, &capabilities).ok());
  v1::CreateJobRequest request = NewJob();
  request.mutable_scene()->mutable_scene()->set_name(std::string(capabilities.limits().max_message_bytes(), 'x'));
  v1::Job job;
  const grpc::Status status = Create(server, request, job);
  EXPECT_EQ(status.error_code(), RESOURCE_EXHAUSTED);
  EXPECT_THAT(status.error_message(), HasSubstr(std::to_string(capabilities.limits().max_message_bytes())));
}

// A unary call of any method, in bytes.
grpc::Status CallRaw(grpc::Channel& channel, const char* method, const std::string& request, std::string& response) {
  TestContext context;
  const grpc::Slice slice(request);
  const grpc::ByteBuffer bytes(&slice, 1);
  grpc::ByteBuffer answer;
  const grpc::internal::RpcMethod rpc(method, grpc::internal::RpcMethod::NORMAL_RPC);
  const grpc::Status status =
      grpc::internal::BlockingUnaryCall<grpc::ByteBuffer, grpc::ByteBuffer, grpc::ByteBuffer, grpc::ByteBuffer>(
          &channel, rpc, &context, bytes, &answer);
  grpc::Slice whole;
  if (status.ok() && answer.DumpToSingleSlice(&whole).ok()) {
    response.assign(reinterpret_cast<const char*>(whole.begin()), whole.size());
  }
  return status;
}

TEST_F(CallsTest, HealthOfTheServerAndOfEachService) {
  LoopbackServer server(Options());
  const auto channel = server.NewChannel();
  for (const std::string service : {"", "flatlight.v1.RenderService", "flatlight.v1.SceneService"}) {
    // HealthCheckRequest {service = 1}, HealthCheckResponse {status = 1: SERVING = 1}.
    const std::string request = "\x0a" + std::string(1, static_cast<char>(service.size())) + service;
    std::string response;
    EXPECT_TRUE(CallRaw(*channel, "/grpc.health.v1.Health/Check", request, response).ok()) << service;
    EXPECT_EQ(response, "\x08\x01") << service;
  }
}

TEST_F(CallsTest, RubbishIsNotAMessage) {
  LoopbackServer server(Options());
  const auto channel = server.NewChannel();
  for (const char* method : {"/flatlight.v1.RenderService/CreateJob", "/flatlight.v1.RenderService/WatchJob",
                             "/flatlight.v1.RenderService/GetResult", "/flatlight.v1.SceneService/UploadScene"}) {
    std::string answer;
    const grpc::Status status = CallRaw(*channel, method, "\xff\xff\xff\xffrubbish", answer);
    EXPECT_EQ(status.error_code(), INVALID_ARGUMENT) << method << ": " << status.error_message();
    EXPECT_EQ(ReasonOf(status), "NOT_A_MESSAGE") << method;
  }
}

TEST_F(CallsTest, WithATokenOnlyItsHoldersPass) {
  ServerOptions options = Options();
  options.token = "open sesame";
  LoopbackServer server(options);
  const auto call = [&](const std::string& authorization) {
    TestContext context;
    if (!authorization.empty()) context.AddMetadata("authorization", authorization);
    v1::GetCapabilitiesResponse response;
    return server.info().GetCapabilities(&context, {}, &response);
  };
  EXPECT_TRUE(call("Bearer open sesame").ok());
  for (const char* wrong : {"", "Bearer open sesam", "Bearer open sesame!", "open sesame", "Bearer "}) {
    EXPECT_EQ(call(wrong).error_code(), UNAUTHENTICATED) << wrong;
    EXPECT_EQ(ReasonOf(call(wrong)), "BAD_TOKEN") << wrong;
  }
  v1::WatchJobRequest watch;
  TestContext watch_context;
  EXPECT_EQ(server.render().WatchJob(&watch_context, watch)->Finish().error_code(), UNAUTHENTICATED);
  v1::GetResultRequest result;
  TestContext result_context;
  EXPECT_EQ(server.render().GetResult(&result_context, result)->Finish().error_code(), UNAUTHENTICATED);
}

TEST(ServerTest, ListensOnlyWhereNoOtherMachineReachesIt) {
  for (const char* address :
       {"0.0.0.0:0", "[::]:0", "192.168.0.1:0", "example.org:0", "127.0.0.1", "127.0.0.1:x", "unix:"}) {
    ServerOptions options;
    options.address = address;
    EXPECT_TRUE(absl::IsInvalidArgument(Server::Start(options).status())) << address;
  }
}

TEST(ServerTest, ATakenAddressIsAnError) {
  ServerOptions options;
  LoopbackServer first;
  options.address = first.server().address();
  const auto second = Server::Start(options);
  EXPECT_TRUE(absl::IsUnavailable(second.status())) << second.status();
  EXPECT_THAT(std::string(second.status().message()), HasSubstr("in use"));
}

TEST(ServerTest, AnAddressThatCannotBeSaysWhy) {
  ServerOptions options;
  options.address = "unix:/nonexistent/socket";
  const auto server = Server::Start(options);
  EXPECT_TRUE(absl::IsUnavailable(server.status())) << server.status();
  EXPECT_THAT(std::string(server.status().message()), HasSubstr("No such file or directory"));
}

}  // namespace
}  // namespace flatlight
