#include "segmentation/assemble.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "segmentation/piece_shape.hpp"

namespace gfp {
namespace {

constexpr int kFragmentPixels = 250;      // smaller pieces are fragments at a cut,
constexpr int kFragmentShare = 12;        // and so are those below a twelfth of the other
constexpr double kReachesSupport = 0.022; // a lower outline this near to the support stands on it
constexpr double kSameHeight = 0.010;     // two parts of one rim, or of one box
constexpr double kHollow = -0.0008;       // bulge of an inner wall: -1 mm for a cup, -10 mm for a bowl
constexpr double kFlare = 0.025;          // a rim stands out over its own wall by no more,
constexpr double kFlareHeight = 0.6;      // and the wall is seen from this share of the rim's height downwards
constexpr double kSeenThrough = 0.7;      // share of the outline that something nearer surrounds,
constexpr double kMouthShare = 0.6;       // most of it one thing
constexpr double kHangingGap = 0.05;      // a part is no farther from what it hangs on
constexpr double kOverhangGap = 0.12;     // what bears it is hidden by it for longer
constexpr double kDividedGap = 0.30;      // an occluder hides no more of one object than this

class Assembler {
 public:
  Assembler(const OrganizedCloud& cloud, const PieceMap& map, const std::vector<Contact>& contacts, const Eigen::Vector3d& up, const SegmentationOptions& options)
      : cloud_(cloud), map_(map), options_(options), up_(up), contacts_(contacts), root_(map.pixels.size()) {
    for (std::size_t p = 0; p < root_.size(); ++p) root_[p] = static_cast<int>(p);
  }

  void shape(const std::vector<std::uint8_t>& valid, const std::vector<const FlatSurface*>& supports) {
    shapes_.resize(root_.size());
    oneapi::tbb::parallel_for(std::size_t{0}, root_.size(), [&](std::size_t p) {
      shapes_[p] = piece_shape(cloud_, map_, valid, static_cast<int>(p), supports[p], options_.cluster_tolerance_m);
    });
  }

  std::vector<int> run() {
    repeat([&](const Contact& c) { return continues(c); });
    attach_each([&](int p) { return is_fragment(p) ? strongest(p, [&](const Contact& c) { return c.touching > 0; }) : -1; });
    repeat([&](const Contact& c) { return continues(c) || encloses(c); });
    join_rims();
    attach_each([&](int p) { return mouth_of(p); });
    repeat([&](const Contact& c) { return overhangs(c); });
    attach_each([&](int p) { return mouth_of(p); });
    attach_each([&](int p) { return hangs(p) ? hanging_on(p) : far_side_of(p); });
    join_rims();
    join_divided();
    std::vector<int> number(root_.size(), -1), object(root_.size());
    int count = 0;
    for (int p = 0; p < static_cast<int>(root_.size()); ++p) {
      int& n = number[static_cast<std::size_t>(find(p))];
      if (n < 0) n = count++;
      object[static_cast<std::size_t>(p)] = n;
    }
    return object;
  }

 private:
  int find(int p) const {
    while (root_[static_cast<std::size_t>(p)] != p) p = root_[static_cast<std::size_t>(p)];
    return p;
  }
  const PieceShape& of(int p) const { return shapes_[static_cast<std::size_t>(p)]; }

  // Joins two groups and sums their contacts up; the lower index stays the root.
  void join(int a, int b) {
    a = find(a);
    b = find(b);
    if (a == b) return;
    if (b < a) std::swap(a, b);
    root_[static_cast<std::size_t>(b)] = a;
    shapes_[static_cast<std::size_t>(a)].add(of(b));
    std::map<std::pair<int, int>, Contact> merged;
    for (Contact c : contacts_) {
      int first = find(c.first), second = find(c.second);
      if (first == second) continue;
      if (second < first) {
        std::swap(first, second);
        std::swap(c.first_nearer, c.second_nearer);
        std::swap(c.first_above, c.second_above);
      }
      c.first = first;
      c.second = second;
      const auto [at, fresh] = merged.try_emplace({first, second}, c);
      if (!fresh) add(c, at->second);
    }
    contacts_.clear();
    for (const auto& [key, c] : merged) contacts_.push_back(c);
  }
  static void add(const Contact& c, Contact& sum) {
    sum.pairs += c.pairs;
    sum.touching += c.touching;
    sum.concave += c.concave;
    sum.first_nearer += c.first_nearer;
    sum.second_nearer += c.second_nearer;
    sum.first_above += c.first_above;
    sum.second_above += c.second_above;
    sum.gap_m = std::min(sum.gap_m, c.gap_m);
  }

