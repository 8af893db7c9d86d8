// SPDX-License-Identifier: Apache-2.0
// What a failed call tells the user.
#ifndef FLATLIGHT_CLIENT_CLI_STATUS_RPC_ERROR_H_
#define FLATLIGHT_CLIENT_CLI_STATUS_RPC_ERROR_H_

#include "absl/status/status.h"
#include "google/rpc/status.pb.h"
#include "grpcpp/support/status.h"

namespace flatlight {

// Keeps the code. If the details hold a BadRequest or a QuotaFailure, the message has a line "place: description" for
// each of their violations; else it is the server's.
absl::Status ErrorFromRpc(const grpc::Status& status);
absl::Status ErrorFromRpc(const google::rpc::Status& status);

}  // namespace flatlight

#endif  // FLATLIGHT_CLIENT_CLI_STATUS_RPC_ERROR_H_
