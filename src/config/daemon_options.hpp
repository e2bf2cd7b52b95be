#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "bumblebee/bumblebee_options.hpp"
#include "freenect/freenect_options.hpp"
#include "gfp/cloud/stereo_to_depth.hpp"
#include "gfp/core/error.hpp"
#include "gfp/core/fields.hpp"
#include "gfp/frame/failing_source.hpp"
#include "gfp/frame/run_source.hpp"
#include "gfp/pipeline/pipeline_options.hpp"
#include "gfp/primitive/upsampled.hpp"
#include "gfp/recording/recording_series.hpp"
#include "openni2/openni2_options.hpp"
#include "publish/publish_options.hpp"
#include "replay/replay_options.hpp"
#include "synthetic/synthetic_options.hpp"
#include "view/view_options.hpp"

namespace gfp {

/// One sensor: its name in topics, the driver that reads it and the driver's own options.
struct SensorConfig {
  std::string name = "camera";      ///< [a-z0-9_]+, unique.
  std::string driver = "synthetic";
  std::string input;                ///< File or folder that `replay` plays; of `freenect` a recorded folder instead of a
                                    ///< device; of `openni2` a device's URI or an .oni file; of `bumblebee` the camera.
  std::string calibration;          ///< Of `bumblebee`: a stereo calibration (OpenCV YAML, or `left.yaml,right.yaml` of ROS).
  std::string camera;               ///< Camera file, or `fx,fy,cx,cy`; empty: what the driver knows by itself.
  std::string isolation = "none";   ///< `process`: the driver runs in a process of its own, which may crash or hang.
  SourceOptions source;             ///< Timeouts and reconnection.
  FailureOptions failure;           ///< On purpose, for drills.
  ReplayOptions replay;             ///< Of the driver of that name; its `sensor` and `camera` are the ones above.
  SyntheticOptions synthetic;       ///< Likewise.
  FreenectOptions freenect;         ///< Likewise; its `folder` is `input`.
  OpenNi2Options openni2;           ///< Likewise; its `uri` is `input`.
  BumblebeeOptions bumblebee;       ///< Likewise; its `device` is `input`.
  StereoOptions stereo;             ///< Matching, of `bumblebee`.
};

template <class Visitor>
void visit_fields(SensorConfig& o, Visitor&& field) {
  field("name", o.name);
  field("driver", o.driver, OneOf{{"synthetic", "replay", "freenect", "openni2", "bumblebee"}});
  field("input", o.input);
  field("calibration", o.calibration);
  field("camera", o.camera);
  field("isolation", o.isolation, OneOf{{"none", "process"}});
  field.section("source", o.source);
  field.section("failure", o.failure);
  field.section("replay", o.replay);
  field.section("synthetic", o.synthetic);
  field.section("freenect", o.freenect);
  field.section("openni2", o.openni2);
  field.section("bumblebee", o.bumblebee);
  field.section("stereo", o.stereo);
}

struct LogOptions {
  std::string level = "info";
  std::string file;  ///< Empty: standard error.
};

template <class Visitor>
void visit_fields(LogOptions& o, Visitor&& field) {
  field("level", o.level, OneOf{{"trace", "debug", "info", "warn", "error", "off"}});
  field("file", o.file);
}

/// Where the robot that asks for grasps stands.
struct RobotOptions {
  Transform T_world_base = Transform::Identity();
  double min_reach_m = 0.15;  ///< Of the tool centre, from the base's origin.
  double max_reach_m = 0.85;
};

template <class Visitor>
void visit_fields(RobotOptions& o, Visitor&& field) {
  field("T_world_base", o.T_world_base);
  field("min_reach_m", o.min_reach_m, 0.0, 10.0);
  field("max_reach_m", o.max_reach_m, 0.01, 100.0);
}

/// The whole configuration of gfpd.
struct DaemonOptions {
  int threads = 0;          ///< Of the pipeline; 0: one a core.
  bool lossless = false;    ///< Every frame is processed, however late: for replay. False: the latest frame wins.
  std::string gripper_file; ///< As in config/grippers, relative to the configuration; under what pipeline.gripper says.
  std::string primitives;   ///< Folder of own primitives (gfp primitive build), relative to the configuration; a class there replaces the built-in one.
  int upsampling = 0;       ///< How often the primitives' edges are halved (P10): finer surfaces, more time.
  std::vector<SensorConfig> sensors;
  PublishOptions publish;
  ViewOptions view;
  RobotOptions robot;
  LogOptions log;
  RecordingOptions recording;
  PipelineOptions pipeline;
};

template <class Visitor>
void visit_fields(DaemonOptions& o, Visitor&& field) {
  field("threads", o.threads, 0, 256);
  field("lossless", o.lossless);
  field("gripper_file", o.gripper_file);
  field("primitives", o.primitives);
  field("upsampling", o.upsampling, 0, kMaxUpsampling);
  field.list("sensors", o.sensors);
  field.section("publish", o.publish);
  field.section("view", o.view);
  field.section("robot", o.robot);
  field.section("log", o.log);
  field.section("recording", o.recording);
  field.section("pipeline", o.pipeline);
}

/// What one field list cannot say: sensor names are well-formed and unique, ranges are not empty, tcp only where it is
/// allowed. Errors: kInvalidArgument, as in `sensors.1.name = front, expected a name no other sensor has`.
Result<void> validate(const DaemonOptions& options);

}  // namespace gfp

namespace gfp::config {

/// The defaults, overlaid with the file, overlaid with `path.to.key=value` settings in their order; validated.
/// An empty path stands for no file. Errors: kNotFound, kIo, kTooLarge, kCorruptData, kInvalidArgument; each names the
/// file (or the setting), line, key, value and bound, a line per problem.
Result<DaemonOptions> load_daemon_options(const std::filesystem::path& file, const std::vector<std::string>& settings = {});

/// The same from text; `source` is what errors name.
Result<DaemonOptions> parse_daemon_options(std::string_view text, const std::string& source, const std::vector<std::string>& settings = {});

/// Reads one gripper, as in config/grippers. Errors: as load_daemon_options().
Result<Gripper> load_gripper_file(const std::filesystem::path& file);

/// `options`, overlaid with settings; validated. Errors: as load_daemon_options().
Result<DaemonOptions> with_settings(const DaemonOptions& options, const std::vector<std::string>& settings);

/// Every option's path, as in `pipeline.cloud.min_depth_m` or `sensors.0.name`, and its value as the configuration writes it.
std::map<std::string, std::string> parameters(const DaemonOptions& options);

/// Every option with its value, as YAML that load_daemon_options() reads back to the same.
std::string to_yaml(const DaemonOptions& options);

/// JSON Schema (2020-12) of the configuration: keys, types, defaults, bounds.
std::string schema_json();

}  // namespace gfp::config
