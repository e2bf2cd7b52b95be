#include "case_picture.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "gfp/core/raster.hpp"

namespace gfp {
namespace {

using Colour = std::function<Eigen::Vector3d(std::size_t triangle)>;  // red, green, blue in [0, 1]
constexpr double kFullError_m = 0.010;
constexpr Rgb8 kPaper{246, 246, 244};

/// A tile's camera: where it stands relative to the object, and its intrinsics for kPictureTile_px squared pixels.
struct Viewpoint {
  Transform T_view_object = Transform::Identity();
  CameraModel camera;
};

// Zooms a camera onto the mesh: the square around its projection, with a margin, becomes the tile.
CameraModel zoomed(const CameraModel& camera, const TriangleMesh& mesh_view) {
  Eigen::Vector2d low(1e9, 1e9), high(-1e9, -1e9);
  for (const auto& v : mesh_view.vertices) {
    const Eigen::Vector2d pixel = camera.project({v.x(), v.y(), std::max(v.z(), 0.05)});
    low = low.cwiseMin(pixel);
    high = high.cwiseMax(pixel);
  }
  const double side = 1.3 * std::max((high - low).maxCoeff(), 8.0), scale = kPictureTile_px / side;
  const Eigen::Vector2d corner = 0.5 * (low + high) - Eigen::Vector2d::Constant(0.5 * side);
  CameraModel zoom = camera;
  zoom.width = zoom.height = kPictureTile_px;
  zoom.fx *= scale;
  zoom.fy *= scale;
  zoom.cx = (camera.cx - corner.x()) * scale;
  zoom.cy = (camera.cy - corner.y()) * scale;
  return zoom;
}

Viewpoint from_camera(const EvaluationCase& shown) {
  const Transform& T = shown.truth.T_camera_object;
  return {T, zoomed(shown.frame.camera, transformed(shown.truth.shape->mesh, T))};
}

// The same camera carried half around the object's up axis.
Viewpoint from_behind(const EvaluationCase& shown) {
  Transform T = shown.truth.T_camera_object;
  T.rotate(Eigen::AngleAxisd(3.141592653589793, Eigen::Vector3d::UnitZ()));
  return {T, zoomed(shown.frame.camera, transformed(shown.truth.shape->mesh, T))};
}

Rgb8 to_rgb(const Eigen::Vector3d& colour) {
  const auto byte = [](double value) { return static_cast<std::uint8_t>(std::lround(255 * std::clamp(value, 0.0, 1.0))); };
  return {byte(colour.x()), byte(colour.y()), byte(colour.z())};
}

// Flat shading with a light at the camera. `mesh_object` in the true object's frame.
Image<Rgb8> render(const TriangleMesh& mesh_object, const Viewpoint& viewpoint, const Colour& colour) {
  const TriangleMesh mesh = transformed(mesh_object, viewpoint.T_view_object);
  DepthTile tile;
  tile.reset({0, 0, kPictureTile_px, kPictureTile_px}, 1);
  rasterise(mesh.vertices, mesh.triangles, viewpoint.camera, tile);
  const auto normals = triangle_normals(mesh);
  Image<Rgb8> image(kPictureTile_px, kPictureTile_px, kPaper);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    if (tile.triangle[i] < 0) continue;
    const std::size_t t = static_cast<std::size_t>(tile.triangle[i]);
    const int u = static_cast<int>(i) % kPictureTile_px, v = static_cast<int>(i) / kPictureTile_px;
    const double facing = std::abs(normals[t].dot(viewpoint.camera.ray(u, v).normalized()));
    image.pixels[i] = to_rgb((0.35 + 0.65 * facing) * colour(t));
  }
  return image;
}

Image<Rgb8> draw_depth(const EvaluationCase& shown, const CameraModel& zoom) {
  const Frame& frame = shown.frame;
  const double scale = zoom.fx / frame.camera.fx;
  const auto source = [&](int u, int v) {
    return Eigen::Vector2i(static_cast<int>(std::lround((u - zoom.cx) / scale + frame.camera.cx)), static_cast<int>(std::lround((v - zoom.cy) / scale + frame.camera.cy)));
  };
  const double centre = shown.truth.T_camera_object.translation().z();
  Image<Rgb8> image(kPictureTile_px, kPictureTile_px, {30, 30, 30});
  for (int v = 0; v < kPictureTile_px; ++v)
    for (int u = 0; u < kPictureTile_px; ++u) {
      const Eigen::Vector2i pixel = source(u, v);
      if (!frame.depth.pixels.contains(pixel.x(), pixel.y()) || frame.depth.pixels.at(pixel.x(), pixel.y()) == 0) continue;
      const double depth = frame.depth.scale_m * frame.depth.pixels.at(pixel.x(), pixel.y());
      const double grey = std::clamp(0.6 - 2.0 * (depth - centre), 0.15, 1.0);  // 10 cm nearer: a fifth brighter
      const bool object = shown.object_mask.at(pixel.x(), pixel.y()) != 0;
      image.at(u, v) = to_rgb(grey * (object ? Eigen::Vector3d(0.55, 1.0, 0.6) : Eigen::Vector3d(0.8, 0.8, 0.85)));
    }
  return image;
}

// Signed distance of each triangle's centre from the true surface: positive outside.
std::vector<double> signed_errors(const TriangleMesh& fit, const TruthShape& truth) {
  const auto normals = triangle_normals(truth.mesh);
  std::vector<double> errors;
  for (const Triangle& t : fit.triangles) {
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    for (const std::int32_t corner : t) centre += fit.vertices[static_cast<std::size_t>(corner)] / 3;
    const auto nearest = truth.tree.closest(centre);
    const bool outside = (centre - nearest.point).dot(normals[static_cast<std::size_t>(nearest.triangle)]) >= 0;
    errors.push_back(outside ? nearest.distance_m : -nearest.distance_m);
  }
  return errors;
}

Eigen::Vector3d error_colour(double error_m) {
  const double share = std::clamp(error_m / kFullError_m, -1.0, 1.0), fade = 1 - std::abs(share);
  return share > 0 ? Eigen::Vector3d(1, fade, fade) : Eigen::Vector3d(fade, fade, 1);
}

void put(const Image<Rgb8>& tile, int place, Image<Rgb8>& row) {
  for (int v = 0; v < tile.height; ++v)
    std::copy_n(&tile.at(0, v), tile.width, &row.at(place * kPictureTile_px, v));
}

bool drawable(const FittedModel& fit) {
  return fit.topology && std::all_of(fit.vertices.begin(), fit.vertices.end(), [](const Eigen::Vector3d& v) { return v.allFinite(); });
}

}  // namespace

