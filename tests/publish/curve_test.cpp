#include <gtest/gtest.h>

#include <filesystem>

#include "gfp/client/scene_subscriber.hpp"
#include "publish/stage.hpp"

namespace gfp {
namespace {

using namespace std::chrono_literals;
using test::kLong;
using test::numbered_scene;

/// A publisher on tcp behind a key, on ports that the system chooses, with one authorized client.
class Curve : public ::testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(write_curve_key(folder_ / "server", server_));
    std::filesystem::create_directories(folder_ / "authorized");
    authorize("alice", alice_);
    options_.sensor_endpoints = {"ipc://" + (folder_ / "sensor").string()};
    options_.state_endpoints = {"ipc://" + (folder_ / "state").string(), "tcp://127.0.0.1:" + std::to_string(port_)};
    options_.control_endpoints = {"ipc://" + (folder_ / "control").string(), "tcp://127.0.0.1:" + std::to_string(port_ + 1)};
    options_.curve_key = (folder_ / "server.key").string();
    options_.authorized_keys = (folder_ / "authorized").string();
    options_.heartbeat_s = 0.05;
    auto started = Publisher::start(options_, 1);
    ASSERT_TRUE(started.has_value()) << started.error().what;
    publisher_ = std::move(*started);
    publisher_->put(numbered_scene(1));
  }
  void authorize(const std::string& name, const CurveKey& key) { folder_.write("authorized/" + name + ".pub", "public: " + key.public_key + "\n"); }

  /// Whether a client gets a scene. What is refused stays silent: such a client waits for `patience`.
  bool gets_scenes(const std::string& endpoint, const CurveAccess& curve, std::chrono::milliseconds patience) const {
    SubscriberOptions options;
    options.endpoints = {endpoint};
    options.curve = curve;
    auto scenes = SceneSubscriber::connect(options);
    EXPECT_TRUE(scenes.has_value());
    return scenes->next(patience).has_value();
  }
  std::string tcp() const { return options_.state_endpoints[1]; }
  std::uint64_t refused() const {
    auto client = ControlClient::connect({options_.control_endpoints[0], kLong, {}});
    const auto snapshot = client->snapshot("/gfp/status/gfpd/");
    v1::DaemonStatus status;
    EXPECT_TRUE(snapshot && status.ParseFromString(snapshot->topics.at(0).payload));
    return status.refused();
  }

  static constexpr auto kRefusal = 400ms;
  test::TemporaryFolder folder_;
  const CurveKey server_ = new_curve_key(), alice_ = new_curve_key(), mallory_ = new_curve_key();
  const int port_ = 20'000 + 2 * (getpid() % 10'000);
  PublishOptions options_;
  std::unique_ptr<Publisher> publisher_;
};

TEST_F(Curve, AnAuthorizedKeyIsServedOverTcp) {
  EXPECT_TRUE(gets_scenes(tcp(), {server_.public_key, alice_}, kLong));
  EXPECT_TRUE(ControlClient::connect({options_.control_endpoints[1], kLong, {server_.public_key, alice_}})->snapshot().has_value());
}

TEST_F(Curve, LocalSocketsNeedNoKey) { EXPECT_TRUE(gets_scenes(options_.state_endpoints[0], {}, kLong)); }

TEST_F(Curve, WrongAndMissingKeysAreRefused) {
  EXPECT_FALSE(gets_scenes(tcp(), {server_.public_key, mallory_}, kRefusal)) << "a key that is not authorized";
  EXPECT_GE(refused(), 1U);
  EXPECT_FALSE(gets_scenes(tcp(), {}, kRefusal)) << "no key";
  EXPECT_FALSE(gets_scenes(tcp(), {mallory_.public_key, alice_}, kRefusal)) << "another server's key";
  EXPECT_FALSE(gets_scenes(tcp(), {server_.public_key, {alice_.public_key, mallory_.secret_key}}, kRefusal)) << "a stolen public half";
  EXPECT_FALSE(ControlClient::connect({options_.control_endpoints[1], kRefusal, {server_.public_key, mallory_}})->snapshot().has_value());
  EXPECT_TRUE(gets_scenes(tcp(), {server_.public_key, alice_}, kLong)) << "after all of them";
}

