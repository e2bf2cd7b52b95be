#include "publish/inbox.hpp"

#include <gtest/gtest.h>

#include "support/hand_made_scene.hpp"

namespace gfp {
namespace {

ScenePtr scene(std::uint64_t sequence, std::vector<std::uint64_t> lost = {}) {
  auto made = std::make_shared<Scene>(test::hand_made_scene(0));
  made->sequence = sequence;
  made->lost = std::move(lost);
  return made;
}

TEST(Inbox, KeepsTheLatestOfEachKindAndCountsWhatItReplaced) {
  Inbox inbox;
  for (std::uint64_t i = 0; i < 5; ++i) inbox.put(scene(i));
  const auto content = inbox.take();
  ASSERT_EQ(content.scenes.size(), 1U);
  EXPECT_EQ(content.scenes.at("front").value->sequence, 4U);
  EXPECT_EQ(content.scenes.at("front").dropped, 4U);
  EXPECT_TRUE(inbox.take().scenes.empty());
}

// A scene that is replaced takes nothing with it that is told only once.
TEST(Inbox, LostIdsOutliveTheSceneThatToldThem) {
  Inbox inbox;
  inbox.put(scene(1, {5, 6}));
  inbox.put(scene(2, {7}));
  EXPECT_EQ(inbox.take().lost.at("front"), (std::set<std::uint64_t>{5, 6, 7}));
  inbox.put(scene(3, {1, 2}));
  auto back = std::make_shared<Scene>(test::hand_made_scene(1));  // object 1 is there again
  back->lost.clear();
  inbox.put(ScenePtr(back));
  EXPECT_EQ(inbox.take().lost.at("front"), (std::set<std::uint64_t>{2}));
}

TEST(Inbox, TheLogIsBounded) {
  Inbox inbox;
  for (int i = 0; i < 1000; ++i) {
    v1::LogRecord record;
    record.set_text(std::to_string(i));
    inbox.put(std::move(record));
  }
  const auto content = inbox.take();
  EXPECT_EQ(content.log.size(), 256U);
  EXPECT_EQ(content.log.back().text(), "999");
}

}  // namespace
}  // namespace gfp
