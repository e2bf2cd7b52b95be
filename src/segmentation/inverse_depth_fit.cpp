#include "segmentation/inverse_depth_fit.hpp"

#include <algorithm>
#include <cmath>

namespace gfp {

std::optional<PlaneFit> InverseDepthSums::solve() const {
  if (n < 3) return std::nullopt;
  const double mx = x / n, my = y / n, mw = w / n;
  const double cxx = xx / n - mx * mx, cxy = xy / n - mx * my, cyy = yy / n - my * my;
  const double cxw = xw / n - mx * mw, cyw = yw / n - my * mw, cww = ww / n - mw * mw;
  const double determinant = cxx * cyy - cxy * cxy;
  if (!(determinant > 1e-9 * (cxx + cyy) * (cxx + cyy))) return std::nullopt;
  const double a = (cxw * cyy - cyw * cxy) / determinant;
  const double b = (cyw * cxx - cxw * cxy) / determinant;
  PlaneFit fit{{a, b, mw - a * mx - b * my}, std::sqrt(std::max(0.0, cww - a * cxw - b * cyw))};
  if (!(fit.coefficients.norm() > 1e-3) || !fit.coefficients.allFinite()) return std::nullopt;
  return fit;
}

}  // namespace gfp
