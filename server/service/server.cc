// SPDX-License-Identifier: Apache-2.0
#include "server/service/server.h"

#include <algorithm>
#include <cstdio>
#include <mutex>
#include <utility>
#include <vector>

#include "core/execution/clock.h"
#include "core/execution/thread_pool.h"
#include "core/render/index_cache.h"
#include "core/render/rendering.h"
#include "grpcpp/ext/proto_server_reflection_plugin.h"
#include "grpcpp/health_check_service_interface.h"
#include "grpcpp/server.h"
#include "grpcpp/server_builder.h"
#include "server/review/room_store.h"
#include "server/scheduler/task_queue.h"
#include "server/service/backend.h"
#include "server/service/build_version.h"
#include "server/service/call_interceptor.h"
#include "server/service/call_telemetry.h"
#include "server/service/connection_limits.h"
#include "server/service/job_format.h"
#include "server/service/job_sweeper.h"
#include "server/service/listen_address.h"
#include "server/service/machine.h"
#include "server/service/render_calls.h"
#include "server/service/render_service.h"
#include "server/service/review_service.h"
#include "server/service/scene_cache.h"
#include "server/service/scene_service.h"
#include "server/service/tls_credentials.h"
#include "server/service/watch_hub.h"
#include "server/store/durable_job_store.h"
#include "server/store/durable_scene_store.h"
#include "server/store/error.h"
#include "server/store/job_archive.h"
#include "server/store/memory_job_store.h"
#include "server/store/memory_scene_store.h"
#include "server/store/random_bytes.h"
#include "server/store/schema.h"
#include "server/store/storage.h"
#include "server/store/webhook_outbox.h"
#include "server/telemetry/json_log.h"
#include "server/telemetry/metrics.h"
#include "server/webhook/webhook_rules.h"
#include "server/webhook/webhook_sender.h"

namespace flatlight {
namespace {

constexpr std::size_t kMaxWaitingQuickBytes = 64u << 20;
constexpr std::size_t kMaxWaitingSlowBytes = 256u << 20;
constexpr std::size_t kMaxBuiltSceneBytes = 1u << 30;
constexpr std::size_t kMaxIndexedElements = 2'000'000;  // Of IndexCache::kElementBytes each, with their scene.
constexpr std::size_t kMaxSolvedBytes = 256u << 20;     // Of what `reference` found.
constexpr std::chrono::milliseconds kFlush{100};
constexpr double kMaxCachedResultBytes = 256e6;  // Of those that are on disk too.
const std::vector<std::string> kServices = {
    v1::RenderService::service_full_name(), v1::SceneService::service_full_name(),
    v1::ServerService::service_full_name(), v1::ReviewService::service_full_name()};
constexpr char kAuditLog[] = "/audit.jsonl";  // In the data folder.
constexpr char kStorageHealth[] = "flatlight.storage";
constexpr int kQuickThreads = 4;
constexpr int kSlowThreads = 2;

SchedulerOptions MakeSchedulerOptions(const ServerOptions& options, Metrics& metrics, CpuLedger& ledger) {
  SchedulerOptions scheduler;
  scheduler.events = &metrics;
  scheduler.runners = 2;
  scheduler.starters = 2;
  scheduler.max_running_jobs = options.limits.max_running_jobs;
  scheduler.ledger = &ledger;
  scheduler.retention = options.retention;
  scheduler.checkpoint_interval = options.checkpoint_interval;
  return scheduler;
}

absl::Status WouldLetStrangersIn(const std::string& address) {
  return MakeError(
      absl::StatusCode::kInvalidArgument, "NO_USERS",
      "other machines can reach " + address +
          ", and without users or a token everybody there could do everything; add a first user (flatlightd "
          "user add --data DIR NAME --role admin) or give a --token-file");
}

struct Logs {
  std::unique_ptr<JsonLog> calls;  // Null, as below: not written.
  std::unique_ptr<JsonLog> audit;

