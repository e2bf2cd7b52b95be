// gfp_fake_bumblebee: a stereo camera on the network that shows a synthetic table. Writes the calibration that belongs to it.
//   gfp_fake_bumblebee CALIBRATION.yaml [SEED [OBJECTS [LOST_PACKETS_PER_MILLE [LAYOUT]]]]
// LAYOUT: interleaved, stacked, parts (bumblebee.layout: stacked), or two_devices, which is a camera an eye, on 127.0.0.1 and 127.0.0.2.
#include <csignal>

#include <fmt/format.h>

#include <cstdlib>
#include <fstream>
#include <iostream>
#include <string_view>

#include "bumblebee/fake/fake_bumblebee.hpp"
#include "bumblebee/fake/textured_pair.hpp"
#include "gfp/simulation/table_top_scene.hpp"

int main(int argc, char** argv) {
  if (argc < 2 || argv[1][0] == '-') {
    const bool is_asked = argc > 1 && (std::string_view(argv[1]) == "--help" || std::string_view(argv[1]) == "-h");
    (is_asked ? std::cout : std::cerr) << "usage: gfp_fake_bumblebee CALIBRATION.yaml [SEED [OBJECTS [LOST_PACKETS_PER_MILLE [LAYOUT]]]]\n"
                                          "A stereo camera on the loopback interface that shows a synthetic table, until it is ended. Writes its calibration to CALIBRATION.yaml.\n"
                                          "LAYOUT: interleaved, stacked, parts, two_devices\n";
    return is_asked ? 0 : 64;
  }
  const std::uint64_t seed = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 7;
  gfp::TableTopOptions table;
  if (argc > 3) table.objects = static_cast<int>(std::strtol(argv[3], nullptr, 10));
  gfp::FakeBumblebeeOptions options;
  if (argc > 4) options.camera.lost_packets = 1e-3 * std::strtod(argv[4], nullptr);
  if (argc > 5) options.layout = argv[5];
  std::vector<gfp::FakeBumblebeeOptions> cameras(1, options);
  if (options.layout == "two_devices") {
    cameras.assign(2, options);
    cameras[0].layout = "left", cameras[1].layout = "right";
    cameras[1].camera.serial = "GFPBB02", cameras[1].camera.address = "127.0.0.2";
  }

  sigset_t signals;  // before the camera's thread begins, so that it inherits the mask
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT), sigaddset(&signals, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);

  constexpr double kBaseline_m = 0.12;  // a Bumblebee2's
  constexpr int kPictures = 4;          // that differ by their noise
  const gfp::CameraModel camera = gfp::default_kinect_camera();
  const gfp::Transform T_world_camera = gfp::look_at_pose({0, 0, 0.05}, 0.9, 0.7, -1.57);
  std::vector<gfp::StereoPair> pairs;
  for (std::uint64_t i = 0; i < kPictures; ++i) pairs.push_back(gfp::textured_pair(gfp::table_top_scene(table, seed), camera, kBaseline_m, T_world_camera, 2.0, i));
  std::vector<std::unique_ptr<gfp::FakeBumblebee>> fakes;
  for (const gfp::FakeBumblebeeOptions& one : cameras) {
    auto fake = gfp::FakeBumblebee::start(pairs, one);
    if (!fake) {
      std::cerr << "gfp_fake_bumblebee: " << fake.error().what << "\n";
      return 71;
    }
    fakes.push_back(std::move(*fake));
  }
  std::ofstream(argv[1]) << fmt::format(
      "%YAML:1.0\n---\nwidth: {0}\nheight: {1}\nM1: [{2}, 0, {3}, 0, {2}, {4}, 0, 0, 1]\nD1: []\nM2: [{2}, 0, {3}, 0, {2}, {4}, 0, 0, 1]\nD2: []\nR: [1, 0, 0, 0, 1, 0, 0, 0, 1]\nT: [{5}, 0, 0]\n", camera.width,
      camera.height, camera.fx, camera.cx, camera.cy, -kBaseline_m);
  for (const auto& one : cameras) std::cout << "Aravis-" << one.camera.serial << " on " << one.camera.address << " at " << one.camera.rate_hz << " Hz, " << one.layout << "\n" << std::flush;
  int signal = 0;
  sigwait(&signals, &signal);
  return 0;
}
