// One synthetic scene through every way that a sensor's frames may take: the same objects come out. Frames of the scene differ by their noise, so each is
// compared with the same frame taken directly.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <utility>
#include <vector>

#include "app/builtin_library.hpp"
#include "app/input.hpp"
#include "gfp/pipeline/process_frame.hpp"
#include "openni2/openni2_source.hpp"
#ifdef GFP_HAS_BUMBLEBEE
#include "bumblebee/bumblebee_source.hpp"
#include "bumblebee/fake/fake_bumblebee.hpp"
#include "bumblebee/fake/textured_pair.hpp"
#include "gfp/cloud/rectify_stereo.hpp"
#include "support/gige_lock.hpp"
#endif
#include "support/fakenect_folder.hpp"
#include "support/true_shapes.hpp"
#include "synthetic/synthetic_source.hpp"

namespace gfp {
namespace {

using namespace std::chrono_literals;
namespace fs = std::filesystem;

constexpr std::uint64_t kSeed = 4;
constexpr int kObjects = 3;

SyntheticOptions scene_options(std::uint64_t frames = 1) {
  SyntheticOptions options;
  options.seed = kSeed;
  options.table.objects = kObjects;
  options.rate_hz = 0;
  options.frames = frames;
  options.frame_time = true;
  return options;
}

Frame first_frame(FrameSource& source) {
  const auto opened = source.open();
  EXPECT_TRUE(opened) << opened.error().what;
  auto frame = source.grab(10s);
  EXPECT_TRUE(frame) << frame.error().what;
  return frame ? std::move(*frame) : Frame{};
}

Scene scene_of(const Frame& frame) { return process_frame(frame, {}, builtin_library()).scene; }

/// What is compared: an object's class and how well it fills its truth.
struct Seen {
  std::string class_name;
  double iou_filled = 0;
};

class SensorPaths : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    SyntheticSource source(scene_options());
    frame_ = new Frame(first_frame(source));
    truth_ = new FrameTruth(source.truth(0));
    shapes_ = new test::TrueShapes(test::true_shapes(source.scene()));
    ASSERT_FALSE(shapes_->empty());
    direct_ = new std::vector<Seen>(compare(scene_of(*frame_)));
  }
  static void TearDownTestSuite() {
    delete frame_;
    delete truth_;
    delete shapes_;
    delete direct_;
  }

  /// Per true object, the fit that lies nearest.
  static std::vector<Seen> compare(const Scene& scene) {
    std::vector<Seen> seen;
    for (std::size_t i = 0; i < shapes_->size(); ++i) {
      const auto centre = [](const TriangleMesh& mesh) { return bounds(mesh.vertices).centre(); };
      const Eigen::Vector3d place = truth_->T_camera_object[i] * centre((*shapes_)[i]->mesh);
      const SceneObject* nearest = nullptr;
      double least = 0.05;
      for (const SceneObject& object : scene.objects) {
        const double distance = (centre(object.model.mesh_camera()) - place).norm();
        if (distance < least) least = distance, nearest = &object;
      }
      if (nearest == nullptr) {
        seen.push_back({"missing", 0});
        continue;
      }
      seen.push_back({nearest->model.class_name, test::filled_iou((*shapes_)[i], truth_->T_camera_object[i], nearest->model)});
    }
    return seen;
  }

  static void expect_same_objects(const Frame& frame, const std::vector<Seen>& direct, const char* path) {
    const std::vector<Seen> seen = compare(scene_of(frame));
    for (std::size_t i = 0; i < seen.size(); ++i) {
      EXPECT_EQ(seen[i].class_name, direct[i].class_name) << path << ", object " << i;
      EXPECT_NEAR(seen[i].iou_filled, direct[i].iou_filled, 0.03) << path << ", object " << i;
      std::printf("%s: object %zu is a %s, IoU %.3f (direct: %s, %.3f)\n", path, i, seen[i].class_name.c_str(), seen[i].iou_filled, direct[i].class_name.c_str(), direct[i].iou_filled);
    }
  }

  /// The same frame of the synthetic source: a device may have begun before it was listened to. Empty where there is none. The last 31 pixels of an .oni are
  /// not to be trusted.
  static Frame same_frame(const Frame& frame) {
    SyntheticSource source(scene_options(100));
    for (auto candidate = source.grab(10s); candidate; candidate = source.grab(10s))
      if (std::equal(frame.depth.pixels.pixels.begin(), frame.depth.pixels.pixels.end() - 31, candidate->depth.pixels.pixels.begin())) return std::move(*candidate);
    return {};
  }

  /// How much the fits of one scene differ by its noise alone: least and greatest IoU of each object over some frames.
  static std::vector<std::pair<double, double>> spread() {
    SyntheticSource source(scene_options(6));
    std::vector<std::pair<double, double>> range(shapes_->size(), {1.0, 0.0});
    for (auto frame = source.grab(10s); frame; frame = source.grab(10s)) {
      const std::vector<Seen> seen = compare(scene_of(*frame));
      for (std::size_t i = 0; i < seen.size(); ++i) range[i] = {std::min(range[i].first, seen[i].iou_filled), std::max(range[i].second, seen[i].iou_filled)};
    }
    return range;
  }