  absl::Status Open(const ServerOptions& options) {
    if (!options.log.empty()) {
      auto opened = JsonLog::Open(options.log);
      if (!opened.ok()) return opened.status();
      calls = *std::move(opened);
    }
    if (options.data.empty()) return absl::OkStatus();
    auto opened = JsonLog::Open(options.data + kAuditLog);
    if (!opened.ok()) return opened.status();
    audit = *std::move(opened);
    return absl::OkStatus();
  }
};

}  // namespace

// In the order in which they need each other; destroyed in reverse.
struct Server::Parts {
  Parts(const ServerOptions& options, std::unique_ptr<Storage> opened, Logs opened_logs,
        std::unique_ptr<Database> users, std::unique_ptr<Database> for_rooms, std::unique_ptr<WebhookOutbox> outbox,
        const std::string& webhook_key)
      : logs(std::move(opened_logs)),
        webhook_rules(options.webhook_rules),
        webhooks(std::move(outbox)),
        webhook_sender(options.webhooks, webhook_rules, *webhooks, webhook_key, "flatlightd/" + BuildVersion(),
                       [this](const WebhookAttempt& attempt) { NoteWebhook(attempt); }),
        indexes(options.indexes == nullptr ? own_indexes : *options.indexes),
        pool(options.threads),
        storage(std::move(opened)),
        quotas(options.quotas),
        ledger(storage.get(), {.interval = options.checkpoint_interval, .now = options.day_clock}),
        archive(storage == nullptr ? nullptr : std::make_unique<JobArchive>(*storage, BuildVersion())),
        format(BuildVersion(), options.retention),
        job_store(MakeJobStore(options)),
        jobs(*job_store),
        scene_store(MakeSceneStore(options)),
        scenes(*scene_store),
        rooms(RoomLimits(), std::move(for_rooms)),
        hub({.epoch = RandomEpoch(),
             .max_watches = options.limits.max_watches,
             .heartbeat = options.heartbeat,
             .users_version = [this] { return backend.guard.UsersVersion(); }},
            jobs),
        scheduler(MakeSchedulerOptions(options, metrics, ledger), jobs, pool, clock, StartOf(options),
                  [this](const JobId& job) { hub.Changed(job.Name()); }),
        backend{.version = BuildVersion(),
                .limits = options.limits,
                .threads = pool.threads(),
                .processors = UsableProcessors(),
                .guard = Guard(options.token, std::move(users), quotas,
                               options.request_clock == nullptr ? clock : *options.request_clock),
                .jobs = jobs,
                .scenes = scenes,
                .rooms = rooms,
                .access = JobAccess(jobs, rooms),
                .built_scenes = built_scenes,
                .scheduler = scheduler,
                .ledger = ledger,
                .hub = hub,
                .quick = quick,
                .slow = slow,
                .telemetry = telemetry,
                .retention = options.retention,
                .webhook_rules = webhook_rules,
                .webhooks = *webhooks,
                .webhook_key = webhook_key},
        quick(kQuickThreads, kMaxWaitingQuickBytes),
        slow(kSlowThreads, kMaxWaitingSlowBytes),
        render_service(backend, hub),
        scene_service(backend),
        server_service(backend),
        review_service(backend, hub),
        sweeper(
            {.retention = options.retention, .interval = options.retention_interval, .now = options.retention_clock},
            jobs,
            {.is_needed =
                 [this](const JobId& job) { return hub.IsWatched(job.Name()) || rooms.IsShown(job).value_or(true); },
             .remove =
                 [this](const JobId& job) {
                   absl::Status deleted = scheduler.Delete(job);
                   if (deleted.ok()) backend.job_messages.Forget(job);
                   return deleted;
                 },
             .removed = [this](const JobSpec& job) { NoteExpired(job); }}) {
    metrics.ReadWith([this] { return Read(); });
  }

  Readings Read() {
    Readings now;
    now.load = scheduler.Load();
    now.watches = static_cast<double>(hub.size());
    const auto& counts = hub.counts();
    now.resumed_watches = static_cast<double>(counts.resumed);
    now.new_watches = static_cast<double>(counts.added) - now.resumed_watches;
    now.updates = static_cast<double>(counts.updates);
    now.conflated = static_cast<double>(counts.conflated);
    for (const JsonLog* log : {logs.calls.get(), logs.audit.get()}) {
      if (log != nullptr) now.lost_log_lines += static_cast<double>(log->lost_lines());
    }
    now.open_webhooks = static_cast<double>(webhooks->OpenOf(std::nullopt).value_or(0));
    const std::lock_guard lock(health_mutex);
    now.storage_healthy = storage_healthy;
    return now;
  }

