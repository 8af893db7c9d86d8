// SPDX-License-Identifier: Apache-2.0
#include "server/service/message_bytes.h"

#include <grpc/slice.h>

#include "grpcpp/support/proto_buffer_reader.h"
#include "grpcpp/support/slice.h"
#include "server/store/error.h"

namespace flatlight {

grpc::ByteBuffer ToBytes(const google::protobuf::MessageLite& message) {
  // Into gRPC's own memory: with every call.
  const std::size_t size = message.ByteSizeLong();
  grpc_slice bytes = grpc_slice_malloc(size);
  message.SerializeWithCachedSizesToArray(GRPC_SLICE_START_PTR(bytes));
  const grpc::Slice slice(bytes, grpc::Slice::STEAL_REF);
  return {&slice, 1};
}

absl::Status FromBytes(const grpc::ByteBuffer& bytes, google::protobuf::MessageLite& message) {
  if (grpc::Slice slice; bytes.TrySingleSlice(&slice).ok()) {  // As nearly all are: without a reader.
    if (message.ParseFromArray(slice.begin(), static_cast<int>(slice.size()))) return absl::OkStatus();
  } else {
    grpc::ByteBuffer copy = bytes;  // Shares the bytes; the reader wants it mutable.
    grpc::ProtoBufferReader reader(&copy);
    if (reader.status().ok() && message.ParseFromZeroCopyStream(&reader)) return absl::OkStatus();
  }
  return MakeError(absl::StatusCode::kInvalidArgument, "NOT_A_MESSAGE",
                   "the request is not a serialised " + message.GetTypeName());
}

}  // namespace flatlight
