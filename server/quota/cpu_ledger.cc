// SPDX-License-Identifier: Apache-2.0
#include "server/quota/cpu_ledger.h"

namespace flatlight {
namespace {

using Day = std::chrono::duration<std::int64_t, std::ratio<86400>>;

constexpr std::int64_t kDaysKept = 400;  // For who asks what a term has cost.

std::int64_t DayOf(CpuLedger::WallTime time) { return std::chrono::floor<Day>(time.time_since_epoch()).count(); }

CpuLedger::WallTime EndOf(std::int64_t day) {
  return CpuLedger::WallTime(std::chrono::duration_cast<CpuLedger::WallTime::duration>(Day(day + 1)));
}

}  // namespace

CpuLedger::CpuLedger(Storage* storage, Options options) : storage_(storage), options_(std::move(options)) {
  if (storage_ != nullptr) writer_ = std::thread([this] { Work(); });
}

CpuLedger::~CpuLedger() { Close(); }

void CpuLedger::Close() {
  {
    const std::lock_guard lock(mutex_);
    closed_ = true;
  }
  wake_.notify_all();
  if (writer_.joinable()) writer_.join();
  Write().IgnoreError();
}

std::int64_t CpuLedger::Today() const { return DayOf(options_.now()); }

CpuLedger::WallTime CpuLedger::EndOfToday() const { return EndOf(Today()); }

std::chrono::milliseconds CpuLedger::UntilTomorrow() const {
  const WallTime now = options_.now();  // Of two looks, the second may be tomorrow's.
  return std::chrono::ceil<std::chrono::milliseconds>(EndOf(DayOf(now)) - now);
}

void CpuLedger::TurnToToday() {
  const std::int64_t today = Today();
  if (today == day_) return;
  day_ = today;
  used_.clear();
  if (storage_ != nullptr) {
    // A day that cannot be read counts from now on.
    storage_
        ->Read([&](Database& database) -> absl::Status {
          return database.Prepare("SELECT user, seconds FROM cpu_days WHERE day = ?")
              .Bind(today)
              .ForEachRow([&](const Statement& row) { used_[row.Bytes(0)] = row.Real(1); });
        })
        .IgnoreError();
  }
  for (const auto& [key, seconds] : unwritten_) {
    if (key.first == today) used_[key.second] += seconds;
  }
}

double CpuLedger::Charge(const std::string& user, double seconds) {
  const std::lock_guard lock(mutex_);
  TurnToToday();
  const double used = used_[user] += seconds;
  // Without storage too: the clock may go back to a day that was.
  unwritten_[{day_, user}] += seconds;
  if (storage_ == nullptr) unwritten_.erase(unwritten_.begin(), unwritten_.lower_bound({day_ - 1, ""}));
  return used;
}

double CpuLedger::UsedToday(const std::string& user) {
  const std::lock_guard lock(mutex_);
  TurnToToday();
  const auto used = used_.find(user);
  return used == used_.end() ? 0 : used->second;
}

absl::Status CpuLedger::Write() {
  if (storage_ == nullptr) return absl::OkStatus();
  const std::lock_guard one(writing_);
  std::map<Key, double> rows;
  {
    const std::lock_guard lock(mutex_);
    rows = unwritten_;
  }
  if (rows.empty()) return absl::OkStatus();
  absl::Status written = storage_->Write([&](Storage::Writing& writing) -> absl::Status {
    for (const auto& [key, seconds] : rows) {
      Statement add = writing.Prepare(
          "INSERT INTO cpu_days(user, day, seconds) VALUES(?, ?, ?) ON CONFLICT(user, day) DO UPDATE SET seconds = "
          "seconds + excluded.seconds");
      add.Bind(std::string_view(key.second)).Bind(key.first).BindReal(seconds);
      if (absl::Status added = add.Run(); !added.ok()) return added;
    }
    return writing.Prepare("DELETE FROM cpu_days WHERE day < ?").Bind(rows.rbegin()->first.first - kDaysKept).Run();
  });
  if (!written.ok()) return written;
  const std::lock_guard lock(mutex_);
  for (const auto& [key, seconds] : rows) {
    const auto entry = unwritten_.find(key);
    entry->second -= seconds;
    if (entry->second == 0) unwritten_.erase(entry);
  }
  return absl::OkStatus();
}

void CpuLedger::Work() {
  std::unique_lock lock(mutex_);
  while (!closed_) {
    wake_.wait_for(lock, options_.interval);
    lock.unlock();
    // What fails is tried again with the next.
    Write().IgnoreError();
    lock.lock();
  }
}

}  // namespace flatlight
