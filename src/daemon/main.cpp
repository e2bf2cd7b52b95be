// gfpd: from cameras to graspable objects, for whoever subscribes. SIGTERM and SIGINT drain and end, SIGHUP reloads, SIGUSR1
// triggers the recording ring.
#include <csignal>

#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <random>
#include <utility>

#include "app/builtin_library.hpp"
#include "app/driver_channel.hpp"
#include "app/make_source.hpp"
#include "cli/exit_code.hpp"
#include "daemon/daemon.hpp"
#include "daemon/logging.hpp"
#include "daemon/service_manager.hpp"
#include "gfp/core/mutex.hpp"
#include "gfp/core/version.hpp"
#include "view/access.hpp"
#include "view/view.hpp"
#include <spdlog/spdlog.h>

namespace {

struct Arguments {
  std::string config;
  std::vector<std::string> settings;
  bool insecure = false;
  bool driver_child = false;
};

gfp::Result<gfp::DaemonOptions> load(const Arguments& arguments) {
  std::vector<std::string> settings = arguments.settings;
  if (arguments.insecure) settings.insert(settings.begin(), "publish.insecure=true");
  auto options = gfp::config::load_daemon_options(arguments.config, settings);
  if (!options) return options;
  if (gfp::Result<void> valid = gfp::validate(options->pipeline); !valid) return tl::unexpected(valid.error());
  if (gfp::Result<void> valid = gfp::view::validate(options->view); !valid) return tl::unexpected(valid.error());
  return options;
}

std::uint64_t new_session() {
  std::random_device device;
  return (static_cast<std::uint64_t>(device()) << 32) | device();
}

/// The primitives that frames are processed with: those of the last good configuration, from the next frame on. Safe from any thread.
class LiveLibrary {
 public:
  explicit LiveLibrary(gfp::PrimitiveLibrary library) { store(std::move(library)); }
  void store(gfp::PrimitiveLibrary library) {
    auto shared = std::make_shared<const gfp::PrimitiveLibrary>(std::move(library));
    const gfp::MutexLock lock(mutex_);
    library_ = std::move(shared);
  }
  std::shared_ptr<const gfp::PrimitiveLibrary> load() const {
    const gfp::MutexLock lock(mutex_);
    return library_;
  }

 private:
  mutable gfp::Mutex mutex_;
  std::shared_ptr<const gfp::PrimitiveLibrary> library_ GFP_GUARDED_BY(mutex_);  ///< Shared with the frame under way.
};

/// One recording has one time line; where several are played, or one in a process of its own, nobody steers them.
bool is_steerable(const gfp::SensorConfig& sensor) { return sensor.driver == "replay" && sensor.input.ends_with(".mcap") && sensor.isolation == "none"; }

std::shared_ptr<gfp::ReplayControl> playback_of(const gfp::DaemonOptions& options) {
  const bool is_replay = options.view.enabled && options.sensors.size() == 1 && is_steerable(options.sensors[0]);
  if (!is_replay) return nullptr;
  auto playback = std::make_shared<gfp::ReplayControl>();
  playback->hold_at_end();
  return playback;
}

/// `playback`: of the recording that is played; may be empty.
gfp::DaemonParts parts(const LiveLibrary& live, std::shared_ptr<gfp::ReplayControl> playback) {
  return {[playback = std::move(playback)](gfp::SensorConfig sensor) {
            if (playback && is_steerable(sensor)) {
              sensor.replay.control = playback;
              sensor.replay.recorded_time = true;
            }
            return gfp::make_source(sensor);
          },
          [&live](const gfp::Frame& frame, const gfp::SceneMemory& memory, const gfp::PipelineOptions& options) {
            const auto library = live.load();
            return gfp::process_frame(frame, memory, *library, options);
          },
          [&live](const gfp::Scene& scene, const gfp::SceneMemory& memory, const gfp::PipelineOptions& options, gfp::ShadowMemory& kept) {
            const auto library = live.load();
            return gfp::shadow_scene(scene, memory, *library, options, kept);
          }};
}

void reload(gfp::Daemon& daemon, LiveLibrary& library, const Arguments& arguments) {
  gfp::tell_reloading();
  const auto options = load(arguments);
  if (!options) return spdlog::error("reload: the old configuration stays: {}", options.error().what);
  auto primitives = gfp::library_of_configuration(options->primitives, options->upsampling, arguments.config);
  if (!primitives) return spdlog::error("reload: the old configuration stays: {}", primitives.error().what);
  if (const auto done = daemon.reload(*options); !done) return spdlog::error("reload: the old configuration stays: {}", done.error().what);
  library.store(std::move(*primitives));
  spdlog::info("reloaded {}", arguments.config);
}

/// Until SIGTERM or SIGINT.
void serve(gfp::Daemon& daemon, LiveLibrary& library, const Arguments& arguments, const sigset_t& signals) {
  gfp::Nanoseconds next_tick = gfp::monotonic_now();
  while (true) {
    const gfp::Nanoseconds now = gfp::monotonic_now();
    if (now >= next_tick) {
      daemon.tick();
      if (daemon.is_responsive()) gfp::tell_service_manager("WATCHDOG=1");
      next_tick = now + std::chrono::seconds(1);
    }
    const auto left = std::max(gfp::Nanoseconds(1'000'000), next_tick - gfp::monotonic_now());
    const timespec wait{static_cast<time_t>(left.count() / 1'000'000'000), static_cast<long>(left.count() % 1'000'000'000)};
    const int signal = sigtimedwait(&signals, nullptr, &wait);
    if (signal == SIGHUP) {
      reload(daemon, library, arguments);
      gfp::tell_service_manager("READY=1");
    }
    if (signal == SIGUSR1 && daemon.recorder() != nullptr) daemon.recorder()->trigger();
    if (signal == SIGTERM || signal == SIGINT) return spdlog::info("stopping on signal {}", signal);
  }
}

/// Robots live without a view: where it cannot be served, that is said and the daemon goes on.
std::unique_ptr<gfp::View> start_view(const gfp::DaemonOptions& options, std::uint64_t session, gfp::Publisher& publisher, std::shared_ptr<gfp::ReplayControl> playback) {
  auto view = gfp::View::start(options.view, session, std::move(playback));
  if (!view) return spdlog::warn("no view: {}", view.error().what), nullptr;
  publisher.mirror(&(*view)->inbox());
  spdlog::info("the view is at http://{}:{}/", options.view.address, (*view)->port());
  return std::move(*view);
}

int run(const Arguments& arguments) {
  const auto options = load(arguments);
  if (!options) {
    std::cerr << "gfpd: " << options.error().what << "\n";
    return options.error().code == gfp::ErrorCode::kNotFound ? gfp::kExitNoInput : gfp::kExitConfig;
  }
  if (const auto logging = gfp::start_logging(options->log); !logging) {
    std::cerr << "gfpd: " << logging.error().what << "\n";
    return gfp::kExitCannotCreate;
  }
  // Blocked before the first thread starts, so that every thread inherits it and only serve() gets signals.
  sigset_t signals;
  sigemptyset(&signals);
  for (const int signal : {SIGTERM, SIGINT, SIGHUP, SIGUSR1}) sigaddset(&signals, signal);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);

