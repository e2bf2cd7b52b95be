// gfpd: from cameras to graspable objects, for whoever subscribes. SIGTERM and SIGINT drain and end, SIGHUP reloads, SIGUSR1
// triggers the recording ring.
#include <csignal>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <random>
#include <utility>

#include "app/builtin_library.hpp"
#include "app/driver_channel.hpp"
#include "app/make_source.hpp"
#include "app/retype_primitive.hpp"
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

/// Where the primitives come from, as configured.
struct LibraryPlace {
  std::string primitives;
  int upsampling = 0;
  std::string configuration;
  std::filesystem::path folder() const { return std::filesystem::path(configuration).parent_path() / primitives; }
};

/// The primitives that frames are processed with: those of the last good configuration, from the next frame on. Safe from any thread.
class LiveLibrary {
 public:
  /// Errors: as library_of_configuration(); then the old ones stay.
  gfp::Result<void> load(const LibraryPlace& place) {
    auto read = gfp::library_of_configuration(place.primitives, place.upsampling, place.configuration);
    if (!read) return tl::unexpected(read.error());
    auto shared = std::make_shared<const gfp::PrimitiveLibrary>(std::move(*read));
    const gfp::MutexLock lock(mutex_);
    library_ = std::move(shared);
    place_ = place;
    return {};
  }
  std::shared_ptr<const gfp::PrimitiveLibrary> get() const {
    const gfp::MutexLock lock(mutex_);
    return library_;
  }
  LibraryPlace place() const {
    const gfp::MutexLock lock(mutex_);
    return place_;
  }

 private:
  mutable gfp::Mutex mutex_;
  std::shared_ptr<const gfp::PrimitiveLibrary> library_ GFP_GUARDED_BY(mutex_);  ///< Shared with the frame under way.
  LibraryPlace place_ GFP_GUARDED_BY(mutex_);
};

/// A person's word on control points: into the folder of own primitives, and from there into the library. Without vertices it only says how they are.
gfp::Result<gfp::RetypedPrimitive> retype(LiveLibrary& live, const std::string& name, const std::vector<std::uint32_t>& vertices, std::optional<gfp::PointType> type) {
  using gfp::ErrorCode, gfp::failure;
  const LibraryPlace place = live.place();
  if (place.primitives.empty()) return failure(ErrorCode::kUnsupported, "primitives is empty in the configuration, expected a folder that keeps what is said by hand");
  if (place.upsampling != 0) return failure(ErrorCode::kUnsupported, fmt::format("upsampling = {}, expected 0: its vertices are not those of the file", place.upsampling));
  auto primitive = gfp::primitive_to_retype(place.folder(), name);
  if (!primitive) return tl::unexpected(primitive.error());
  std::vector<bool> chosen(primitive->size());
  for (const std::uint32_t vertex : vertices) {
    if (vertex >= chosen.size()) return failure(ErrorCode::kInvalidArgument, fmt::format("vertex {}, expected below {}", vertex, chosen.size()));
    chosen[vertex] = true;
  }
  gfp::RetypedPrimitive done{primitive->name, "", gfp::set_types_by_hand(chosen, type, *primitive), {}, {}};
  if (done.changed > 0) {
    const auto file = gfp::keep_primitive(place.folder(), *primitive);
    if (!file) return failure(file.error().code, file.error().what + " (the folder of `primitives` must be writable for gfpd)");
    done.file = file->string();
    if (auto loaded = live.load(place); !loaded) return tl::unexpected(loaded.error());
    spdlog::info("primitive {}: {} vertices retyped by hand, {}", done.name, done.changed, done.file);
  }
  done.types = primitive->topology->types;
  done.manual = primitive->manual_types;
  return done;
}

/// Recordings have one time line; where a sensor is none, or is played in a process of its own, nobody steers them.
bool is_steerable(const gfp::SensorConfig& sensor) { return sensor.driver == "replay" && sensor.input.ends_with(".mcap") && sensor.isolation == "none"; }

