// SPDX-License-Identifier: Apache-2.0
#include "client/cli/connection/connection.h"

#include <utility>

#include "client/cli/connection/channel.h"
#include "client/cli/status/exit_code.h"
#include "client/cli/status/rpc_error.h"
#include "client/cli/text/numbers.h"

namespace flatlight {
namespace {

constexpr std::chrono::seconds kDeadline{60};  // Of a unary call; each answers at once or after a short wait.

}  // namespace

Connection::Connection(ServerAddress address, Tls tls, std::string token, Interruption& interruption, Tell tell)
    : address_(std::move(address)),
      tls_(std::move(tls)),
      token_(std::move(token)),
      interruption_(interruption),
      tell_(std::move(tell)) {
  const std::shared_ptr<grpc::Channel> channel = NewChannel(address_, tls_);
  render_ = v1::RenderService::NewStub(channel);
  scenes_ = v1::SceneService::NewStub(channel);
  server_ = v1::ServerService::NewStub(channel);
  review_ = v1::ReviewService::NewStub(channel);
}

absl::StatusOr<std::unique_ptr<Connection>> Connection::Open(const ServerAddress& address, const Tls& tls,
                                                             const std::string& token, Interruption& interruption,
                                                             Tell tell) {
  std::unique_ptr<Connection> connection(new Connection(address, tls, token, interruption, std::move(tell)));
  if (absl::Status status = connection->ReadCapabilities(); !status.ok()) return status;
  return connection;
}

std::unique_ptr<grpc::ClientContext> Connection::NewContext() const {
  auto context = std::make_unique<grpc::ClientContext>();
  if (!token_.empty()) context->AddMetadata("authorization", "Bearer " + token_);
  return context;
}

absl::Status Connection::Explain(const grpc::Status& status) const {
  if (status.error_code() == grpc::StatusCode::CANCELLED && interruption_.Requested())
    return InterruptedError("interrupted");
  if (status.error_code() == grpc::StatusCode::UNAVAILABLE) return CannotReach(address_, tls_, status.error_message());
  if (status.error_code() == grpc::StatusCode::DEADLINE_EXCEEDED)
    return absl::UnavailableError("the server at " + address_.text + " did not answer in time");
  return ErrorFromRpc(status);
}

absl::Status Connection::Call(const std::function<grpc::Status(grpc::ClientContext*)>& call, OnSignal on_signal,
                              bool repeatable) {
  Retry retry(repeatable);
  for (bool told = false;; told = true) {
    const std::unique_ptr<grpc::ClientContext> context = NewContext();
    context->set_deadline(std::chrono::system_clock::now() + kDeadline);
    if (on_signal == OnSignal::kCancel) interruption_.Guard(context.get());
    const grpc::Status status = call(context.get());
    if (on_signal == OnSignal::kCancel) interruption_.Guard(nullptr);
    if (status.ok() || tell_ == nullptr || interruption_.Requested()) return Explain(status);
    const auto wait = retry.Next(status, std::uniform_real_distribution<double>(0, 1)(random_));
    if (!wait) return Explain(status);
    if (!told) {
      tell_(retry.why() + "; trying again in " + FormatSeconds(std::chrono::duration<double>(*wait).count()) +
            ", up to " + std::to_string(retry.tries_left()) + " times");
    }
    if (!interruption_.Sleep(*wait)) return InterruptedError("interrupted");
  }
}

absl::Status Connection::ReadCapabilities() {
  const auto read = [this](grpc::ClientContext* context) {
    return server_->GetCapabilities(context, v1::GetCapabilitiesRequest(), &capabilities_);
  };
  // It waits here, and not between calls, for a server that does not answer.
  const auto call = [this](const std::function<grpc::Status(grpc::ClientContext*)>& one) {
    return Call(one, OnSignal::kCancel, false);
  };
  const auto read_soon = [&read](grpc::ClientContext* context) {
    context->set_deadline(std::chrono::system_clock::now() + std::chrono::seconds(1));
    return read(context);
  };
  if (tls_.on) {
    // A certificate that is wrong is not mended by waiting.
    absl::Status tried = call(read_soon);
    const bool may_pass = tried.code() == absl::StatusCode::kUnavailable && TlsHint(tls_, tried.ToString()).empty();
    if (!may_pass) return tried;
  }
  absl::Status status = call([&read](grpc::ClientContext* context) {
    context->set_wait_for_ready(true);
    context->set_deadline(std::chrono::system_clock::now() + kPatience);
    const grpc::Status waited = read(context);
    return waited.error_code() == grpc::StatusCode::DEADLINE_EXCEEDED
               ? grpc::Status(grpc::StatusCode::UNAVAILABLE,
                              "no answer within " + std::to_string(kPatience.count()) + " s")
               : waited;
  });
  if (status.code() != absl::StatusCode::kUnavailable) return status;
  // A call that does not wait knows why there is no connection.
  const absl::Status reason = call(read_soon);
  return reason.code() == absl::StatusCode::kUnavailable ? reason : status;
}

}  // namespace flatlight
