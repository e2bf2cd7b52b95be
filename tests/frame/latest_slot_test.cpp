#include "gfp/frame/latest_slot.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <thread>
#include <vector>

namespace gfp {
namespace {

TEST(LatestSlot, NewerValueReplacesTheOlderAndIsCounted) {
  LatestSlot<int> slot;
  EXPECT_TRUE(slot.put(1));
  EXPECT_TRUE(slot.put(2));
  EXPECT_TRUE(slot.put(3));
  EXPECT_EQ(slot.take(), 3);
  EXPECT_EQ(slot.dropped(), 2U);
  EXPECT_FALSE(slot.try_take().has_value());
}

TEST(LatestSlot, HandsOutWhatIsLeftAfterClosingThenNothing) {
  LatestSlot<int> slot;
  slot.put(7);
  slot.close();
  EXPECT_FALSE(slot.finished());
  EXPECT_FALSE(slot.put(8));
  EXPECT_EQ(slot.take(), 7);
  EXPECT_FALSE(slot.take().has_value());
  EXPECT_TRUE(slot.finished());
}

TEST(LatestSlot, CarriesValuesThatCanOnlyBeMoved) {
  LatestSlot<std::unique_ptr<int>> slot;
  slot.put(std::make_unique<int>(5));
  EXPECT_EQ(**slot.take(), 5);
}

TEST(LatestSlot, StopWakesAWaitingTaker) {
  LatestSlot<int> slot;
  bool got_value = true;
  std::jthread taker([&](const std::stop_token& stop) { got_value = slot.take(stop).has_value(); });
  taker.request_stop();
  taker.join();
  EXPECT_FALSE(got_value);
}

TEST(LatestSlot, StopWakesAWaitingLosslessPutter) {
  LatestSlot<int> slot(HandOver::kLossless);
  ASSERT_TRUE(slot.put(1));
  bool put = true;
  std::jthread putter([&](const std::stop_token& stop) { put = slot.put(2, stop); });
  putter.request_stop();
  putter.join();
  EXPECT_FALSE(put);
  EXPECT_EQ(slot.take(), 1);  // the value that was there is not lost
}

TEST(LatestSlot, LosslessHandsOverEveryValueInOrder) {
  LatestSlot<int> slot(HandOver::kLossless);
  constexpr int kCount = 2000;
  std::jthread putter([&] {
    for (int i = 0; i < kCount; ++i) slot.put(i);
    slot.close();
  });
  std::vector<int> taken;
  while (const auto value = slot.take()) taken.push_back(*value);
  ASSERT_EQ(taken.size(), static_cast<std::size_t>(kCount));
  for (int i = 0; i < kCount; ++i) EXPECT_EQ(taken[static_cast<std::size_t>(i)], i);
  EXPECT_EQ(slot.dropped(), 0U);
}

// With latest-wins, taken + dropped must account for every value, and what is taken never goes back in time.
TEST(LatestSlot, AccountsForEveryValueUnderContention) {
  LatestSlot<int> slot;
  constexpr int kCount = 20000;
  std::jthread putter([&] {
    for (int i = 0; i < kCount; ++i) slot.put(i);
    slot.close();
  });
  int last = -1, taken = 0;
  while (const auto value = slot.take()) {
    EXPECT_GT(*value, last);
    last = *value;
    ++taken;
  }
  EXPECT_EQ(last, kCount - 1);
  EXPECT_EQ(taken + static_cast<int>(slot.dropped()), kCount);
}

}  // namespace
}  // namespace gfp
