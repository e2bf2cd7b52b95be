#include "simulation/render_scene.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace gfp {
namespace {

using Eigen::Vector3d;

constexpr double kNear_m = 0.05;
constexpr double kTableThickness_m = 0.03;
constexpr Rgb8 kFloorColor{96, 92, 88}, kWallColor{205, 203, 196}, kTableColor{170, 132, 92};
constexpr std::int32_t kBackgroundLabel = -1, kTableLabel = -2;

float brightness(const Vector3d& normal_world) {
  static const Vector3d kLight = Vector3d(-0.35, -0.45, 0.82).normalized();  // a lamp above, to the left and front
  return static_cast<float>(0.42 + 0.58 * std::max(0.0, normal_world.dot(kLight)));
}

/// 1/z = a u + b v + c on a plane seen by a pinhole camera.
struct InverseDepth {
  double a = 0, b = 0, c = 0;
};

struct WorldPlane {
  Vector3d normal;
  double offset;  ///< normal . x = offset
};

InverseDepth inverse_depth(const WorldPlane& plane, const CameraModel& camera, const Transform& T_world_camera) {
  const double distance = plane.offset - plane.normal.dot(T_world_camera.translation());
  if (!std::isfinite(distance) || std::abs(distance) < 1e-6) return {};
  const Vector3d n = T_world_camera.linear().transpose() * plane.normal / distance;
  return {n.x() / camera.fx, n.y() / camera.fy, n.z() - n.x() * camera.cx / camera.fx - n.y() * camera.cy / camera.fy};
}

/// One row of the two endless planes: the nearer one in front of the camera, nothing beyond kFarthest_m.
__attribute__((target_clones("arch=x86-64-v3", "default"))) void fill_row(int width, float floor_a, float floor_c, float wall_a, float wall_c,
                                                                         float* depth, std::int32_t* facet) {
  constexpr float kSmallest = static_cast<float>(1.0 / kFarthest_m);
  for (int u = 0; u < width; ++u) {
    const float x = static_cast<float>(u);
    const float floor_inverse = floor_a * x + floor_c, wall_inverse = wall_a * x + wall_c;
    const float inverse = floor_inverse > wall_inverse ? floor_inverse : wall_inverse;
    const bool seen = inverse > kSmallest;
    depth[u] = seen ? 1.0F / inverse : std::numeric_limits<float>::infinity();
    facet[u] = seen ? (floor_inverse > wall_inverse ? 0 : 1) : -1;
  }
}

void fill_planes(const InverseDepth& floor, const InverseDepth& wall, DepthTile& tile) {
  for (int v = 0; v < tile.height; ++v) {
    const std::size_t row = static_cast<std::size_t>(v) * static_cast<std::size_t>(tile.width);
    fill_row(tile.width, static_cast<float>(floor.a), static_cast<float>(floor.b * v + floor.c), static_cast<float>(wall.a),
             static_cast<float>(wall.b * v + wall.c), tile.depth.data() + row, tile.triangle.data() + row);
  }
}

/// Cuts off what is nearer than the near plane (Sutherland-Hodgman): the table may reach behind the camera.
std::vector<Vector3d> clip_near(const std::vector<Vector3d>& polygon) {
  constexpr double kPlane = 1.01 * kNear_m;
  std::vector<Vector3d> kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector3d &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    if (a.z() >= kPlane) kept.push_back(a);
    if ((a.z() >= kPlane) != (b.z() >= kPlane)) kept.push_back(a + (b - a) * ((kPlane - a.z()) / (b.z() - a.z())));
  }
  return kept;
}

class SceneRenderer {
 public:
  SceneRenderer(const VirtualScene& scene, const CameraModel& camera, const Transform& T_world_camera, Rendering& out)
      : scene_(scene), camera_(camera), T_world_camera_(T_world_camera), T_camera_world_(T_world_camera.inverse()), out_(out) {}

  void render() {
    out_.tile.rect = {0, 0, camera_.width, camera_.height};
    out_.tile.step = 1, out_.tile.width = camera_.width, out_.tile.height = camera_.height;
    const std::size_t pixels = static_cast<std::size_t>(camera_.width) * static_cast<std::size_t>(camera_.height);
    out_.tile.depth.resize(pixels), out_.tile.triangle.resize(pixels);
    out_.facets.clear();
    out_.vertices_camera.clear();
    draw_room();
    draw_table();
    for (std::size_t i = 0; i < scene_.objects.size(); ++i) draw_object(scene_.objects[i], static_cast<std::int32_t>(i));
  }

 private:
  void draw_room() {
    const WorldPlane floor{Vector3d::UnitZ(), scene_.floor_z_m}, wall{Vector3d::UnitY(), scene_.wall_y_m};
    add_flat_facet(floor.offset - T_world_camera_.translation().z(), kBackgroundLabel, kFloorColor, Vector3d::UnitZ());
    add_flat_facet(wall.offset - T_world_camera_.translation().y(), kBackgroundLabel, kWallColor, -Vector3d::UnitY());
    fill_planes(inverse_depth(floor, camera_, T_world_camera_), inverse_depth(wall, camera_, T_world_camera_), out_.tile);
  }

