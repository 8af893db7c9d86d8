// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_WEBHOOK_WEBHOOK_SENDER_H_
#define FLATLIGHT_SERVER_WEBHOOK_WEBHOOK_SENDER_H_

#include <curl/curl.h>

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "absl/status/status.h"
#include "server/store/webhook_outbox.h"
#include "server/webhook/webhook_rules.h"
#include "server/webhook/webhook_transfer.h"

namespace flatlight {

// What came of one attempt to tell of a job's end.
struct WebhookAttempt {
  enum class Outcome : std::uint8_t { kDelivered, kFailed, kGivenUp, kRefused };
  Outcome outcome = Outcome::kDelivered;
  DueWebhook webhook;  // `attempts` with this one.
  std::string error;
};
std::string NameOf(WebhookAttempt::Outcome outcome);  // "delivered", "failed", "given_up", "refused".

// Sends what is due in an outbox, on a thread of its own, many at once: who takes long holds up nobody else. Each is
// sent at least once: what was being sent when the process ended, or could not be noted as sent, is sent again.
class WebhookSender {
 public:
  struct Options {
    // After each failure; after the last one it is given up. Up to a fifth is added, lest all come back at once.
    std::vector<std::chrono::milliseconds> retries = {
        std::chrono::seconds(5), std::chrono::seconds(30), std::chrono::minutes(5), std::chrono::minutes(30),
        std::chrono::hours(2),   std::chrono::hours(5),    std::chrono::hours(10)};
    std::chrono::milliseconds connect_limit{5000};
    std::chrono::milliseconds limit{10'000};  // Of an attempt, connection included.
    std::size_t at_once = 32;
    std::size_t at_once_per_owner = 2;
    std::function<WallTime()> now = [] { return std::chrono::system_clock::now(); };
  };
  // Sends from now on. What is passed in must outlive the sender. `tried` is told of each attempt, on the sender's
  // thread. `user_agent` names the build.
  WebhookSender(Options options, const WebhookRules& rules, WebhookOutbox& outbox, std::string key,
                std::string user_agent, std::function<void(const WebhookAttempt&)> tried);
  // As Close without grace.
  ~WebhookSender();

  // Something is due. From any thread; quick.
  void Wake();
  // Sends what is due for the first time and what is under way for at most so long, and then no more.
  void Close(std::chrono::milliseconds grace);

 private:
  struct Flight {
    DueWebhook webhook;
    std::unique_ptr<WebhookTransfer> transfer;
  };
  struct FreeMulti {
    void operator()(CURLM* multi) const { curl_multi_cleanup(multi); }
  };

  void Work();
  void StartDue();
  void Start(DueWebhook webhook);
  // Whether there were any.
  bool TakeEnded();
  void Note(DueWebhook webhook, const WebhookTransfer::Result& result);
  // What could not be written is tried again later; until then it is not sent again.
  void WriteNotes();
  std::chrono::milliseconds UntilNext();
  std::size_t FlightsOf(const std::string& owner) const;

  const Options options_;
  const WebhookRules& rules_;
  WebhookOutbox& outbox_;
  const std::string key_;
  const std::string user_agent_;
  const std::function<void(const WebhookAttempt&)> tried_;
  const std::unique_ptr<CURLM, FreeMulti> multi_;
  std::map<std::int64_t, Flight> flights_;                       // The thread's alone, by number.
  std::map<std::int64_t, std::function<absl::Status()>> notes_;  // Likewise: what is to be written.
  std::atomic<std::chrono::steady_clock::duration> closing_{std::chrono::steady_clock::duration::max()};  // When.
  std::thread thread_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_WEBHOOK_WEBHOOK_SENDER_H_
