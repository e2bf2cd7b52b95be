#include "bench/peers_opencv_stereo.hpp"

#include <cstring>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace gfp::bench {
namespace {

cv::Mat view_of(const Image<std::uint8_t>& image) { return cv::Mat(image.height, image.width, CV_8U, const_cast<std::uint8_t*>(image.pixels.data())); }

}  // namespace

OpencvStereo::OpencvStereo(int min_disparity_px, int disparities) : min_disparity_px_(min_disparity_px), disparities_(disparities) { cv::setNumThreads(1); }

Image<std::int16_t> OpencvStereo::match(const Image<std::uint8_t>& left, const Image<std::uint8_t>& right) const {
  constexpr int kBlock = 3;
  const auto sgbm = cv::StereoSGBM::create(min_disparity_px_, disparities_, kBlock, 8 * kBlock * kBlock, 32 * kBlock * kBlock, 1, 63, 10, 100, 2, cv::StereoSGBM::MODE_SGBM_3WAY);
  cv::Mat disparity;
  sgbm->compute(view_of(left), view_of(right), disparity);
  Image<std::int16_t> found(disparity.cols, disparity.rows);
  std::memcpy(found.pixels.data(), disparity.ptr(), 2 * found.pixels.size());
  return found;
}

Image<std::uint8_t> read_scaled(const std::filesystem::path& file, int width, int height) {
  const cv::Mat grey = cv::imread(file.string(), cv::IMREAD_GRAYSCALE);
  Image<std::uint8_t> image(width, height);
  cv::Mat scaled(height, width, CV_8U, image.pixels.data());
  cv::resize(grey, scaled, scaled.size(), 0, 0, cv::INTER_AREA);
  return image;
}

}  // namespace gfp::bench
