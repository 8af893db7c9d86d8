// SPDX-License-Identifier: Apache-2.0
// A channel to a server, with what every call needs: the token, a deadline, the user's Ctrl-C.
#ifndef FLATLIGHT_CLIENT_CLI_CONNECTION_CONNECTION_H_
#define FLATLIGHT_CLIENT_CLI_CONNECTION_CONNECTION_H_

#include <chrono>
#include <functional>
#include <memory>
#include <random>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "client/cli/connection/interruption.h"
#include "client/cli/connection/retry.h"
#include "client/cli/connection/server_address.h"
#include "client/cli/tls/tls.h"
#include "flatlight/v1/render_service.grpc.pb.h"
#include "flatlight/v1/review_service.grpc.pb.h"
#include "flatlight/v1/scene_service.grpc.pb.h"
#include "flatlight/v1/server_service.grpc.pb.h"

namespace flatlight {

class Connection {
 public:
  // How long Open waits for a server that does not answer (yet).
  static constexpr std::chrono::seconds kPatience{5};

  // Reads the server's capabilities, so an open connection is one that works. An empty token is not sent.
  // UNAVAILABLE after kPatience, with the reason. Where the server is too busy, or does not answer, unary calls are
  // made again if that is safe (see Retry), and `tell` gets one line for each such call; empty: they are made once.
  using Tell = std::function<void(const std::string&)>;
  static absl::StatusOr<std::unique_ptr<Connection>> Open(const ServerAddress& address, const Tls& tls,
                                                          const std::string& token, Interruption& interruption,
                                                          Tell tell = nullptr);

  v1::RenderService::Stub& render() { return *render_; }
  v1::SceneService::Stub& scenes() { return *scenes_; }
  v1::ServerService::Stub& server() { return *server_; }
  v1::ReviewService::Stub& review() { return *review_; }
  const v1::GetCapabilitiesResponse& capabilities() const { return capabilities_; }
  const std::string& address() const { return address_.text; }
  Interruption& interruption() { return interruption_; }

  // A context with the token, for streams; see MessageStream.
  std::unique_ptr<grpc::ClientContext> NewContext() const;

  enum class OnSignal { kCancel, kGoOn };

  // One unary call: Call(connection.render(), &v1::RenderService::Stub::GetJob, request, response). Errors name the
  // server if it could not be reached; INTERRUPTED after a signal.
  template <class Stub, class Request, class Response>
  absl::Status Call(Stub& stub, grpc::Status (Stub::*method)(grpc::ClientContext*, const Request&, Response*),
                    const Request& request, Response& response, OnSignal on_signal = OnSignal::kCancel) {
    return Call([&](grpc::ClientContext* context) { return (stub.*method)(context, request, &response); }, on_signal,
                IsRepeatable(request));
  }

  // The same, for who wants the response or the error.
  template <class Stub, class Request, class Response>
  absl::StatusOr<Response> Ask(Stub& stub,
                               grpc::Status (Stub::*method)(grpc::ClientContext*, const Request&, Response*),
                               const Request& request, OnSignal on_signal = OnSignal::kCancel) {
    Response response;
    absl::Status status = Call(stub, method, request, response, on_signal);
    if (!status.ok()) return status;
    return response;
  }

  // What the user is told about a call that ended so.
  absl::Status Explain(const grpc::Status& status) const;

 private:
  Connection(ServerAddress address, Tls tls, std::string token, Interruption& interruption, Tell tell);
  absl::Status Call(const std::function<grpc::Status(grpc::ClientContext*)>& call, OnSignal on_signal, bool repeatable);
  absl::Status ReadCapabilities();

  ServerAddress address_;
  Tls tls_;
  std::string token_;
  Interruption& interruption_;
  Tell tell_;
  std::minstd_rand random_{std::random_device()()};
  std::unique_ptr<v1::RenderService::Stub> render_;
  std::unique_ptr<v1::SceneService::Stub> scenes_;
  std::unique_ptr<v1::ServerService::Stub> server_;
  std::unique_ptr<v1::ReviewService::Stub> review_;
  v1::GetCapabilitiesResponse capabilities_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_CLIENT_CLI_CONNECTION_CONNECTION_H_
