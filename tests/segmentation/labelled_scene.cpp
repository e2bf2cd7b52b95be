#include "segmentation/labelled_scene.hpp"

#include <liblzf/lzf.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <map>
#include <sstream>

namespace gfp::test {
namespace {

std::string header_value(const std::string& header, const std::string& key) {
  const auto at = header.find("\n" + key + " ");
  if (at == std::string::npos) return {};
  const auto start = at + key.size() + 2;
  return header.substr(start, header.find('\n', start) - start);
}

std::string read_all(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::stringstream content;
  content << stream.rdbuf();
  return content.str();
}

}  // namespace

std::filesystem::path data_directory() {
  if (const char* directory = std::getenv("GFP_DATA_DIR")) return directory;
  return std::filesystem::path(GFP_SOURCE_DIR) / "../shared/data";
}

std::optional<LabelledScene> read_pcd_scene(const std::filesystem::path& file, const CameraModel& camera) {
  const std::string content = read_all(file);
  const std::string marker = "DATA binary_compressed\n";
  const auto marker_at = content.find(marker);
  if (marker_at == std::string::npos) return std::nullopt;
  const std::string header = content.substr(0, marker_at);
  const int width = std::stoi(header_value(header, "WIDTH")), height = std::stoi(header_value(header, "HEIGHT"));
  const auto pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);

  const char* payload = content.data() + marker_at + marker.size();
  std::uint32_t sizes[2];  // compressed, uncompressed
  std::memcpy(sizes, payload, sizeof sizes);
  std::vector<char> fields(sizes[1]);
  if (lzf_decompress(payload + 8, sizes[0], fields.data(), sizes[1]) != sizes[1]) return std::nullopt;

  std::map<std::string, const char*> planes;  // a field after the other, each a whole plane
  std::istringstream names(header_value(header, "FIELDS"));
  std::size_t offset = 0;
  for (std::string name; names >> name; offset += 4 * pixels) planes[name] = fields.data() + offset;
  const auto word = [&]<class T>(const char* plane, std::size_t i, T value) {
    std::memcpy(&value, plane + 4 * i, 4);
    return value;
  };

  LabelledScene scene{file.stem().string(), {}, camera, Image<Rgb8>(width, height), Image<std::int32_t>(width, height)};
  scene.depth.scale_m = 1e-4;
  scene.depth.pixels = Image<std::uint16_t>(width, height);
  const char* color = planes.contains("rgba") ? planes["rgba"] : planes["rgb"];
  for (std::size_t i = 0; i < pixels; ++i) {
    const float z = std::abs(word(planes["z"], i, 0.0F));
    if (z == z && z < 6.5F) scene.depth.pixels.pixels[i] = static_cast<std::uint16_t>(std::lround(1e4F * z));
    const auto packed = word(color, i, std::uint32_t{});
    scene.color.pixels[i] = {static_cast<std::uint8_t>(packed >> 16), static_cast<std::uint8_t>(packed >> 8), static_cast<std::uint8_t>(packed)};
    if (planes.contains("label")) {
      const auto label = word(planes["label"], i, std::uint32_t{});
      scene.objects.pixels[i] = label >= 20 ? static_cast<std::int32_t>(label / 10) : 0;
    }
  }
  return scene;
}

std::vector<LabelledScene> read_osd_learn() {
  const auto directory = data_directory() / "scenes/osd_learn";
  std::vector<std::filesystem::path> files;
  std::error_code absent;
  for (const auto& entry : std::filesystem::directory_iterator(directory, absent))
    if (entry.path().extension() == ".pcd") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  std::vector<LabelledScene> scenes;
  for (const auto& file : files)
    if (auto scene = read_pcd_scene(file, default_kinect_camera())) scenes.push_back(std::move(*scene));
  return scenes;
}

Coverage coverage(const LabelledScene& scene, const Image<std::int32_t>& labels) {
  std::map<std::int32_t, int> object_pixels, segment_pixels;
  std::map<std::pair<std::int32_t, std::int32_t>, int> common;
  for (std::size_t i = 0; i < labels.pixels.size(); ++i) {
    if (scene.depth.pixels.pixels[i] == 0) continue;
    const auto object = scene.objects.pixels[i], segment = labels.pixels[i];
    if (object >= 2) ++object_pixels[object];
    if (segment >= 0) ++segment_pixels[segment];
    if (object >= 2 && segment >= 0) ++common[{object, segment}];
  }
  Coverage result;
  for (const auto& [object, count] : object_pixels) {
    double best = 0;
    for (const auto& [pair, both] : common)
      if (pair.first == object) best = std::max(best, static_cast<double>(both) / (count + segment_pixels[pair.second] - both));
    result.best_iou.push_back(best);
    result.sum += best;
    ++result.objects;
  }
  return result;
}

}  // namespace gfp::test