Image<Rgb8> draw_case(const EvaluationCase& shown, const std::vector<FittedModel>& fits) {
  const TruthShape& truth = *shown.truth.shape;
  const Viewpoint front = from_camera(shown), back = from_behind(shown);
  const Colour plain = [](std::size_t) { return Eigen::Vector3d(0.80, 0.78, 0.72); };
  Image<Rgb8> row(kPictureTile_px * (3 + 3 * static_cast<int>(fits.size())), kPictureTile_px, kPaper);
  put(draw_depth(shown, front.camera), 0, row);
  put(render(truth.mesh, front, plain), 1, row);
  put(render(truth.mesh, back, plain), 2, row);
  for (std::size_t f = 0; f < fits.size(); ++f) {
    if (!drawable(fits[f])) continue;
    const TriangleMesh mesh = transformed(fits[f].mesh_camera(), shown.truth.T_camera_object.inverse());
    const auto& states = fits[f].states;
    const Colour by_state = [&](std::size_t t) -> Eigen::Vector3d {
      int observed = 0;
      for (const std::int32_t corner : mesh.triangles[t])
        observed += static_cast<std::size_t>(corner) < states.size() && (states[static_cast<std::size_t>(corner)] & kVertexObserved) != 0 ? 1 : 0;
      return observed >= 2 ? Eigen::Vector3d(0.45, 0.65, 0.95) : Eigen::Vector3d(0.95, 0.70, 0.40);
    };
    const auto errors = signed_errors(mesh, truth);
    const Colour by_error = [&](std::size_t t) { return error_colour(errors[t]); };
    const int first = 3 + 3 * static_cast<int>(f);
    put(render(mesh, front, by_state), first, row);
    put(render(mesh, front, by_error), first + 1, row);
    put(render(mesh, back, by_error), first + 2, row);
  }
  return row;
}

}  // namespace gfp
