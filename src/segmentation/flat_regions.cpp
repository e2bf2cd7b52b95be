#include "segmentation/flat_regions.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace gfp {
namespace {

constexpr std::size_t kMinRegionCells = 6;
constexpr double kCellCos = 0.94;    // 20 deg: what noise does to the normal of a far cell
constexpr double kJoinCos = 0.978;   // 12 deg between regions of one surface
constexpr double kSameCos = 0.996;   // 5 deg between pieces of one plane

bool continues(const PlaneFit& plane, const Cell& cell) {
  return cell.fit.up().dot(plane.up()) >= kCellCos && std::abs(cell.offset_from(plane)) <= flatness_tolerance(cell.mean_inverse());
}

// The plane is fitted anew whenever the region has grown by half.
FlatRegion grow(const CellGrid& grid, int seed, std::vector<std::int32_t>& owner) {
  FlatRegion region{grid[seed].fit, grid[seed].sums, {seed}};
  owner[static_cast<std::size_t>(seed)] = seed;
  std::size_t fitted = 1;
  for (std::size_t next = 0; next < region.cells.size(); ++next) {
    grid.neighbours(region.cells[next], [&](int neighbour) {
      const Cell& cell = grid[neighbour];
      if (!cell.flat || owner[static_cast<std::size_t>(neighbour)] >= 0 || !continues(region.fit, cell)) return;
      owner[static_cast<std::size_t>(neighbour)] = seed;
      region.cells.push_back(neighbour);
      region.sums.add(cell.sums);
    });
    if (2 * region.cells.size() >= 3 * fitted) {
      region.fit = region.sums.solve().value_or(region.fit);
      fitted = region.cells.size();
    }
  }
  region.fit = region.sums.solve().value_or(region.fit);
  std::sort(region.cells.begin(), region.cells.end());
  return region;
}

void sort_by_size(std::vector<FlatRegion>& regions) {
  std::stable_sort(regions.begin(), regions.end(), [](const auto& a, const auto& b) { return a.cells.size() > b.cells.size(); });
}

// How many cells of a pair of regions are neighbours, and how many of those meet without a step.
struct Contact {
  int cells = 0, smooth = 0;
};

std::map<std::pair<int, int>, Contact> contacts(const CellGrid& grid, const std::vector<FlatRegion>& regions) {
  std::vector<int> owner(grid.cells.size(), -1);
  for (std::size_t r = 0; r < regions.size(); ++r)
    for (const int cell : regions[r].cells) owner[static_cast<std::size_t>(cell)] = static_cast<int>(r);
  std::map<std::pair<int, int>, Contact> result;
  for (int c = 0; c < static_cast<int>(grid.cells.size()); ++c) {
    const int own = owner[static_cast<std::size_t>(c)];
    if (own < 0) continue;
    grid.neighbours(c, [&](int n) {
      const int other = owner[static_cast<std::size_t>(n)];
      if (other <= own) return;
      Contact& contact = result[{own, other}];
      const double step = std::max(std::abs(grid[c].offset_from(grid[n].fit)), std::abs(grid[n].offset_from(grid[c].fit)));
      ++contact.cells;
      contact.smooth += step <= flatness_tolerance(grid[c].mean_inverse());
    });
  }
  return result;
}

bool pieces_of_one_plane(const CellGrid& grid, const FlatRegion& larger, const FlatRegion& smaller) {
  if (larger.fit.up().dot(smaller.fit.up()) < kSameCos) return false;
  const auto on_plane = std::count_if(smaller.cells.begin(), smaller.cells.end(), [&](int c) {
    return std::abs(grid[c].offset_from(larger.fit)) <= flatness_tolerance(grid[c].mean_inverse());
  });
  return 10 * on_plane >= 8 * static_cast<long>(smaller.cells.size());
}

}  // namespace

std::vector<FlatRegion> flat_regions(const CellGrid& grid) {
  std::vector<int> seeds;
  for (int c = 0; c < static_cast<int>(grid.cells.size()); ++c)
    if (grid[c].flat) seeds.push_back(c);
  std::vector<double> roughness(grid.cells.size());
  for (const int c : seeds) roughness[static_cast<std::size_t>(c)] = grid[c].fit.rms_inverse_m / flatness_tolerance(grid[c].mean_inverse());
  std::stable_sort(seeds.begin(), seeds.end(), [&](int a, int b) { return roughness[static_cast<std::size_t>(a)] < roughness[static_cast<std::size_t>(b)]; });
  std::vector<std::int32_t> owner(grid.cells.size(), -1);
  std::vector<FlatRegion> regions;
  for (const int seed : seeds) {
    if (owner[static_cast<std::size_t>(seed)] >= 0) continue;
    FlatRegion region = grow(grid, seed, owner);
    if (region.cells.size() >= kMinRegionCells) regions.push_back(std::move(region));
  }
  sort_by_size(regions);
  return regions;
}

FlatRegion region_on_plane(const CellGrid& grid, const PlaneFit& plane) {
  FlatRegion region{plane, {}, {}};
  for (int c = 0; c < static_cast<int>(grid.cells.size()); ++c) {
    if (!grid[c].flat || !continues(plane, grid[c])) continue;
    region.cells.push_back(c);
    region.sums.add(grid[c].sums);
  }
  if (region.cells.size() < kMinRegionCells) return {};
  region.fit = region.sums.solve().value_or(plane);
  return region;
}

std::vector<FlatRegion> join_surfaces(const CellGrid& grid, std::vector<FlatRegion> regions) {
  std::vector<int> root(regions.size());
  std::iota(root.begin(), root.end(), 0);
  const auto find = [&](int r) {
    while (root[static_cast<std::size_t>(r)] != r) r = root[static_cast<std::size_t>(r)];
    return r;
  };
  const auto join = [&](int a, int b) { root[static_cast<std::size_t>(std::max(find(a), find(b)))] = std::min(find(a), find(b)); };
  const auto cos_between = [&](int a, int b) { return regions[static_cast<std::size_t>(a)].fit.up().dot(regions[static_cast<std::size_t>(b)].fit.up()); };
  for (const auto& [pair, contact] : contacts(grid, regions))
    if (contact.cells >= 3 && 2 * contact.smooth >= contact.cells && cos_between(pair.first, pair.second) >= kJoinCos &&
        cos_between(find(pair.first), find(pair.second)) >= kJoinCos)
      join(pair.first, pair.second);
  for (int small = 1; small < static_cast<int>(regions.size()); ++small)
    for (int large = 0; large < small; ++large)
      if (find(large) != find(small) && pieces_of_one_plane(grid, regions[static_cast<std::size_t>(large)], regions[static_cast<std::size_t>(small)])) join(large, small);

  std::vector<FlatRegion> joined;
  std::vector<int> slot(regions.size(), -1);
  for (int r = 0; r < static_cast<int>(regions.size()); ++r) {
    int& at = slot[static_cast<std::size_t>(find(r))];
    FlatRegion& region = regions[static_cast<std::size_t>(r)];
    if (at < 0) {
      at = static_cast<int>(joined.size());
      joined.push_back(std::move(region));
      continue;
    }
    FlatRegion& host = joined[static_cast<std::size_t>(at)];
    host.sums.add(region.sums);
    host.cells.insert(host.cells.end(), region.cells.begin(), region.cells.end());
  }
  for (FlatRegion& surface : joined) {
    surface.fit = surface.sums.solve().value_or(surface.fit);
    std::sort(surface.cells.begin(), surface.cells.end());
  }
  sort_by_size(joined);
  return joined;
}

}  // namespace gfp
