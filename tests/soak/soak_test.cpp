// Failures again and again in one process: all are recovered from, and nothing is left behind. Ten cycles each here; more with
//   GFP_SOAK_CYCLES=500 GFP_SOAK_LEDGER=ledger.jsonl soak_test
#include <gtest/gtest.h>

#include <functional>

#include "app/isolated_source.hpp"
#include "app/make_source.hpp"
#include "soak/ledger.hpp"
#ifdef GFP_HAS_BUMBLEBEE
#include "bumblebee/bumblebee_source.hpp"
#include "bumblebee/fake/fake_bumblebee.hpp"
#include "support/gige_lock.hpp"
#endif

namespace gfp {
namespace {

using namespace std::chrono_literals;
using test::Holdings;
using test::Ledger;

constexpr long kRssSlack_kb = 20'000;  // what allocators keep after their first cycles; 500 leaks of a frame would be 300 MB
constexpr double kGivenUp_s = 60;

SensorConfig sensor_with(const std::string& mode, std::uint64_t for_frames) {
  SensorConfig sensor;
  sensor.name = "soak";
  sensor.synthetic.table.objects = 0;
  sensor.synthetic.camera.color = false;
  sensor.synthetic.rate_hz = 100;
  sensor.source.hang_s = mode == "hang" ? 2 : 30;  // a busy machine may not let a process run for a while
  sensor.failure = {mode, 3, for_frames, 0};
  return sensor;
}

/// Grabs until the device is gone; false if it never is.
bool run_until_lost(FrameSource& source) {
  for (int i = 0; i < 100; ++i)
    if (const auto frame = source.grab(40s); !frame && frame.error().code == ErrorCode::kDeviceLost) return true;
  return false;
}

/// Opens until it can be opened, as run_source() would but without a pause, and waits for a frame. Returns the seconds from the opening that worked.
double recover(FrameSource& source) {
  for (int i = 0; i < 100; ++i) {
    source.close();
    const Nanoseconds began = monotonic_now();
    if (!source.open()) continue;
    for (int attempt = 0; attempt < 100; ++attempt)
      if (source.grab(500ms)) return std::chrono::duration<double>(monotonic_now() - began).count();
  }
  ADD_FAILURE() << "it does not come back";
  return 1e9;
}

void soak(const std::string& name, FrameSource& source, const std::function<bool()>& fail, const std::function<void()>& mend = [] {}) {
  Ledger ledger(name);
  Holdings first;
  for (int cycle = 0; cycle < ledger.cycles(); ++cycle) {
    ASSERT_TRUE(fail()) << name << " cycle " << cycle;
    mend();
    const double recovery_s = recover(source);
    const Holdings held = Holdings::now();
    ledger.add(recovery_s, held);
    EXPECT_LT(recovery_s, kGivenUp_s) << name << " cycle " << cycle;  // how long it took is the ledger's to tell: other programs run beside a test
    if (cycle == 1) first = held;  // the first cycle fills caches
    if (cycle < 2) continue;
    EXPECT_EQ(held.descriptors, first.descriptors) << name << " cycle " << cycle;
    EXPECT_LE(held.threads, first.threads) << name << " cycle " << cycle;
    EXPECT_LT(held.rss_kb, first.rss_kb + kRssSlack_kb) << name << " cycle " << cycle;
  }
}

void soak_isolated(const std::string& mode, std::uint64_t for_frames) {
  const SensorConfig sensor = sensor_with(mode, for_frames);
  const auto source = make_isolated_source(sensor, (*make_source(sensor))->info(), GFP_DAEMON_PROGRAM);
  ASSERT_TRUE(source->open());
  soak(mode, *source, [&] { return run_until_lost(*source); });
}

TEST(Soak, Unplugged) {
  auto source = make_source(sensor_with("unplug", 2));
  ASSERT_TRUE(source);
  ASSERT_TRUE((*source)->open());
  soak("unplug", **source, [&] { return run_until_lost(**source); });
}

TEST(Soak, CrashesInAProcessOfItsOwn) { soak_isolated("crash", 1); }

TEST(Soak, HangsInAProcessOfItsOwn) { soak_isolated("hang", 3600); }

#ifdef GFP_HAS_BUMBLEBEE
TEST(Soak, BumblebeeUnpluggedFromTheNetwork) {
  const test::GigeLock lock;
  const std::vector<StereoPair> pictures{{Image<std::uint8_t>(64, 48, 1), Image<std::uint8_t>(64, 48, 2), {}}};
  auto camera = FakeBumblebee::start(pictures);
  ASSERT_TRUE(camera) << camera.error().what;
  BumblebeeOptions options;
  options.device = "Aravis-GFPBB01";
  const auto source = make_bumblebee_source(options, [](const StereoPair&, Frame&) -> Result<void> { return {}; });
  ASSERT_TRUE(source->open());
  const auto unplug = [&] {
    camera->reset();
    for (int i = 0; i < 50; ++i)
      if (!source->grab(200ms)) return true;
    return false;
  };
  const auto plug_in = [&] {
    camera = FakeBumblebee::start(pictures);
    ASSERT_TRUE(camera) << camera.error().what;
  };
  soak("bumblebee", *source, unplug, plug_in);
}
#endif

}  // namespace
}  // namespace gfp
