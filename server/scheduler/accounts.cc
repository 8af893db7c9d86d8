// SPDX-License-Identifier: Apache-2.0
#include "server/scheduler/accounts.h"

#include <algorithm>
#include <limits>

#include "core/math/check.h"

namespace flatlight {

double Accounts::LeastAttained() const {
  double least = std::numeric_limits<double>::infinity();
  for (const auto& [user, account] : accounts_) least = std::min(least, account.attained);
  return least;
}

void Accounts::Enter(const std::string& user) {
  const auto [entry, is_new] = accounts_.try_emplace(user);
  Account& account = entry->second;
  if (is_new) {
    account.attained = std::numeric_limits<double>::infinity();  // Not to be its own measure.
    if (accounts_.size() > 1) level_ = std::max(level_, LeastAttained());
    account.attained = level_;
    if (const auto debt = absent_.find(user); debt != absent_.end()) {
      account.attained = std::max(level_, debt->second);
      absent_.erase(debt);
    }
    std::erase_if(absent_, [&](const auto& other) { return other.second <= level_; });
  }
  ++account.jobs;
}

void Accounts::Leave(const std::string& user) {
  const auto entry = accounts_.find(user);
  FLATLIGHT_DCHECK(entry != accounts_.end());
  if (--entry->second.jobs > 0) return;
  const double attained = entry->second.attained;
  level_ = std::max(level_, LeastAttained());
  accounts_.erase(entry);
  // Who was alone is level with whoever comes next.
  if (!accounts_.empty() && attained > level_) absent_[user] = attained;
}

void Accounts::Serve(const std::string& user) {
  if (const auto entry = accounts_.find(user); entry != accounts_.end()) entry->second.turn = ++turns_;
}

void Accounts::Charge(const std::string& user, double cpu_seconds) {
  if (const auto entry = accounts_.find(user); entry != accounts_.end()) entry->second.attained += cpu_seconds;
}

void Accounts::TakePlace(const std::string& user, JobClass job_class) {
  ++places_[user][static_cast<std::size_t>(job_class)];
  ++all_places_;
}

void Accounts::GivePlace(const std::string& user, JobClass job_class) {
  const auto entry = places_.find(user);
  FLATLIGHT_DCHECK(entry != places_.end());
  --all_places_;
  --entry->second[static_cast<std::size_t>(job_class)];
  if (PlacesOf(user, static_cast<JobClass>(kJobClasses - 1)) == 0) places_.erase(entry);
}

std::size_t Accounts::PlacesOf(const std::string& user, JobClass job_class) const {
  const auto entry = places_.find(user);
  if (entry == places_.end()) return 0;
  std::size_t places = 0;
  for (std::size_t i = 0; i <= static_cast<std::size_t>(job_class); ++i) places += entry->second[i];
  return places;
}

Accounts::Rank Accounts::RankOf(const std::string& user) const {
  const auto entry = accounts_.find(user);
  if (entry == accounts_.end()) return {level_, 0};
  return {entry->second.attained, entry->second.turn};
}

}  // namespace flatlight
