// SPDX-License-Identifier: Apache-2.0
#include "server/scheduler/fair_queue.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flatlight {
namespace {

using ::testing::ElementsAre;

// By name, if there is no other reason.
std::optional<std::string> ByName(const std::string& user, JobClass) { return user; }

std::vector<std::string> PopAll(FairQueue<std::string>& queue, std::size_t count = 1000) {
  std::vector<std::string> items;
  while (items.size() < count) {
    auto item = queue.Pop(ByName);
    if (!item) break;
    items.push_back(*std::move(item));
  }
  return items;
}

TEST(FairQueueTest, ByClassThenNewcomersThenRankThenArrival) {
  FairQueue<std::string> queue;
  queue.Push({JobClass::kRegrade, "ada", true}, "regrade");
  queue.Push({JobClass::kGraded, "ada", true}, "graded");
  queue.Push({JobClass::kInteractive, "bob", false}, "bob 1");
  queue.Push({JobClass::kInteractive, "ada", false}, "ada 1");
  queue.Push({JobClass::kInteractive, "ada", false}, "ada 2");
  queue.Push({JobClass::kInteractive, "bob", true}, "bob new");
  EXPECT_THAT(PopAll(queue), ElementsAre("bob new", "ada 1", "ada 2", "bob 1", "graded", "regrade"));
  EXPECT_TRUE(queue.empty());
}

TEST(FairQueueTest, LowerClassesGetOneTurnInEight) {
  FairQueue<std::string> queue;
  for (int i = 0; i < 16; ++i) queue.Push({JobClass::kInteractive, "ada", false}, "i");
  queue.Push({JobClass::kGraded, "ada", false}, "g");
  queue.Push({JobClass::kRegrade, "ada", false}, "r");
  const std::vector<std::string> order = PopAll(queue);
  EXPECT_EQ(std::ranges::find(order, "g") - order.begin(), 7);
  EXPECT_EQ(std::ranges::find(order, "r") - order.begin(), 15);
  EXPECT_EQ(order.size(), 18u);
}

TEST(FairQueueTest, EvenTheLowestClassGetsATurnWhileTheMiddleOneHasWork) {
  FairQueue<std::string> queue;
  for (int i = 0; i < 200; ++i) {
    queue.Push({JobClass::kInteractive, "ada", false}, "i");
    queue.Push({JobClass::kGraded, "ada", false}, "g");
  }
  queue.Push({JobClass::kRegrade, "ada", false}, "r");
  const std::vector<std::string> order = PopAll(queue);
  EXPECT_LE(std::ranges::find(order, "r") - order.begin(), 64);
}

TEST(FairQueueTest, NewcomersDoNotStopTheOthers) {
  FairQueue<std::string> queue;
  for (int i = 0; i < 8; ++i) queue.Push({JobClass::kInteractive, "ada", true}, "new");
  queue.Push({JobClass::kInteractive, "bob", false}, "old");
  const std::vector<std::string> order = PopAll(queue);
  EXPECT_EQ(std::ranges::find(order, "old") - order.begin(), 4);
}

TEST(FairQueueTest, WhoHasNoRankIsPassedOver) {
  FairQueue<std::string> queue;
  queue.Push({JobClass::kInteractive, "ada", false}, "ada");
  queue.Push({JobClass::kGraded, "bob", false}, "bob");
  const auto not_ada = [](const std::string& user, JobClass) {
    return user == "ada" ? std::nullopt : std::optional<std::string>(user);
  };
  EXPECT_EQ(queue.Pop(not_ada), "bob");
  EXPECT_EQ(queue.Pop(not_ada), std::nullopt);
  EXPECT_EQ(queue.size(), 1u);
}

TEST(FairQueueTest, TellsTheOrderOfTurns) {
  FairQueue<std::string> queue;
  for (const char* item : {"bob 1", "bob 2", "bob 3"}) queue.Push({JobClass::kInteractive, "bob", false}, item);
  for (const char* item : {"ada 1", "ada 2"}) queue.Push({JobClass::kInteractive, "ada", false}, item);
  queue.Push({JobClass::kGraded, "ada", false}, "graded");
  EXPECT_THAT(queue.InTurn(ByName), ElementsAre("ada 1", "bob 1", "ada 2", "bob 2", "bob 3", "graded"));
  EXPECT_EQ(queue.size(), 6u);
}

TEST(FairQueueTest, WhatIsRemovedIsGone) {
  FairQueue<std::string> queue;
  queue.Push({JobClass::kInteractive, "ada", false}, "1");
  queue.Push({JobClass::kInteractive, "ada", false}, "2");
  EXPECT_TRUE(queue.Remove({JobClass::kInteractive, "ada", false}, "1"));
  EXPECT_FALSE(queue.Remove({JobClass::kInteractive, "ada", false}, "1"));
  EXPECT_THAT(PopAll(queue), ElementsAre("2"));
}

}  // namespace
}  // namespace flatlight
