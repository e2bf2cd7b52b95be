// gfp replay FILE: a gfpd whose cameras are a recording. Every frame is processed, in the recording's rhythm, and published.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <atomic>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <random>
#include <thread>

#include "app/builtin_library.hpp"
#include "cli/commands.hpp"
#include "cli/listen.hpp"
#include "daemon/daemon.hpp"
#include "daemon/logging.hpp"
#include "replay/mcap_source.hpp"

namespace gfp {
namespace {

struct ReplayArguments {
  std::string file, config;
  std::vector<std::string> settings;
  ReplayOptions replay;
  std::string name;
  std::vector<std::string> sensors;  ///< That are played.
  ListenArguments listen;
};

/// What is counted on the pipeline's thread and read on this one.
struct Progress {
  std::atomic<std::uint64_t> frames{0}, objects{0};
};

DaemonParts parts_of(const ReplayArguments& arguments, const PrimitiveLibrary& library, std::shared_ptr<Progress> progress) {
  return {[arguments](const SensorConfig& sensor) -> Result<std::unique_ptr<FrameSource>> {
            ReplayOptions options = arguments.replay;
            options.sensor = sensor.name;
            auto source = open_mcap(arguments.file, options);
            if (!source) return tl::unexpected(source.error());
            return std::unique_ptr<FrameSource>(std::move(*source));
          },
          [progress, &library](const Frame& frame, const SceneMemory& memory, const PipelineOptions& options) {
            PipelineResult result = process_frame(frame, memory, library, options);
            progress->objects += result.scene.objects.size();
            ++progress->frames;
            return result;
          },
          [&library](const Scene& scene, const SceneMemory& memory, const PipelineOptions& options, ShadowMemory& kept) {
            return shadow_scene(scene, memory, library, options, kept);
          },
          [](const std::string&, const std::vector<std::uint32_t>&, std::optional<PointType>) -> Result<RetypedPrimitive> { return failure(ErrorCode::kUnsupported, "gfp replay changes no primitives, expected gfpd"); }};
}

Result<DaemonOptions> options_of(const ReplayArguments& arguments) {
  std::vector<std::string> settings = arguments.settings;
  auto options = config::load_daemon_options(arguments.config, settings);
  if (!options) return options;
  options->lossless = true;
  options->sensors.clear();
  for (const std::string& name : arguments.sensors) {
    SensorConfig& sensor = options->sensors.emplace_back();
    sensor.name = name;
    sensor.driver = "replay";
    sensor.input = arguments.file;
  }
  if (auto valid = validate(*options); !valid) return tl::unexpected(valid.error());
  return options;
}

/// All that were recorded, under their names; one, where a topic or a name is asked for, or others made the recording.
Result<std::vector<std::string>> sensors_of(const ReplayArguments& arguments) {
  const auto recorded = McapStreams::recorded_sensors(arguments.file);
  if (!recorded) return recorded;
  if (recorded->size() > 1 && arguments.replay.topic.empty()) {
    if (arguments.name.empty()) return recorded;
    return failure(ErrorCode::kInvalidArgument, fmt::format("--name = {}, expected --topic with it: {} holds {} sensors: {}", arguments.name, arguments.file, recorded->size(), fmt::join(*recorded, ", ")));
  }
  const auto probe = McapStreams::open(arguments.file, arguments.replay);
  if (!probe) return tl::unexpected(probe.error());
  return std::vector<std::string>{!arguments.name.empty() ? arguments.name : probe->recorded_sensor()};
}

void replay(ReplayArguments& arguments, ExitStatus& status) {
  auto sensors = sensors_of(arguments);
  if (!sensors) return status.fail(std::cerr, "replay", sensors.error());
  arguments.sensors = std::move(*sensors);
  const auto options = options_of(arguments);
  if (!options) return status.fail(std::cerr, "replay", options.error());
  if (const auto logging = start_logging(options->log); !logging) return status.fail(std::cerr, "replay", logging.error());
  arguments.replay.control = std::make_shared<ReplayControl>();
  const auto progress = std::make_shared<Progress>();
  const ListenEnd end(arguments.listen);
  const auto library = library_of_configuration(options->primitives, options->upsampling, arguments.config);
  if (!library) return status.fail(std::cerr, "replay", library.error());
  std::random_device device;
  auto daemon = Daemon::start(*options, parts_of(arguments, *library, progress), (static_cast<std::uint64_t>(device()) << 32U) | device());
  if (!daemon) return status.fail(std::cerr, "replay", daemon.error());
  Nanoseconds next_tick = monotonic_now();
  while (!end.reached(progress->frames)) {
    const ReplayControl::State state = arguments.replay.control->state();
    if (state.ended && progress->frames >= state.frames) break;
    if (monotonic_now() >= next_tick) {
      (*daemon)->tick();
      next_tick += std::chrono::seconds(1);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  (*daemon)->stop();
  if (arguments.listen.json) std::cout << nlohmann::ordered_json{{"file", arguments.file}, {"sensor", fmt::format("{}", fmt::join(arguments.sensors, ", "))}, {"frames", progress->frames.load()}, {"objects", progress->objects.load()}}.dump() << std::endl;
  else std::cout << fmt::format("{}: {} frames, {:.1f} objects a frame\n", arguments.file, progress->frames.load(), static_cast<double>(progress->objects) / std::max<double>(1, static_cast<double>(progress->frames)));
}

}  // namespace

void add_replay_command(CLI::App& app, ExitStatus& status) {
  CLI::App& command = *app.add_subcommand("replay", "Processes and publishes a recording as gfpd would its cameras: ours, or ROS 2 MCAP files with depth images");
  const auto arguments = std::make_shared<ReplayArguments>();
  ReplayOptions& replay_options = arguments->replay;
  command.add_option("FILE", arguments->file, "MCAP file")->required();
  command.add_option("--config", arguments->config, "As gfpd's; its sensors are replaced by the recording");
  command.add_option("--set", arguments->settings, "Overrides one option: path.to.key=value; may be repeated")->take_all();
  command.add_option("--speed", replay_options.speed, "Times the recording's own; 0: as fast as it is processed")->capture_default_str()->check(CLI::Range(0.0, 1000.0));
  command.add_option("--start", replay_options.start_s, "Seconds of the recording to leave out")->check(CLI::NonNegativeNumber);
  command.add_option("--step", replay_options.step, "Every so many-th frame")->capture_default_str()->check(CLI::Range(1, 1'000'000));
  command.add_flag("--loop", replay_options.loop, "Starts over at the end");
  command.add_option("--topic", replay_options.topic, "Of the depth images; by default those of all sensors that were recorded");
  command.add_option("--color-topic", replay_options.color_topic, "Of colour images registered to depth, in files of others");
  command.add_option("--name", arguments->name, "Of the sensor, in topics; by default as recorded; with several, for the one of --topic");
  command.add_option("--seconds", arguments->listen.seconds, "Ends after so many seconds")->check(CLI::NonNegativeNumber);
  command.add_option("--count", arguments->listen.count, "Ends after so many frames");
  command.add_flag("--json", arguments->listen.json, "A JSON object at the end");
  command.callback([arguments, &status] { replay(*arguments, status); });
}

}  // namespace gfp
