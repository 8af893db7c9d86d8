// SPDX-License-Identifier: Apache-2.0
#include "server/service/connection_limits.h"

#include "grpcpp/resource_quota.h"

namespace flatlight {
namespace {

constexpr int kMaxMetadataBytes = 16 << 10;
constexpr int kMaxStreams = 1000;  // Of one connection.
// Of answers to a ping, in times between pings: gRPC's clients give none while nothing is read from a stream, and a
// reader that rests is not one that has gone.
constexpr int kPatience = 5;

}  // namespace

void SetConnectionLimits(grpc::ServerBuilder& builder, const Limits& limits, std::chrono::milliseconds keepalive,
                         std::size_t memory_bytes) {
  builder.SetMaxReceiveMessageSize(static_cast<int>(limits.max_message_bytes));
  builder.SetResourceQuota(grpc::ResourceQuota("flatlightd").Resize(memory_bytes));
  builder.AddChannelArgument(GRPC_ARG_MAX_METADATA_SIZE, kMaxMetadataBytes);
  builder.AddChannelArgument(GRPC_ARG_MAX_CONCURRENT_STREAMS, kMaxStreams);
  builder.AddChannelArgument(GRPC_ARG_KEEPALIVE_TIME_MS, static_cast<int>(keepalive.count()));
  builder.AddChannelArgument(GRPC_ARG_KEEPALIVE_TIMEOUT_MS, static_cast<int>(kPatience * keepalive.count()));
  // A client without a call under way may not look at its connection for as long as it likes.
  builder.AddChannelArgument(GRPC_ARG_KEEPALIVE_PERMIT_WITHOUT_CALLS, 0);
  builder.AddChannelArgument(GRPC_ARG_HTTP2_MAX_PINGS_WITHOUT_DATA, 0);  // As many as are due.
  // So may clients with a call under way, every 10 s.
  builder.AddChannelArgument(GRPC_ARG_HTTP2_MIN_RECV_PING_INTERVAL_WITHOUT_DATA_MS, 10'000);
}

}  // namespace flatlight
