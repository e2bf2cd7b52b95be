#include "publish/demand.hpp"

#include <gtest/gtest.h>

namespace gfp {
namespace {

std::string said(Demand& demand, const std::string& message) { return demand.update(std::as_bytes(std::span(message))); }

TEST(Demand, APrefixWantsItsTopicsAndNoOthers) {
  Demand demand;
  EXPECT_FALSE(demand.wants("/gfp/scene/"));
  EXPECT_EQ(said(demand, "\1/gfp/sensor/cam1/"), "/gfp/sensor/cam1/");
  EXPECT_TRUE(demand.wants("/gfp/sensor/cam1/depth/"));
  EXPECT_FALSE(demand.wants("/gfp/sensor/cam10/depth/"));  // why topics end in a slash
  EXPECT_FALSE(demand.wants("/gfp/sensor/"));
  EXPECT_TRUE(demand.wants_below("/gfp/sensor/"));
  EXPECT_FALSE(demand.wants_below("/gfp/objects/"));
}

TEST(Demand, TheEmptyPrefixWantsEverything) {
  Demand demand;
  EXPECT_EQ(said(demand, "\1"), "/");
  EXPECT_TRUE(demand.wants("/gfp/objects/5/"));
}

TEST(Demand, UnsubscribingEndsIt) {
  Demand demand;
  said(demand, "\1/a/");
  EXPECT_EQ(said(demand, std::string("\0/a/", 4)), "");
  EXPECT_FALSE(demand.wants("/a/"));
  EXPECT_EQ(demand.size(), 0U);
}

TEST(Demand, NonsenseIsIgnored) {
  Demand demand;
  EXPECT_EQ(said(demand, ""), "");
  EXPECT_EQ(said(demand, "\7/a/"), "");
  EXPECT_EQ(demand.size(), 0U);
}

// A flood of subscriptions costs bounded memory and no subscriber a message.
TEST(Demand, AFloodIsBounded) {
  Demand demand;
  for (int i = 0; i < 20'000; ++i) said(demand, "\1/x/" + std::to_string(i) + "/");
  EXPECT_EQ(demand.size(), 10'000U);
  EXPECT_TRUE(demand.wants("/x/19999/"));
}

}  // namespace
}  // namespace gfp
