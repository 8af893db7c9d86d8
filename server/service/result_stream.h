// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_SERVICE_RESULT_STREAM_H_
#define FLATLIGHT_SERVER_SERVICE_RESULT_STREAM_H_

#include <memory>
#include <string>
#include <utility>

#include "grpcpp/support/byte_buffer.h"
#include "grpcpp/support/server_callback.h"
#include "server/service/calls_under_way.h"

namespace flatlight {

// Streams bytes as GetResultResponse messages. Deletes itself.
class ResultStream final : public grpc::ServerWriteReactor<grpc::ByteBuffer> {
 public:
  static constexpr std::size_t kChunkBytes = 256u << 10;

  explicit ResultStream(CallsUnderWay::Ticket ticket) : ticket_(std::move(ticket)) {}

  // One of the two is to be called once.
  void Send(std::shared_ptr<const std::string> bytes);
  void Fail(const grpc::Status& status) { Finish(status); }

  void OnWriteDone(bool ok) override;
  void OnDone() override { delete this; }

 private:
  void SendNext();

  const CallsUnderWay::Ticket ticket_;
  std::shared_ptr<const std::string> bytes_;
  std::size_t sent_ = 0;
  grpc::ByteBuffer chunk_;  // In flight.
};

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_SERVICE_RESULT_STREAM_H_
