#pragma once

#include <Eigen/Core>
#include <functional>
#include <limits>
#include <vector>

#include "primitive/family_shape.hpp"

namespace gfp {

/// One closed curve of vertices; a pole is a ring of one.
using Ring = std::vector<std::int32_t>;

/// A window of quads left open in a sweep, for a handle to grow from: between rings [ring_low, ring_high], columns
/// [-half_columns, half_columns] around `column`.
struct Window {
  std::size_t ring_low = 0, ring_high = 0;
  int column = 0;
  int half_columns = 1;
};

/// One ring of a sweep: every `stride`-th column has a vertex; stride 0 is a pole.
struct RingSpec {
  Part part = Part::kBody;
  int stride = 1;
};

struct SweepOptions {
  std::vector<Window> windows;
  std::size_t rim = std::numeric_limits<std::size_t>::max();  ///< Ring that the lid closes; later rings are the cavity.
};

/// Section of a tube: centre, the half axes towards `outward` and `sideways`, squareness as in superellipse().
struct TubeSection {
  Eigen::Vector3d centre, outward, sideways;
  double half_outward = 0, half_sideways = 0;
  double squareness = 2;
};

/// Builds closed surfaces from rings of vertices. Rings run counter-clockwise seen from above; a sweep starts at the bottom
/// pole, climbs outside, and (for hollow things) comes down inside.
class SurfaceBuilder {
 public:
  using Place = std::function<Eigen::Vector3d(std::size_t ring, int column)>;

  /// Joins rings of `columns` vertices (fewer by their stride). `place` gives the positions.
  std::vector<Ring> sweep(const std::vector<RingSpec>& specs, int columns, const Place& place, const SweepOptions& options = {});

  /// The window's edge, starting at its lowest middle vertex and counter-clockwise seen from outside (or, `reversed`, at its
  /// highest middle vertex and clockwise: where a tube comes back).
  static Ring window_loop(const std::vector<Ring>& rings, const Window& window, bool reversed = false);

  /// A tube from `start` through the sections (as many vertices a ring as `start`; the first one in direction `outward`, then
  /// towards `sideways`; outward x sideways is the direction of travel). Ends in the ring `end`.
  void tube(const Ring& start, const std::vector<TubeSection>& sections, const Ring& end, Part part);
  /// The same, closed by a pole at `tip`.
  void stub(const Ring& start, const std::vector<TubeSection>& sections, const Eigen::Vector3d& tip, Part part);

  /// Drops unused vertices and hands over the shape.
  FamilyShape finish(const Eigen::Vector3d& reference_size_m) const;

 private:
  std::int32_t add_vertex(const Eigen::Vector3d& point, Part part);
  Ring add_sections(const Ring& start, const std::vector<TubeSection>& sections, Part part);
  void add_triangle(std::int32_t a, std::int32_t b, std::int32_t c, bool filled);
  void join(const Ring& from, const Ring& to, bool filled, const std::function<bool(int column)>& open);
  void join_equal(const Ring& from, const Ring& to, bool filled, const std::function<bool(int column)>& open);

  FamilyShape shape_;
};

}  // namespace gfp
