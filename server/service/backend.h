// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_SERVICE_BACKEND_H_
#define FLATLIGHT_SERVER_SERVICE_BACKEND_H_

#include <atomic>
#include <string>

#include "core/execution/executor.h"
#include "server/quota/cpu_ledger.h"
#include "server/review/room_store.h"
#include "server/scheduler/scheduler.h"
#include "server/scheduler/task_queue.h"
#include "server/service/call_telemetry.h"
#include "server/service/calls_under_way.h"
#include "server/service/guard.h"
#include "server/service/job_access.h"
#include "server/service/job_messages.h"
#include "server/service/limits.h"
#include "server/service/page_tokens.h"
#include "server/service/scene_cache.h"
#include "server/service/watch_hub.h"
#include "server/store/job_store.h"
#include "server/store/retention.h"
#include "server/store/scene_store.h"
#include "server/store/webhook_outbox.h"
#include "server/webhook/webhook_rules.h"

namespace flatlight {

// What the services share. They hold no state of their own.
struct Backend {
  const std::string version;
  const Limits limits;
  const int threads;  // For rendering.
  const std::uint32_t processors;
  const Guard guard;
  JobStore& jobs;
  SceneStore& scenes;
  RoomStore& rooms;
  const JobAccess access;
  SceneCache& built_scenes;
  Scheduler& scheduler;
  CpuLedger& ledger;
  WatchHub& hub;
  // For work that takes longer than an event thread may: requests of ordinary size, and those that may take seconds.
  TaskQueue& quick;
  TaskQueue& slow;
  CallTelemetry& telemetry;
  const Retention retention;
  const WebhookRules& webhook_rules;
  WebhookOutbox& webhooks;
  const std::string webhook_key;  // See WebhookOutbox.
  std::atomic<bool> draining = false;
  CallsUnderWay calls = {};
  JobMessages job_messages = {};
  const PageTokens page_tokens = {};
};

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_SERVICE_BACKEND_H_
