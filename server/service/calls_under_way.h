// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_SERVICE_CALLS_UNDER_WAY_H_
#define FLATLIGHT_SERVER_SERVICE_CALLS_UNDER_WAY_H_

#include <atomic>
#include <chrono>
#include <thread>
#include <utility>

namespace flatlight {

// Counts calls, so that a server that goes down knows when the last one has its answer. (gRPC's own shutdown also waits
// for idle connections, whose clients may not be listening.) Every call asks: it costs neither a lock nor memory.
class CallsUnderWay {
 public:
  // A call is under way as long as a copy of its ticket lives. All tickets end before this: also those of calls that
  // AwaitNone did not wait for, whose tasks end with their queues, and those have their answers, which gRPC waits for.
  class Ticket {
   public:
    Ticket(const Ticket& other) : Ticket(other.calls_) {}
    Ticket(Ticket&& other) noexcept : calls_(std::exchange(other.calls_, nullptr)) {}
    Ticket& operator=(const Ticket&) = delete;
    Ticket& operator=(Ticket&&) = delete;
    ~Ticket() {
      if (calls_ != nullptr) --calls_->count_;
    }

   private:
    friend class CallsUnderWay;
    explicit Ticket(CallsUnderWay* calls) : calls_(calls) {
      if (calls_ != nullptr) ++calls_->count_;
    }

    CallsUnderWay* calls_;  // Null: moved away.
  };

  Ticket Enter() { return Ticket(this); }

  // Looks every millisecond: it is done once, and what calls would have to do to wake it they would do each time.
  void AwaitNone(std::chrono::milliseconds at_most) const {
    const auto end = std::chrono::steady_clock::now() + at_most;
    while (count_ > 0 && std::chrono::steady_clock::now() < end) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }

 private:
  std::atomic<int> count_ = 0;
};

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_SERVICE_CALLS_UNDER_WAY_H_
