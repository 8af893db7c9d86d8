// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_SERVICE_REFUSED_STREAM_H_
#define FLATLIGHT_SERVER_SERVICE_REFUSED_STREAM_H_

#include "absl/status/status.h"
#include "grpcpp/support/server_callback.h"
#include "server/service/status_convert.h"

namespace flatlight {

// A stream that ends before it begins. Deletes itself.
class RefusedStream final : public grpc::ServerWriteReactor<grpc::ByteBuffer> {
 public:
  explicit RefusedStream(const absl::Status& why) { Finish(ToGrpcStatus(why)); }
  void OnDone() override { delete this; }
};

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_SERVICE_REFUSED_STREAM_H_
