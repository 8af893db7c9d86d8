// SPDX-License-Identifier: Apache-2.0
#include "server/service/message_bytes.h"

#include <string>

#include "grpcpp/support/proto_buffer_reader.h"
#include "grpcpp/support/slice.h"
#include "server/store/error.h"

namespace flatlight {

grpc::ByteBuffer ToBytes(const google::protobuf::MessageLite& message) {
  auto* text = new std::string(message.SerializeAsString());
  const grpc::Slice slice(
      text->data(), text->size(), [](void* owner) { delete static_cast<std::string*>(owner); }, text);
  return {&slice, 1};
}

absl::Status FromBytes(const grpc::ByteBuffer& bytes, google::protobuf::MessageLite& message) {
  grpc::ByteBuffer copy = bytes;  // Shares the bytes; the reader wants it mutable.
  grpc::ProtoBufferReader reader(&copy);
  if (reader.status().ok() && message.ParseFromZeroCopyStream(&reader)) return absl::OkStatus();
  return MakeError(absl::StatusCode::kInvalidArgument, "NOT_A_MESSAGE",
                   "the request is not a serialised " + message.GetTypeName());
}

}  // namespace flatlight
