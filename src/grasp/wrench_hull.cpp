#include "grasp/wrench_hull.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <optional>
#include <queue>
#include <vector>

#include "gfp/core/random.hpp"

namespace gfp {
namespace {

constexpr double kBeyond = 1e-10;  // a wrench this close to a facet lies in it; generators have length about 1
constexpr double kFlat = 1e-9;

struct Facet {
  std::array<double, 6> normal;
  double offset;
  std::array<std::int32_t, 6> vertices;
  std::array<std::int32_t, 6> neighbours;  // neighbours[i] shares all vertices but vertices[i]
  double beyond = 0;                       // of the wrench that is being added
  int seen_at = -1;                        // which addition computed `beyond`
  bool alive = true;
};

struct Nearest {
  double offset;
  std::int32_t facet;
  bool operator>(const Nearest& other) const { return offset != other.offset ? offset > other.offset : facet > other.facet; }
};

double height(const Facet& facet, const Wrench& w) {
  double sum = -facet.offset;
  for (std::size_t d = 0; d < 6; ++d) sum += facet.normal[d] * w[static_cast<Eigen::Index>(d)];
  return sum;
}

class GrowingHull {
 public:
  explicit GrowingHull(std::span<const Wrench> wrenches) : wrenches_(wrenches) {
    Random random(0x67666857u);  // keys only have to differ
    for (std::size_t i = 0; i < wrenches.size(); ++i) keys_.push_back(random.next());
    facets_.reserve(4096);
  }

  bool start();                                  // false: the wrenches span less than six dimensions
  std::optional<std::int32_t> nearest_own();     // a facet of the hull itself, nearest first; nullopt when none is left
  const Facet& facet(std::int32_t index) const { return facets_[static_cast<std::size_t>(index)]; }
  double offset_of_support(const Facet& facet) const;
  double volume() const;
  bool consistent() const { return consistent_; }

 private:
  struct Ridge {  // a ridge between two new facets, waiting for its second
    std::uint64_t key;
    std::int32_t facet, slot;
    int stamp;
  };

  void push(Facet facet);
  void add(std::int32_t seed, std::int32_t point);
  void find_visible(std::int32_t seed, std::int32_t point);
  std::int32_t new_facet(const Facet& visible, std::size_t slot, std::int32_t point);
  void join(std::int32_t facet);
  Facet& at(std::int32_t index) { return facets_[static_cast<std::size_t>(index)]; }
  const Wrench& wrench(std::int32_t index) const { return wrenches_[static_cast<std::size_t>(index)]; }

