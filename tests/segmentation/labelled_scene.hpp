#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "gfp/frame/frame.hpp"

namespace gfp::test {

/// A real frame with what a person said about it.
struct LabelledScene {
  std::string name;
  DepthImage depth;             ///< 0.1 mm units.
  CameraModel camera;
  Image<Rgb8> color;
  Image<std::int32_t> objects;  ///< 0: none, else an object's number (>= 2 where the file labels it: its label / 10).
};

/// GFP_DATA_DIR, else `../shared/data` beside the source tree.
std::filesystem::path data_directory();

/// An organised binary_compressed PCD with the fields [label] x y z rgb(a) of four bytes each. Clouds with z < 0
/// (x right, y up) are turned into the optical frame. For the test data only: trusts its input, empty where the file is absent.
std::optional<LabelledScene> read_pcd_scene(const std::filesystem::path& file, const CameraModel& camera);

/// The labelled frames of scenes/osd_learn in the order of their names; empty where the data is absent.
std::vector<LabelledScene> read_osd_learn();

/// Mean over the labelled objects of the best IoU that any segment has with the object's readings. `labels`: index of
/// the segment, negative for none. Pixels without a reading do not count.
struct Coverage {
  double sum = 0;
  int objects = 0;
  std::vector<double> best_iou;  ///< By object number, ascending.
  double mean() const { return objects == 0 ? 1.0 : sum / objects; }
};
Coverage coverage(const LabelledScene& scene, const Image<std::int32_t>& labels);

}  // namespace gfp::test
