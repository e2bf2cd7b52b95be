#include "cli/scene_diff.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

#include "gfp/core/mesh.hpp"

namespace gfp {
namespace {

constexpr double kSameObject_m = 0.1;

std::string text(const Eigen::Vector3d& v) { return fmt::format("{:.4f} {:.4f} {:.4f}", v.x(), v.y(), v.z()); }

/// Compares one pair of objects; every difference gets the frame and the ids.
class ObjectComparison {
 public:
  ObjectComparison(Difference head, const DiffObject& a, const DiffObject& b, const DiffTolerances& tolerances, std::vector<Difference>& out)
      : head_(std::move(head)), a_(a), b_(b), tolerances_(tolerances), out_(out) {
    head_.id_a = a.id;
    head_.id_b = b.id;
  }

  void run() {
    words("class", a_.class_name, b_.class_name);
    words("method", a_.method, b_.method);
    const Eigen::Vector3d at_a = a_.T_camera_object.translation(), at_b = b_.T_camera_object.translation();
    measure("position", (at_a - at_b).norm(), tolerances_.position_m, text(at_a), text(at_b));
    const Eigen::Vector3d turn = rotation_vector(a_.T_camera_object.linear().transpose() * b_.T_camera_object.linear());
    measure("angle", turn.norm(), tolerances_.angle_rad, "0", text(turn));
    measure("size", (a_.extents_m - b_.extents_m).cwiseAbs().maxCoeff(), tolerances_.size_m, text(a_.extents_m), text(b_.extents_m));
    vertices();
    if (tolerances_.grasps) grasps();
  }

 private:
  void add(const std::string& what, double delta, double tolerance, std::string a, std::string b) {
    Difference difference = head_;
    difference.what = what;
    difference.a = std::move(a);
    difference.b = std::move(b);
    difference.delta = delta;
    difference.tolerance = tolerance;
    out_.push_back(std::move(difference));
  }
  void measure(const std::string& what, double delta, double tolerance, std::string a, std::string b) {
    if (!(delta <= tolerance)) add(what, delta, tolerance, std::move(a), std::move(b));
  }
  void words(const std::string& what, const std::string& a, const std::string& b) {
    if (a != b) add(what, 0, 0, a, b);
  }

  void vertices() {
    if (a_.vertices.empty() || b_.vertices.empty()) return;  // one source does not tell
    if (a_.topology != b_.topology || a_.vertices.size() != b_.vertices.size()) {
      add("topology", 0, 0, fmt::format("{:016x}, {} vertices", a_.topology, a_.vertices.size()), fmt::format("{:016x}, {} vertices", b_.topology, b_.vertices.size()));
      return;
    }
    std::size_t worst = 0;
    double delta = 0;
    for (std::size_t i = 0; i < a_.vertices.size(); ++i)
      if (const double d = (a_.vertices[i] - b_.vertices[i]).norm(); d > delta) delta = d, worst = i;
    measure("vertices", delta, tolerances_.vertex_m, fmt::format("vertex {}: {}", worst, text(a_.vertices[worst])), fmt::format("vertex {}: {}", worst, text(b_.vertices[worst])));
  }

  void grasps() {
    words("no_grasp_reason", a_.no_grasp_reason, b_.no_grasp_reason);
    if (a_.grasps.size() != b_.grasps.size()) {
      add("grasps", 0, 0, std::to_string(a_.grasps.size()), std::to_string(b_.grasps.size()));
      return;
    }
    for (std::size_t i = 0; i < a_.grasps.size(); ++i) {
      const Grasp &a = a_.grasps[i], &b = b_.grasps[i];
      const std::string which = fmt::format("grasp {} ", i);
      const Eigen::Vector3d at_a = a.T_camera_tcp.translation(), at_b = b.T_camera_tcp.translation();
      measure(which + "position", (at_a - at_b).norm(), tolerances_.position_m, text(at_a), text(at_b));
      const Eigen::Vector3d turn = rotation_vector(a.T_camera_tcp.linear().transpose() * b.T_camera_tcp.linear());
      measure(which + "angle", turn.norm(), tolerances_.angle_rad, "0", text(turn));
      measure(which + "width", std::abs(a.width_m - b.width_m), tolerances_.width_m, fmt::format("{:.4f}", a.width_m), fmt::format("{:.4f}", b.width_m));
      measure(which + "epsilon", std::abs(a.epsilon - b.epsilon), tolerances_.epsilon, fmt::format("{:.4f}", a.epsilon), fmt::format("{:.4f}", b.epsilon));
    }
  }

