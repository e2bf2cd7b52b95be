#include "segmentation/plane_candidates.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace gfp {
namespace {

constexpr float kMinDepth = 0.05F, kMaxDepth = 30.0F;  // metres: what any of our sensors could mean
constexpr int kCellSamples = 4;            // a side
constexpr int kMinCellReadings = 12;       // of 16
constexpr int kMinRegionCells = 6;
constexpr double kMaxCellAngleCos = 0.94;  // 20 deg: what noise does to the normal of a far cell
constexpr double kSameAngleCos = 0.985;    // 10 deg, between regions
constexpr double kMaxNoiseInverse = 0.012; // 1/m: rougher than this is no plane (12 mm at 1 m)
constexpr double kMinNoiseInverse = 0.0006;

// How far a surface may lie from a plane that it continues, as a residual of 1/z: 4 mm at close range, 4 mm x z^2 beyond.
double join_tolerance(double inverse_depth) { return 0.003 * inverse_depth * inverse_depth + 0.004; }

struct Cell {
  InverseDepthSums sums;
  Eigen::Vector3d up = Eigen::Vector3d::Zero();
  double roughness = 0;   // rms over what is allowed; a cell above 1 is not flat
  bool flat = false;
};

Cell fit_cell(const SampleGrid& grid, int i0, int j0) {
  Cell cell;
  for (int j = j0; j < j0 + kCellSamples; ++j)
    for (int i = i0; i < i0 + kCellSamples; ++i)
      if (const auto s = grid.index(i, j); grid.valid(s)) cell.sums.add(grid.ray_x[s], grid.ray_y[s], grid.inverse_depth[s]);
  if (cell.sums.n < kMinCellReadings) return cell;
  const auto fit = cell.sums.solve();
  if (!fit) return cell;
  cell.up = fit->up();
  cell.roughness = fit->rms_inverse_m / join_tolerance(cell.sums.w / cell.sums.n);
  cell.flat = cell.roughness <= 1.0;
  return cell;
}

struct CellGrid {
  int columns = 0, rows = 0;
  std::vector<Cell> cells;
};

CellGrid fit_cells(const SampleGrid& grid) {
  CellGrid cells{grid.width / kCellSamples, grid.height / kCellSamples, {}};
  cells.cells.reserve(static_cast<std::size_t>(cells.columns) * static_cast<std::size_t>(cells.rows));
  for (int r = 0; r < cells.rows; ++r)
    for (int c = 0; c < cells.columns; ++c) cells.cells.push_back(fit_cell(grid, c * kCellSamples, r * kCellSamples));
  return cells;
}

bool continues(const PlaneFit& plane, const Cell& cell, double min_cos) {
  const double w = cell.sums.w / cell.sums.n;
  return cell.up.dot(plane.up()) >= min_cos &&
         std::abs(plane.residual(cell.sums.x / cell.sums.n, cell.sums.y / cell.sums.n, w)) <= join_tolerance(w);
}

struct Region {
  InverseDepthSums sums;
  PlaneFit fit;
  std::vector<int> cells;
};

// Breadth first from `seed`; the plane is fitted anew whenever the region has grown by half.
Region grow(const CellGrid& grid, int seed, std::vector<std::int32_t>& owner, std::int32_t id) {
  Region region;
  region.sums = grid.cells[static_cast<std::size_t>(seed)].sums;
  const auto first = region.sums.solve();
  if (!first) return region;
  region.fit = *first;
  region.cells = {seed};
  owner[static_cast<std::size_t>(seed)] = id;
  std::size_t fitted = 1;
  for (std::size_t next = 0; next < region.cells.size(); ++next) {
    const int c = region.cells[next] % grid.columns, r = region.cells[next] / grid.columns;
    constexpr int kSteps[4][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}};
    for (const auto& step : kSteps) {
      const int nc = c + step[0], nr = r + step[1];
      if (nc < 0 || nr < 0 || nc >= grid.columns || nr >= grid.rows) continue;
      const int neighbour = nr * grid.columns + nc;
      const Cell& cell = grid.cells[static_cast<std::size_t>(neighbour)];
      if (!cell.flat || owner[static_cast<std::size_t>(neighbour)] >= 0 || !continues(region.fit, cell, kMaxCellAngleCos)) continue;
      owner[static_cast<std::size_t>(neighbour)] = id;
      region.cells.push_back(neighbour);
      region.sums.add(cell.sums);
    }
    if (2 * region.cells.size() >= 3 * fitted) {
      if (const auto fit = region.sums.solve()) region.fit = *fit;
      fitted = region.cells.size();
    }
  }
  if (const auto fit = region.sums.solve()) region.fit = *fit;
  return region;
}

std::vector<Region> grow_regions(const CellGrid& grid) {
  std::vector<int> seeds(grid.cells.size());
  std::iota(seeds.begin(), seeds.end(), 0);
  std::stable_sort(seeds.begin(), seeds.end(), [&](int a, int b) {
    return grid.cells[static_cast<std::size_t>(a)].roughness < grid.cells[static_cast<std::size_t>(b)].roughness;
  });
  std::vector<std::int32_t> owner(grid.cells.size(), -1);
  std::vector<Region> regions;
  for (const int seed : seeds) {
    if (!grid.cells[static_cast<std::size_t>(seed)].flat || owner[static_cast<std::size_t>(seed)] >= 0) continue;
    Region region = grow(grid, seed, owner, static_cast<std::int32_t>(seed));
    if (region.cells.size() >= kMinRegionCells) regions.push_back(std::move(region));
  }
  std::stable_sort(regions.begin(), regions.end(), [](const Region& a, const Region& b) { return a.cells.size() > b.cells.size(); });
  return regions;
}

