#include "cli/primitive_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <ostream>
#include <string>
#include <vector>

#include "cli/canvas.hpp"
#include "cli/painter.hpp"

namespace gfp {
namespace {

std::size_t count_manual(const Primitive& primitive) {
  return static_cast<std::size_t>(std::count_if(primitive.manual_types.begin(), primitive.manual_types.end(), [](const auto& type) { return type.has_value(); }));
}

/// One standard deviation of each size as a share of it.
Eigen::Vector3d size_spread(const Primitive& primitive) { return primitive.log_size_covariance.diagonal().cwiseMax(0).cwiseSqrt(); }

bool set_by_hand(const Primitive& primitive, std::size_t vertex) { return !primitive.manual_types.empty() && primitive.manual_types[vertex].has_value(); }

std::string hex(std::uint64_t hash) { return fmt::format("{:016x}", hash); }

// ---- the sheet ----

constexpr int kCell = kPrimitivePicture_px;
constexpr Rgb8 kPaper{18, 18, 24}, kInk{225, 225, 230}, kBody{120, 170, 220}, kControl{255, 210, 60}, kByHand{255, 90, 90};

/// Looks at a body of `radius_m` around `centre` from 30 degrees above and to the side.
Transform view_of(const Eigen::Vector3d& centre, double distance_m) {
  const Eigen::Vector3d forward = Eigen::Vector3d(-0.62, 0.62, -0.48).normalized();
  Transform T_object_view = Transform::Identity();
  T_object_view.linear().col(0) = forward.cross(Eigen::Vector3d::UnitZ()).normalized();
  T_object_view.linear().col(1) = forward.cross(T_object_view.linear().col(0));
  T_object_view.linear().col(2) = forward;
  T_object_view.translation() = centre - distance_m * forward;
  return T_object_view.inverse();
}

/// A cell of a sheet in which a body of `radius_m` around `centre` is seen.
class BodyPicture {
 public:
  BodyPicture(const Eigen::Vector3d& centre, double radius_m)
      : canvas_(kCell, kCell, kPaper), painter_(canvas_, {kCell, kCell, kFocal_px, kFocal_px, 0.5 * (kCell - 1), 0.5 * (kCell - 1), DistortionModel::kNone, {}}),
        T_view_object_(view_of(centre, std::max(radius_m / std::sin(kHalfAngle), radius_m + 0.06))) {}

  void body(const TriangleMesh& mesh, Rgb8 color, double alpha = 1.0) { painter_.meshes({{transformed(mesh, T_view_object_), {}, color}}, alpha); }
  void dot(const Eigen::Vector3d& point, Rgb8 color) { painter_.dot(T_view_object_ * point, 1.2, color, 0.8); }
  void line(const Eigen::Vector3d& from, const Eigen::Vector3d& to, Rgb8 color) { painter_.line(T_view_object_ * from, T_view_object_ * to, color, 2); }
  Image<Rgb8> captioned(const std::string& caption) {
    canvas_.label(0, 0, caption, kInk, 1);
    return canvas_.image();
  }

