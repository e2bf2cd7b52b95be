// What the rest of the table says of each thing on it (P4), over the whole pipeline.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include "app/builtin_library.hpp"
#include "gfp/pipeline/process_frame.hpp"
#include "synthetic/synthetic_source.hpp"

namespace gfp {
namespace {

using namespace std::chrono_literals;

struct Count {
  int right = 0, all = 0;
};

/// Classes of what stands on tables of `classes`, each frame seen for the first time.
Count classes_found(const std::vector<std::string>& classes, double weight) {
  Count count;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    SyntheticOptions options;
    options.seed = seed;
    options.rate_hz = 0;
    options.frame_time = true;
    options.table.objects = 5;
    options.table.classes = classes;
    SyntheticSource source(options);
    PipelineOptions pipeline;
    pipeline.selection.context.weight = weight;
    const Scene scene = process_frame(*source.grab(10s), {}, builtin_library(), pipeline).scene;
    const FrameTruth truth = source.truth(0);
    for (std::size_t i = 0; i < truth.T_camera_object.size(); ++i) {
      const auto& [name, class_name, mesh, T_world_object, color] = source.scene().objects[i];
      const Eigen::Vector3d place = truth.T_camera_object[i] * bounds(mesh.vertices).centre();
      for (const SceneObject& object : scene.objects) {
        if ((bounds(object.model.mesh_camera().vertices).centre() - place).norm() > 0.03) continue;
        ++count.all;
        count.right += object.model.class_name == class_name ? 1 : 0;
        break;
      }
    }
  }
  return count;
}

void compare(const char* what, const std::vector<std::string>& classes, int most_lost) {
  const Count without = classes_found(classes, 0), with = classes_found(classes, 1);
  std::printf("%s: %d of %d classes right alone, %d of %d with the context\n", what, without.right, without.all, with.right, with.all);
  EXPECT_GT(with.all, 30);
  EXPECT_GE(with.right, without.right - most_lost) << what;
}

TEST(ContextOnTables, HelpsWhereThingsBelongTogether) {
  compare("kitchen", {"mug", "cup", "bowl", "plate", "wine_glass", "jug", "spoon", "knife"}, 0);
  compare("workshop", {"hammer", "screwdriver", "drill", "clamp", "spray_bottle", "box"}, 0);
}

TEST(ContextOnTables, DoesNoHarmWhereTheyDoNot) { compare("anything", {}, 1); }

}  // namespace
}  // namespace gfp
