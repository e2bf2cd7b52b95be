// gfp record FILE: what a running gfpd publishes, as an MCAP file that replays and that Foxglove shows.
#include <fmt/format.h>

#include <algorithm>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/commands.hpp"
#include "cli/listen.hpp"
#include "gfp/client/frame_assembler.hpp"
#include "gfp/client/scene_subscriber.hpp"
#include "gfp/recording/recording_file.hpp"
#include "wire/recorded_messages.hpp"
#include "wire/topics.hpp"

namespace gfp {
namespace {

struct RecordArguments {
  ListenArguments listen;
  std::string file;
  RecordContent content;
  bool no_depth = false, no_objects = false;
  int zstd_level = 1;
};

/// Takes what comes into the file, until something ends it.
class RecordRun {
 public:
  RecordRun(const RecordArguments& arguments, RecordingFile file) : messages_(arguments.content), file_(std::move(file)) {}

  std::uint64_t frames = 0, scenes = 0, corrupt = 0;

  void take_sensor(Subscriber& subscriber, std::chrono::milliseconds patience) {
    for (auto message = subscriber.receive(patience); message; message = subscriber.receive(std::chrono::milliseconds(0))) {
      const auto frame = assembler_.put(*message);
      if (!frame) ++corrupt;
      if (!frame || !*frame) continue;
      ++frames;
      messages_.put(**frame, log_time(), sink_);
    }
  }

  void take_scenes(SceneSubscriber& subscriber, std::chrono::milliseconds patience) {
    for (auto scene = subscriber.next(patience); scene; scene = subscriber.next(std::chrono::milliseconds(0))) {
      ++scenes;
      messages_.put(*scene, log_time(), sink_);
    }
  }

  /// Chunks go to the disk every second at least. Errors: of the file, now or since the last call.
  Result<void> flush_when_due() {
    if (failed_) return tl::unexpected(*failed_);
    if (monotonic_now() - flushed_ < std::chrono::milliseconds(500)) return {};
    flushed_ = monotonic_now();
    return file_.flush();
  }
  RecordingFile& file() { return file_; }

 private:
  Nanoseconds log_time() { return log_time_ = std::max(realtime_now(), log_time_ + Nanoseconds(1)); }

  wire::RecordingMessages messages_;
  RecordingFile file_;
  FrameAssembler assembler_;
  Nanoseconds log_time_{}, flushed_{};
  std::optional<Error> failed_;
  wire::RecordingMessages::Sink sink_ = [this](const McapChannelSpec& spec, const McapMessage& message) {
    if (auto written = file_.put(spec, message); !written && !failed_) failed_ = written.error();
  };
};

void print_result(const RecordArguments& arguments, const RecordRun& run, std::uint64_t messages, std::uint64_t bytes, std::uint64_t missed) {
  if (arguments.listen.json) {
    const nlohmann::ordered_json line = {{"file", arguments.file}, {"frames", run.frames}, {"scenes", run.scenes}, {"messages", messages}, {"bytes", bytes}, {"missed", missed}, {"corrupt", run.corrupt}};
    std::cout << line.dump() << std::endl;
  } else {
    std::cout << fmt::format("{}: {} frames, {} scenes, {:.1f} MB; {} messages missed, {} corrupt\n", arguments.file, run.frames, run.scenes, 1e-6 * static_cast<double>(bytes), missed, run.corrupt);
  }
}

void record(const RecordArguments& arguments, ExitStatus& status) {
  const bool wants_frames = arguments.content.depth || arguments.content.color;
  std::vector<std::string> topics{std::string(wire::kSensorPrefix)};
  auto sensor = Subscriber::connect(topics, arguments.listen.subscriber);
  if (!sensor) return status.fail(std::cerr, "record", sensor.error());
  auto scenes = SceneSubscriber::connect(arguments.listen.subscriber);
  if (!scenes) return status.fail(std::cerr, "record", scenes.error());
  auto file = RecordingFile::create(arguments.file, {1U << 20U, 200'000'000, arguments.zstd_level});
  if (!file) return status.fail(std::cerr, arguments.file, file.error());
  RecordRun run(arguments, std::move(*file));
  const ListenEnd end(arguments.listen);
  Result<void> written;
  while (written && !end.reached(std::max(run.frames, run.scenes))) {
    if (wants_frames) run.take_sensor(*sensor, std::chrono::milliseconds(10));
    if (arguments.content.objects) run.take_scenes(*scenes, std::chrono::milliseconds(wants_frames ? 0 : 10));
    written = run.flush_when_due();
  }
  if (!written) return status.fail(std::cerr, arguments.file, written.error());  // what there is stays as .active, for gfp repair
  const std::uint64_t messages = run.file().messages();
  if (auto finished = run.file().finish(); !finished) return status.fail(std::cerr, arguments.file, finished.error());
  print_result(arguments, run, messages, run.file().bytes(), sensor->counts().missed + scenes->counts().missed);
  if (messages == 0) status.fail(kExitUnavailable);
}

}  // namespace

void add_record_command(CLI::App& app, ExitStatus& status) {
  auto arguments = std::make_shared<RecordArguments>();
  CLI::App* command = app.add_subcommand("record", "Records what a running gfpd publishes into an MCAP file (gfpd records by itself with recording.mode)");
  command->add_option("FILE", arguments->file, "File to write; FILE.active until it is closed")->required();
  command->add_option("--endpoint", arguments->listen.subscriber.endpoints, "ZeroMQ endpoints, sensor and state; default: this host's gfpd");
  command->add_option("--seconds", arguments->listen.seconds, "Ends after so many seconds; else with Ctrl-C")->check(CLI::NonNegativeNumber);
  command->add_option("--count", arguments->listen.count, "Ends after so many frames or scenes");
  command->add_flag("--color", arguments->content.color, "Colour too");
  command->add_flag("--no-depth", arguments->no_depth, "Objects only");
  command->add_flag("--no-objects", arguments->no_objects, "Sensors only");
  command->add_option("--view-hz", arguments->content.view_hz, "How often objects are added in a form that Foxglove shows")->capture_default_str()->check(CLI::Range(0.0, 30.0));
  command->add_option("--zstd-level", arguments->zstd_level, "Of the compression")->capture_default_str()->check(CLI::Range(0, 19));
  command->add_flag("--json", arguments->listen.json, "A JSON object at the end");
  command->callback([arguments, &status] {
    arguments->content.depth = !arguments->no_depth;
    arguments->content.objects = !arguments->no_objects;
    record(*arguments, status);
  });
}

}  // namespace gfp
