// Sensors fail again and again in one process, as they run in the daemon (run_source, default options): each time frames come again, and nothing is left behind.
// Ten cycles each here; more with
//   GFP_SOAK_CYCLES=500 GFP_SOAK_LEDGER=ledger.jsonl soak_test
// which goes on where the ledger ends.
#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <cstdlib>
#include <functional>
#include <thread>

#include "app/isolated_source.hpp"
#include "app/make_source.hpp"
#include "gfp/core/mutex.hpp"
#include "soak/holdings.hpp"
#include "support/fakenect_folder.hpp"
#include "support/soak_ledger.hpp"
#include "synthetic/synthetic_source.hpp"
#ifdef GFP_HAS_BUMBLEBEE
#include "bumblebee/bumblebee_source.hpp"
#include "bumblebee/fake/fake_bumblebee.hpp"
#include "support/gige_lock.hpp"
#endif
#ifdef GFP_OPENNI2_LIBRARY
#include "openni2/openni2_source.hpp"
#endif

namespace gfp {
namespace {

using namespace std::chrono_literals;
using test::Holdings;
using test::SoakLedger;
using test::Trial;

constexpr long kRssSlack_kb = 20'000;  // what allocators keep after their first cycles; 500 leaks of a frame would be 300 MB
constexpr Nanoseconds kGivenUp = 60s;
constexpr std::uint64_t kCycles = 10;

/// A source whose cable can be pulled.
class Unpluggable final : public FrameSource {
 public:
  Unpluggable(std::unique_ptr<FrameSource> source, const std::atomic<bool>& plugged) : source_(std::move(source)), plugged_(plugged) {}
  SourceInfo info() const override { return source_->info(); }
  Result<void> open() override { return plugged_ ? source_->open() : gone(); }
  Result<Frame> grab(std::chrono::milliseconds timeout) override {
    if (!plugged_) return tl::unexpected<Error>(gone().error());
    return source_->grab(timeout);
  }
  void close() noexcept override { source_->close(); }

 private:
  static Result<void> gone() { return failure(ErrorCode::kDeviceLost, "unplugged"); }
  const std::unique_ptr<FrameSource> source_;
  const std::atomic<bool>& plugged_;
};

/// A source at work as in the daemon.
class Runner {
 public:
  explicit Runner(FrameSource& source, const SourceOptions& options = {})
      : taker_([this](const std::stop_token& stop) {
          while (slot_.take(stop)) continue;
        }),
        driver_([this, &source, options](const std::stop_token& stop) { run_source(source, slot_, options, stop, [this](const SourceStatus& status) { note(status); }); }) {}

  /// Seconds until the next time, counted from those seen before, that it is lost, or streams; negative: it is not.
  double until_lost() { return until(losses_, seen_losses_); }
  double until_streaming() { return until(streams_, seen_streams_); }
  std::string what() const {
    MutexLock lock(mutex_);
    return what_;
  }

 private:
  static double until(const std::atomic<int>& count, int& seen) {
    const Nanoseconds began = monotonic_now();
    while (count <= seen) {
      if (monotonic_now() - began > kGivenUp) return -1;
      std::this_thread::sleep_for(1ms);  // polling
    }
    ++seen;
    return std::chrono::duration<double>(monotonic_now() - began).count();
  }
  void note(const SourceStatus& status) {
    MutexLock lock(mutex_);
    if (status.last_error) what_ = status.last_error->what;
    const bool lost = status.state == SourceState::kLost, streams = status.state == SourceState::kStreaming;
    if (lost && !lost_) ++losses_;
    if (streams && lost_) ++streams_;
    if (lost || streams) lost_ = lost;
  }

