// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_SERVICE_MESSAGE_BYTES_H_
#define FLATLIGHT_SERVER_SERVICE_MESSAGE_BYTES_H_

#include <google/protobuf/message_lite.h>

#include <string_view>

#include "absl/status/status.h"
#include "grpcpp/support/byte_buffer.h"
#include "grpcpp/support/slice.h"

namespace flatlight {

// A copy of a result shares its bytes.
grpc::Slice ToSlice(const google::protobuf::MessageLite& message);
grpc::ByteBuffer ToBytes(const google::protobuf::MessageLite& message);
// Of what the serialised message `part` and `message` say together: what both have, `message` has, and repeated fields
// are those of `part`, then those of `message`.
grpc::ByteBuffer ToBytes(std::string_view part, const google::protobuf::MessageLite& message);

// INVALID_ARGUMENT if the bytes are no such message.
absl::Status FromBytes(const grpc::ByteBuffer& bytes, google::protobuf::MessageLite& message);

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_SERVICE_MESSAGE_BYTES_H_