std::shared_ptr<gfp::ReplayControl> playback_of(const gfp::DaemonOptions& options) {
  const bool is_replay = options.view.enabled && std::all_of(options.sensors.begin(), options.sensors.end(), is_steerable);
  if (!is_replay) return nullptr;
  auto playback = std::make_shared<gfp::ReplayControl>();
  playback->hold_at_end();
  return playback;
}

/// `playback`: of the recordings that are played; may be empty.
gfp::DaemonParts parts(LiveLibrary& live, std::shared_ptr<gfp::ReplayControl> playback) {
  return {[playback = std::move(playback)](gfp::SensorConfig sensor) {
            if (playback && is_steerable(sensor)) {
              sensor.replay.control = playback;
              sensor.replay.recorded_time = true;
            }
            return gfp::make_source(sensor);
          },
          [&live](const gfp::Frame& frame, const gfp::SceneMemory& memory, const gfp::PipelineOptions& options) {
            const auto library = live.get();
            return gfp::process_frame(frame, memory, *library, options);
          },
          [&live](const gfp::Scene& scene, const gfp::SceneMemory& memory, const gfp::PipelineOptions& options, gfp::ShadowMemory& kept) {
            const auto library = live.get();
            return gfp::shadow_scene(scene, memory, *library, options, kept);
          },
          [&live](const std::string& name, const std::vector<std::uint32_t>& vertices, std::optional<gfp::PointType> type) { return retype(live, name, vertices, type); }};
}

void reload(gfp::Daemon& daemon, LiveLibrary& library, const Arguments& arguments) {
  gfp::tell_reloading();
  const auto options = load(arguments);
  if (!options) return spdlog::error("reload: the old configuration stays: {}", options.error().what);
  const LibraryPlace before = library.place();
  if (const auto read = library.load({options->primitives, options->upsampling, arguments.config}); !read) return spdlog::error("reload: the old configuration stays: {}", read.error().what);
  if (const auto done = daemon.reload(*options); !done) {
    static_cast<void>(library.load(before));
    return spdlog::error("reload: the old configuration stays: {}", done.error().what);
  }
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
    if (signal == SIGUSR1) daemon.recorder().trigger();
    if (signal == SIGTERM || signal == SIGINT) return spdlog::info("stopping on signal {}", signal);
  }
}

/// Robots live without a view: where it cannot be served, that is said and the daemon goes on.
std::unique_ptr<gfp::View> start_view(const gfp::DaemonOptions& options, std::uint64_t session, gfp::Daemon& daemon, std::shared_ptr<gfp::ReplayControl> playback) {
  auto view = gfp::View::start(options.view, session, std::move(playback), [&daemon](gfp::PeerRequest request, std::function<void(gfp::PeerReply)> send) { daemon.ask(std::move(request), std::move(send)); });
  if (!view) return spdlog::warn("no view: {}", view.error().what), nullptr;
  daemon.publisher().mirror(&(*view)->inbox());
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

  LiveLibrary library;  // it outlives the daemon, whose pipeline reads it
  if (const auto read = library.load({options->primitives, options->upsampling, arguments.config}); !read) {
    std::cerr << "gfpd: " << read.error().what << "\n";
    return gfp::kExitConfig;
  }
  const std::uint64_t session = new_session();
  const auto playback = playback_of(*options);
  std::unique_ptr<gfp::View> view;  // it outlives the daemon, whose threads put into it
  auto daemon = gfp::Daemon::start(*options, parts(library, playback), session);
  if (!daemon) {
    spdlog::error("{}", daemon.error().what);
    return daemon.error().code == gfp::ErrorCode::kInvalidArgument ? gfp::kExitConfig : gfp::kExitUnavailable;
  }
  gfp::publish_log_to(&(*daemon)->publisher());
  if (options->view.enabled) view = start_view(*options, session, **daemon, playback);
  spdlog::info("gfpd {} serves {} sensor(s)", gfp::version(), options->sensors.size());
  gfp::tell_service_manager("READY=1");
  serve(**daemon, library, arguments, signals);
  gfp::tell_service_manager("STOPPING=1");
  gfp::publish_log_to(nullptr);
  if (view) view->stop();  // it asks the daemon
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
