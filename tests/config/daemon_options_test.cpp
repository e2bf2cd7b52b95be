#include "config/daemon_options.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "config/yaml_document.hpp"

namespace gfp::config {
namespace {

const std::filesystem::path kConfigDir = GFP_CONFIG_DIR;

TEST(DaemonOptions, DefaultYamlHoldsEveryOptionAtItsDefault) {
  const auto text = read_text(kConfigDir / "default.yaml");
  ASSERT_TRUE(text.has_value()) << text.error().what;
  const YAML::Node written = *parse_yaml(*text, "default.yaml"), expected = *parse_yaml(to_yaml(DaemonOptions{}), "defaults");
  EXPECT_EQ(YAML::Dump(written), YAML::Dump(expected));
}

TEST(DaemonOptions, EveryFileInConfigLoads) {
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(kConfigDir)) {
    if (entry.path().extension() != ".yaml") continue;
    const auto loaded = load_daemon_options(entry.path());
    EXPECT_TRUE(loaded.has_value()) << loaded.error().what;
    ++files;
  }
  EXPECT_GE(files, 1);
}

TEST(DaemonOptions, EveryGripperLoadsAndLiesUnderWhatTheConfigurationSays) {
  for (const auto& entry : std::filesystem::directory_iterator(kConfigDir / "grippers")) {
    const auto gripper = load_gripper_file(entry.path());
    ASSERT_TRUE(gripper.has_value()) << gripper.error().what;
    EXPECT_EQ(gripper->name, entry.path().stem());
    const auto options = parse_daemon_options("gripper_file: grippers/" + entry.path().filename().string() + "\npipeline: {gripper: {friction: 0.9}}\n",
                                              (kConfigDir / "robot.yaml").string());
    ASSERT_TRUE(options.has_value()) << options.error().what;
    EXPECT_EQ(options->pipeline.gripper.stroke_m, gripper->stroke_m);
    EXPECT_EQ(options->pipeline.gripper.friction, 0.9);
  }
}

TEST(DaemonOptions, SavingAndLoadingIsTheIdentity) {
  DaemonOptions options;
  options.threads = 2;
  options.sensors.resize(2);
  options.sensors[0].name = "front";
  options.sensors[1].source.reconnect.max_s = 12.5;
  options.publish.vertices = "int16";
  options.pipeline.segmentation.min_height_m = 1.0 / 30.0;
  const auto loaded = parse_daemon_options(to_yaml(options), "saved");
  ASSERT_TRUE(loaded.has_value()) << loaded.error().what;
  EXPECT_EQ(to_yaml(*loaded), to_yaml(options));
  EXPECT_NE(to_yaml(*loaded), to_yaml(DaemonOptions{}));
}

TEST(DaemonOptions, SettingsOverrideTheFileInTheirOrder) {
  const std::string file = "pipeline: {segmentation: {min_points: 100}}\nsensors: [{name: a}, {name: b}]\n";
  const auto loaded = parse_daemon_options(file, "f.yaml", {"pipeline.segmentation.min_points=50", "pipeline.segmentation.min_points=60",
                                                            "sensors.1.name=back", "log.file=", "publish.sensor_endpoints=[ipc://x, ipc://y]"});
  ASSERT_TRUE(loaded.has_value()) << loaded.error().what;
  EXPECT_EQ(loaded->pipeline.segmentation.min_points, 60);
  EXPECT_EQ(loaded->sensors[0].name, "a");
  EXPECT_EQ(loaded->sensors[1].name, "back");
  EXPECT_EQ(loaded->publish.sensor_endpoints.size(), 2U);
}

TEST(DaemonOptions, BadSettingsAreNamed) {
  const auto what = [](const std::string& setting) { return parse_daemon_options("", "f.yaml", {setting}).error().what; };
  EXPECT_EQ(what("threads"), "--set threads: expected path.to.key=value");
  EXPECT_EQ(what("=3"), "--set =3: expected path.to.key=value");
  EXPECT_EQ(what("threads=many"), "--set threads=many: threads = many, expected an integer in [0, 256]");
  EXPECT_EQ(what("pipeline.segmentation.min_point=3"), "--set pipeline.segmentation.min_point=3: pipeline.segmentation.min_point is not a key; did you mean min_points?");
  EXPECT_EQ(what("sensors.0.name=x"), "--set sensors.0.name=x: sensors.0 is not one of the 0 elements of the list, counted from 0");
  EXPECT_FALSE(parse_daemon_options("", "f.yaml", {std::string(1000, '.') + "=1"}).has_value());
}

TEST(DaemonOptions, WhatOneFieldCannotSayIsValidated) {
  const auto what = [](const std::string& text) {
    const auto loaded = parse_daemon_options(text, "f.yaml");
    return loaded ? "" : loaded.error().what;
  };
  EXPECT_EQ(what("sensors: [{name: a}, {name: a}]"), "f.yaml: sensors.1.name = a, expected a name no other sensor has");
  EXPECT_EQ(what("sensors: [{name: Front}]"), "f.yaml: sensors.0.name = Front, expected 1 to 64 of a-z, 0-9 and _");
  EXPECT_EQ(what("publish: {state_endpoints: ['udp://x']}"), "f.yaml: publish.state_endpoints = udp://x, expected ipc://, inproc:// or tcp://");
  EXPECT_NE(what("publish: {state_endpoints: ['tcp://*:5602']}").find("unencrypted and for everybody"), std::string::npos);
  EXPECT_EQ(what("publish: {state_endpoints: ['tcp://*:5602'], insecure: true}"), "");
  EXPECT_EQ(what("pipeline: {cloud: {min_depth_m: 2, max_depth_m: 1}}"),
            "f.yaml: pipeline.cloud.min_depth_m = 2, expected less than max_depth_m = 1");
}

TEST(DaemonOptions, TheSchemaIsJsonAndKnowsNestedBounds) {
  const auto schema = nlohmann::json::parse(schema_json());
  const auto& points = schema["properties"]["pipeline"]["properties"]["segmentation"]["properties"]["min_points"];
  EXPECT_EQ(points["default"], 300);
  EXPECT_EQ(points["minimum"], 10);
}

}  // namespace
}  // namespace gfp::config