  LatestSlot<FramePtr> slot_;
  std::atomic<int> losses_{0}, streams_{0};
  int seen_losses_ = 0, seen_streams_ = 0;
  mutable Mutex mutex_;
  std::string what_ GFP_GUARDED_BY(mutex_);
  bool lost_ GFP_GUARDED_BY(mutex_) = true;  ///< Of the two states that it goes to and fro between.
  std::jthread taker_, driver_;
};

/// `fail`, lost, `mend`, frames again. The ledger holds the time from `mend` to the first frame. `left_open`: descriptors that a library leaves open each time.
void soak(const std::string& name, FrameSource& source, const std::function<void()>& fail = [] {}, const std::function<void()>& mend = [] {}, const SourceOptions& options = {}, int left_open = 0) {
  const char* const cycles = std::getenv("GFP_SOAK_CYCLES");
  const char* const file = std::getenv("GFP_SOAK_LEDGER");
  Holdings first;
  int cycle = 0;  // of this process
  Runner runner(source, options);
  ASSERT_GE(runner.until_streaming(), 0) << name << ": " << runner.what();
  const auto one_cycle = [&](std::uint64_t) -> Trial {
    fail();
    if (runner.until_lost() < 0) return {"it was not lost", {}};
    mend();
    const double recovery_s = runner.until_streaming();
    if (recovery_s < 0) return {runner.what(), {}};  // how long it took is the ledger's to tell: other programs run beside a test
    Holdings held = Holdings::now();
    for (const Nanoseconds began = monotonic_now(); cycle > 1 && held.threads > first.threads && monotonic_now() - began < kGivenUp; held = Holdings::now()) std::this_thread::sleep_for(1ms);  // polling: a library's threads are on their way out
    if (cycle == 1) first = held;  // the first cycle fills caches
    if (cycle > 1) {
      EXPECT_LE(held.descriptors, first.descriptors + 1 + left_open * (cycle - 1)) << name << " cycle " << cycle;
      EXPECT_LE(held.threads, first.threads) << name << " cycle " << cycle;
      EXPECT_LT(held.rss_kb, first.rss_kb + kRssSlack_kb) << name << " cycle " << cycle;
    }
    ++cycle;
    Trial trial;
    trial.measured("recovery_s", recovery_s);
    trial.measured("rss_kb", held.rss_kb);
    trial.measured("threads", held.threads);
    trial.measured("descriptors", held.descriptors);
    trial.measured("pid", getpid());
    return trial;
  };
  EXPECT_TRUE(SoakLedger(file != nullptr ? file : "").run(name, cycles != nullptr ? std::strtoull(cycles, nullptr, 10) : kCycles, one_cycle, 1)) << name << " cycle " << cycle;
}

void soak_cable(const std::string& name, const std::function<std::unique_ptr<FrameSource>()>& make, int left_open = 0) {
  std::atomic<bool> plugged{true};
  Unpluggable source(make(), plugged);
  soak(name, source, [&] { plugged = false; }, [&] { plugged = true; }, {}, left_open);
}

SensorConfig synthetic() {
  SensorConfig sensor;
  sensor.name = "soak";
  sensor.synthetic.table.objects = 0;
  sensor.synthetic.camera.color = false;
  return sensor;
}

void soak_isolated(const std::string& mode, std::uint64_t for_frames) {
  SensorConfig sensor = synthetic();
  const bool for_the_figure = std::getenv("GFP_SOAK_LEDGER") != nullptr;
  sensor.source.hang_s = mode != "hang" ? 30 : for_the_figure ? 0 : 3;  // a busy machine may not let a process run for a while
  sensor.failure = {mode, 10, for_frames, 0};
  const auto source = make_isolated_source(sensor, (*make_source(sensor))->info(), GFP_DAEMON_PROGRAM);
  soak(mode, *source);
}

TEST(Soak, SyntheticUnplugged) {
  soak_cable("synthetic", [] { return std::move(*make_source(synthetic())); });
}

TEST(Soak, CrashesInAProcessOfItsOwn) { soak_isolated("crash", 1); }

TEST(Soak, HangsInAProcessOfItsOwn) { soak_isolated("hang", 3600); }

#ifdef GFP_HAS_FREENECT
TEST(Soak, KinectUnplugged) {
  const auto folder = std::filesystem::path(::testing::TempDir()) / "soak_fakenect";
  SyntheticOptions options = synthetic().synthetic;
  options.frames = 600;
  options.rate_hz = 0;
  SyntheticSource scene(options);
  std::vector<Frame> frames;
  for (auto frame = scene.grab(1s); frame && frames.size() < 60; frame = scene.grab(1s)) frames.push_back(std::move(*frame));
  test::write_fakenect_folder(folder, frames);
  const auto make = [&] {
    SensorConfig sensor;
    sensor.driver = "freenect";
    sensor.input = folder.string();
    return std::move(*make_source(sensor));
  };
  soak_cable("freenect", make, 1);  // fakenect never closes its INDEX.txt; libfreenect has none
  std::filesystem::remove_all(folder);
}
#endif

#ifdef GFP_OPENNI2_LIBRARY
// The device says itself that it is gone.
TEST(Soak, OpenNi2Unplugged) {
  OpenNi2Options options;
  options.library = GFP_OPENNI2_LIBRARY;
  options.uri = "gfp-synthetic:objects=0,unplug_after=5";
  const auto source = make_openni2_source(options);
  soak("openni2", *source);
}
#endif

#ifdef GFP_HAS_BUMBLEBEE
TEST(Soak, BumblebeeUnplugged) {
  const test::GigeLock lock;
  const std::vector<StereoPair> pictures{{Image<std::uint8_t>(64, 48, 1), Image<std::uint8_t>(64, 48, 2), {}}};
  auto camera = FakeBumblebee::start(pictures);
  ASSERT_TRUE(camera) << camera.error().what;
  BumblebeeOptions options;
  options.device = "Aravis-GFPBB01";
  const auto source = make_bumblebee_source(options, [](const StereoPair&, Frame&) -> Result<void> { return {}; });
  SourceOptions run;
  run.health.stuck_frames = 0;
  soak("bumblebee", *source, [&] { camera->reset(); }, [&] { camera = FakeBumblebee::start(pictures); }, run);
}
#endif

}  // namespace
}  // namespace gfp