  fs::path temporary(const char* name) const { return fs::path(::testing::TempDir()) / name; }

  static inline const Frame* frame_ = nullptr;
  static inline const FrameTruth* truth_ = nullptr;
  static inline test::TrueShapes* shapes_ = nullptr;
  static inline const std::vector<Seen>* direct_ = nullptr;
};

TEST_F(SensorPaths, TheSceneIsSeenAtAll) {
  for (const Seen& object : *direct_) EXPECT_GT(object.iou_filled, 0.5) << object.class_name;
}

// Eleven bits of disparity are not the frame itself: another noise, within which the same scene gives the same objects.
TEST_F(SensorPaths, FakenectFolder) {
  const fs::path folder = temporary("sensor_paths_fakenect");
  fs::remove_all(folder);
  test::write_fakenect_folder(folder, {*frame_});
  InputOptions options;
  options.camera = CameraFile{default_kinect_camera(), {}, Transform::Identity()};
  const auto input = open_input(folder.string(), options);
  ASSERT_TRUE(input) << input.error().what;
  const std::vector<Seen> seen = compare(scene_of(first_frame(*input->source)));
  const auto range = spread();
  for (std::size_t i = 0; i < seen.size(); ++i) {
    EXPECT_EQ(seen[i].class_name, (*direct_)[i].class_name) << "object " << i;
    EXPECT_GT(seen[i].iou_filled, range[i].first - 0.03) << "object " << i;
    EXPECT_LT(seen[i].iou_filled, range[i].second + 0.03) << "object " << i;
    std::printf("fakenect: object %zu is a %s, IoU %.3f (directly %.3f to %.3f)\n", i, seen[i].class_name.c_str(), seen[i].iou_filled, range[i].first, range[i].second);
  }
  fs::remove_all(folder);
}

TEST_F(SensorPaths, OpenNi2LiveAndRecorded) {
  const fs::path file = temporary("sensor_paths.oni");
  fs::remove(file);
  OpenNi2Options options;
  options.library = GFP_OPENNI2_LIBRARY;
  options.uri = "gfp-synthetic:rate_hz=5,seed=" + std::to_string(kSeed) + ",objects=" + std::to_string(kObjects);
  options.record = file.string();
  {
    const auto live = make_openni2_source(options);
    const Frame frame = first_frame(*live), same = same_frame(frame);
    ASSERT_FALSE(same.depth.pixels.empty());
    expect_same_objects(frame, compare(scene_of(same)), "live OpenNI2");
    for (int i = 0; i < 2; ++i) EXPECT_TRUE(live->grab(10s));
  }
  options.uri = file.string();
  options.record.clear();
  options.fast = options.frame_time = true;
  const auto recorded = make_openni2_source(options);
  const Frame frame = first_frame(*recorded), same = same_frame(frame);
  ASSERT_FALSE(same.depth.pixels.empty());
  expect_same_objects(frame, compare(scene_of(same)), ".oni");
  fs::remove(file);
}

#ifdef GFP_HAS_BUMBLEBEE
// The same scene with a grain on its surfaces, through a stereo camera on the network and the matcher: another sensor, so its objects are reported, and only
// that one of them is found at all is asked for.
TEST_F(SensorPaths, BumblebeeOverTheNetwork) {
  const test::GigeLock lock;
  constexpr double kBaseline_m = 0.12;
  const SyntheticSource source(scene_options());
  const CameraModel camera = default_kinect_camera();
  const std::vector<StereoPair> pictures{textured_pair(source.scene(), camera, kBaseline_m, truth_->T_world_camera, 2.0, 1)};
  const FakeBumblebeeOptions by_default;
  const auto fake = FakeBumblebee::start(pictures, by_default);
  ASSERT_TRUE(fake) << fake.error().what;
  auto rectifier = StereoRectifier::make(calibration_of_pair(camera, kBaseline_m, truth_->T_world_camera));
  ASSERT_TRUE(rectifier) << rectifier.error().what;
  StereoOptions matching;
  matching.disparities = 128;
  const auto bumblebee = make_bumblebee_source({}, stereo_to_frame(std::move(*rectifier), matching, truth_->T_world_camera));
  ASSERT_TRUE(bumblebee->open());
  Result<Frame> frame = failure(ErrorCode::kTimeout, "");
  for (int attempt = 0; attempt < 100 && !frame; ++attempt) frame = bumblebee->grab(500ms);  // a busy machine loses packets
  ASSERT_TRUE(frame) << frame.error().what;
  const std::vector<Seen> seen = compare(scene_of(*frame));
  double best = 0;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    std::printf("stereo: object %zu is a %s, IoU %.3f (Kinect: %s, %.3f)\n", i, seen[i].class_name.c_str(), seen[i].iou_filled, (*direct_)[i].class_name.c_str(), (*direct_)[i].iou_filled);
    best = std::max(best, seen[i].iou_filled);
  }
  EXPECT_GT(best, 0.3);
}
#endif

}  // namespace
}  // namespace gfp
