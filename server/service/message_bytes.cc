// SPDX-License-Identifier: Apache-2.0
#include "server/service/message_bytes.h"

#include <grpc/slice.h>

#include <algorithm>
#include <cstdint>

#include "grpcpp/support/proto_buffer_reader.h"
#include "server/store/error.h"

namespace flatlight {

namespace {

// Into gRPC's own memory: with every call.
grpc::Slice Serialise(std::string_view part, const google::protobuf::MessageLite& message) {
  grpc_slice bytes = grpc_slice_malloc(part.size() + message.ByteSizeLong());
  std::uint8_t* const start = GRPC_SLICE_START_PTR(bytes);
  message.SerializeWithCachedSizesToArray(std::copy(part.begin(), part.end(), start));
  return {bytes, grpc::Slice::STEAL_REF};
}

}  // namespace

grpc::Slice ToSlice(const google::protobuf::MessageLite& message) { return Serialise("", message); }

grpc::ByteBuffer ToBytes(const google::protobuf::MessageLite& message) { return ToBytes("", message); }

grpc::ByteBuffer ToBytes(std::string_view part, const google::protobuf::MessageLite& message) {
  const grpc::Slice slice = Serialise(part, message);
  return {&slice, 1};
}

absl::Status FromBytes(const grpc::ByteBuffer& bytes, google::protobuf::MessageLite& message) {
  // Nearly all are empty or in one piece: without a reader.
  if (bytes.Length() == 0) {
    if (message.ParseFromArray(nullptr, 0)) return absl::OkStatus();
  } else if (grpc::Slice slice; bytes.TrySingleSlice(&slice).ok()) {
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
