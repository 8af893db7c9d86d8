// SPDX-License-Identifier: Apache-2.0
#include "client/cli/connection/channel.h"

#include <grpcpp/create_channel.h>
#include <grpcpp/security/credentials.h>

namespace flatlight {

std::shared_ptr<grpc::Channel> NewChannel(const ServerAddress& address, const Tls& tls) {
  grpc::ChannelArguments arguments;
  arguments.SetMaxReceiveMessageSize(-1);  // The server bounds what it sends.
  arguments.SetUserAgentPrefix("flatlight");
  // The defaults wait a second before the second try, long for a server that is just starting.
  arguments.SetInt(GRPC_ARG_INITIAL_RECONNECT_BACKOFF_MS, 20);
  arguments.SetInt(GRPC_ARG_MIN_RECONNECT_BACKOFF_MS, 1000);
  arguments.SetInt(GRPC_ARG_MAX_RECONNECT_BACKOFF_MS, 1000);
  // TCP never misses a peer that vanished without a word, and so a new call would be sent down the old connection. The
  // server allows a ping every 10 s; it sends a heartbeat as often, so a watch that goes well needs none.
  arguments.SetInt(GRPC_ARG_KEEPALIVE_TIME_MS, 15'000);
  arguments.SetInt(GRPC_ARG_KEEPALIVE_TIMEOUT_MS, 5'000);
  arguments.SetInt(GRPC_ARG_HTTP2_MAX_PINGS_WITHOUT_DATA, 0);  // As many as it takes: a watcher only reads.
  if (address.local) arguments.SetInt(GRPC_ARG_ENABLE_HTTP_PROXY, 0);
  if (!tls.on) return grpc::CreateCustomChannel(address.target, grpc::InsecureChannelCredentials(), arguments);
  if (!tls.arguments.name.empty()) arguments.SetSslTargetNameOverride(tls.arguments.name);
  return grpc::CreateCustomChannel(address.target, grpc::SslCredentials({tls.ca, tls.key, tls.cert}), arguments);
}

absl::Status CannotReach(const ServerAddress& address, const Tls& tls, const std::string& message) {
  return absl::UnavailableError("cannot reach the server at " + address.text + ": " + message + TlsHint(tls, message));
}

}  // namespace flatlight