TEST_F(Curve, KeysAreAddedAndRevokedWhileItRuns) {
  EXPECT_FALSE(gets_scenes(tcp(), {server_.public_key, mallory_}, kRefusal));
  authorize("bob", mallory_);
  EXPECT_TRUE(gets_scenes(tcp(), {server_.public_key, mallory_}, kLong));  // it goes on knocking until the folder is read again
  std::filesystem::remove(folder_ / "authorized" / "bob.pub");
  const auto deadline = std::chrono::steady_clock::now() + kLong;
  bool is_served = true;
  while (is_served && std::chrono::steady_clock::now() < deadline) is_served = gets_scenes(tcp(), {server_.public_key, mallory_}, kRefusal);
  EXPECT_FALSE(is_served);
}

// Who is shut out hears nothing more on a connection that stood; the others are back within a moment, and local ones never notice.
TEST_F(Curve, ARevokedKeyEndsItsStandingConnection) {
  authorize("bob", mallory_);
  const auto listen = [&](const std::string& endpoint, const CurveAccess& curve) {
    SubscriberOptions options;
    options.endpoints = {endpoint};
    options.curve = curve;
    return std::move(*Subscriber::connect({"/gfp/status/gfpd/"}, options));
  };
  const auto hears = [](Subscriber& subscriber, std::chrono::milliseconds patience) { return subscriber.receive(patience).has_value(); };
  Subscriber bob = listen(tcp(), {server_.public_key, mallory_}), alice = listen(tcp(), {server_.public_key, alice_}), local = listen(options_.state_endpoints[0], {});
  ASSERT_TRUE(hears(bob, kLong) && hears(alice, kLong) && hears(local, kLong));
  std::filesystem::remove(folder_ / "authorized" / "bob.pub");
  const auto deadline = std::chrono::steady_clock::now() + kLong;
  while (hears(bob, kRefusal) && std::chrono::steady_clock::now() < deadline) {  // a status comes every 50 ms
  }
  EXPECT_FALSE(hears(bob, kRefusal));
  while (alice.receive(0ms)) {  // what came before
  }
  EXPECT_TRUE(hears(alice, kLong));
  EXPECT_TRUE(ControlClient::connect({options_.control_endpoints[1], kLong, {server_.public_key, alice_}})->snapshot().has_value());
  while (local.receive(0ms)) {
  }
  EXPECT_TRUE(hears(local, kLong));
  EXPECT_EQ(local.counts().missed, 0U);
  EXPECT_FALSE(hears(bob, kRefusal));
}

TEST(CurveKeys, AreWrittenOnceAndReadBack) {
  const test::TemporaryFolder folder;
  const CurveKey key = new_curve_key();
  ASSERT_TRUE(write_curve_key(folder / "robot", key));
  EXPECT_EQ(std::filesystem::status(folder / "robot.key").permissions(), std::filesystem::perms::owner_read | std::filesystem::perms::owner_write);
  const auto whole = read_curve_key(folder / "robot.key"), half = read_curve_key(folder / "robot.pub");
  ASSERT_TRUE(whole && half);
  EXPECT_EQ(whole->public_key, key.public_key);
  EXPECT_EQ(whole->secret_key, key.secret_key);
  EXPECT_EQ(half->public_key, key.public_key);
  EXPECT_TRUE(half->secret_key.empty());
  EXPECT_EQ(write_curve_key(folder / "robot", new_curve_key()).error().code, ErrorCode::kIo);  // never over another
}

TEST(CurveKeys, BadFilesAreErrorsThatNameThem) {
  const test::TemporaryFolder folder;
  EXPECT_EQ(read_curve_key(folder / "none.key").error().code, ErrorCode::kNotFound);
  for (const std::string text : {"", "public: short\n", "public: \n", "hello"}) {
    const auto key = read_curve_key(folder.write("bad.key", text));
    ASSERT_FALSE(key.has_value()) << text;
    EXPECT_NE(key.error().what.find("bad.key"), std::string::npos);
  }
  EXPECT_EQ(read_curve_key(folder.write("big.key", std::string(100'000, 'x'))).error().code, ErrorCode::kTooLarge);
}

TEST(CurveKeys, ADaemonWithoutItsSecretOrItsFolderDoesNotStart) {
  const test::TemporaryFolder folder;
  PublishOptions options;
  options.curve_key = folder.write("server.pub", "public: " + new_curve_key().public_key + "\n").string();
  options.authorized_keys = folder.path().string();
  EXPECT_NE(Publisher::start(options, 1).error().what.find("only a public key"), std::string::npos);
  ASSERT_TRUE(write_curve_key(folder / "whole", new_curve_key()));
  options.curve_key = (folder / "whole.key").string();
  options.authorized_keys = (folder / "nowhere").string();
  EXPECT_EQ(Publisher::start(options, 1).error().code, ErrorCode::kNotFound);
}

}  // namespace
}  // namespace gfp
