#include "segmentation/pieces.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "gfp/core/box_normals.hpp"

namespace gfp {
namespace {

constexpr int kNormalRadius = 3;
constexpr int kSpan = 4;                  // a crease is looked for between normals this many pixels to either side
constexpr float kCreaseCos = 0.88F;       // 28 deg
constexpr float kStepShare = 0.5F;        // of the cluster tolerance: a step of depth that ends a surface
constexpr int kMinPiece = 40;             // pixels; less is noise at a cut

struct Offset {
  int du, dv;
};

/// An index with its column and row: divisions are the dear part of walking over neighbours.
struct Pixel {
  std::int32_t i;
  int u, v;
};

PixelRect bounds_of(const PixelList& pixels, int width) {
  PixelRect box{width, pixels.front() / width, 0, pixels.back() / width + 1};
  for (const auto i : pixels) {
    box.u0 = std::min(box.u0, i % width);
    box.u1 = std::max(box.u1, i % width + 1);
  }
  return box;
}

class Cutter {
 public:
  Cutter(const OrganizedCloud& cloud, const std::vector<PixelList>& clusters, double tolerance_m, PieceMap& map)
      : cloud_(cloud), clusters_(clusters), tolerance_(static_cast<float>(tolerance_m)), map_(map), cluster_of_(cloud.size(), -1), open_(cloud.size(), 0), crease_(cloud.size(), 0) {}

  void run() {
    for (std::size_t c = 0; c < clusters_.size(); ++c)
      for (const auto i : clusters_[c]) cluster_of_[static_cast<std::size_t>(i)] = static_cast<std::int32_t>(c);
    estimate_normals();
    for (const PixelList& cluster : clusters_)
      for (const auto i : cluster) open_[static_cast<std::size_t>(i)] = !is_step(pixel(i)) && !near_crease(pixel(i));
    const auto kept = connected_components(cloud_, open_, open_, {kStepShare * tolerance_, 0.0}, kMinPiece);
    for (const PixelList& pixels : kept) add(pixels);
    grow_back();
    add_what_is_left();
    collect();
  }

 private:
  Pixel pixel(std::int32_t i) const { return {i, i % cloud_.width, i / cloud_.width}; }
  float z(std::int32_t i) const { return cloud_.z[static_cast<std::size_t>(i)]; }
  float step_limit(std::int32_t i) const { return kStepShare * tolerance_ * std::max(1.0F, z(i) * z(i)); }

  void estimate_normals() {
    const DepthPlanes depth{cloud_.width, cloud_.height, cloud_.x.data(), cloud_.y.data(), cloud_.z.data(),
                            cloud_.camera.fx, cloud_.camera.fy, cloud_.camera.distortion == DistortionModel::kNone};
    for (auto* plane : {&map_.nx, &map_.ny, &map_.nz}) plane->assign(cloud_.size(), std::numeric_limits<float>::quiet_NaN());
    for (const PixelList& cluster : clusters_)
      box_normals(depth, {kNormalRadius, 0.02F, true}, bounds_of(cluster, cloud_.width), map_.nx.data(), map_.ny.data(), map_.nz.data());
  }

  // The pixel `offset` away where it is in the image and in the same cluster, else -1.
  std::int32_t same_cluster(const Pixel& p, Offset offset) const {
    const int u = p.u + offset.du, v = p.v + offset.dv;
    if (u < 0 || v < 0 || u >= cloud_.width || v >= cloud_.height) return -1;
    const std::int32_t there = p.i + offset.dv * cloud_.width + offset.du;
    return cluster_of_[static_cast<std::size_t>(there)] == cluster_of_[static_cast<std::size_t>(p.i)] ? there : -1;
  }

  // A step is more than the surface's own slope explains: the depth's second difference across the pixel.
  bool is_step(const Pixel& p) const {
    const std::int32_t i = p.i;
    for (const Offset d : {Offset{1, 0}, Offset{0, 1}}) {
      const std::int32_t ahead = same_cluster(p, d), behind = same_cluster(p, {-d.du, -d.dv});
      if (ahead < 0 || std::abs(z(ahead) - z(i)) <= step_limit(i)) continue;
      if (behind < 0 || std::abs((z(ahead) - z(i)) - (z(i) - z(behind))) > step_limit(i)) return true;
    }
    return false;
  }

