#pragma once

#include <memory>
#include <string>

#include "gfp/core/random.hpp"
#include "gfp/scene/scene.hpp"
#include "support/box_model.hpp"

namespace gfp::test {

inline Transform random_pose(Random& random) {
  const Eigen::Vector3d omega(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
  Transform pose = Transform::Identity();
  pose.linear() = rotation_from_vector(omega);
  pose.translation() = Eigen::Vector3d(random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3), random.uniform(0.5, 1.5));
  return pose;
}

inline Grasp hand_made_grasp(Random& random) {
  Grasp grasp;
  grasp.T_camera_tcp = random_pose(random);
  grasp.T_camera_parent = random_pose(random);
  grasp.T_camera_pregrasp_tcp = random_pose(random);
  grasp.gripper = "parallel_85";
  grasp.width_m = random.uniform(0.01, 0.08);
  grasp.approach = grasp.T_camera_tcp.linear().col(0);
  grasp.epsilon = random.uniform(0.01, 0.2);
  grasp.volume_quality = random.uniform();
  grasp.force_closure = true;
  grasp.p_force_closure = random.uniform();
  grasp.epsilon_lcb = random.uniform(0, 0.01);
  for (GraspContact& contact : grasp.contacts)
    contact = {Eigen::Vector3d(random.uniform(), random.uniform(), random.uniform()), Eigen::Vector3d::UnitY(), random.below(2) == 1};
  grasp.collision_margin_m = random.uniform(0, 0.05);
  grasp.visibility = "one";
  grasp.abstain = random.below(2) == 1;
  grasp.score = random.uniform();
  return grasp;
}

inline SceneObject hand_made_object(std::uint64_t id, Random& random) {
  SceneObject object;
  object.id = id;
  object.status = ObjectStatus::kUpdated;
  object.class_probabilities = {{"box", 0.75}, {"unknown", 0.25}};
  object.model = box_model("gfp_robust", "box", Eigen::Vector3d((64 + random.below(128)) / 1024.0, 0.125, 0.15625), random.uniform());
  auto topology = std::make_shared<Topology>(*object.model.topology);
  topology->hash = 0xB0C5'0000'0000'0001;
  topology->filled_triangles = topology->triangles;
  object.model.topology = topology;
  object.model.T_camera_object = random_pose(random);
  object.model.modes = {0.5, -1.25};
  object.model.stable_pose = 1;
  object.model.states[0] = 0;
  for (float& sigma : object.model.sigma_m) sigma = static_cast<float>(random.uniform(0.0005, 0.02));
  for (Eigen::Index i = 0; i < 36; ++i) object.model.pose_covariance.data()[i] = random.uniform(-1e-4, 1e-4);
  object.model.yaw_low_rad = -0.4;
  object.model.yaw_high_rad = 0.3;
  object.model.evidence = {0.002, 0.98, 0.9, 0.01, 0.85, 0.001, 0.002, 1.5, 0.7};
  object.model.iterations = 8;
  object.model.energies = {0.5, 0.25, 0.125 + random.uniform()};
  object.model.converged = true;
  object.grasps.grasps = {hand_made_grasp(random), hand_made_grasp(random)};
  object.pixels = 1234;
  object.bbox = {10, 20, 60, 90};
  object.occluded = true;
  object.volume_material_m3 = 1e-4;
  object.volume_filled_m3 = 2e-4;
  object.closed = true;
  object.fresh = false;
  object.ms = {{"fit", 4.5}};
  return object;
}

/// A scene in which no member has its default value, of `objects` boxes with ids 1, 2...; the last has no grasp.
inline Scene hand_made_scene(int objects = 2, std::uint64_t seed = 1) {
  Random random(seed);
  Scene scene;
  scene.sensor = "front";
  scene.sequence = 42 + seed;
  scene.stamps = {Nanoseconds(1'000'000'007 + static_cast<std::int64_t>(seed)), Nanoseconds(2'000'000'011), Nanoseconds(1'700'000'000'000'000'013)};
  scene.camera = default_kinect_camera();
  scene.camera.distortion = DistortionModel::kPlumbBob;
  scene.camera.coefficients = {0.1, -0.2, 0, 0, 0.01};
  scene.T_world_sensor = random_pose(random);
  scene.support = SupportPlane{random_pose(random), {{0, 0}, {1, 0}, {0.5, 0.7}}, 0.0015, 54321};
  for (int i = 1; i <= objects; ++i) scene.objects.push_back(hand_made_object(static_cast<std::uint64_t>(i), random));
  if (objects > 0) scene.objects.back().grasps = {{}, "too_wide"};
  scene.lost = {77, 99};
  scene.rejected = {{120, "too_small"}};
  scene.profile = "robust";
  scene.ms = {{"cloud", 1.5}, {"objects", 12.25}};
  return scene;
}

}  // namespace gfp::test
