// SPDX-License-Identifier: Apache-2.0
#include "server/scheduler/task_queue.h"

#include <gtest/gtest.h>

#include <future>
#include <vector>

namespace flatlight {
namespace {

TEST(TaskQueue, RunsTasksInOrder) {
  std::vector<int> done;
  {
    TaskQueue queue(1, 0);
    for (int i = 0; i < 5; ++i) EXPECT_TRUE(queue.Post(0, [&done, i] { done.push_back(i); }));
  }
  EXPECT_EQ(done, (std::vector<int>{0, 1, 2, 3, 4})) << "what waits is run before the queue goes away";
}

TEST(TaskQueue, RefusesMoreBytesThanMayWait) {
  std::promise<void> started;
  std::promise<void> gate;
  TaskQueue queue(1, 10);
  ASSERT_TRUE(queue.Post(10, [&] {
    started.set_value();
    gate.get_future().wait();
  }));
  started.get_future().wait();  // It no longer waits.
  EXPECT_TRUE(queue.Post(6, [] {}));
  EXPECT_FALSE(queue.Post(5, [] { ADD_FAILURE() << "a refused task ran"; }));
  EXPECT_TRUE(queue.Post(4, [] {}));
  gate.set_value();
}

TEST(TaskQueue, OneLongTaskDoesNotHoldUpTheOtherThread) {
  std::promise<void> gate;
  std::promise<void> other;
  TaskQueue queue(2, 10);
  ASSERT_TRUE(queue.Post(0, [&] { gate.get_future().wait(); }));
  ASSERT_TRUE(queue.Post(0, [&] { other.set_value(); }));
  other.get_future().wait();
  gate.set_value();
}

}  // namespace
}  // namespace flatlight
