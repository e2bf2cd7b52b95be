#include "primitive/surface_builder.hpp"

#include <cassert>

#include "primitive/curves.hpp"

namespace gfp {
namespace {

int wrap(int index, std::size_t count) {
  const int n = static_cast<int>(count);
  return ((index % n) + n) % n;
}

std::int32_t at(const Ring& ring, int index) { return ring[static_cast<std::size_t>(wrap(index, ring.size()))]; }

bool nowhere(int /*column*/) { return false; }

}  // namespace

std::int32_t SurfaceBuilder::add_vertex(const Eigen::Vector3d& point, Part part) {
  shape_.mesh.vertices.push_back(point);
  shape_.parts.push_back(part);
  return static_cast<std::int32_t>(shape_.mesh.vertices.size()) - 1;
}

void SurfaceBuilder::add_triangle(std::int32_t a, std::int32_t b, std::int32_t c, bool filled) {
  shape_.mesh.triangles.push_back({a, b, c});
  shape_.filled.push_back(filled);
}

void SurfaceBuilder::join_equal(const Ring& from, const Ring& to, bool filled, const std::function<bool(int)>& open) {
  const int n = static_cast<int>(from.size());
  for (int k = 0; k < n; ++k) {
    if (open(k)) continue;
    // Diagonals turn from quadrant to quadrant, so that mirrored columns have mirrored triangles.
    if ((4 * k / n) % 2 == 0) {
      add_triangle(at(from, k), at(from, k + 1), at(to, k + 1), filled);
      add_triangle(at(from, k), at(to, k + 1), at(to, k), filled);
    } else {
      add_triangle(at(from, k), at(from, k + 1), at(to, k), filled);
      add_triangle(at(from, k + 1), at(to, k + 1), at(to, k), filled);
    }
  }
}

void SurfaceBuilder::join(const Ring& from, const Ring& to, bool filled, const std::function<bool(int)>& open) {
  const int n = static_cast<int>(from.size()), m = static_cast<int>(to.size());
  if (n == m) return join_equal(from, to, filled, open);
  for (int k = 0; n == 1 && k < m; ++k) add_triangle(from[0], at(to, k + 1), at(to, k), filled);
  for (int k = 0; m == 1 && k < n; ++k) add_triangle(at(from, k), at(from, k + 1), to[0], filled);
  if (n == 1 || m == 1) return;
  assert(n == 2 * m || m == 2 * n);
  for (int k = 0; k < std::min(n, m); ++k) {
    if (n > m) {
      add_triangle(at(from, 2 * k), at(from, 2 * k + 1), at(to, k), filled);
      add_triangle(at(from, 2 * k + 1), at(to, k + 1), at(to, k), filled);
      add_triangle(at(from, 2 * k + 1), at(from, 2 * k + 2), at(to, k + 1), filled);
    } else {
      add_triangle(at(from, k), at(to, 2 * k + 1), at(to, 2 * k), filled);
      add_triangle(at(from, k), at(from, k + 1), at(to, 2 * k + 1), filled);
      add_triangle(at(from, k + 1), at(to, 2 * k + 2), at(to, 2 * k + 1), filled);
    }
  }
}

std::vector<Ring> SurfaceBuilder::sweep(const std::vector<RingSpec>& specs, int columns, const Place& place, const SweepOptions& options) {
  std::vector<Ring> rings;
  for (std::size_t r = 0; r < specs.size(); ++r) {
    Ring ring;
    const int stride = specs[r].stride == 0 ? columns : specs[r].stride;
    for (int column = 0; column < columns; column += stride) ring.push_back(add_vertex(place(r, column), specs[r].part));
    rings.push_back(std::move(ring));
  }
  for (std::size_t r = 0; r + 1 < rings.size(); ++r) {
    const auto open = [&](int column) {
      for (const auto& window : options.windows)
        if (window.ring_low <= r && r < window.ring_high &&
            wrap(column - window.column + window.half_columns, rings[r].size()) < 2 * window.half_columns)
          return true;
      return false;
    };
    join(rings[r], rings[r + 1], r < options.rim, open);
  }
  if (options.rim < rings.size()) shape_.lid = rings[options.rim];
  return rings;
}

Ring SurfaceBuilder::window_loop(const std::vector<Ring>& rings, const Window& window, bool reversed) {
  Ring loop;
  const int half = window.half_columns, column = window.column;
  for (int k = 0; k <= half; ++k) loop.push_back(at(rings[window.ring_low], column + k));
  for (std::size_t r = window.ring_low + 1; r < window.ring_high; ++r) loop.push_back(at(rings[r], column + half));
  for (int k = half; k >= -half; --k) loop.push_back(at(rings[window.ring_high], column + k));
  for (std::size_t r = window.ring_high - 1; r > window.ring_low; --r) loop.push_back(at(rings[r], column - half));
  for (int k = -half; k < 0; ++k) loop.push_back(at(rings[window.ring_low], column + k));
  if (!reversed) return loop;
  Ring back;  // from the opposite vertex, the other way round
  const int n = static_cast<int>(loop.size());
  for (int k = 0; k < n; ++k) back.push_back(at(loop, n / 2 - k));
  return back;
}

Ring SurfaceBuilder::add_sections(const Ring& start, const std::vector<TubeSection>& sections, Part part) {
  const auto circle = unit_circle(static_cast<int>(start.size()));
  Ring previous = start;
  for (const auto& section : sections) {
    Ring ring;
    for (const auto& direction : circle) {
      const Eigen::Vector2d p = superellipse(direction, section.squareness);
      ring.push_back(add_vertex(section.centre + p.x() * section.half_outward * section.outward + p.y() * section.half_sideways * section.sideways, part));
    }
    join(previous, ring, true, nowhere);
    previous = std::move(ring);
  }
  return previous;
}

void SurfaceBuilder::tube(const Ring& start, const std::vector<TubeSection>& sections, const Ring& end, Part part) {
  join(add_sections(start, sections, part), end, true, nowhere);
}

void SurfaceBuilder::stub(const Ring& start, const std::vector<TubeSection>& sections, const Eigen::Vector3d& tip, Part part) {
  const Ring last = add_sections(start, sections, part);
  join(last, {add_vertex(tip, part)}, true, nowhere);
}

FamilyShape SurfaceBuilder::finish(const Eigen::Vector3d& reference_size_m) const {
  FamilyShape result;
  std::vector<std::int32_t> index(shape_.mesh.vertices.size(), -1);
  for (const auto& triangle : shape_.mesh.triangles)
    for (const auto v : triangle) index[static_cast<std::size_t>(v)] = 0;
  for (std::size_t i = 0; i < index.size(); ++i) {
    if (index[i] < 0) continue;
    index[i] = static_cast<std::int32_t>(result.mesh.vertices.size());
    result.mesh.vertices.push_back(shape_.mesh.vertices[i]);
    result.parts.push_back(shape_.parts[i]);
  }
  const auto moved = [&](std::int32_t v) { return index[static_cast<std::size_t>(v)]; };
  for (const auto& [a, b, c] : shape_.mesh.triangles) result.mesh.triangles.push_back({moved(a), moved(b), moved(c)});
  for (const auto v : shape_.lid) result.lid.push_back(moved(v));
  result.filled = shape_.filled;
  result.reference_size_m = reference_size_m;
  return result;
}

}  // namespace gfp
