#pragma once

#include <Eigen/Core>
#include <vector>

#include "gfp/core/image.hpp"
#include "gfp/frame/stereo_calibration.hpp"

namespace gfp {

/// Inner corners of a chessboard and the side of a square.
struct Chessboard {
  int columns = 9, rows = 6;
  double square_m = 0;
};

/// Corners of one board as both eyes see them, row by row; empty where either does not see all of it.
struct BoardView {
  std::vector<Eigen::Vector2f> left, right;
};

/// Finds the board with OpenCV, to a fraction of a pixel.
BoardView find_board(const Image<std::uint8_t>& left, const Image<std::uint8_t>& right, const Chessboard& board);

struct CalibrationResult {
  StereoCalibration calibration;
  double rms_px = 0;  ///< Reprojection error over all corners of both eyes.
};

/// Zhang's method with a plumb-bob lens for each eye, then both together (OpenCV: calibrateCamera, stereoCalibrate).
/// Errors: kTooFewPoints (fewer than 3 boards), kDegenerateGeometry (OpenCV refuses them), kInvalidArgument (the result is no stereo camera).
Result<CalibrationResult> calibrate_stereo(const std::vector<BoardView>& views, const Chessboard& board, int width, int height);

}  // namespace gfp
