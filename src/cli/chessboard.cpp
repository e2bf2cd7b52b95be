#include "cli/chessboard.hpp"

#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

namespace gfp {
namespace {

using Corners = std::vector<cv::Point2f>;

std::vector<Eigen::Vector2f> find(const Image<std::uint8_t>& image, const Chessboard& board) {
  const cv::Mat grey(image.height, image.width, CV_8U, const_cast<std::uint8_t*>(image.pixels.data()));
  Corners corners;
  if (!cv::findChessboardCorners(grey, {board.columns, board.rows}, corners, cv::CALIB_CB_ADAPTIVE_THRESH | cv::CALIB_CB_NORMALIZE_IMAGE)) return {};
  cv::cornerSubPix(grey, corners, {11, 11}, {-1, -1}, {cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 30, 0.01});
  std::vector<Eigen::Vector2f> found;
  for (const cv::Point2f& corner : corners) found.emplace_back(corner.x, corner.y);
  return found;
}

Corners points(const std::vector<Eigen::Vector2f>& corners) {
  Corners all;
  for (const Eigen::Vector2f& corner : corners) all.emplace_back(corner.x(), corner.y());
  return all;
}

CameraModel camera_of(const cv::Mat& K, const cv::Mat& D, int width, int height) {
  CameraModel camera{width, height, K.at<double>(0, 0), K.at<double>(1, 1), K.at<double>(0, 2), K.at<double>(1, 2), DistortionModel::kPlumbBob, {}};
  for (int i = 0; i < 5; ++i) camera.coefficients.push_back(D.at<double>(i));
  return camera;
}

}  // namespace

BoardView find_board(const Image<std::uint8_t>& left, const Image<std::uint8_t>& right, const Chessboard& board) {
  BoardView view{find(left, board), find(right, board)};
  return view.left.empty() || view.right.empty() ? BoardView{} : view;
}

Result<CalibrationResult> calibrate_stereo(const std::vector<BoardView>& views, const Chessboard& board, int width, int height) {
  if (views.size() < 3) return failure(ErrorCode::kTooFewPoints, "pairs with the whole board = " + std::to_string(views.size()) + ", expected at least 3");
  std::vector<cv::Point3f> model;
  for (int row = 0; row < board.rows; ++row)
    for (int column = 0; column < board.columns; ++column) model.emplace_back(static_cast<float>(board.square_m * column), static_cast<float>(board.square_m * row), 0.0F);
  const std::vector<std::vector<cv::Point3f>> models(views.size(), model);
  std::vector<Corners> left, right;
  for (const BoardView& view : views) left.push_back(points(view.left)), right.push_back(points(view.right));
  try {
    const cv::Size size(width, height);
    cv::Mat K1, D1, K2, D2, R, T, E, F;
    cv::calibrateCamera(models, left, size, K1, D1, cv::noArray(), cv::noArray(), cv::CALIB_FIX_K3);
    cv::calibrateCamera(models, right, size, K2, D2, cv::noArray(), cv::noArray(), cv::CALIB_FIX_K3);
    CalibrationResult result;
    result.rms_px = cv::stereoCalibrate(models, left, right, K1, D1, K2, D2, size, R, T, E, F, cv::CALIB_USE_INTRINSIC_GUESS | cv::CALIB_FIX_K3, {cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 100, 1e-6});
    result.calibration.left = camera_of(K1, D1, width, height);
    result.calibration.right = camera_of(K2, D2, width, height);
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) result.calibration.T_right_left.linear()(i, j) = R.at<double>(i, j);
      result.calibration.T_right_left.translation()(i) = T.at<double>(i);
    }
    if (const auto valid = validate(result.calibration); !valid) return tl::unexpected<Error>(valid.error());
    return result;
  } catch (const cv::Exception& error) {
    return failure(ErrorCode::kDegenerateGeometry, "OpenCV cannot calibrate from these pictures: " + error.err);
  }
}

}  // namespace gfp