  // Each attempt in the log of calls, in the audit log what nothing follows. Of the URL no more than the host: the rest
  // may be secret.
  void NoteWebhook(const WebhookAttempt& attempt) {
    metrics.WebhookTried(NameOf(attempt.outcome));
    JsonLog::Line line;
    line["webhook"] = NameOf(attempt.outcome);
    line["caller"] = attempt.webhook.owner;
    line["resource"] = attempt.webhook.job.Name();
    line["host"] = WebhookHost(attempt.webhook.url);
    line["attempt"] = attempt.webhook.attempts;
    if (!attempt.error.empty()) line["error"] = attempt.error;
    if (logs.calls != nullptr) logs.calls->Write(line);
    if (logs.audit != nullptr && attempt.outcome != WebhookAttempt::Outcome::kFailed) logs.audit->Write(line);
  }

  void NoteExpired(const JobSpec& job) {
    metrics.JobExpired();
    if (logs.audit == nullptr) return;
    JsonLog::Line line;
    line["removed"] = "expired";
    line["caller"] = job.owner;
    line["resource"] = job.id.Name();
    logs.audit->Write(line);
  }

  std::unique_ptr<JobStore> MakeJobStore(const ServerOptions& options) {
    const std::size_t most = options.limits.max_jobs;
    const auto webhook_is_due = [this] { webhook_sender.Wake(); };
    if (archive == nullptr) {
      return std::make_unique<MemoryJobStore>(MemoryJobStore::Limits{.max_jobs = most}, clock,
                                              MemoryJobStore::Webhooks{*webhooks, format, webhook_is_due});
    }
    archive->WhenWebhookIsDue(webhook_is_due);
    DurableJobStore::Options durable_options;
    durable_options.memory.max_jobs = most;
    durable_options.memory.max_ended_bytes = kMaxCachedResultBytes;
    auto store = std::make_unique<DurableJobStore>(
        durable_options, clock, *archive, format, [this](const JobId& job) { hub.Changed(job.Name()); },
        [this](const absl::Status& health) { TellStorageHealth(health); });
    durable = store.get();
    return store;
  }

  std::unique_ptr<SceneStore> MakeSceneStore(const ServerOptions& options) {
    const MemorySceneStore::Limits most{.max_scene_bytes = options.limits.max_scene_bytes};
    if (storage == nullptr) return std::make_unique<MemorySceneStore>(most, clock);
    auto store = std::make_unique<DurableSceneStore>(most, clock, *storage);
    durable_scenes = store.get();
    return store;
  }

  // Goes on with the scenes and jobs of the process before.
  absl::Status Restore() {
    if (durable == nullptr) return absl::OkStatus();
    if (absl::Status read = durable_scenes->Restore(); !read.ok()) return read;
    const auto restored = durable->Restore();
    if (!restored.ok()) return restored.status();
    for (const JobRecord& job : *restored) {
      scheduler.Resubmit(
          job, [this, spec = job.spec] { return RestoreJob(backend, *archive, *spec); },
          backend.guard.QuotasOf(job.spec->owner));
    }
    return absl::OkStatus();
  }

  absl::Status ServeMetrics(const std::string& where) {
    if (where.empty()) return absl::OkStatus();
    const auto parsed = ParseListenAddress(where);
    if (!parsed.ok()) return parsed.status();
    if (parsed->host.empty()) return absl::InvalidArgumentError("metrics are served at HOST:PORT, not at " + where);
    auto served = metrics.Expose(parsed->host, parsed->port);
    if (!served.ok()) return served.status();
    metrics_address = *std::move(served);
    return absl::OkStatus();
  }

  void TellStorageHealth(const absl::Status& health) {
    if (!health.ok()) std::fprintf(stderr, "flatlightd: %s\n", std::string(health.message()).c_str());
    const std::lock_guard lock(health_mutex);
    storage_healthy = health.ok();
    if (grpc != nullptr) grpc->GetHealthCheckService()->SetServingStatus(kStorageHealth, storage_healthy);
  }

