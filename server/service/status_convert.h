// SPDX-License-Identifier: Apache-2.0
// The one place where errors become what gRPC sends. Every error carries google.rpc.ErrorInfo (domain "flatlight");
// mistakes in a request also carry BadRequest, exhausted limits QuotaFailure and RetryInfo.
#ifndef FLATLIGHT_SERVER_SERVICE_STATUS_CONVERT_H_
#define FLATLIGHT_SERVER_SERVICE_STATUS_CONVERT_H_

#include <string>

#include "absl/status/status.h"
#include "core/scene/diagnostic.h"
#include "google/rpc/status.pb.h"
#include "grpcpp/support/status.h"

namespace flatlight {

// INVALID_ARGUMENT with the path of every mistake. `what` begins the message ("the scene").
absl::Status MakeDiagnosticsError(const std::string& reason, const std::string& what, const Diagnostics& diagnostics);
// The same for one mistake in a field of a request.
absl::Status MakeFieldError(const std::string& path, const std::string& message);

// gRPC clients accept 8 KiB of trailers unless told otherwise, so a long message is cut, and of many mistakes only the
// first are kept; ErrorInfo.metadata["more_violations"] then says how many were left out (ValidateScene tells them
// all).
google::rpc::Status ToRpcStatus(const absl::Status& status);
// Of its ErrorInfo; empty if it has none.
std::string ReasonOf(const google::rpc::Status& status);
// The way back, without the details that only a caller needs.
absl::Status FromRpcStatus(const google::rpc::Status& status);
grpc::Status ToGrpcStatus(const absl::Status& status);

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_SERVICE_STATUS_CONVERT_H_