  template <class Rule>
  void repeat(Rule&& rule) {
    for (bool changed = true; changed;) {
      changed = false;
      for (const Contact& c : contacts_) {
        if (!rule(c)) continue;
        join(c.first, c.second);
        changed = true;
        break;
      }
    }
  }

  // `host(p)`: what group p belongs to, or -1. The smallest first: a fragment's fragment goes along with it.
  template <class Host>
  void attach_each(Host&& host) {
    std::vector<int> order;
    for (int p = 0; p < static_cast<int>(root_.size()); ++p)
      if (find(p) == p) order.push_back(p);
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return of(a).pixels < of(b).pixels; });
    for (const int p : order) {
      const int group = find(p);  // what joined it comes along
      if (const int h = host(group); h >= 0) join(group, h);
    }
  }

  // The neighbour with the longest contact among those that `usable` admits; -1 where there is none.
  template <class Usable>
  int strongest(int p, Usable&& usable) const {
    int best = -1, most = 0;
    for (const Contact& c : contacts_) {
      if (!c.is_of(p) || !usable(c) || of(c.other(p)).pixels < of(p).pixels || c.touching <= most) continue;
      most = c.touching;
      best = c.other(p);
    }
    return best;
  }

  static bool continues(const Contact& c) { return c.touching >= 6 && 4 * c.touching >= c.pairs && 2 * c.concave <= c.touching; }

  bool is_fragment(int p) const {
    if (of(p).pixels < kFragmentPixels) return true;
    for (const Contact& c : contacts_)
      if (c.is_of(p) && 4 * c.touching >= c.pairs && kFragmentShare * of(p).pixels < of(c.other(p)).pixels) return true;
    return false;
  }

  /// Pairs with all others.
  int outline(int p) const {
    int pairs = 0;
    for (const Contact& c : contacts_) pairs += c.is_of(p) ? c.pairs : 0;
    return pairs;
  }

  // A floor within a wall: most of the smaller one's outline touches the other, which rises above it.
  bool encloses(const Contact& c) const {
    const int smaller = of(c.first).pixels < of(c.second).pixels ? c.first : c.second;
    const PieceShape &inner = of(smaller), &outer = of(c.other(smaller));
    const double circumference = 3.5 * std::sqrt(static_cast<double>(inner.pixels));  // of a disc, in pixels across both axes
    return inner.top_m < outer.top_m - 0.01 && c.touching > 0.5 * std::max<double>(circumference, outline(smaller));
  }

  // Behind the other's outline, as high as it, and hollow. Halves of one hollow are joined first: neither need be hollow alone.
  void join_rims() {
    repeat([&](const Contact& c) {
      if (c.touching < 6 || std::abs(of(c.first).top_m - of(c.second).top_m) > kSameHeight) return false;
      PieceShape both = of(c.first);
      both.add(of(c.second));
      return both.bulge_m() < kHollow && in_front_of_both(c.first, c.second, both.top_m) >= 0;
    });
    repeat([&](const Contact& c) {
      if (2 * c.nearer(c.front()) < c.pairs || c.pairs < 5) return false;
      const PieceShape &front = of(c.front()), &back = of(c.other(c.front()));
      if (std::abs(front.top_m - back.top_m) > kSameHeight || back.bulge_m() > kHollow) return false;
      const double across = (front.mean_point() - back.mean_point()).norm();
      return front.bulge_m() > back.bulge_m() && across <= 0.6 * options_.max_size_m;
    });
  }

