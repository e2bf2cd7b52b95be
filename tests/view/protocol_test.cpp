#include "view/protocol.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "gfp/core/random.hpp"

namespace gfp::view {
namespace {

using Json = nlohmann::json;

TEST(Protocol, TheNewerSubprotocolIsChosen) {
  EXPECT_EQ(choose_subprotocol("foxglove.websocket.v1"), "foxglove.websocket.v1");
  EXPECT_EQ(choose_subprotocol("foxglove.websocket.v1, foxglove.sdk.v1"), "foxglove.sdk.v1");
  EXPECT_EQ(choose_subprotocol("chat,foxglove.sdk.v1 "), "foxglove.sdk.v1");
  EXPECT_EQ(choose_subprotocol("foxglove.sdk.v10"), "");
  EXPECT_EQ(choose_subprotocol(""), "");
}

TEST(Protocol, ChannelsCarryTheirSchemaInBase64) {
  const Channel channel{7, "/gfp/scene/", "gfp.v1.Scene", std::string("\0\xff\x10 a", 5)};
  const Json message = Json::parse(advertise(std::span(&channel, 1)));
  EXPECT_EQ(message["op"], "advertise");
  EXPECT_EQ(message["channels"][0]["id"], 7);
  EXPECT_EQ(message["channels"][0]["schema"], "AP8QIGE=");
  for (const auto& [bytes, text] : {std::pair<std::string, std::string>{"M", "TQ=="}, {"Ma", "TWE="}, {"Man", "TWFu"}, {"", ""}}) {  // RFC 4648
    const Channel one{1, "/a/", "A", bytes};
    EXPECT_EQ(Json::parse(advertise(std::span(&one, 1)))["channels"][0]["schema"], text);
  }
}

TEST(Protocol, TheHeaderIsLittleEndian) {
  const std::string header = message_header(0x01020304, 0x1112131415161718);
  EXPECT_EQ(header, std::string("\x01\x04\x03\x02\x01\x18\x17\x16\x15\x14\x13\x12\x11", 13));
}

// Layouts as in the SDK's protocol: opcode, then little-endian fields without gaps.
TEST(Protocol, PlaybackRequestsAreRead) {
  const std::string fixed("\3\1\0\0\0\x3f\1\0\x94\x35\x77\0\0\0\0", 15);  // pause, speed 0.5, seek to 2e9 ns
  const auto request = parse_client_binary(fixed + std::string("\2\0\0\0ab", 6));
  ASSERT_TRUE(request) << request.error().what;
  const auto& playback = std::get<PlaybackRequest>(*request);
  EXPECT_FALSE(playback.play);
  EXPECT_EQ(playback.speed, 0.5);
  EXPECT_EQ(playback.seek, Nanoseconds(2'000'000'000));
  EXPECT_EQ(playback.id, "ab");
  for (std::size_t length = 0; length < fixed.size() + 4; ++length) EXPECT_FALSE(parse_client_binary((fixed + std::string(4, '\0')).substr(0, length))) << length;
  EXPECT_TRUE(parse_client_binary(fixed + std::string(4, '\0')));
  EXPECT_FALSE(parse_client_binary(fixed + std::string("\5\0\0\0ab", 6))) << "an id that is cut off";
  EXPECT_FALSE(parse_client_binary(fixed + std::string("\1\0\0\0ab", 6))) << "an id with more behind it";
  EXPECT_FALSE(parse_client_binary(fixed + std::string("\1\2\0\0", 4) + std::string(513, 'x'))) << "a long id";
  for (const auto& [place, byte] : {std::pair{std::size_t{1}, '\2'}, {std::size_t{0}, '\4'}, {std::size_t{5}, '\xbf'}, {std::size_t{6}, '\2'}, {std::size_t{14}, '\x80'}}) {
    std::string bad = fixed + std::string(4, '\0');  // another command, opcode, a negative speed, a flag of 2, a time beyond 2262
    bad[place] = byte;
    EXPECT_FALSE(parse_client_binary(bad)) << place;
  }
}

TEST(Protocol, PlaybackIsTold) {
  EXPECT_EQ(playback_state({PlaybackStatus::kEnded, Nanoseconds(0x0102030405060708), 2, true, "ab"}),
            std::string("\5\3\x08\x07\x06\x05\x04\x03\x02\x01\0\0\0\x40\1\2\0\0\0ab", 21));
  EXPECT_EQ(time_message(Nanoseconds(0x0102030405060708)), std::string("\2\x08\x07\x06\x05\x04\x03\x02\x01", 9));
  const Json live = Json::parse(server_info("gfpd", 1));
  EXPECT_EQ(live["capabilities"], Json::array());
  EXPECT_FALSE(live.contains("dataStartTime"));
  const Json replay = Json::parse(server_info("gfpd", 1, PlaybackRange{Nanoseconds(1'500'000'000), Nanoseconds(4'000'000'007), true, 0.5}));
  EXPECT_EQ(replay["capabilities"], Json::parse(R"(["time","playbackControl"])"));
  EXPECT_EQ(replay["dataStartTime"], Json::parse(R"({"sec":1,"nsec":500000000})"));
  EXPECT_EQ(replay["dataEndTime"], Json::parse(R"({"sec":4,"nsec":7})"));
  EXPECT_EQ(replay["metadata"]["playback"], "paused");
}

TEST(Protocol, SubscriptionsAreRead) {
  const auto subscribe = parse_client_message(R"({"op":"subscribe","subscriptions":[{"id":1,"channelId":4294967295}]})");
  ASSERT_TRUE(subscribe.has_value());
  EXPECT_EQ(std::get<Subscribe>(*subscribe).items.at(0).channel, 4294967295U);
  const auto unsubscribe = parse_client_message(R"({"op":"unsubscribe","subscriptionIds":[3,4]})");
  EXPECT_EQ(std::get<Unsubscribe>(*unsubscribe).subscriptions, (std::vector<std::uint32_t>{3, 4}));
  EXPECT_EQ(std::get<Other>(*parse_client_message(R"({"op":"setParameters"})")).op, "setParameters");
}

// Whatever a client sends is a message or an error.
TEST(Protocol, HostileTextsAreErrors) {
  for (const std::string text : {"", "{", "[]", "null", R"({"op":1})", R"({"op":"subscribe"})", R"({"op":"subscribe","subscriptions":{}})", R"({"op":"subscribe","subscriptions":[{"id":-1,"channelId":1}]})",
                                 R"({"op":"subscribe","subscriptions":[{"id":1.5,"channelId":1}]})", R"({"op":"unsubscribe","subscriptionIds":["1"]})"})
    EXPECT_FALSE(parse_client_message(text).has_value()) << text;
  EXPECT_EQ(parse_client_message(std::string(100'000, '[')).error().code, ErrorCode::kTooLarge);
  EXPECT_FALSE(parse_client_message(std::string(60'000, '[')).has_value());
  std::string many = R"({"op":"unsubscribe","subscriptionIds":[0)";
  for (int i = 1; i < 2000; ++i) many += ",1";
  EXPECT_FALSE(parse_client_message(many + "]}").has_value());
  Random random(3);
  const std::string valid = R"({"op":"subscribe","subscriptions":[{"id":1,"channelId":2}]})";
  for (int i = 0; i < 5000; ++i) {
    std::string text = valid;
    for (int k = 0; k < 3; ++k) text[random.below(static_cast<std::uint32_t>(text.size()))] = static_cast<char>(random.below(256));
    (void)parse_client_message(text);
  }
}

}  // namespace
}  // namespace gfp::view
