// SPDX-License-Identifier: Apache-2.0
// Real connections over loopback, with certificates made here.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <string>

#include "grpcpp/create_channel.h"
#include "server/store/error.h"
#include "server/store/storage.h"
#include "server/store/user_store.h"
#include "tests/support/loopback/loopback_server.h"
#include "tests/support/status/status_matchers.h"
#include "tests/support/status/temporary_folder.h"
#include "tests/support/tls/certificate_authority.h"

namespace flatlight {
namespace {

using absl::StatusCode;
using ::testing::AllOf;
using testing::CertificateAuthority;
using ::testing::HasSubstr;
using testing::IsOk;
using testing::StatusIs;
using testing::TestContext;
using Issued = CertificateAuthority::Issued;

class TlsTest : public ::testing::Test {
 protected:
  std::string Write(const std::string& name, const std::string& text) {
    // As a careful program replaces a file.
    std::ofstream(folder_.path() + "/new") << text;
    std::filesystem::rename(folder_.path() + "/new", folder_.path() + "/" + name);
    return folder_.path() + "/" + name;
  }
  void Install(const Issued& identity) {
    options_.tls.certificate = Write("server.pem", identity.certificate);
    options_.tls.key = Write("server.key", identity.key);
  }
  void AskForCertificates() { options_.tls.client_ca = Write("class.pem", class_ca_.certificate()); }
  void Start() {
    auto server = Server::Start(options_);
    ASSERT_THAT(server, IsOk());
    server_ = *std::move(server);
  }
  absl::Status WhyNot() { return Server::Start(options_).status(); }

  // A connection of its own.
  std::unique_ptr<v1::RenderService::Stub> Connect(const std::shared_ptr<grpc::ChannelCredentials>& credentials) {
    grpc::ChannelArguments arguments;
    arguments.SetInt(GRPC_ARG_USE_LOCAL_SUBCHANNEL_POOL, 1);
    return v1::RenderService::NewStub(grpc::CreateCustomChannel(server_->address(), credentials, arguments));
  }
  std::unique_ptr<v1::RenderService::Stub> Connect(const CertificateAuthority& trusted, const Issued& own = {}) {
    return Connect(grpc::SslCredentials({trusted.certificate(), own.key, own.certificate}));
  }
  static grpc::Status List(v1::RenderService::Stub& stub) {
    TestContext context;
    v1::ListJobsResponse response;
    return stub.ListJobs(&context, v1::ListJobsRequest(), &response);
  }
  grpc::Status List(const CertificateAuthority& trusted, const Issued& own = {}) {
    return List(*Connect(trusted, own));
  }

