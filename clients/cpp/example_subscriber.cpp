// Meshes and grasps of a running gfpd. Usage: gfp_example_subscriber [ENDPOINT], default: this host's gfpd.
#include <cstdio>

#include "gfp/client/scene_subscriber.hpp"

int main(int argc, char** argv) {
  gfp::SubscriberOptions options;
  if (argc > 1) options.endpoints = {argv[1]};
  auto scenes = gfp::SceneSubscriber::connect(options);
  if (!scenes) return std::fprintf(stderr, "%s\n", scenes.error().what.c_str()), 69;
  while (true) {
    const auto scene = scenes->next(std::chrono::seconds(5));
    if (!scene) {
      std::fprintf(stderr, "%s\n", scene.error().what.c_str());
      continue;
    }
    for (const gfp::SceneObject& object : scene->objects) {
      const gfp::TriangleMesh mesh = object.model.mesh_camera();  // metres, camera frame
      std::printf("%llu %s: %zu vertices, %zu triangles, %zu grasps", static_cast<unsigned long long>(object.id), object.model.class_name.c_str(),
                  mesh.vertices.size(), mesh.triangles.size(), object.grasps.grasps.size());
      if (object.grasps.grasps.empty()) std::printf(" (%s)\n", object.grasps.no_grasp_reason.c_str());
      else std::printf(", best %.0f mm wide\n", 1e3 * object.grasps.grasps.front().width_m);
    }
    std::fflush(stdout);
  }
}