  std::span<const Wrench> wrenches_;
  std::vector<std::uint64_t> keys_;  // a ridge's key is the exclusive or of its vertices' keys
  std::vector<Facet> facets_;
  std::priority_queue<Nearest, std::vector<Nearest>, std::greater<>> queue_;
  std::vector<std::int32_t> visible_, created_;
  std::vector<Ridge> waiting_ = std::vector<Ridge>(1 << 12, Ridge{0, -1, -1, -1});
  std::size_t waiting_count_ = 0;
  int additions_ = 0;
  bool consistent_ = true;
};

/// Seven wrenches far from each other (Gram-Schmidt with pivoting), as six plus one vertices of a simplex.
bool GrowingHull::start() {
  const auto n = static_cast<std::int32_t>(wrenches_.size());
  if (n < 7) return false;
  std::array<std::int32_t, 7> corners{};
  std::int32_t farthest = 0;
  for (std::int32_t i = 1; i < n; ++i)
    if (wrench(i).squaredNorm() > wrench(farthest).squaredNorm()) farthest = i;
  corners[0] = farthest;
  std::vector<Wrench> rest(wrenches_.begin(), wrenches_.end());
  for (Wrench& w : rest) w -= wrench(farthest);
  for (std::size_t c = 1; c < 7; ++c) {
    std::int32_t best = 0;
    for (std::int32_t i = 1; i < n; ++i)
      if (rest[static_cast<std::size_t>(i)].squaredNorm() > rest[static_cast<std::size_t>(best)].squaredNorm()) best = i;
    const double length = rest[static_cast<std::size_t>(best)].norm();
    if (!(length > kFlat)) return false;
    const Wrench direction = rest[static_cast<std::size_t>(best)] / length;
    for (Wrench& w : rest) w -= direction.dot(w) * direction;
    corners[c] = best;
  }
  Wrench inside = Wrench::Zero();
  for (const std::int32_t corner : corners) inside += wrench(corner) / 7.0;
  for (std::size_t left_out = 0; left_out < 7; ++left_out) {
    Facet facet;
    for (std::size_t i = 0, slot = 0; i < 7; ++i) {
      if (i == left_out) continue;
      facet.vertices[slot] = corners[i];
      facet.neighbours[slot++] = static_cast<std::int32_t>(i);  // the facet that leaves out corner i
    }
    Eigen::Matrix<double, 5, 6> edges;
    for (std::size_t i = 0; i < 5; ++i) edges.row(static_cast<Eigen::Index>(i)) = (wrench(facet.vertices[i + 1]) - wrench(facet.vertices[0])).transpose();
    Wrench normal = edges.fullPivLu().kernel().col(0).normalized();
    if (normal.dot(inside - wrench(facet.vertices[0])) > 0) normal = -normal;
    Eigen::Map<Wrench>(facet.normal.data()) = normal;
    facet.offset = normal.dot(wrench(facet.vertices[0]));
    push(facet);
  }
  return true;
}

void GrowingHull::push(Facet facet) {
  queue_.push({facet.offset, static_cast<std::int32_t>(facets_.size())});
  facets_.push_back(facet);
}

std::optional<std::int32_t> GrowingHull::nearest_own() {
  while (!queue_.empty() && consistent_) {
    const std::int32_t index = queue_.top().facet;
    queue_.pop();
    if (!facet(index).alive) continue;
    std::int32_t farthest = -1;
    double beyond = kBeyond;
    for (std::size_t i = 0; i < wrenches_.size(); ++i) {
      const double h = height(facet(index), wrenches_[i]);
      if (h > beyond) { beyond = h; farthest = static_cast<std::int32_t>(i); }
    }
    if (farthest < 0) return index;
    add(index, farthest);
  }
  return std::nullopt;
}

void GrowingHull::add(std::int32_t seed, std::int32_t point) {
  ++additions_;
  find_visible(seed, point);
  created_.clear();
  waiting_count_ = 0;
  for (const std::int32_t v : visible_)
    for (std::size_t slot = 0; slot < 6; ++slot) {
      const Facet& neighbour = facet(facet(v).neighbours[slot]);
      if (neighbour.beyond <= kBeyond || neighbour.seen_at != additions_) created_.push_back(new_facet(facet(v), slot, point));
    }
  for (const std::int32_t v : visible_) at(v).alive = false;
  for (const std::int32_t c : created_) join(c);
  consistent_ = consistent_ && waiting_count_ == 0;
}

/// All facets that `point` lies beyond, connected to `seed`; their other neighbours get `beyond` too.
void GrowingHull::find_visible(std::int32_t seed, std::int32_t point) {
  const Wrench& w = wrench(point);
  visible_.assign(1, seed);
  at(seed).seen_at = additions_;
  at(seed).beyond = height(facet(seed), w);
  for (std::size_t next = 0; next < visible_.size(); ++next)
    for (const std::int32_t n : std::array(facet(visible_[next]).neighbours)) {
      Facet& neighbour = at(n);
      if (neighbour.seen_at == additions_) continue;
      neighbour.seen_at = additions_;
      neighbour.beyond = height(neighbour, w);
      if (neighbour.beyond > kBeyond) visible_.push_back(n);
    }
}

/// The facet over `visible`'s ridge opposite to `slot` with `point`; its hyperplane is a combination of the ridge's two.
std::int32_t GrowingHull::new_facet(const Facet& visible, std::size_t slot, std::int32_t point) {
  const auto index = static_cast<std::int32_t>(facets_.size());
  const std::int32_t across = visible.neighbours[slot];
  Facet& hidden = at(across);
  const double a = visible.beyond, b = std::max(0.0, -hidden.beyond);
  Facet facet;
  double squared = 0;
  for (std::size_t d = 0; d < 6; ++d) {
    facet.normal[d] = a * hidden.normal[d] + b * visible.normal[d];
    squared += facet.normal[d] * facet.normal[d];
  }
  const double scale = 1.0 / std::sqrt(squared);
  for (double& x : facet.normal) x *= scale;
  facet.offset = scale * (a * hidden.offset + b * visible.offset);
  consistent_ = consistent_ && std::isfinite(facet.offset);
  facet.vertices = visible.vertices;
  facet.vertices[slot] = point;
  facet.neighbours.fill(-1);
  facet.neighbours[slot] = across;
  // The hidden facet's slot of this ridge: its one vertex that the ridge lacks.
  for (std::size_t i = 0; i < 6; ++i) {
    const std::int32_t v = hidden.vertices[i];
    if (std::find(facet.vertices.begin(), facet.vertices.end(), v) == facet.vertices.end()) hidden.neighbours[i] = index;
  }
  push(facet);
  return index;
}

/// Links a new facet with the other new facets over the ridges that hold the new point.
void GrowingHull::join(std::int32_t index) {
  if (2 * (waiting_count_ + 6) > waiting_.size()) {  // one addition met more open ridges than the table holds
    consistent_ = false;
    return;
  }
  std::uint64_t all = 0;
  for (const std::int32_t v : facet(index).vertices) all ^= keys_[static_cast<std::size_t>(v)];
  for (std::size_t slot = 0; slot < 6; ++slot) {
    if (facet(index).neighbours[slot] >= 0) continue;
    const std::uint64_t key = all ^ keys_[static_cast<std::size_t>(facet(index).vertices[slot])];
    std::size_t place = key & (waiting_.size() - 1);
    while (waiting_[place].stamp == additions_ && waiting_[place].key != key) place = (place + 1) & (waiting_.size() - 1);
    Ridge& ridge = waiting_[place];
    if (ridge.stamp != additions_) {
      ridge = {key, index, static_cast<std::int32_t>(slot), additions_};
      ++waiting_count_;
    } else if (ridge.facet >= 0) {
      at(index).neighbours[slot] = ridge.facet;
      at(ridge.facet).neighbours[static_cast<std::size_t>(ridge.slot)] = index;
      ridge.facet = -1;
      --waiting_count_;
    } else {
      consistent_ = false;  // a third facet at one ridge: rounding broke the horizon
    }
  }
}

double GrowingHull::offset_of_support(const Facet& facet) const {
  double support = -1e300;
  for (const Wrench& w : wrenches_) support = std::max(support, height(facet, w) + facet.offset);
  return support;
}

double GrowingHull::volume() const {
  double sum = 0;
  for (const Facet& facet : facets_) {
    if (!facet.alive) continue;
    Eigen::Matrix<double, 6, 6> simplex;  // with the origin as seventh corner; signed by its side of the facet
    for (std::size_t i = 0; i < 6; ++i) simplex.col(static_cast<Eigen::Index>(i)) = wrench(facet.vertices[i]);
    sum += std::copysign(simplex.determinant(), facet.offset);
  }
  return sum / 720.0;
}

}  // namespace

GraspQuality wrench_hull_quality(std::span<const Wrench> wrenches, bool volume) {
  std::vector<Wrench> joggled;
  // Rounding can break the horizon of wrenches that are coplanar to about kBeyond; displaced by 1e-8 they are not.
  for (std::uint64_t attempt = 0; attempt < 4; ++attempt) {
    GrowingHull hull(attempt == 0 ? wrenches : std::span<const Wrench>(joggled));
    if (!hull.start()) return {};
    GraspQuality quality;
    if (const auto nearest = hull.nearest_own()) {
      const double epsilon = hull.offset_of_support(hull.facet(*nearest));
      quality.force_closure = epsilon > kFlat;
      quality.epsilon = quality.force_closure ? epsilon : 0;
      if (volume) while (hull.nearest_own()) {}
      if (volume && hull.consistent()) quality.volume = hull.volume();
    }
    if (hull.consistent()) return quality;
    Random random(attempt);
    joggled.assign(wrenches.begin(), wrenches.end());
    for (Wrench& w : joggled)
      for (double& x : w) x += 1e-8 * random.uniform(-1, 1);
  }
  return {};
}

}  // namespace gfp
