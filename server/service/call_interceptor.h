// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_SERVICE_CALL_INTERCEPTOR_H_
#define FLATLIGHT_SERVER_SERVICE_CALL_INTERCEPTOR_H_

#include "grpcpp/support/server_interceptor.h"
#include "server/service/call_telemetry.h"

namespace flatlight {

// Tells `telemetry`, which outlives this, of all calls but the unary ones of flatlight services: streams, health,
// reflection, and methods that there are not.
class CallInterceptors final : public grpc::experimental::ServerInterceptorFactoryInterface {
 public:
  explicit CallInterceptors(CallTelemetry& telemetry) : telemetry_(telemetry) {}
  grpc::experimental::Interceptor* CreateServerInterceptor(grpc::experimental::ServerRpcInfo* info) override;

 private:
  CallTelemetry& telemetry_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_SERVICE_CALL_INTERCEPTOR_H_