 private:
  static constexpr double kHalfAngle = 0.3;
  inline static const double kFocal_px = 0.46 * kCell / std::tan(kHalfAngle);
  Canvas canvas_;
  Painter painter_;
  Transform T_view_object_;
};

/// One shape in a cell of its own. All cells of a sheet have the same scale, so that sizes compare.
Image<Rgb8> draw_shape(const Primitive& primitive, const std::vector<double>& modes, double radius_m, const std::string& caption, bool with_controls) {
  const TriangleMesh mesh = shape_mesh(primitive, modes);
  BodyPicture picture(bounds(mesh.vertices).centre(), radius_m);
  picture.body(mesh, kBody);
  for (std::size_t i = 0; with_controls && i < mesh.vertices.size(); ++i)
    if (primitive.topology->types[i] == PointType::kControl) picture.dot(mesh.vertices[i], set_by_hand(primitive, i) ? kByHand : kControl);
  return picture.captioned(caption);
}

}  // namespace

TriangleMesh shape_mesh(const Primitive& primitive, const std::vector<double>& modes) { return {shape(primitive, primitive.typical_size_m(), modes), primitive.topology->triangles}; }

std::size_t count_controls(const Primitive& primitive) {
  return static_cast<std::size_t>(std::count(primitive.topology->types.begin(), primitive.topology->types.end(), PointType::kControl));
}

std::string symmetry_text(const Symmetry& symmetry) {
  std::vector<std::string> parts;
  if (symmetry.revolution) parts.emplace_back("revolution about z");
  if (!symmetry.revolution && symmetry.cyclic > 1) parts.push_back(fmt::format("{}-fold about z", symmetry.cyclic));
  if (symmetry.mirror_x) parts.emplace_back("mirror x = 0");
  if (symmetry.mirror_y) parts.emplace_back("mirror y = 0");
  if (symmetry.flip_z) parts.emplace_back("upside down");
  return parts.empty() ? "none" : fmt::format("{}", fmt::join(parts, ", "));
}

nlohmann::json primitive_json(const Primitive& primitive) {
  using nlohmann::json;
  const Eigen::Vector3d size = primitive.typical_size_m(), spread = size_spread(primitive);
  json poses = json::array();
  for (const StablePose& pose : primitive.stable_poses) poses.push_back({{"name", pose.name}, {"probability", pose.probability}});
  const Symmetry& symmetry = primitive.symmetry;
  return {{"name", primitive.name},
          {"class", primitive.class_name},
          {"aliases", primitive.aliases},
          {"schema_version", Primitive::kSchemaVersion},
          {"vertices", primitive.size()},
          {"triangles", primitive.topology->triangles.size()},
          {"control_points", count_controls(primitive)},
          {"regular_points", primitive.size() - count_controls(primitive)},
          {"manual_types", count_manual(primitive)},
          {"features", primitive.features},
          {"typical_size_m", {size.x(), size.y(), size.z()}},
          {"size_spread", {spread.x(), spread.y(), spread.z()}},
          {"modes", primitive.modes.size()},
          {"mode_sigma", primitive.mode_sigma},
          {"residual_sigma", primitive.residual_sigma},
          {"symmetry", {{"revolution", symmetry.revolution}, {"cyclic", symmetry.cyclic}, {"mirror_x", symmetry.mirror_x}, {"mirror_y", symmetry.mirror_y}, {"flip_z", symmetry.flip_z}}},
          {"genus", primitive.genus},
          {"hollow", primitive.hollow},
          {"stable_poses", poses},
          {"contact_pairs", primitive.contact_pairs.size()},
          {"rest_edge_length_m", primitive.rest_edge_length},
          {"provenance", {{"source", primitive.provenance.source}, {"licence", primitive.provenance.licence}, {"members", primitive.provenance.members}}},
          {"topology_hash", hex(primitive.topology->hash)},
          {"content_hash", hex(primitive.content_hash)}};
}

void print_primitive(std::ostream& out, const Primitive& primitive) {
  const Eigen::Vector3d size_mm = 1e3 * primitive.typical_size_m(), spread = 100 * size_spread(primitive);
  const auto line = [&out](const char* name, const std::string& value) { out << fmt::format("{:<16}{}\n", name, value); };
  line("name", primitive.name);
  line("class", primitive.class_name + (primitive.aliases.empty() ? "" : fmt::format(" (also {})", fmt::join(primitive.aliases, ", "))));
  line("points", fmt::format("{}: {} control, {} regular, {} set by hand; {} features", primitive.size(), count_controls(primitive),
                             primitive.size() - count_controls(primitive), count_manual(primitive), primitive.features));
  line("triangles", fmt::format("{}, edges of {:.1f} mm", primitive.topology->triangles.size(), 1e3 * primitive.rest_edge_length));
  line("typical size", fmt::format("{:.0f} x {:.0f} x {:.0f} mm (+-{:.0f}, {:.0f}, {:.0f} %)", size_mm.x(), size_mm.y(), size_mm.z(), spread.x(), spread.y(), spread.z()));
  line("modes", fmt::format("{}, RMS displacement of one sigma: {:.3f}; unexplained {:.3f}", primitive.modes.size(), fmt::join(primitive.mode_sigma, ", "), primitive.residual_sigma));
  line("symmetry", symmetry_text(primitive.symmetry));
  line("topology", fmt::format("genus {}, {}", primitive.genus, primitive.hollow ? "hollow" : "solid"));
  for (const StablePose& pose : primitive.stable_poses) line("rests", fmt::format("{} {:.2f}", pose.name, pose.probability));
  line("contact pairs", std::to_string(primitive.contact_pairs.size()));
  line("source", fmt::format("{}, {} members, {}", primitive.provenance.source, primitive.provenance.members, primitive.provenance.licence));
  line("content hash", hex(primitive.content_hash));
}

Image<Rgb8> draw_body(const TriangleMesh& mesh, const std::string& caption, Rgb8 color) {
  const Bounds box = bounds(mesh.vertices);
  BodyPicture picture(box.centre(), 0.5 * box.size().norm());
  picture.body(mesh, color);
  return picture.captioned(caption);
}

Image<Rgb8> draw_symmetry(const Primitive& primitive) {
  constexpr Rgb8 kAxis{255, 90, 90}, kPlane{120, 230, 140};
  const TriangleMesh mesh = shape_mesh(primitive);
  const Bounds box = bounds(mesh.vertices);
  BodyPicture picture(box.centre(), 0.62 * box.size().norm());
  picture.body(mesh, kBody, 0.6);
  const Eigen::Vector3d low = box.centre() - 0.58 * box.size(), high = box.centre() + 0.58 * box.size();
  const auto frame = [&](int axis) {  // the rectangle in the plane x = 0 or y = 0
    const auto corner = [&](double along, double z) { return axis == 0 ? Eigen::Vector3d(0, along, z) : Eigen::Vector3d(along, 0, z); };
    const double near = axis == 0 ? low.y() : low.x(), far = axis == 0 ? high.y() : high.x();
    const Eigen::Vector3d corners[4] = {corner(near, low.z()), corner(far, low.z()), corner(far, high.z()), corner(near, high.z())};
    for (int k = 0; k < 4; ++k) picture.line(corners[k], corners[(k + 1) % 4], kPlane);
  };
  const Symmetry& symmetry = primitive.symmetry;
  if (symmetry.mirror_x && !symmetry.revolution) frame(0);
  if (symmetry.mirror_y && !symmetry.revolution) frame(1);
  if (symmetry.revolution || symmetry.cyclic > 1) picture.line({0, 0, low.z()}, {0, 0, high.z()}, kAxis);
  return picture.captioned(symmetry.revolution ? "revolution" : symmetry.cyclic > 1 ? fmt::format("{}-fold", symmetry.cyclic) : "symmetry");
}

Image<Rgb8> draw_primitive(const Primitive& primitive) {
  const std::size_t modes = primitive.modes.size();
  std::vector<std::vector<Image<Rgb8>>> rows;
  double radius_m = 1e-3;
  const auto coefficients = [](std::size_t mode, double value) {
    std::vector<double> result(mode + 1, 0.0);
    result[mode] = value;
    return result;
  };
  for (std::size_t k = 0; k < std::max<std::size_t>(1, modes); ++k)
    for (const double sigma : {-2.0, 2.0})
      radius_m = std::max(radius_m, 0.5 * bounds(shape(primitive, primitive.typical_size_m(), modes == 0 ? std::vector<double>{} : coefficients(k, sigma))).size().norm());
  const Eigen::Vector3d size_mm = 1e3 * primitive.typical_size_m();
  rows.push_back({draw_shape(primitive, {}, radius_m, fmt::format("{} {:.0f} x {:.0f} x {:.0f} mm", primitive.name, size_mm.x(), size_mm.y(), size_mm.z()), false),
                  draw_shape(primitive, {}, radius_m, fmt::format("{} control points", count_controls(primitive)), true)});
  for (std::size_t k = 0; k < modes; ++k) {
    rows.emplace_back();
    for (const double sigma : {-2.0, 0.0, 2.0})
      rows.back().push_back(draw_shape(primitive, coefficients(k, sigma), radius_m, fmt::format("mode {} {:+.0f} sigma", k + 1, sigma), false));
  }
  Canvas sheet(3 * kCell, static_cast<int>(rows.size()) * kCell, kPaper);
  for (std::size_t r = 0; r < rows.size(); ++r)
    for (std::size_t c = 0; c < rows[r].size(); ++c) sheet.paste(rows[r][c], static_cast<int>(c) * kCell, static_cast<int>(r) * kCell);
  return sheet.image();
}

}  // namespace gfp
