// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_SCHEDULER_USER_QUEUES_H_
#define FLATLIGHT_SERVER_SCHEDULER_USER_QUEUES_H_

#include <algorithm>
#include <cstddef>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace flatlight {

// What waits for its turn: a line for each user, so that the length of one's line is of no concern to another.
template <class Item>
class UserQueues {
 public:
  void Push(const std::string& user, Item item) {
    lines_[user].push_back(std::move(item));
    ++size_;
  }

  // The head of the line of the user whose `rank(user)`, an optional, is least; who has none is passed over.
  template <class Rank>
  std::optional<Item> PopLeast(const Rank& rank) {
    auto least = lines_.end();
    decltype(rank(std::string())) least_rank;
    for (auto line = lines_.begin(); line != lines_.end(); ++line) {
      const auto its_rank = rank(line->first);
      if (its_rank && (!least_rank || *its_rank < *least_rank)) {
        least = line;
        least_rank = its_rank;
      }
    }
    if (least == lines_.end()) return std::nullopt;
    Item item = std::move(least->second.front());
    least->second.pop_front();
    if (least->second.empty()) lines_.erase(least);
    --size_;
    return item;
  }

  // Returns whether it was there.
  bool Remove(const std::string& user, const Item& item) {
    const auto line = lines_.find(user);
    if (line == lines_.end() || std::erase(line->second, item) == 0) return false;
    if (line->second.empty()) lines_.erase(line);
    --size_;
    return true;
  }

  // All that waits, in the order in which turns would come if everybody's came as often as everybody else's, beginning
  // with the user whose `rank(user)` is least, and no one else joined.
  template <class Rank>
  std::vector<Item> InTurn(const Rank& rank) const {
    struct Turn {
      std::size_t round;
      decltype(rank(std::string())) user;
      const Item* item;
    };
    std::vector<Turn> turns;
    turns.reserve(size_);
    for (const auto& [user, line] : lines_) {
      const auto its_rank = rank(user);
      for (std::size_t i = 0; i < line.size(); ++i) turns.push_back({i, its_rank, &line[i]});
    }
    std::ranges::sort(turns, {}, [](const Turn& turn) { return std::tie(turn.round, turn.user); });
    std::vector<Item> items;
    items.reserve(turns.size());
    for (const Turn& turn : turns) items.push_back(*turn.item);
    return items;
  }

  bool empty() const { return size_ == 0; }
  std::size_t size() const { return size_; }

 private:
  std::map<std::string, std::deque<Item>> lines_;  // None of them empty.
  std::size_t size_ = 0;
};

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_SCHEDULER_USER_QUEUES_H_
