#pragma once

#include <fmt/format.h>
#include <liblzf/lzf.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "gfp/core/camera_model.hpp"
#include "gfp/core/image.hpp"
#include "replay/axes.hpp"

/// Writers of the formats that the driver reads, for tests: the simplest code that follows the formats.
namespace gfp::test {

template <class T>
void put(std::string& out, T value) {
  out.append(reinterpret_cast<const char*>(&value), sizeof(value));
}

inline std::string lzf(const std::string& bytes) {
  std::string out(bytes.size() + bytes.size() / 8 + 64, '\0');
  out.resize(lzf_compress(bytes.data(), static_cast<unsigned>(bytes.size()), out.data(), static_cast<unsigned>(out.size())));
  return out;
}

/// A cloud as a test draws it: optical frame, NaN where there is no reading.
struct DrawnCloud {
  int width = 0, height = 0;
  std::vector<float> x, y, z;
  std::vector<std::uint32_t> rgb, label;
};

/// A tilted wall with a hole, seen by `camera`; file axes as given (then x, y, z are what the file says).
inline DrawnCloud draw_wall(const CameraModel& camera, const Axes& axes = {}) {
  DrawnCloud cloud{camera.width, camera.height, {}, {}, {}, {}, {}};
  for (int v = 0; v < camera.height; ++v)
    for (int u = 0; u < camera.width; ++u) {
      const double depth = 0.8 + 0.2 * u / camera.width + 0.1 * v / camera.height;
      const Eigen::Vector3d optical = depth * camera.ray(u, v);
      float file[3];
      for (std::size_t i = 0; i < 3; ++i)
        file[axes.index[i]] = static_cast<float>(axes.sign[i] * optical[static_cast<Eigen::Index>(i)]);
      const bool hole = u % 7 == 0 && v % 5 == 0;
      const float nan = std::numeric_limits<float>::quiet_NaN();
      cloud.x.push_back(hole ? nan : file[0]);
      cloud.y.push_back(hole ? nan : file[1]);
      cloud.z.push_back(hole ? nan : file[2]);
      cloud.rgb.push_back(static_cast<std::uint32_t>(u % 256) << 16U | static_cast<std::uint32_t>(v % 256) << 8U | 7U);
      cloud.label.push_back(static_cast<std::uint32_t>(u / 8));
    }
  return cloud;
}

inline std::string pcd_header(const DrawnCloud& cloud, const char* kind) {
  return fmt::format(
      "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS label x y z rgba\nSIZE 4 4 4 4 4\nTYPE U F F F U\nCOUNT 1 1 1 1 1\n"
      "WIDTH {}\nHEIGHT {}\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS {}\nDATA {}\n",
      cloud.width, cloud.height, cloud.z.size(), kind);
}

inline std::string ascii_pcd(const DrawnCloud& cloud) {
  std::string out = pcd_header(cloud, "ascii");
  for (std::size_t i = 0; i < cloud.z.size(); ++i)
    out += fmt::format("{} {} {} {} {}\n", cloud.label[i], cloud.x[i], cloud.y[i], cloud.z[i], cloud.rgb[i]);
  return out;
}

inline std::string binary_pcd(const DrawnCloud& cloud) {
  std::string out = pcd_header(cloud, "binary");
  for (std::size_t i = 0; i < cloud.z.size(); ++i)
    put(out, cloud.label[i]), put(out, cloud.x[i]), put(out, cloud.y[i]), put(out, cloud.z[i]), put(out, cloud.rgb[i]);
  return out;
}

inline std::string compressed_pcd(const DrawnCloud& cloud) {
  std::string planes;
  for (const auto value : cloud.label) put(planes, value);
  for (const auto* column : {&cloud.x, &cloud.y, &cloud.z})
    for (const auto value : *column) put(planes, value);
  for (const auto value : cloud.rgb) put(planes, value);
  const std::string packed = lzf(planes);
  std::string out = pcd_header(cloud, "binary_compressed");
  put(out, static_cast<std::uint32_t>(packed.size()));
  put(out, static_cast<std::uint32_t>(planes.size()));
  return out + packed;
}

inline std::string pclzf(int width, int height, const char* type, const std::string& pixels) {
  std::string out = "PCLZF";
  put(out, width), put(out, height);
  std::string name(type);
  name.resize(16, ' ');
  out += name;
  const std::string packed = lzf(pixels);
  put(out, static_cast<std::uint32_t>(packed.size()));
  put(out, static_cast<std::uint32_t>(pixels.size()));
  return out + packed;
}

inline std::string depth_pclzf(const Image<std::uint16_t>& depth) {
  std::string pixels;
  for (const auto value : depth.pixels) put(pixels, value);
  return pclzf(depth.width, depth.height, "depth16", pixels);
}

inline constexpr char kPclzfXml[] =
    "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n<rgb>\n<focal_length_x>1</focal_length_x>\n</rgb>\n<depth>\n"
    "\t<focal_length_x>525</focal_length_x>\n\t<focal_length_y>526</focal_length_y>\n\t<principal_point_x>320</principal_point_x>\n"
    "\t<principal_point_y>240</principal_point_y>\n\t<z_multiplication_factor>0.001</z_multiplication_factor>\n</depth>\n";

}  // namespace gfp::test