  void draw_table() {
    const double x = scene_.table_half_x_m, y = scene_.table_half_y_m, z = -kTableThickness_m;
    draw_quad({{-x, -y, 0}, {x, -y, 0}, {x, y, 0}, {-x, y, 0}}, Vector3d::UnitZ());
    draw_quad({{-x, -y, z}, {x, -y, z}, {x, -y, 0}, {-x, -y, 0}}, -Vector3d::UnitY());
    draw_quad({{x, -y, z}, {x, y, z}, {x, y, 0}, {x, -y, 0}}, Vector3d::UnitX());
    draw_quad({{x, y, z}, {-x, y, z}, {-x, y, 0}, {x, y, 0}}, Vector3d::UnitY());
    draw_quad({{-x, y, z}, {-x, -y, z}, {-x, -y, 0}, {-x, y, 0}}, -Vector3d::UnitX());
  }

  void draw_quad(std::vector<Vector3d> corners, const Vector3d& normal_world) {
    const double distance = normal_world.dot(corners[0] - T_world_camera_.translation());
    if (distance >= 0) return;  // seen from behind
    for (Vector3d& corner : corners) corner = T_camera_world_ * corner;
    const std::vector<Vector3d> polygon = clip_near(corners);
    std::vector<Triangle> fan;
    const RasteriseOptions options{static_cast<std::int32_t>(out_.facets.size()), kNear_m, false};
    for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
      fan.push_back({0, static_cast<std::int32_t>(i), static_cast<std::int32_t>(i + 1)});
      add_flat_facet(distance, kTableLabel, kTableColor, normal_world);
    }
    rasterise(polygon, fan, camera_, out_.tile, options);
  }

  void add_flat_facet(double distance, std::int32_t label, Rgb8 color, const Vector3d& normal_world) {
    const float level = brightness(normal_world);
    out_.facets.push_back({static_cast<float>(std::abs(distance)), label, color, {level, level, level}, {-1, -1, -1}});
  }

  void draw_object(const PlacedMesh& object, std::int32_t label) {
    const Transform T_camera_object = T_camera_world_ * object.T_world_object;
    object_vertices_.resize(object.mesh.vertices.size());
    for (std::size_t i = 0; i < object_vertices_.size(); ++i) object_vertices_[i] = T_camera_object * object.mesh.vertices[i];
    const auto first_vertex = static_cast<std::int32_t>(out_.vertices_camera.size());
    const RasteriseOptions options{static_cast<std::int32_t>(out_.facets.size()), kNear_m, true};
    add_object_facets(object, label, first_vertex);
    out_.vertices_camera.insert(out_.vertices_camera.end(), object_vertices_.begin(), object_vertices_.end());
    rasterise(object_vertices_, object.mesh.triangles, camera_, out_.tile, options);
  }

  void add_object_facets(const PlacedMesh& object, std::int32_t label, std::int32_t first_vertex) {
    face_normals_.clear();
    vertex_normals_.assign(object_vertices_.size(), Vector3d::Zero());
    const auto vertex = [&](std::int32_t i) -> const Vector3d& { return object_vertices_[static_cast<std::size_t>(i)]; };
    for (const Triangle& t : object.mesh.triangles) {
      const Vector3d normal = (vertex(t[1]) - vertex(t[0])).cross(vertex(t[2]) - vertex(t[0]));
      for (const std::int32_t i : t) vertex_normals_[static_cast<std::size_t>(i)] += normal;
      face_normals_.push_back(normal.stableNormalized());
    }
    for (Vector3d& normal : vertex_normals_) normal.stableNormalize();
    for (std::size_t k = 0; k < face_normals_.size(); ++k) {
      const Triangle& t = object.mesh.triangles[k];
      Facet facet{static_cast<float>(std::abs(face_normals_[k].dot(vertex(t[0])))), label, object.color, {}, {}};
      for (std::size_t c = 0; c < 3; ++c) {
        const Vector3d& smooth = vertex_normals_[static_cast<std::size_t>(t[c])];
        constexpr double kCrease = 0.77;  // 40 degrees: what is sharper stays an edge
        const Vector3d& normal = smooth.dot(face_normals_[k]) > kCrease ? smooth : face_normals_[k];
        facet.brightness[c] = brightness(T_world_camera_.linear() * normal);
        facet.corner[c] = first_vertex + t[c];
      }
      out_.facets.push_back(facet);
    }
  }

  const VirtualScene& scene_;
  const CameraModel& camera_;
  const Transform& T_world_camera_;
  const Transform T_camera_world_;
  Rendering& out_;
  std::vector<Vector3d> object_vertices_, face_normals_, vertex_normals_;
};

}  // namespace

void render_scene(const VirtualScene& scene, const CameraModel& camera, const Transform& T_world_camera, Rendering& rendering) {
  SceneRenderer(scene, camera, T_world_camera, rendering).render();
}

}  // namespace gfp
