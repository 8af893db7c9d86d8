// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_SERVICE_MESSAGE_BYTES_H_
#define FLATLIGHT_SERVER_SERVICE_MESSAGE_BYTES_H_

#include <google/protobuf/message_lite.h>

#include "absl/status/status.h"
#include "grpcpp/support/byte_buffer.h"

namespace flatlight {

// A copy of the result shares its bytes.
grpc::ByteBuffer ToBytes(const google::protobuf::MessageLite& message);

// INVALID_ARGUMENT if the bytes are no such message.
absl::Status FromBytes(const grpc::ByteBuffer& bytes, google::protobuf::MessageLite& message);

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_SERVICE_MESSAGE_BYTES_H_