  /// A flared rim hides the top of the outer wall below it: nearer than the wall, and both nearly as high.
  bool overhangs(const Contact& c) const {
    const PieceShape &rim = of(c.front()), &wall = of(c.other(c.front()));
    if (c.pairs < 8 || 2 * c.nearer(c.front()) < c.pairs || c.gap_m > kFlare) return false;
    if (rim.bulge_m() > kHollow || wall.top_m > rim.top_m || wall.top_m < kFlareHeight * rim.top_m) return false;
    return level(wall.mean_point() - rim.mean_point()).dot(level(rim.mean_point())) < 0;  // on the camera's side of it
  }

  /// What is seen through a mouth is the inside: surrounded by what is nearer and higher, mostly by one thing, and not beside that, as what is seen through
  /// a handle. That one thing, or -1.
  int mouth_of(int p) const {
    int hidden = 0, most = 0, mouth = -1;
    for (const Contact& c : contacts_) {
      if (!c.is_of(p)) continue;
      const int other = c.other(p), nearer = c.nearer(other);
      hidden += nearer;
      if (nearer > most) most = nearer, mouth = other;
    }
    const int around = outline(p) + of(p).open;
    if (mouth < 0 || hidden < kSeenThrough * around || most < kMouthShare * around || of(mouth).top_m < of(p).top_m) return -1;
    const Eigen::Vector3d away = level(of(mouth).mean_point()).normalized(), off = level(of(p).mean_point() - of(mouth).mean_point());
    const double behind = off.dot(away), beside = (off - behind * away).norm();
    return beside < 0.6 * of(mouth).spread_m() && behind < 4 * of(mouth).spread_m() ? mouth : -1;
  }
  Eigen::Vector3d level(const Eigen::Vector3d& v) const { return v - up_ * up_.dot(v); }

  // Nothing bears it: it ends above the support, and what is below its outline is farther away.
  bool hangs(int p) const { return of(p).base_m > kReachesSupport && 10 * of(p).foot_hidden < 6 * of(p).foot; }

  // A small part high up, close behind something that it is not higher than: the far side of a handle.
  int far_side_of(int p) const {
    if (of(p).base_m < 0.05) return -1;
    for (const Contact& c : contacts_) {
      if (!c.is_of(p) || c.gap_m > 0.03) continue;
      const int other = c.other(p);
      if (8 * of(p).pixels < of(other).pixels && of(p).top_m <= of(other).top_m) return other;
    }
    return -1;
  }

  int hanging_on(int p) const {
    for (const Contact& c : contacts_)
      if (stands_on(c, p)) return -1;
    if (const int touched = strongest(p, [](const Contact& c) { return c.touching >= 3; }); touched >= 0) return touched;
    int nearest = -1;
    double gap = kHangingGap;
    for (const Contact& c : contacts_) {
      if (!c.is_of(p) || c.gap_m >= gap || of(c.other(p)).pixels < of(p).pixels) continue;
      gap = c.gap_m;
      nearest = c.other(p);
    }
    return nearest >= 0 ? nearest : borne_by(p);
  }

  // What hangs over something on the support is borne by it: a drill's body on its grip, of which less may be seen.
  int borne_by(int p) const {
    int nearest = -1;
    double gap = kOverhangGap;
    for (const Contact& c : contacts_) {
      if (!c.is_of(p) || c.gap_m >= gap || 2 * c.nearer(p) < c.pairs) continue;
      const PieceShape& foot = of(c.other(p));
      if (foot.base_m > kReachesSupport || foot.top_m > of(p).top_m || foot.pixels < kFragmentPixels) continue;
      if (level(foot.mean_point() - of(p).mean_point()).norm() > of(p).spread_m()) continue;
      gap = c.gap_m;
      nearest = c.other(p);
    }
    return nearest;
  }