  testing::TemporaryFolder folder_;
  const CertificateAuthority ca_{"an authority"};
  const CertificateAuthority other_ca_{"another authority"};
  const CertificateAuthority class_ca_{"the class"};
  ServerOptions options_;
  std::unique_ptr<Server> server_;
};

TEST_F(TlsTest, OnlyWhoSpeaksTlsAndTrustsTheServerGetsThrough) {
  Install(ca_.Issue("server"));
  Start();
  EXPECT_TRUE(List(ca_).ok());
  EXPECT_EQ(List(*Connect(grpc::InsecureChannelCredentials())).error_code(), grpc::StatusCode::UNAVAILABLE);
  EXPECT_THAT(List(other_ca_).error_message(), HasSubstr("certificate verify failed"));
}

TEST_F(TlsTest, CallersShowACertificateIfAsked) {
  Install(ca_.Issue("server"));
  AskForCertificates();
  Start();
  EXPECT_TRUE(List(ca_, class_ca_.Issue("ada")).ok());
  EXPECT_EQ(List(ca_).error_code(), grpc::StatusCode::UNAVAILABLE);
  EXPECT_EQ(List(ca_, ca_.Issue("ada")).error_code(), grpc::StatusCode::UNAVAILABLE) << "of the wrong authority";
  const Issued expired = class_ca_.Issue("ada", std::chrono::hours(-2), std::chrono::hours(-1));
  EXPECT_EQ(List(ca_, expired).error_code(), grpc::StatusCode::UNAVAILABLE);
}

TEST_F(TlsTest, ACertificateDoesNotStandForAToken) {
  Install(ca_.Issue("server"));
  AskForCertificates();
  options_.token = "secret";
  Start();
  const auto stub = Connect(ca_, class_ca_.Issue("ada"));
  EXPECT_EQ(testing::ReasonOf(List(*stub)), "BAD_TOKEN");
  TestContext context;
  context.AddMetadata("authorization", "Bearer secret");
  v1::ListJobsResponse response;
  EXPECT_TRUE(stub->ListJobs(&context, v1::ListJobsRequest(), &response).ok());
}

TEST_F(TlsTest, ReplacedFilesAreForNewConnections) {
  Install(ca_.Issue("server"));
  Start();
  const auto before = Connect(ca_);
  v1::CreateJobRequest request;
  *request.mutable_scene()->mutable_scene() = testing::FloorAndLampProto({4});
  request.mutable_settings()->set_method(v1::Settings::PATH_TRACING);
  request.mutable_settings()->set_time_limit(1000);
  TestContext create_context;
  v1::Job job;
  ASSERT_TRUE(before->CreateJob(&create_context, request, &job).ok());
  TestContext watch_context;
  v1::WatchJobRequest watch_request;
  watch_request.set_name(job.name());
  const auto watch = before->WatchJob(&watch_context, watch_request);
  v1::WatchJobResponse message;
  ASSERT_TRUE(watch->Read(&message));

  // While only one of the two is new, the old ones serve.
  const Issued renewed = other_ca_.Issue("server");
  Write("server.pem", renewed.certificate);
  EXPECT_TRUE(List(ca_).ok());
  Write("server.pem", "nothing");
  EXPECT_TRUE(List(ca_).ok());
  std::filesystem::remove(options_.tls.certificate);
  EXPECT_TRUE(List(ca_).ok());
  Install(renewed);
  EXPECT_TRUE(List(other_ca_).ok());
  EXPECT_FALSE(List(ca_).ok());
  // One that has expired is not taken either.
  Install(ca_.Issue("server", std::chrono::hours(-2), std::chrono::hours(-1)));
  EXPECT_TRUE(List(other_ca_).ok());

  EXPECT_TRUE(watch->Read(&message)) << "the stream goes on";
  EXPECT_TRUE(List(*before).ok());
  watch_context.TryCancel();
  watch->Finish();
}

TEST_F(TlsTest, AReplacedClientCaIsTaken) {
  Install(ca_.Issue("server"));
  AskForCertificates();
  Start();
  const CertificateAuthority next_term{"next term"};
  EXPECT_TRUE(List(ca_, class_ca_.Issue("ada")).ok());
  Write("class.pem", next_term.certificate());
  EXPECT_FALSE(List(ca_, class_ca_.Issue("ada")).ok());
  EXPECT_TRUE(List(ca_, next_term.Issue("ada")).ok());
}

TEST_F(TlsTest, FilesThatCannotServeAreRefusedAtTheStart) {
  const Issued good = ca_.Issue("server");
  const auto refused = [&](const std::string& what) {
    EXPECT_THAT(WhyNot(), StatusIs(StatusCode::kInvalidArgument, HasSubstr(what)));
    EXPECT_EQ(ReasonOf(WhyNot()), "BAD_CERTIFICATE");
  };
  Install({good.certificate, ca_.Issue("server").key});
  refused(options_.tls.key + " is not that of the certificate " + options_.tls.certificate);
  Install({"nothing", good.key});
  refused(options_.tls.certificate + " holds no certificate");
  Install({good.certificate, good.certificate});
  refused(options_.tls.key + " holds no private key");
  Install(ca_.Issue("server", std::chrono::hours(-2), std::chrono::hours(-1)));
  refused(options_.tls.certificate + " expired on ");
  Install(ca_.Issue("server", std::chrono::hours(1), std::chrono::hours(2)));
  refused(options_.tls.certificate + " is valid from ");
  Install(good);
  options_.tls.client_ca = Write("class.pem", good.key);
  refused(options_.tls.client_ca + " holds no certificate");
  options_.tls.client_ca = folder_.path() + "/none.pem";
  refused("none.pem: No such file or directory");
  options_.tls = {options_.tls.certificate, folder_.path(), ""};
  refused(folder_.path() + ": Is a directory");
}

TEST_F(TlsTest, StrangersAreNotLetIn) {
  options_.address = "0.0.0.0:0";
  EXPECT_THAT(WhyNot(), StatusIs(StatusCode::kInvalidArgument, HasSubstr("without TLS")));
  options_.token = "secret";
  EXPECT_THAT(WhyNot(), StatusIs(StatusCode::kInvalidArgument, HasSubstr("without TLS")));
  options_.token = "";
  Install(ca_.Issue("server"));
  AskForCertificates();
  options_.data = folder_.path() + "/data";
  for (const char* address : {"0.0.0.0:0", "[::]:0", "192.0.2.1:0"}) {
    options_.address = address;
    EXPECT_THAT(WhyNot(), StatusIs(StatusCode::kInvalidArgument, AllOf(HasSubstr(address), HasSubstr("user add"))));
  }
  {
    const auto database = Database::Open(Storage::DatabasePath(options_.data));
    ASSERT_TRUE(UserStore(**database).Add({{"ada", Role::kAdmin, {}}}).ok());
  }
  options_.address = "0.0.0.0:0";
  Start();
  const auto own = class_ca_.Issue("eve");
  const auto known = v1::RenderService::NewStub(
      grpc::CreateChannel("127.0.0.1" + server_->address().substr(server_->address().rfind(':')),
                          grpc::SslCredentials({ca_.certificate(), own.key, own.certificate})));
  EXPECT_EQ(testing::ReasonOf(List(*known)), "BAD_TOKEN");
}

TEST_F(TlsTest, AddressesAreNumbers) {
  Install(ca_.Issue("server"));
  options_.token = "secret";
  for (const char* address : {"example.org:7000", "::1:7000", "[localhost]:7000", "256.0.0.1:7000", ":7000"}) {
    options_.address = address;
    EXPECT_THAT(WhyNot(), StatusIs(StatusCode::kInvalidArgument, HasSubstr("is not an address of this machine")));
  }
  options_.address = "192.0.2.1:7000";  // Of no machine (RFC 5737).
  EXPECT_THAT(WhyNot(), StatusIs(StatusCode::kUnavailable, HasSubstr("cannot listen on 192.0.2.1:7000: ")));
}

}  // namespace
}  // namespace flatlight