// One plane that an object or a gap divides is one candidate: the smaller regions that lie on a larger one's plane join it.
std::vector<Region> join_coplanar(const CellGrid& grid, std::vector<Region> regions) {
  std::vector<Region> joined;
  for (Region& region : regions) {
    Region* host = nullptr;
    for (Region& larger : joined) {
      const auto on_plane = std::count_if(region.cells.begin(), region.cells.end(), [&](int cell) {
        return continues(larger.fit, grid.cells[static_cast<std::size_t>(cell)], 0.0);
      });
      if (region.fit.up().dot(larger.fit.up()) >= kSameAngleCos && 10 * on_plane >= 8 * static_cast<long>(region.cells.size())) { host = &larger; break; }
    }
    if (host == nullptr) { joined.push_back(std::move(region)); continue; }
    host->sums.add(region.sums);
    host->cells.insert(host->cells.end(), region.cells.begin(), region.cells.end());
    if (const auto fit = host->sums.solve()) host->fit = *fit;
  }
  return joined;
}

// The region's cells and their neighbours: readings beside a flat cell may lie on its plane although their cell is not flat.
std::vector<std::uint8_t> sample_region(const SampleGrid& samples, const CellGrid& grid, const std::vector<int>& cells) {
  std::vector<std::uint8_t> flags(samples.inverse_depth.size(), 0);
  for (const int cell : cells) {
    const int i0 = (cell % grid.columns - 1) * kCellSamples, j0 = (cell / grid.columns - 1) * kCellSamples;
    for (int j = std::max(0, j0); j < std::min(samples.height, j0 + 3 * kCellSamples); ++j)
      for (int i = std::max(0, i0); i < std::min(samples.width, i0 + 3 * kCellSamples); ++i) flags[samples.index(i, j)] = 1;
  }
  return flags;
}

}  // namespace

SampleGrid sample_grid(const OrganizedCloud& cloud) {
  SampleGrid grid;
  grid.stride = std::clamp(std::min(cloud.width, cloud.height) / 120, 1, 128);
  grid.width = (cloud.width - grid.stride / 2 + grid.stride - 1) / grid.stride;
  grid.height = (cloud.height - grid.stride / 2 + grid.stride - 1) / grid.stride;
  const auto count = static_cast<std::size_t>(grid.width) * static_cast<std::size_t>(grid.height);
  for (auto* plane : {&grid.ray_x, &grid.ray_y, &grid.inverse_depth}) plane->assign(count, 0.0F);
  for (int j = 0; j < grid.height; ++j)
    for (int i = 0; i < grid.width; ++i) {
      const auto at = static_cast<std::size_t>(j * grid.stride + grid.stride / 2) * static_cast<std::size_t>(cloud.width) +
                      static_cast<std::size_t>(i * grid.stride + grid.stride / 2);
      if (!(cloud.z[at] >= kMinDepth && cloud.z[at] <= kMaxDepth)) continue;
      const float inverse = 1.0F / cloud.z[at];
      const auto s = grid.index(i, j);
      grid.ray_x[s] = cloud.x[at] * inverse;
      grid.ray_y[s] = cloud.y[at] * inverse;
      grid.inverse_depth[s] = inverse;
    }
  return grid;
}

PlaneCandidate refine_plane(const SampleGrid& grid, const PlaneFit& start, const std::vector<std::uint8_t>& region) {
  PlaneCandidate plane{start, {}};
  double band = std::max(3.0 * std::clamp(start.rms_inverse_m, kMinNoiseInverse, kMaxNoiseInverse), 0.004);
  for (int round = 0; round < 4; ++round) {
    InverseDepthSums sums;
    plane.samples.clear();
    for (std::size_t s = 0; s < grid.inverse_depth.size(); ++s) {
      if (!grid.valid(s) || (!region.empty() && region[s] == 0)) continue;
      if (std::abs(plane.fit.residual(grid.ray_x[s], grid.ray_y[s], grid.inverse_depth[s])) > band) continue;
      sums.add(grid.ray_x[s], grid.ray_y[s], grid.inverse_depth[s]);
      plane.samples.push_back(static_cast<std::int32_t>(s));
    }
    const auto fit = sums.solve();
    if (!fit) break;
    plane.fit = *fit;
    band = 3.0 * std::clamp(fit->rms_inverse_m, kMinNoiseInverse, kMaxNoiseInverse);
  }
  return plane;
}

std::vector<PlaneCandidate> plane_candidates(const SampleGrid& grid) {
  const CellGrid cells = fit_cells(grid);
  if (cells.cells.empty()) return {};
  std::vector<PlaneCandidate> candidates;
  for (const Region& region : join_coplanar(cells, grow_regions(cells)))
    candidates.push_back(refine_plane(grid, region.fit, sample_region(grid, cells, region.cells)));
  std::stable_sort(candidates.begin(), candidates.end(), [](const auto& a, const auto& b) { return a.samples.size() > b.samples.size(); });
  return candidates;
}

}  // namespace gfp
