#include "gfp/collection/manual_layer.hpp"

#include <algorithm>
#include <cstddef>
#include <limits>

#include "gfp/primitive/primitive_of_members.hpp"

namespace gfp {

int carry_manual_types(const Primitive& before, Primitive& now) {
  if (before.manual_types.empty()) return 0;
  if (before.topology->triangles == now.topology->triangles && before.size() == now.size()) {
    set_manual_types(now, before.manual_types);
    return 0;
  }
  const Eigen::Vector3d size = now.typical_size_m();
  std::vector<std::optional<PointType>> manual(now.size());
  int lost = 0;
  for (std::size_t i = 0; i < before.manual_types.size(); ++i) {
    if (!before.manual_types[i]) continue;
    double nearest = std::numeric_limits<double>::infinity();
    std::size_t at = 0;
    for (std::size_t k = 0; k < now.size(); ++k) {
      const double distance = size.cwiseProduct(before.mean[i] - now.mean[k]).norm();
      if (distance < nearest) nearest = distance, at = k;
    }
    if (nearest <= now.rest_edge_length) manual[at] = before.manual_types[i];
    else ++lost;
  }
  if (std::any_of(manual.begin(), manual.end(), [](const auto& type) { return type.has_value(); })) set_manual_types(now, std::move(manual));
  return lost;
}

}  // namespace gfp
