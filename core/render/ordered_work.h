// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_RENDER_ORDERED_WORK_H_
#define FLATLIGHT_CORE_RENDER_ORDERED_WORK_H_

#include <cstddef>
#include <functional>

#include "core/execution/cancellation.h"
#include "core/execution/clock.h"
#include "core/execution/executor.h"

namespace flatlight {

// Items that are worked on one after the other, many at once: cut into shards of about a millisecond. Which ones share
// a shard leaves no trace in results.
class OrderedWork {
 public:
  // Works on the items [first, last); false if it was cancelled before the end.
  using Work = std::function<bool(std::size_t first, std::size_t last)>;

  explicit OrderedWork(std::size_t items) : items_(items) {}

  bool done() const { return done_items_ == items_; }
  std::size_t done_items() const { return done_items_; }  // From the first on.
  double fraction() const { return done() ? 1 : static_cast<double>(done_items_) / static_cast<double>(items_); }
  double seconds() const { return seconds_; }  // Spent so far.
  void Finish() { done_items_ = items_; }

  // For a stream of states.
  template <class Self, class Stream>
  static void State(Self& self, Stream& stream) {
    stream(self.done_items_, self.seconds_);
    stream.Require(self.done_items_ <= self.items_);
  }

  // For about `budget`, until done or cancelled.
  void Advance(Executor& executor, int max_threads, const Cancellation& cancellation, const Clock& clock,
               Clock::Duration budget, const Work& work);

 private:
  std::size_t items_;
  std::size_t done_items_ = 0;
  double items_per_shard_ = 1;  // Measured.
  double seconds_ = 0;
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_RENDER_ORDERED_WORK_H_
