#include "config/stereo_calibration_file.hpp"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <vector>

#include "config/yaml_document.hpp"

namespace gfp::config {
namespace {

using Numbers = std::vector<double>;

Error missing(const std::string& source, const std::string& key, const char* expected) { return {ErrorCode::kInvalidArgument, fmt::format("{}: {}, expected {}", source, key, expected)}; }

/// Null: all of them have a value.
template <class... Results>
const Error* first_error(const Results&... results) {
  const Error* first = nullptr;
  ((first = first == nullptr && !results ? &results.error() : first), ...);
  return first;
}

/// OpenCV writes `%YAML:1.0`, which is no YAML, and `---`.
std::string plain_yaml(std::string_view text) {
  if (text.starts_with("%YAML")) text.remove_prefix(std::min(text.size(), text.find('\n')));
  return std::string(text);
}

/// The numbers of `key: {rows, cols, data: [...]}` or of a plain list.
Result<Numbers> numbers(const YAML::Node& document, const std::string& key, std::size_t least, std::size_t most, const std::string& source) {
  try {
    if (!document.IsMap() || !document[key]) return tl::unexpected(missing(source, key + " is missing", "a matrix"));
    const YAML::Node node = document[key];
    auto values = (node.IsMap() ? node["data"] : node).as<Numbers>();
    if (values.size() < least || values.size() > most) return tl::unexpected(missing(source, fmt::format("{} has {} numbers", key, values.size()), fmt::format("{} to {}", least, most).c_str()));
    return values;
  } catch (const YAML::Exception& error) {
    return tl::unexpected(missing(source, key, "a list of numbers"));
  }
}

Result<CameraModel> camera_of(const YAML::Node& document, const std::string& matrix, const std::string& distortion, int width, int height, const std::string& source) {
  const auto k = numbers(document, matrix, 9, 9, source);
  if (!k) return tl::unexpected<Error>(k.error());
  auto d = numbers(document, distortion, 0, 14, source);
  if (!d) return tl::unexpected<Error>(d.error());
  for (std::size_t i = 8; i < d->size(); ++i)
    if ((*d)[i] != 0) return tl::unexpected(missing(source, fmt::format("{} has a term {} of the thin-prism model", distortion, i), "at most 8 coefficients"));
  d->resize(std::min<std::size_t>(8, d->size()));
  const auto model = d->size() > 5 ? DistortionModel::kRationalPolynomial : d->empty() ? DistortionModel::kNone : DistortionModel::kPlumbBob;
  return CameraModel{width, height, (*k)[0], (*k)[4], (*k)[2], (*k)[5], model, std::move(*d)};
}

Eigen::Matrix3d matrix3(const Numbers& values) { return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(values.data()); }

Result<StereoCalibration> checked(StereoCalibration calibration, const std::string& source) {
  if (const auto valid = validate(calibration); !valid) return failure(valid.error().code, source + ": " + valid.error().what);
  return calibration;
}

Result<std::pair<int, int>> size_of(const YAML::Node& document, const std::string& source) {
  try {
    for (const auto& [width, height] : {std::pair{"width", "height"}, {"image_width", "image_height"}})
      if (document.IsMap() && document[width] && document[height]) return std::pair{document[width].as<int>(), document[height].as<int>()};
    if (document.IsMap() && document["image_size"]) {
      const auto size = document["image_size"].as<std::vector<int>>();
      if (size.size() == 2) return std::pair{size[0], size[1]};
    }
  } catch (const YAML::Exception&) {
  }
  return tl::unexpected(missing(source, "the size of the pictures is missing", "width and height"));
}

/// One camera of a ROS pair.
struct CameraInfo {
  CameraModel camera;
  Eigen::Matrix3d R;
  Numbers P;
};

Result<CameraInfo> camera_info(std::string_view text, const std::string& source) {
  const auto document = parse_yaml(text, source);
  if (!document) return tl::unexpected<Error>(document.error());
  const auto size = size_of(*document, source);
  if (!size) return tl::unexpected<Error>(size.error());
  auto camera = camera_of(*document, "camera_matrix", "distortion_coefficients", size->first, size->second, source);
  const auto R = numbers(*document, "rectification_matrix", 9, 9, source);
  auto P = numbers(*document, "projection_matrix", 12, 12, source);
  if (const Error* error = first_error(camera, R, P)) return tl::unexpected<Error>(*error);
  return CameraInfo{std::move(*camera), matrix3(*R), std::move(*P)};
}

std::string matrix_text(const char* name, int rows, int cols, const Numbers& values) {
  return fmt::format("{}: !!opencv-matrix\n   rows: {}\n   cols: {}\n   dt: d\n   data: [ {} ]\n", name, rows, cols, fmt::join(values, ", "));
}

Numbers row_major(const Eigen::MatrixXd& matrix) {
  Numbers values;
  for (Eigen::Index r = 0; r < matrix.rows(); ++r)
    for (Eigen::Index c = 0; c < matrix.cols(); ++c) values.push_back(matrix(r, c));
  return values;
}

}  // namespace

Result<StereoCalibration> parse_opencv_stereo(std::string_view text, const std::string& source) {
  const auto document = parse_yaml(plain_yaml(text), source);
  if (!document) return tl::unexpected<Error>(document.error());
  const auto size = size_of(*document, source);
  if (!size) return tl::unexpected<Error>(size.error());
  auto left = camera_of(*document, "M1", "D1", size->first, size->second, source), right = camera_of(*document, "M2", "D2", size->first, size->second, source);
  const auto R = numbers(*document, "R", 9, 9, source), T = numbers(*document, "T", 3, 3, source);
  if (const Error* error = first_error(left, right, R, T)) return tl::unexpected<Error>(*error);
  StereoCalibration calibration{std::move(*left), std::move(*right), Transform::Identity(), Transform::Identity()};
  calibration.T_right_left.linear() = matrix3(*R);
  calibration.T_right_left.translation() = Eigen::Map<const Eigen::Vector3d>(T->data());
  if (document->IsMap() && (*document)["T_world_sensor"]) {
    const auto world = numbers(*document, "T_world_sensor", 16, 16, source);
    if (!world) return tl::unexpected<Error>(world.error());
    calibration.T_world_sensor.matrix() = Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(world->data());
  }
  return checked(std::move(calibration), source);
}

Result<StereoCalibration> parse_ros_stereo(std::string_view left_text, std::string_view right_text, const std::string& source) {
  auto left = camera_info(left_text, source + " (left)"), right = camera_info(right_text, source + " (right)");
  if (!left) return tl::unexpected<Error>(left.error());
  if (!right) return tl::unexpected<Error>(right.error());
  StereoCalibration calibration{left->camera, right->camera, Transform::Identity(), Transform::Identity()};
  // Rectified coordinates differ by the baseline: x_right = x_left + P[3] / P[0].
  calibration.T_right_left.linear() = right->R.transpose() * left->R;
  calibration.T_right_left.translation() = right->R.transpose() * Eigen::Vector3d(right->P[0] != 0 ? right->P[3] / right->P[0] : 0, 0, 0);
  return checked(std::move(calibration), source);
}

Result<StereoCalibration> load_stereo_calibration(const std::string& file_or_files) {
  const std::size_t comma = file_or_files.find(',');
  const auto first = read_text(file_or_files.substr(0, comma));
  if (!first) return tl::unexpected<Error>(first.error());
  if (comma == std::string::npos) return parse_opencv_stereo(*first, file_or_files);
  const auto second = read_text(file_or_files.substr(comma + 1));
  if (!second) return tl::unexpected<Error>(second.error());
  return parse_ros_stereo(*first, *second, file_or_files);
}

std::string to_opencv_yaml(const StereoCalibration& c) {
  const auto k = [](const CameraModel& m) { return Numbers{m.fx, 0, m.cx, 0, m.fy, m.cy, 0, 0, 1}; };
  const auto count = [](const Numbers& values) { return static_cast<int>(values.size()); };
  return fmt::format("%YAML:1.0\n---\nwidth: {}\nheight: {}\n", c.left.width, c.left.height) + matrix_text("M1", 3, 3, k(c.left)) +
         matrix_text("D1", 1, count(c.left.coefficients), c.left.coefficients) + matrix_text("M2", 3, 3, k(c.right)) +
         matrix_text("D2", 1, count(c.right.coefficients), c.right.coefficients) + matrix_text("R", 3, 3, row_major(c.T_right_left.linear())) +
         matrix_text("T", 3, 1, row_major(c.T_right_left.translation())) + matrix_text("T_world_sensor", 4, 4, row_major(c.T_world_sensor.matrix()));
}

}  // namespace gfp::config
