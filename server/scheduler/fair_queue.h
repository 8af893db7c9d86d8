// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_SCHEDULER_FAIR_QUEUE_H_
#define FLATLIGHT_SERVER_SCHEDULER_FAIR_QUEUE_H_

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "server/scheduler/user_queues.h"
#include "server/store/job_class.h"

namespace flatlight {

// Who is next: decided by class; then newcomers, who have nothing to show yet; then by the users' rank; then by who
// came first. Nobody starves: after so many turns in a row comes one of those who were passed over.
template <class Item>
class FairQueue {
 public:
  static constexpr int kClassTurnsInARow = 7;     // Of a class, while a lower one waits.
  static constexpr int kNewcomerTurnsInARow = 4;  // While others of their class wait.

  struct Place {
    JobClass job_class = JobClass::kInteractive;
    std::string user;
    bool newcomer = false;
  };

  void Push(const Place& place, Item item) { LineOf(place).Push(place.user, std::move(item)); }
  bool Remove(const Place& place, const Item& item) { return LineOf(place).Remove(place.user, item); }

  // `rank(user, class)` is an optional: the least comes first, and who has none is passed over.
  template <class Rank>
  std::optional<Item> Pop(const Rank& rank) {
    return PopFromClass(0, rank);
  }

  // All that waits, about in the order in which turns will come.
  template <class Rank>
  std::vector<Item> InTurn(const Rank& rank) const {
    std::vector<Item> items;
    for (std::size_t i = 0; i < kJobClasses; ++i) {
      for (const auto* queues : {&lanes_[i].newcomers, &lanes_[i].others}) {
        for (Item& item : queues->InTurn(OfClass(i, rank))) items.push_back(std::move(item));
      }
    }
    return items;
  }

  bool empty() const { return size() == 0; }
  std::size_t size() const {
    std::size_t size = 0;
    for (const Lane& lane : lanes_) size += lane.size();
    return size;
  }

 private:
  struct Lane {
    UserQueues<Item> newcomers;
    UserQueues<Item> others;
    int newcomer_turns = 0;  // In a row, while others waited.
    int turns = 0;           // In a row, while a lower class waited.

    std::size_t size() const { return newcomers.size() + others.size(); }
  };

  UserQueues<Item>& LineOf(const Place& place) {
    Lane& lane = lanes_[static_cast<std::size_t>(place.job_class)];
    return place.newcomer ? lane.newcomers : lane.others;
  }

  template <class Rank>
  static auto OfClass(std::size_t i, const Rank& rank) {
    return [i, &rank](const std::string& user) { return rank(user, static_cast<JobClass>(i)); };
  }

  bool LowerClassWaits(std::size_t i) const {
    for (std::size_t j = i + 1; j < kJobClasses; ++j) {
      if (lanes_[j].size() > 0) return true;
    }
    return false;
  }

  // Or from a lower one, if it has nothing or has had its turns.
  template <class Rank>
  std::optional<Item> PopFromClass(std::size_t i, const Rank& rank) {
    if (i == kJobClasses) return std::nullopt;
    Lane& lane = lanes_[i];
    const bool others_wait = LowerClassWaits(i);
    if (others_wait && lane.turns >= kClassTurnsInARow) {
      lane.turns = 0;
      if (auto item = PopFromClass(i + 1, rank)) return item;
    }
    if (auto item = PopFrom(lane, OfClass(i, rank))) {
      lane.turns = others_wait ? lane.turns + 1 : 0;
      return item;
    }
    return PopFromClass(i + 1, rank);
  }

  template <class Rank>
  static std::optional<Item> PopFrom(Lane& lane, const Rank& rank) {
    if (lane.newcomer_turns < kNewcomerTurnsInARow || lane.others.empty()) {
      if (auto item = lane.newcomers.PopLeast(rank)) {
        lane.newcomer_turns = lane.others.empty() ? 0 : lane.newcomer_turns + 1;
        return item;
      }
    }
    lane.newcomer_turns = 0;
    if (auto item = lane.others.PopLeast(rank)) return item;
    return lane.newcomers.PopLeast(rank);
  }

  std::array<Lane, kJobClasses> lanes_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_SCHEDULER_FAIR_QUEUE_H_
