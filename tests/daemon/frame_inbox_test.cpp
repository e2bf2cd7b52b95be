#include "daemon/frame_inbox.hpp"

#include <gtest/gtest.h>

#include <thread>

namespace gfp {
namespace {

FramePtr frame(const std::string& sensor, std::uint64_t sequence, std::int64_t arrived) {
  auto made = std::make_shared<Frame>();
  made->sensor = sensor;
  made->sequence = sequence;
  made->stamps.monotonic = Nanoseconds(arrived);
  return made;
}

TEST(FrameInbox, TakesWhatArrivedFirstAndDropsOnlyWithinASensor) {
  FrameInbox inbox(HandOver::kLatestWins);
  std::stop_source stop;
  inbox.put(frame("a", 0, 30), stop.get_token());
  inbox.put(frame("b", 0, 20), stop.get_token());
  inbox.put(frame("a", 1, 40), stop.get_token());
  EXPECT_EQ((*inbox.take(stop.get_token()))->sensor, "b");
  EXPECT_EQ((*inbox.take(stop.get_token()))->sequence, 1U);
  EXPECT_EQ(inbox.dropped("a"), 1U);
  EXPECT_EQ(inbox.dropped("b"), 0U);
}

TEST(FrameInbox, LosslessWaitsInsteadOfDropping) {
  FrameInbox inbox(HandOver::kLossless);
  std::stop_source stop;
  std::jthread producer([&] {
    for (std::uint64_t i = 0; i < 200; ++i) inbox.put(frame("a", i, static_cast<std::int64_t>(i)), stop.get_token());
  });
  for (std::uint64_t i = 0; i < 200; ++i) ASSERT_EQ((*inbox.take(stop.get_token()))->sequence, i);
  EXPECT_EQ(inbox.dropped("a"), 0U);
}

// However fast each of them is: what comes out is in the order of their stamps, until one has ended.
TEST(FrameInbox, LosslessMergesSensorsByTheirStamps) {
  FrameInbox inbox(HandOver::kLossless);
  std::stop_source stop;
  inbox.expect("fast");
  inbox.expect("slow");
  const auto produce = [&](const std::string& sensor, std::int64_t first, std::int64_t every, std::uint64_t count, std::chrono::microseconds pause) {
    for (std::uint64_t i = 0; i < count; ++i) {
      auto made = std::make_shared<Frame>(*frame(sensor, i, 0));
      made->stamps.sensor = Nanoseconds(first + every * static_cast<std::int64_t>(i));
      inbox.put(made, stop.get_token());
      std::this_thread::sleep_for(pause);
    }
    inbox.finished(sensor);
  };
  std::jthread fast([&] { produce("fast", 0, 10, 30, std::chrono::microseconds(0)); }), slow([&] { produce("slow", 5, 20, 10, std::chrono::microseconds(500)); });
  Nanoseconds last{-1};
  for (int i = 0; i < 40; ++i) {
    const auto taken = inbox.take(stop.get_token());
    EXPECT_GT((*taken)->stamps.sensor, last) << "frame " << i;
    last = (*taken)->stamps.sensor;
  }
}

TEST(FrameInbox, StopEndsEveryWait) {
  FrameInbox inbox(HandOver::kLossless);
  std::stop_source stop;
  std::optional<FramePtr> taken;
  std::jthread consumer([&] { taken = inbox.take(stop.get_token()); });
  stop.request_stop();
  consumer.join();
  EXPECT_FALSE(taken.has_value());
  inbox.put(frame("a", 0, 0), stop.get_token());  // returns
  inbox.put(frame("a", 1, 0), stop.get_token());
}

}  // namespace
}  // namespace gfp