  std::shared_ptr<grpc::ServerCredentials> NewCredentials() const {
    return tls == nullptr ? grpc::InsecureServerCredentials() : tls->ForServer();
  }

  Scheduler::Start StartOf(const ServerOptions& options) {
    if (options.start_rendering) {
      return [start = options.start_rendering](std::shared_ptr<const Scene> scene, const JobSpec& job) {
        return start(std::move(scene), job.plan);
      };
    }
    return [this](std::shared_ptr<const Scene> scene, const JobSpec& job) {
      return StartRendering(std::move(scene), job.plan, indexes, job.sharers);
    };
  }

  SteadyClock clock;
  Metrics metrics{BuildVersion()};
  Logs logs;
  CallTelemetry telemetry{metrics, logs.calls.get(), logs.audit.get(), kServices};
  const WebhookRules webhook_rules;
  const std::unique_ptr<WebhookOutbox> webhooks;
  WebhookSender webhook_sender;
  IndexCache own_indexes{kMaxIndexedElements, kMaxSolvedBytes};
  IndexCache& indexes;
  ThreadPool pool;
  std::unique_ptr<Storage> storage;  // Null, as are the archive and `durable`: nothing outlives the process.
  const QuotaTable quotas;
  CpuLedger ledger;
  std::unique_ptr<JobArchive> archive;
  ProtoJobFormat format;
  DurableJobStore* durable = nullptr;
  std::unique_ptr<JobStore> job_store;
  JobStore& jobs;
  DurableSceneStore* durable_scenes = nullptr;
  std::unique_ptr<SceneStore> scene_store;
  SceneStore& scenes;
  RoomStore rooms;
  SceneCache built_scenes{kMaxBuiltSceneBytes};
  WatchHub hub;
  Scheduler scheduler;
  Backend backend;
  // Ended before it: calls that have their answers may still let go there of what they had of the backend.
  TaskQueue quick;
  TaskQueue slow;
  RenderService render_service;
  SceneService scene_service;
  ServerService server_service;
  ReviewService review_service;
  JobSweeper sweeper;
  std::unique_ptr<TlsCredentials> tls;  // Null: without TLS.
  std::mutex health_mutex;              // Held while `grpc` changes.
  bool storage_healthy = true;
  std::unique_ptr<grpc::Server> grpc;
  std::string address;
  std::string metrics_address;
};

Server::Server(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}

Server::~Server() { Drain(std::chrono::milliseconds(0)); }

const std::string& Server::address() const { return parts_->address; }

const std::string& Server::metrics_address() const { return parts_->metrics_address; }

std::string Server::MetricsText() const { return parts_->metrics.Text(); }

absl::Status Server::ReopenLogs() {
  for (JsonLog* log : {parts_->logs.calls.get(), parts_->logs.audit.get()}) {
    if (log == nullptr) continue;
    if (absl::Status opened = log->Reopen(); !opened.ok()) return opened;
  }
  return absl::OkStatus();
}

absl::StatusOr<std::unique_ptr<Server>> Server::Start(const ServerOptions& options) {
  const bool with_tls = !options.tls.certificate.empty();
  const auto address = ParseListenAddress(options.address, with_tls);
  if (!address.ok()) return address.status();
  std::unique_ptr<TlsCredentials> tls;
  if (with_tls) {
    tls = std::make_unique<TlsCredentials>(
        options.tls, [](const std::string& news) { std::fprintf(stderr, "flatlightd: %s\n", news.c_str()); });
    if (absl::Status good = tls->Check(); !good.ok()) return good;
  }
  const auto cannot_listen = [&](const std::string& why) {
    return MakeError(absl::StatusCode::kUnavailable, "CANNOT_LISTEN",
                     "cannot listen on " + options.address + ": " + why);
  };
  if (!address->path.empty() && IsListening(address->path)) return cannot_listen("another program listens there");

  std::unique_ptr<Storage> storage;
  std::unique_ptr<Database> users;
  if (!options.data.empty()) {
    auto opened = Storage::Open(options.data);
    if (!opened.ok()) return opened.status();
    storage = *std::move(opened);
    // A connection of its own: no call waits at the door for what another one writes.
    auto connection = Database::OpenExisting(Storage::DatabasePath(options.data));
    if (!connection.ok()) return connection.status();
    users = *std::move(connection);
  }
  const auto open_database = [&] {
    return options.data.empty() ? NewMemoryDatabase() : Database::OpenExisting(Storage::DatabasePath(options.data));
  };
  auto for_rooms = open_database();
  if (!for_rooms.ok()) return for_rooms.status();
  auto for_webhooks = open_database();
  if (!for_webhooks.ok()) return for_webhooks.status();
  auto webhooks = std::make_unique<WebhookOutbox>(*std::move(for_webhooks));
  const auto webhook_key = webhooks->Key();
  if (!webhook_key.ok()) return webhook_key.status();
  Logs logs;
  if (absl::Status opened = logs.Open(options); !opened.ok()) return opened;
  auto parts = std::make_unique<Parts>(options, std::move(storage), std::move(logs), std::move(users),
                                       *std::move(for_rooms), std::move(webhooks), *webhook_key);
  parts->tls = std::move(tls);
  if (!address->of_this_machine) {
    const auto knows = parts->backend.guard.KnowsEverybody();
    if (!knows.ok()) return knows.status();
    if (!*knows) return WouldLetStrangersIn(options.address);
  }
  if (absl::Status restored = parts->Restore(); !restored.ok()) return restored;
  if (absl::Status served = parts->ServeMetrics(options.metrics_address); !served.ok()) return served;
  grpc::EnableDefaultHealthCheckService(true);
  grpc::reflection::InitProtoReflectionServerBuilderPlugin();
  grpc::ServerBuilder builder;
  int port = 0;
  builder.AddListeningPort(address->ToString(address->port), parts->NewCredentials(), &port);
  builder.AddChannelArgument(GRPC_ARG_ALLOW_REUSEPORT, 0);
  SetConnectionLimits(builder, options.limits, options.keepalive, options.connection_memory_bytes);
  std::vector<std::unique_ptr<grpc::experimental::ServerInterceptorFactoryInterface>> interceptors;
  interceptors.push_back(std::make_unique<CallInterceptors>(parts->telemetry));
  builder.experimental().SetInterceptorCreators(std::move(interceptors));
  builder.RegisterService(&parts->render_service);
  builder.RegisterService(&parts->scene_service);
  builder.RegisterService(&parts->server_service);
  builder.RegisterService(&parts->review_service);
  {
    const std::lock_guard lock(parts->health_mutex);
    parts->grpc = builder.BuildAndStart();
    if (parts->grpc != nullptr && parts->durable != nullptr) {
      parts->grpc->GetHealthCheckService()->SetServingStatus(kStorageHealth, parts->storage_healthy);
    }
  }
  if (parts->grpc == nullptr) {
    const std::string why = WhyNotListening(*address);
    return cannot_listen(why.empty() ? "another program listened there until just now" : why);
  }
  parts->address = address->ToString(port);
  for (const std::string& service : kServices) {
    parts->grpc->GetHealthCheckService()->SetServingStatus(service, true);
  }
  return std::unique_ptr<Server>(new Server(std::move(parts)));
}

void Server::Drain(std::chrono::milliseconds grace) {
  Parts& parts = *parts_;
  if (parts.grpc == nullptr) return;
  parts.backend.draining = true;
  parts.grpc->GetHealthCheckService()->Shutdown();
  parts.sweeper.Close();
  parts.hub.Drain(grace);
  parts.scheduler.Stop();
  parts.ledger.Close();
  if (parts.durable != nullptr) parts.durable->Close();
  parts.webhook_sender.Close(grace);
  parts.backend.calls.AwaitNone(grace);
  // Answers are on their way; what remains is to write them, and idle connections.
  parts.grpc->Shutdown(std::chrono::system_clock::now() + std::min(grace, kFlush));
  parts.grpc->Wait();
  parts.metrics.Close();
  const std::lock_guard lock(parts.health_mutex);
  parts.grpc.reset();
}

}  // namespace flatlight
