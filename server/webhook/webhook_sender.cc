// SPDX-License-Identifier: Apache-2.0
#include "server/webhook/webhook_sender.h"

#include <algorithm>
#include <utility>

#include "server/webhook/webhook_signature.h"

namespace flatlight {
namespace {

using std::chrono::milliseconds;
using Outcome = WebhookAttempt::Outcome;
using Steady = std::chrono::steady_clock;

constexpr milliseconds kLongestWait{60'000};  // A clock that was set is noticed after so long.
constexpr milliseconds kShortestWait{10};
constexpr milliseconds kWhileBusy{500};
constexpr milliseconds kRewrite{2000};

// Between 0 and a fifth of a delay, always the same for the same attempt.
milliseconds Spread(milliseconds delay, const DueWebhook& webhook) {
  const auto mixed = (static_cast<std::uint64_t>(webhook.number) * 31 + webhook.attempts) * 0x9E3779B97F4A7C15u;
  return milliseconds(delay.count() * static_cast<std::int64_t>(mixed >> 54) / 5120);
}

}  // namespace

std::string NameOf(Outcome outcome) {
  switch (outcome) {
    case Outcome::kDelivered:
      return "delivered";
    case Outcome::kFailed:
      return "failed";
    case Outcome::kGivenUp:
      return "given_up";
    case Outcome::kRefused:
      return "refused";
  }
  return "";
}

WebhookSender::WebhookSender(Options options, const WebhookRules& rules, WebhookOutbox& outbox, std::string key,
                             std::string user_agent, std::function<void(const WebhookAttempt&)> tried)
    : options_(std::move(options)),
      rules_(rules),
      outbox_(outbox),
      key_(std::move(key)),
      user_agent_(std::move(user_agent)),
      tried_(std::move(tried)),
      multi_(curl_multi_init()),
      thread_([this] { Work(); }) {}

WebhookSender::~WebhookSender() { Close(milliseconds(0)); }

void WebhookSender::Wake() { curl_multi_wakeup(multi_.get()); }

void WebhookSender::Close(milliseconds grace) {
  if (!thread_.joinable()) return;
  closing_ = Steady::now().time_since_epoch() + grace;
  Wake();
  thread_.join();
}

void WebhookSender::Work() {
  while (true) {
    const Steady::duration closing = closing_;
    const bool is_closing = closing != Steady::duration::max();
    const Steady::duration now = Steady::now().time_since_epoch();
    if (now < closing) StartDue();
    int running = 0;
    curl_multi_perform(multi_.get(), &running);
    const bool any_ended = TakeEnded();
    WriteNotes();
    if (is_closing && ((flights_.empty() && !any_ended) || now >= closing)) break;
    // Each that ends lets in the next.
    milliseconds wait = any_ended ? milliseconds(0) : UntilNext();
    if (is_closing) wait = std::min(wait, std::chrono::ceil<milliseconds>(closing - now));
    curl_multi_poll(multi_.get(), nullptr, 0, static_cast<int>(wait.count()), nullptr);
  }
  for (const auto& [number, flight] : flights_) curl_multi_remove_handle(multi_.get(), flight.transfer->handle());
  flights_.clear();
}

std::size_t WebhookSender::FlightsOf(const std::string& owner) const {
  return static_cast<std::size_t>(std::count_if(
      flights_.begin(), flights_.end(), [&](const auto& flight) { return flight.second.webhook.owner == owner; }));
}

void WebhookSender::StartDue() {
  if (flights_.size() >= options_.at_once) return;
  // Those under way are among them.
  auto due = outbox_.Due(options_.now(), options_.at_once_per_owner, 2 * options_.at_once + notes_.size());
  if (!due.ok()) return;
  for (DueWebhook& webhook : *due) {
    if (flights_.size() >= options_.at_once) return;
    if (flights_.contains(webhook.number) || notes_.contains(webhook.number)) continue;
    // While the server ends, only what is new: the rest is for the next one.
    if (closing_.load() != Steady::duration::max() && webhook.attempts > 0) continue;
    if (FlightsOf(webhook.owner) < options_.at_once_per_owner) Start(std::move(webhook));
  }
}

void WebhookSender::Start(DueWebhook webhook) {
  // It may have been allowed in a process before.
  if (const absl::Status allowed = rules_.Check(webhook.url); !allowed.ok()) {
    return Note(std::move(webhook), {WebhookTransfer::Outcome::kRefused, std::string(allowed.message())});
  }
  const WallTime now = options_.now();
  const auto secrets = outbox_.SecretsOf(webhook.owner, now);
  if (!secrets.ok()) {
    return Note(std::move(webhook), {WebhookTransfer::Outcome::kFailed, std::string(secrets.status().message())});
  }
  const std::int64_t number = webhook.number;
  const std::string id = WebhookId(webhook.job.uuid());
  const auto timestamp = std::chrono::duration_cast<std::chrono::seconds>(now.time_since_epoch()).count();
  std::string signatures;
  for (const SecretTerm& term : *secrets) {
    const std::string secret = WebhookSecret(key_, webhook.owner, term.generation);
    signatures += (signatures.empty() ? "" : " ") + WebhookSignature(secret, id, timestamp, webhook.body);
  }
  WebhookTransfer::Message message{
      webhook.url,
      webhook.body,
      {"Content-Type: application/json", "Expect:", "User-Agent: " + user_agent_, "webhook-id: " + id,
       "webhook-timestamp: " + std::to_string(timestamp), "webhook-signature: " + signatures}};
  auto transfer = std::make_unique<WebhookTransfer>(rules_, std::move(message), options_.connect_limit, options_.limit);
  curl_multi_add_handle(multi_.get(), transfer->handle());
  flights_[number] = {std::move(webhook), std::move(transfer)};
}

bool WebhookSender::TakeEnded() {
  bool any = false;
  int left = 0;
  while (const CURLMsg* message = curl_multi_info_read(multi_.get(), &left)) {
    if (message->msg != CURLMSG_DONE) continue;
    const auto flight = std::find_if(flights_.begin(), flights_.end(), [&](const auto& entry) {
      return entry.second.transfer->handle() == message->easy_handle;
    });
    const WebhookTransfer::Result result = flight->second.transfer->ResultOf(message->data.result);
    curl_multi_remove_handle(multi_.get(), message->easy_handle);
    DueWebhook webhook = std::move(flight->second.webhook);
    flights_.erase(flight);
    Note(std::move(webhook), result);
    any = true;
  }
  return any;
}

void WebhookSender::Note(DueWebhook webhook, const WebhookTransfer::Result& result) {
  const std::int64_t number = webhook.number;
  const std::size_t failures = webhook.attempts++;
  WebhookAttempt attempt;
  if (result.outcome == WebhookTransfer::Outcome::kTaken) {
    attempt.outcome = Outcome::kDelivered;
    notes_[number] = [this, number] { return outbox_.Delivered(number, options_.now()); };
  } else if (result.outcome == WebhookTransfer::Outcome::kFailed && failures < options_.retries.size()) {
    attempt.outcome = Outcome::kFailed;
    const milliseconds delay = options_.retries[failures] + Spread(options_.retries[failures], webhook);
    notes_[number] = [this, number, error = result.error, due = options_.now() + delay] {
      return outbox_.TryAgain(number, error, due);
    };
  } else {
    const bool refused = result.outcome == WebhookTransfer::Outcome::kRefused;
    attempt.outcome = refused ? Outcome::kRefused : Outcome::kGivenUp;
    notes_[number] = [this, number, error = result.error] { return outbox_.GiveUp(number, error, options_.now()); };
  }
  attempt.webhook = std::move(webhook);
  attempt.error = result.error;
  tried_(attempt);
}

void WebhookSender::WriteNotes() {
  std::erase_if(notes_, [](const auto& note) { return note.second().ok(); });
}

milliseconds WebhookSender::UntilNext() {
  if (!notes_.empty()) return kRewrite;
  // Those under way are due too, and so are those that wait for them.
  if (!flights_.empty()) return kWhileBusy;
  const auto next = outbox_.NextDue();
  if (!next.ok() || !*next) return kLongestWait;
  const auto wait = std::chrono::ceil<milliseconds>(**next - options_.now());
  return std::clamp(wait, kShortestWait, kLongestWait);
}

}  // namespace flatlight
