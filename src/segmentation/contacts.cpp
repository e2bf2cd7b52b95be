#include "segmentation/contacts.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace gfp {
namespace {

constexpr int kSearchPx = 24;         // an object's shadow without readings is this wide at most
constexpr int kNormalSpan = 3;        // normals are compared this many pixels into either piece
constexpr float kValleySine = 0.26F;  // 15 deg
constexpr float kLevel = 0.9F, kUpright = 0.6F;

struct Pair {
  std::int32_t a, b;  // pixels of the first and of the second piece
  float distance;
  bool level_direction;  // whether b is beside a in its row
};

class Finder {
 public:
  Finder(const OrganizedCloud& cloud, const PieceMap& map, const std::vector<std::uint8_t>& valid, double tolerance_m, const Eigen::Vector3d& up)
      : cloud_(cloud), map_(map), valid_(valid), tolerance_(static_cast<float>(tolerance_m)), up_(up.cast<float>()) {}

  std::vector<Contact> run() {
    for (const PixelList& pixels : map_.pixels)
      for (const auto i : pixels) {
        look(i, 1, cloud_.width - i % cloud_.width - 1);
        look(i, cloud_.width, cloud_.height - i / cloud_.width - 1);
      }
    std::vector<Contact> contacts;
    for (auto& [key, pairs] : pairs_) contacts.push_back(describe(key, pairs));
    return contacts;
  }

 private:
  Eigen::Vector3f point(std::int32_t i) const { return cloud_.point(static_cast<std::size_t>(i)); }
  std::int32_t piece(std::int32_t i) const { return map_.piece[static_cast<std::size_t>(i)]; }

  void look(std::int32_t i, std::int32_t step, int room) {
    const int limit = std::min(room, kSearchPx);
    for (int k = 1; k <= limit; ++k) {
      const std::int32_t n = i + k * step;
      if (valid_[static_cast<std::size_t>(n)] == 0) continue;
      const auto own = piece(i), other = piece(n);
      if (other < 0 || other == own) return;
      const float distance = (point(i) - point(n)).norm();
      if (own < other) pairs_[{own, other}].push_back({i, n, distance, step == 1});
      else pairs_[{other, own}].push_back({n, i, distance, step == 1});
      return;
    }
  }

  // A normal a little inside the piece, where the box does not reach over the boundary.
  Eigen::Vector3f inner_normal(std::int32_t i, std::int32_t towards) const {
    const std::int32_t deeper = i - kNormalSpan * towards;
    if (deeper >= 0 && deeper < static_cast<std::int32_t>(map_.piece.size()) && piece(deeper) == piece(i)) {
      const Eigen::Vector3f n = map_.normal(deeper);
      if (n.x() == n.x()) return n;
    }
    return map_.normal(i);
  }

  void classify(const Pair& pair, Contact& contact) const {
    const Eigen::Vector3f pa = point(pair.a), pb = point(pair.b);
    const float limit = tolerance_ * std::max(1.0F, pa.z() * pb.z());
    if (pair.distance > limit) {
      ++(pa.z() < pb.z() ? contact.first_nearer : contact.second_nearer);
      return;
    }
    ++contact.touching;
    const std::int32_t step = (pair.b > pair.a ? 1 : -1) * (pair.level_direction ? 1 : cloud_.width);
    const Eigen::Vector3f na = inner_normal(pair.a, step), nb = inner_normal(pair.b, -step);
    const Eigen::Vector3f between = (point(pair.a) - pb).normalized();
    if (!((na - nb).dot(between) < -kValleySine)) return;
    ++contact.concave;
    contact.first_above += nb.dot(up_) > kLevel && na.dot(up_) < kUpright;
    contact.second_above += na.dot(up_) > kLevel && nb.dot(up_) < kUpright;
  }

  Contact describe(const std::pair<int, int>& key, std::vector<Pair>& pairs) const {
    Contact contact;
    contact.first = key.first;
    contact.second = key.second;
    contact.pairs = static_cast<int>(pairs.size());
    for (const Pair& pair : pairs) classify(pair, contact);
    const auto column = [&](const Pair& pair) { return pair.a % cloud_.width + pair.b % cloud_.width; };
    std::stable_sort(pairs.begin(), pairs.end(), [&](const Pair& p, const Pair& q) { return column(p) < column(q); });
    const std::size_t outer = std::max<std::size_t>(1, pairs.size() / 8);
    const auto smallest = [](auto begin, auto end) {
      return static_cast<double>(std::min_element(begin, end, [](const Pair& p, const Pair& q) { return p.distance < q.distance; })->distance);
    };
    const auto first = pairs.begin(), last = pairs.end(), cut = static_cast<std::ptrdiff_t>(outer) + first;
    contact.gap_left_m = smallest(first, cut);
    contact.gap_right_m = smallest(last - static_cast<std::ptrdiff_t>(outer), last);
    contact.gap_m = smallest(first, last);
    std::vector<float> middle;
    for (std::size_t k = pairs.size() / 4; k <= 3 * (pairs.size() - 1) / 4; ++k) middle.push_back(pairs[k].distance);
    if (middle.empty()) middle.push_back(pairs[pairs.size() / 2].distance);
    std::nth_element(middle.begin(), middle.begin() + static_cast<std::ptrdiff_t>(middle.size() / 2), middle.end());
    contact.gap_middle_m = static_cast<double>(middle[middle.size() / 2]);
    return contact;
  }

  const OrganizedCloud& cloud_;
  const PieceMap& map_;
  const std::vector<std::uint8_t>& valid_;
  float tolerance_;
  Eigen::Vector3f up_;
  std::map<std::pair<int, int>, std::vector<Pair>> pairs_;
};

}  // namespace

std::vector<Contact> find_contacts(const OrganizedCloud& cloud, const PieceMap& map, const std::vector<std::uint8_t>& valid,
                                   double tolerance_m, const Eigen::Vector3d& up) {
  return Finder(cloud, map, valid, tolerance_m, up).run();
}

}  // namespace gfp