  // It rises from a level top of the other, over most of the contact, and is more than a knob.
  bool stands_on(const Contact& c, int p) const {
    return c.is_of(p) && c.touching >= 10 && 2 * c.above(p) >= c.touching && of(p).top_m - of(p).base_m >= 0.02 && 6 * of(p).pixels >= of(c.other(p)).pixels;
  }

  // One surface on both sides of something nearer.
  void join_divided() {
    for (int a = 0; a < static_cast<int>(root_.size()); ++a)
      for (int b = a + 1; b < static_cast<int>(root_.size()); ++b)
        if (find(a) == a && find(b) == b && divided(a, b)) join(a, b);
  }

  bool divided(int a, int b) const {
    const PieceShape &sa = of(a), &sb = of(b);
    if (std::min(sa.pixels, sb.pixels) < kFragmentPixels) return false;
    if (std::abs(sa.top_m - sb.top_m) > kSameHeight || std::abs(sa.base_m - sb.base_m) > 2 * kSameHeight) return false;
    const Eigen::Vector3d na = sa.mean_normal().normalized(), nb = sb.mean_normal().normalized(), between = sb.mean_point() - sa.mean_point();
    if (na.dot(nb) < 0.96 || between.norm() > options_.max_size_m) return false;
    if (std::abs(between.dot((na + nb).normalized())) > 0.012) return false;
    const int occluder = in_front_of_both(a, b);
    return occluder >= 0 && hides_the_gap(a, b, occluder);
  }

  // A group in front of both; as high as `top_m` where that is given.
  int in_front_of_both(int a, int b, double top_m = std::numeric_limits<double>::quiet_NaN()) const {
    for (int o = 0; o < static_cast<int>(root_.size()); ++o)
      if (o != a && o != b && find(o) == o && !(std::abs(of(o).top_m - top_m) > kSameHeight) && in_front(o, a) && in_front(o, b)) return o;
    return -1;
  }
  bool in_front(int o, int p) const {
    return std::any_of(contacts_.begin(), contacts_.end(), [&](const Contact& c) { return c.is_of(o) && c.is_of(p) && c.nearer(o) >= 10; });
  }

  // Along the line between the middles there is nothing but the two, the occluder and missing readings.
  bool hides_the_gap(int a, int b, int occluder) const {
    const Eigen::Vector3d pa = of(a).mean_point(), pb = of(b).mean_point();
    int other = 0;
    Eigen::Vector3d left = pa, entered = pb;
    constexpr int kSteps = 200;
    for (int k = 0; k <= kSteps; ++k) {
      const Eigen::Vector3d p = pa + (pb - pa) * k / kSteps;
      const Eigen::Vector2d pixel = cloud_.camera.project(p);
      const int u = static_cast<int>(std::lround(pixel.x())), v = static_cast<int>(std::lround(pixel.y()));
      if (u < 0 || v < 0 || u >= cloud_.width || v >= cloud_.height) return false;
      const auto i = static_cast<std::size_t>(v) * static_cast<std::size_t>(cloud_.width) + static_cast<std::size_t>(u);
      const int piece = map_.piece[i] < 0 ? -1 : find(map_.piece[i]);
      if (piece == a) left = p;
      if (piece == b && (entered - pb).norm() < 1e-12) entered = p;
      other += cloud_.valid(i) && piece != a && piece != b && piece != occluder;
    }
    return 10 * other < kSteps && (entered - left).norm() <= kDividedGap;
  }

  const OrganizedCloud& cloud_;
  const PieceMap& map_;
  const SegmentationOptions& options_;
  const Eigen::Vector3d up_;
  std::vector<Contact> contacts_;
  std::vector<int> root_;
  std::vector<PieceShape> shapes_;
};

}  // namespace

std::vector<int> assemble(const OrganizedCloud& cloud, const PieceMap& map, const std::vector<std::uint8_t>& valid,
                          const std::vector<Contact>& contacts, const std::vector<const FlatSurface*>& supports, const Eigen::Vector3d& up, const SegmentationOptions& options) {
  Assembler assembler(cloud, map, contacts, up, options);
  assembler.shape(valid, supports);
  return assembler.run();
}

}  // namespace gfp
