// gfp_make_recording FILE: a second of a made-up sensor with objects, every kind of message in it.
#include <cstdio>

#include "gfp/core/random.hpp"
#include "gfp/recording/recording_file.hpp"
#include "support/hand_made_scene.hpp"
#include "wire/recorded_messages.hpp"

namespace gfp {
namespace {

Frame frame_at(int i, Random& random) {
  Frame frame;
  frame.sensor = "front";
  frame.sequence = static_cast<std::uint64_t>(i);
  frame.stamps.realtime = Nanoseconds(1'700'000'000'000'000'000) + i * Nanoseconds(33'333'333);
  frame.stamps.sensor = frame.stamps.realtime;
  frame.camera = default_kinect_camera(160, 120);
  frame.depth.pixels = Image<std::uint16_t>(160, 120);
  frame.color = Image<Rgb8>(160, 120);
  for (std::uint16_t& depth : frame.depth.pixels.pixels) depth = static_cast<std::uint16_t>(800 + random.below(400));
  for (Rgb8& pixel : frame.color.pixels) pixel.r = static_cast<std::uint8_t>(random.below(256));
  return frame;
}

int run(const char* path) {
  auto file = RecordingFile::create(path);
  if (!file) return std::fprintf(stderr, "%s\n", file.error().what.c_str()), 1;
  RecordContent content;
  content.color = true;
  content.view_hz = 10;
  wire::RecordingMessages messages(content);
  bool is_written = true;
  const auto sink = [&](const McapChannelSpec& spec, const McapMessage& message) { is_written = is_written && file->put(spec, message).has_value(); };
  Random random(1);
  for (int i = 0; i < 60; ++i) {
    const Frame frame = frame_at(i, random);
    messages.put(frame, frame.stamps.realtime, sink);
    Scene scene = test::hand_made_scene(3, static_cast<std::uint64_t>(i));
    scene.stamps = frame.stamps;
    messages.put(scene, frame.stamps.realtime + Nanoseconds(20'000'000), sink);
  }
  return is_written && file->finish() ? 0 : 1;
}

}  // namespace
}  // namespace gfp

int main(int argc, char** argv) { return argc == 2 ? gfp::run(argv[1]) : 64; }
