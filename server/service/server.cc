// SPDX-License-Identifier: Apache-2.0
#include "server/service/server.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "core/execution/clock.h"
#include "core/execution/thread_pool.h"
#include "core/render/index_cache.h"
#include "core/render/rendering.h"
#include "grpcpp/ext/proto_server_reflection_plugin.h"
#include "grpcpp/health_check_service_interface.h"
#include "grpcpp/server.h"
#include "grpcpp/server_builder.h"
#include "server/scheduler/task_queue.h"
#include "server/service/backend.h"
#include "server/service/build_version.h"
#include "server/service/listen_address.h"
#include "server/service/render_service.h"
#include "server/service/scene_cache.h"
#include "server/service/scene_service.h"
#include "server/service/watch_hub.h"
#include "server/store/error.h"
#include "server/store/memory_job_store.h"
#include "server/store/memory_scene_store.h"
#include "server/store/random_bytes.h"

namespace flatlight {
namespace {

constexpr std::size_t kMaxWaitingQuickBytes = 64u << 20;
constexpr std::size_t kMaxWaitingSlowBytes = 256u << 20;
constexpr std::size_t kMaxBuiltSceneBytes = 1u << 30;
constexpr std::size_t kMaxIndexedElements = 2'000'000;  // Of IndexCache::kElementBytes each, with their scene.
constexpr std::chrono::milliseconds kFlush{100};
constexpr int kQuickThreads = 4;
constexpr int kSlowThreads = 2;

// Not 0, which a watcher sends that knows no epoch; exact in a double, for clients that have no 64-bit integers.
std::uint64_t RandomEpoch() {
  std::uint64_t epoch = 0;
  const auto bytes = RandomBytes<sizeof(epoch)>();
  std::memcpy(&epoch, bytes.data(), sizeof(epoch));
  return (epoch >> 11) | 1;
}

SchedulerOptions MakeSchedulerOptions(const ServerOptions& options) {
  SchedulerOptions scheduler;
  scheduler.runners = 2;
  scheduler.starters = 2;
  scheduler.max_running_jobs = options.limits.max_running_jobs;
  scheduler.max_jobs_per_user = options.limits.max_jobs_per_user;
  return scheduler;
}

}  // namespace

// In the order in which they need each other; destroyed in reverse.
struct Server::Parts {
  explicit Parts(const ServerOptions& options)
      : pool(options.threads),
        jobs({.max_jobs = options.limits.max_jobs}, clock),
        scenes({.max_scene_bytes = options.limits.max_scene_bytes}, clock),
        hub({.epoch = RandomEpoch(), .max_watches = options.limits.max_watches, .heartbeat = options.heartbeat}, jobs),
        scheduler(MakeSchedulerOptions(options), jobs, pool, clock, StartOf(options),
                  [this](const JobId& job) { hub.JobChanged(job); }),
        quick(kQuickThreads, kMaxWaitingQuickBytes),
        slow(kSlowThreads, kMaxWaitingSlowBytes),
        backend{.version = BuildVersion(),
                .limits = options.limits,
                .threads = pool.threads(),
                .guard = Guard(options.token),
                .jobs = jobs,
                .scenes = scenes,
                .built_scenes = built_scenes,
                .scheduler = scheduler,
                .quick = quick,
                .slow = slow},
        render_service(backend, hub),
        scene_service(backend),
        server_service(backend) {}

  Scheduler::Start StartOf(const ServerOptions& options) {
    if (options.start_rendering) return options.start_rendering;
    return [this](std::shared_ptr<const Scene> scene, const Plan& plan) {
      return StartRendering(std::move(scene), plan, indexes);
    };
  }

  SteadyClock clock;
  IndexCache indexes{kMaxIndexedElements};
  ThreadPool pool;
  MemoryJobStore jobs;
  MemorySceneStore scenes;
  SceneCache built_scenes{kMaxBuiltSceneBytes};
  WatchHub hub;
  Scheduler scheduler;
  TaskQueue quick;
  TaskQueue slow;
  Backend backend;
  RenderService render_service;
  SceneService scene_service;
  ServerService server_service;
  std::unique_ptr<grpc::Server> grpc;
  std::string address;
};

Server::Server(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}

Server::~Server() { Drain(std::chrono::milliseconds(0)); }

const std::string& Server::address() const { return parts_->address; }

absl::StatusOr<std::unique_ptr<Server>> Server::Start(const ServerOptions& options) {
  const auto address = ParseListenAddress(options.address);
  if (!address.ok()) return address.status();
  const auto cannot_listen = [&](const std::string& why) {
    return MakeError(absl::StatusCode::kUnavailable, "CANNOT_LISTEN",
                     "cannot listen on " + options.address + ": " + why);
  };
  if (!address->path.empty() && IsListening(address->path)) return cannot_listen("another program listens there");

  auto parts = std::make_unique<Parts>(options);
  grpc::EnableDefaultHealthCheckService(true);
  grpc::reflection::InitProtoReflectionServerBuilderPlugin();
  grpc::ServerBuilder builder;
  int port = 0;
  builder.AddListeningPort(address->ToString(address->port), grpc::InsecureServerCredentials(), &port);
  builder.AddChannelArgument(GRPC_ARG_ALLOW_REUSEPORT, 0);
  // Clients may ping an idle connection every 10 s.
  builder.AddChannelArgument(GRPC_ARG_HTTP2_MIN_RECV_PING_INTERVAL_WITHOUT_DATA_MS, 10'000);
  builder.AddChannelArgument(GRPC_ARG_KEEPALIVE_PERMIT_WITHOUT_CALLS, 1);
  builder.SetMaxReceiveMessageSize(static_cast<int>(options.limits.max_message_bytes));
  builder.RegisterService(&parts->render_service);
  builder.RegisterService(&parts->scene_service);
  builder.RegisterService(&parts->server_service);
  parts->grpc = builder.BuildAndStart();
  if (parts->grpc == nullptr) {
    const std::string why = WhyNotListening(*address);
    return cannot_listen(why.empty() ? "another program listened there until just now" : why);
  }
  parts->address = address->ToString(port);
  for (const char* service : {v1::RenderService::service_full_name(), v1::SceneService::service_full_name(),
                              v1::ServerService::service_full_name()}) {
    parts->grpc->GetHealthCheckService()->SetServingStatus(service, true);
  }
  return std::unique_ptr<Server>(new Server(std::move(parts)));
}

void Server::Drain(std::chrono::milliseconds grace) {
  Parts& parts = *parts_;
  if (parts.grpc == nullptr) return;
  parts.backend.draining = true;
  parts.grpc->GetHealthCheckService()->Shutdown();
  parts.hub.Drain(grace);
  parts.scheduler.Stop();
  parts.backend.calls.AwaitNone(grace);
  // Answers are on their way; what remains is to write them, and idle connections.
  parts.grpc->Shutdown(std::chrono::system_clock::now() + std::min(grace, kFlush));
  parts.grpc->Wait();
  parts.grpc.reset();
}

}  // namespace flatlight
