#include "view/client_queue.hpp"

#include <gtest/gtest.h>

#include "gfp/core/random.hpp"

namespace gfp::view {
namespace {

using Class = ClientQueue::Class;

ClientQueue::Message message(std::uint32_t subscription, std::size_t bytes) { return {subscription, 0, std::make_shared<const std::string>(bytes, 'x')}; }

TEST(ClientQueue, TheNewestOfASlotReplacesTheOneBefore) {
  ClientQueue queue(1000);
  EXPECT_FALSE(queue.put(Class::kSensor, 1, "", message(1, 100)));
  EXPECT_FALSE(queue.put(Class::kSensor, 1, "", message(2, 60)));
  EXPECT_EQ(queue.bytes(), 60U);
  EXPECT_EQ(queue.replaced(), 1U);
  EXPECT_EQ(queue.take()->subscription, 2U);
  EXPECT_FALSE(queue.take().has_value());
  EXPECT_EQ(queue.bytes(), 0U);
}

TEST(ClientQueue, StateGoesBeforeImagesAndKeysDoNotReplaceEachOther) {
  ClientQueue queue(1000);
  queue.put(Class::kSensor, 1, "", message(1, 10));
  queue.put(Class::kState, 2, "a", message(2, 10));
  queue.put(Class::kState, 2, "b", message(3, 10));
  for (const std::uint32_t expected : {2U, 3U, 1U}) EXPECT_EQ(queue.take()->subscription, expected);
}

// A fast channel keeps its turn when it is replaced: a slow one behind it still comes.
TEST(ClientQueue, NobodyStarves) {
  ClientQueue queue(1000);
  queue.put(Class::kSensor, 1, "", message(1, 10));
  queue.put(Class::kSensor, 2, "", message(2, 10));
  queue.put(Class::kSensor, 1, "", message(3, 10));
  EXPECT_EQ(queue.take()->subscription, 3U);
  queue.put(Class::kSensor, 1, "", message(4, 10));
  EXPECT_EQ(queue.take()->subscription, 2U);
}

TEST(ClientQueue, ImagesMakeRoomForState) {
  ClientQueue queue(100);
  queue.put(Class::kSensor, 1, "", message(1, 80));
  EXPECT_TRUE(queue.put(Class::kState, 2, "", message(2, 90)));
  EXPECT_EQ(queue.take()->subscription, 2U);
  EXPECT_FALSE(queue.take().has_value());
  EXPECT_TRUE(queue.put(Class::kState, 2, "", message(3, 101)));  // larger than all of it
  EXPECT_FALSE(queue.take().has_value());
}

// Whatever is put, what waits is bounded and adds up.
TEST(ClientQueue, BytesAreBoundedAndAddUp) {
  Random random(11);
  ClientQueue queue(5000);
  for (int i = 0; i < 20'000; ++i) {
    if (random.below(4) == 0) (void)queue.take();
    else queue.put(random.below(2) == 0 ? Class::kState : Class::kSensor, random.below(6), std::to_string(random.below(3)), message(1, random.below(1500)));
    if (random.below(50) == 0) queue.forget(random.below(6));
    ASSERT_LE(queue.bytes(), 5000U);
  }
  std::size_t left = queue.bytes();
  while (const auto next = queue.take()) left -= next->payload->size();
  EXPECT_EQ(left, 0U);
}

}  // namespace
}  // namespace gfp::view