  auto primitives = gfp::library_of_configuration(options->primitives, options->upsampling, arguments.config);
  if (!primitives) {
    std::cerr << "gfpd: " << primitives.error().what << "\n";
    return gfp::kExitConfig;
  }
  LiveLibrary library(std::move(*primitives));  // it outlives the daemon, whose pipeline reads it
  const std::uint64_t session = new_session();
  const auto playback = playback_of(*options);
  std::unique_ptr<gfp::View> view;  // it outlives the daemon, whose threads put into it
  auto daemon = gfp::Daemon::start(*options, parts(library, playback), session);
  if (!daemon) {
    spdlog::error("{}", daemon.error().what);
    return daemon.error().code == gfp::ErrorCode::kInvalidArgument ? gfp::kExitConfig : gfp::kExitUnavailable;
  }
  gfp::publish_log_to(&(*daemon)->publisher());
  if (options->view.enabled) view = start_view(*options, session, (*daemon)->publisher(), playback);
  spdlog::info("gfpd {} serves {} sensor(s)", gfp::version(), options->sensors.size());
  gfp::tell_service_manager("READY=1");
  serve(**daemon, library, arguments, signals);
  gfp::tell_service_manager("STOPPING=1");
  gfp::publish_log_to(nullptr);
  (*daemon)->stop();
  spdlog::info("stopped");
  return gfp::kExitOk;
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  CLI::App app{"Turns depth cameras into closed, graspable object models and publishes them", "gfpd"};
  app.set_version_flag("--version", "gfpd " + std::string(gfp::version()));
  app.add_option("--config", arguments.config, "Configuration file (YAML); see config/default.yaml for every option");
  app.add_option("--set", arguments.settings, "Overrides one option: path.to.key=value; may be repeated")->take_all();
  app.add_flag("--insecure", arguments.insecure, "Allows tcp endpoints, which are neither encrypted nor authenticated");
  app.add_flag("--driver-child", arguments.driver_child, "For gfpd itself: be the process of one isolated driver")->group("");
  app.footer("SIGTERM and SIGINT end it after the last state was sent; SIGHUP reloads the configuration; SIGUSR1 makes a file of what a recording ring holds.");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? gfp::kExitOk : gfp::kExitUsage;
  }
  try {
    return arguments.driver_child ? gfp::run_driver_child() : run(arguments);
  } catch (const std::exception& error) {
    std::cerr << "gfpd: " << error.what() << " (a bug: please report it)\n";
    return gfp::kExitSoftware;
  }
}
