#include "config/camera_file.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "config/field_loader.hpp"
#include "config/yaml_document.hpp"
#include "gfp/core/image.hpp"

namespace gfp {
namespace {

struct DistortionFields {
  std::string model = "none";
  std::vector<double> coefficients;
};

template <class Visitor>
void visit_fields(DistortionFields& o, Visitor&& field) {
  field("model", o.model, OneOf{{"none", "plumb_bob", "rational_polynomial"}});
  field("coefficients", o.coefficients, -1e6, 1e6);
}

/// The camera file as it is written. The bounds here are of the file; validate(CameraModel) has the final say.
struct CameraFields {
  int width = 0, height = 0;
  double fx = 0, fy = 0, cx = 0, cy = 0;
  double depth_scale = 0;
  DistortionFields distortion;
  Transform T_world_sensor = Transform::Identity();
};

template <class Visitor>
void visit_fields(CameraFields& o, Visitor&& field) {
  field("width", o.width, 1, kMaxImageSide);
  field("height", o.height, 1, kMaxImageSide);
  field("fx", o.fx, 1e-3, 1e5);
  field("fy", o.fy, 1e-3, 1e5);
  field("cx", o.cx, -1e5, 1e5);
  field("cy", o.cy, -1e5, 1e5);
  field("depth_scale", o.depth_scale, 1e-7, 1.0);
  field.section("distortion", o.distortion);
  field("T_world_sensor", o.T_world_sensor);
}

DistortionModel distortion_model(const std::string& name) {
  if (name == "plumb_bob") return DistortionModel::kPlumbBob;
  return name == "rational_polynomial" ? DistortionModel::kRationalPolynomial : DistortionModel::kNone;
}

}  // namespace

namespace config {

Result<CameraFile> parse_camera_file(std::string_view text, const std::string& source) {
  const auto document = parse_yaml(text, source);
  if (!document) return tl::unexpected(document.error());
  CameraFields fields;
  if (Result<void> loaded = load_fields(*document, source, fields); !loaded) return tl::unexpected(loaded.error());
  for (const char* key : {"width", "height", "fx", "fy", "cx", "cy"})
    if (!document->IsMap() || !(*document)[key]) return failure(ErrorCode::kInvalidArgument, fmt::format("{}: {} is missing", source, key));
  CameraFile file;
  file.camera = {fields.width, fields.height, fields.fx, fields.fy, fields.cx, fields.cy, distortion_model(fields.distortion.model),
                 fields.distortion.coefficients};
  if (fields.depth_scale > 0) file.depth_scale_m = fields.depth_scale;
  file.T_world_sensor = fields.T_world_sensor;
  if (Result<void> valid = validate(file.camera); !valid)
    return failure(valid.error().code, fmt::format("{}: {}", source, valid.error().what));
  return file;
}

Result<CameraFile> load_camera_file(const std::filesystem::path& file) {
  const auto text = read_text(file);
  if (!text) return tl::unexpected(text.error());
  return parse_camera_file(*text, file.string());
}

Result<CameraFile> load_camera(const std::string& file_or_inline) {
  std::error_code status;
  const bool is_inline = file_or_inline.find(',') != std::string::npos && !std::filesystem::exists(file_or_inline, status);
  return is_inline ? parse_inline_camera(file_or_inline) : load_camera_file(file_or_inline);
}

}  // namespace config
}  // namespace gfp
