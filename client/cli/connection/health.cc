// SPDX-License-Identifier: Apache-2.0
#include "client/cli/connection/health.h"

#include <grpcpp/client_context.h>

#include <chrono>
#include <string>

#include "client/cli/connection/channel.h"
#include "client/cli/status/exit_code.h"
#include "grpc/health/v1/health.grpc.pb.h"

namespace flatlight {
namespace {

namespace health = grpc::health::v1;

// Less than the 5 s that the image's health check may take.
constexpr std::chrono::seconds kPatience{3};

}  // namespace

absl::Status CheckHealth(const ServerAddress& address, const Tls& tls, Interruption& interruption) {
  grpc::ClientContext context;
  context.set_deadline(std::chrono::system_clock::now() + kPatience);
  health::HealthCheckResponse response;
  interruption.Guard(&context);
  const grpc::Status status =
      health::Health::NewStub(NewChannel(address, tls))->Check(&context, health::HealthCheckRequest(), &response);
  interruption.Guard(nullptr);
  if (!status.ok() && interruption.Requested()) return InterruptedError("interrupted");
  const std::string server = "the server at " + address.text;
  if (status.error_code() == grpc::StatusCode::DEADLINE_EXCEEDED)
    return absl::UnavailableError(server + " did not answer within " + std::to_string(kPatience.count()) + " s");
  if (!status.ok()) return CannotReach(address, tls, status.error_message());
  if (response.status() == health::HealthCheckResponse::SERVING) return absl::OkStatus();
  return absl::UnavailableError(server + " says that it is " +
                                health::HealthCheckResponse::ServingStatus_Name(response.status()));
}

}  // namespace flatlight