  // Creases are bands as wide as the span: every second pixel of every second row tells for its neighbours (which come later).
  bool near_crease(const Pixel& p) {
    const std::int32_t anchor = same_cluster(p, {-(p.u & 1), -(p.v & 1)});
    if (anchor >= 0 && anchor != p.i) return crease_[static_cast<std::size_t>(anchor)] != 0;
    const bool crease = is_crease(p);
    crease_[static_cast<std::size_t>(p.i)] = crease;
    return crease;
  }

  bool is_crease(const Pixel& p) const {
    constexpr std::array<Offset, 4> kDirections = {{{kSpan, 0}, {0, kSpan}, {kSpan - 1, kSpan - 1}, {kSpan - 1, 1 - kSpan}}};
    for (const Offset d : kDirections) {
      const std::int32_t a = same_cluster(p, d), b = same_cluster(p, {-d.du, -d.dv});
      if (a < 0 || b < 0 || std::abs(z(a) - z(b)) > 4.0F * step_limit(p.i)) continue;
      const Eigen::Vector3f na = map_.normal(a), nb = map_.normal(b);
      if (!(na.dot(nb) < kCreaseCos)) continue;
      const Eigen::Vector3f between = cloud_.point(static_cast<std::size_t>(a)) - cloud_.point(static_cast<std::size_t>(b));
      if ((na - nb).dot(between) < 0.0F) return true;
    }
    return false;
  }

  void add(const PixelList& pixels) {
    const auto id = static_cast<std::int32_t>(map_.cluster.size());
    if (map_.piece.empty()) map_.piece.assign(cloud_.size(), -1);
    for (const auto i : pixels) map_.piece[static_cast<std::size_t>(i)] = id;
    map_.cluster.push_back(cluster_of_[static_cast<std::size_t>(pixels.front())]);
  }

  // Breadth first from all pieces at once, so that a cut is shared out evenly; never across a step of depth.
  void grow_back() {
    if (map_.piece.empty()) map_.piece.assign(cloud_.size(), -1);
    std::vector<std::int32_t> frontier, next;
    for (const PixelList& cluster : clusters_)
      for (const auto i : cluster)
        if (map_.piece[static_cast<std::size_t>(i)] >= 0) frontier.push_back(i);
    while (!frontier.empty()) {
      next.clear();
      for (const auto i : frontier) {
        const Pixel p = pixel(i);
        for (const Offset d : {Offset{1, 0}, Offset{-1, 0}, Offset{0, 1}, Offset{0, -1}}) {
          const std::int32_t n = same_cluster(p, d);
          if (n < 0 || map_.piece[static_cast<std::size_t>(n)] >= 0 || std::abs(z(n) - z(i)) > 2.0F * step_limit(i)) continue;
          map_.piece[static_cast<std::size_t>(n)] = map_.piece[static_cast<std::size_t>(i)];
          next.push_back(n);
        }
      }
      frontier.swap(next);
    }
  }

  void add_what_is_left() {
    std::vector<std::uint8_t> left(cloud_.size(), 0);
    for (const PixelList& cluster : clusters_)
      for (const auto i : cluster) left[static_cast<std::size_t>(i)] = map_.piece[static_cast<std::size_t>(i)] < 0;
    for (const PixelList& pixels : connected_components(cloud_, left, left, {2.0 * static_cast<double>(tolerance_), 0.0}, 1)) add(pixels);
  }

  void collect() {
    map_.pixels.resize(map_.cluster.size());
    for (std::int32_t i = 0; i < static_cast<std::int32_t>(map_.piece.size()); ++i)
      if (const auto p = map_.piece[static_cast<std::size_t>(i)]; p >= 0) map_.pixels[static_cast<std::size_t>(p)].push_back(i);
  }

  const OrganizedCloud& cloud_;
  const std::vector<PixelList>& clusters_;
  float tolerance_;
  PieceMap& map_;
  std::vector<std::int32_t> cluster_of_;
  std::vector<std::uint8_t> open_, crease_;
};

}  // namespace

PieceMap cut_into_pieces(const OrganizedCloud& cloud, const std::vector<PixelList>& clusters, double tolerance_m) {
  PieceMap map;
  Cutter(cloud, clusters, tolerance_m, map).run();
  return map;
}

}  // namespace gfp
