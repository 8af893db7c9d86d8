// SPDX-License-Identifier: Apache-2.0
#include "server/service/result_stream.h"

#include <utility>

#include "flatlight/v1/render_service.pb.h"
#include "server/service/message_bytes.h"

namespace flatlight {

void ResultStream::Send(std::shared_ptr<const std::string> bytes) {
  bytes_ = std::move(bytes);
  SendNext();
}

void ResultStream::SendNext() {
  v1::GetResultResponse response;
  response.set_data(bytes_->substr(sent_, kChunkBytes));
  response.set_total_bytes(static_cast<double>(bytes_->size()));
  sent_ += response.data().size();
  chunk_ = ToBytes(response);
  StartWrite(&chunk_);
}

void ResultStream::OnWriteDone(bool ok) {
  if (!ok) {
    Finish(grpc::Status(grpc::StatusCode::CANCELLED, "the reader has gone"));
  } else if (sent_ < bytes_->size()) {
    SendNext();
  } else {
    Finish(grpc::Status::OK);
  }
}

}  // namespace flatlight