  Difference head_;
  const DiffObject &a_, &b_;
  const DiffTolerances& tolerances_;
  std::vector<Difference>& out_;
};

/// Pairs of indices, the nearest first; each object in one pair at most.
std::vector<std::pair<std::size_t, std::size_t>> match(const std::vector<DiffObject>& a, const std::vector<DiffObject>& b) {
  std::vector<std::tuple<double, std::size_t, std::size_t>> candidates;
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t j = 0; j < b.size(); ++j) {
      const double distance = (a[i].T_camera_object.translation() - b[j].T_camera_object.translation()).norm();
      if (distance <= kSameObject_m) candidates.emplace_back(distance, i, j);
    }
  std::sort(candidates.begin(), candidates.end());
  std::vector<bool> has_a(a.size(), false), has_b(b.size(), false);
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (const auto& [distance, i, j] : candidates) {
    if (has_a[i] || has_b[j]) continue;
    has_a[i] = has_b[j] = true;
    pairs.emplace_back(i, j);
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

std::string describe(const DiffObject& object) { return fmt::format("{} at {}", object.class_name, text(object.T_camera_object.translation())); }

void compare_frame(const DiffFrame& a, const DiffFrame& b, std::size_t number, const DiffTolerances& tolerances, std::vector<Difference>& out) {
  Difference head;
  head.frame = number;
  head.stamp = a.stamp;
  const auto pairs = match(a.objects, b.objects);
  for (const auto& [i, j] : pairs) ObjectComparison(head, a.objects[i], b.objects[j], tolerances, out).run();
  head.what = "object";
  for (std::size_t i = 0; i < a.objects.size(); ++i) {
    if (std::any_of(pairs.begin(), pairs.end(), [&](const auto& pair) { return pair.first == i; })) continue;
    Difference missing = head;
    missing.id_a = a.objects[i].id;
    missing.a = describe(a.objects[i]);
    out.push_back(std::move(missing));
  }
  for (std::size_t j = 0; j < b.objects.size(); ++j) {
    if (std::any_of(pairs.begin(), pairs.end(), [&](const auto& pair) { return pair.second == j; })) continue;
    Difference added = head;
    added.id_b = b.objects[j].id;
    added.b = describe(b.objects[j]);
    out.push_back(std::move(added));
  }
}

using Key = std::pair<std::string, Nanoseconds>;

/// By sensor and stamp; where each side has one sensor only, its name does not matter.
std::map<Key, std::size_t> index_of(const std::vector<DiffFrame>& frames, bool by_sensor) {
  std::map<Key, std::size_t> index;
  for (std::size_t i = 0; i < frames.size(); ++i) index.emplace(Key{by_sensor ? frames[i].sensor : "", frames[i].stamp}, i);
  return index;
}

bool has_one_sensor(const std::vector<DiffFrame>& frames) {
  return std::all_of(frames.begin(), frames.end(), [&](const DiffFrame& frame) { return frame.sensor == frames.front().sensor; });
}

}  // namespace

std::vector<Difference> compare_scenes(const std::vector<DiffFrame>& a, const std::vector<DiffFrame>& b, const DiffTolerances& tolerances) {
  const bool by_sensor = !has_one_sensor(a) || !has_one_sensor(b);
  const auto in_a = index_of(a, by_sensor), in_b = index_of(b, by_sensor);
  std::vector<Difference> out;
  const auto lonely = [&](std::size_t number, const DiffFrame& frame, bool is_a) {
    Difference difference;
    difference.frame = number;
    difference.stamp = frame.stamp;
    difference.what = "frame";
    (is_a ? difference.a : difference.b) = fmt::format("{} objects", frame.objects.size());
    out.push_back(std::move(difference));
  };
  for (const auto& [key, number] : in_a) {
    const auto other = in_b.find(key);
    if (other == in_b.end()) lonely(number, a[number], true);
    else compare_frame(a[number], b[other->second], number, tolerances, out);
  }
  for (const auto& [key, number] : in_b)
    if (!in_a.contains(key)) lonely(number, b[number], false);
  return out;
}

}  // namespace gfp
