#include "grasp/qhull_oracle.hpp"

#include <algorithm>
#include <cstdio>
#include <vector>

extern "C" {
#include <libqhull_r/qhull_ra.h>
}

namespace gfp::test {

HullOracle qhull_oracle(std::span<const Wrench> wrenches, bool volume) {
  std::vector<coordT> points;
  for (const Wrench& w : wrenches) points.insert(points.end(), w.data(), w.data() + 6);
  HullOracle oracle;
  oracle.epsilon = 1e300;
  qhT context;
  qhT* qh = &context;
  qh_zero(qh, stderr);
  char options[] = "qhull Qx";
  std::FILE* quiet = std::fopen("/dev/null", "w");
  const int exit_code = qh_new_qhull(qh, 6, static_cast<int>(wrenches.size()), points.data(), False, options, nullptr, quiet);
  oracle.full = exit_code == qh_ERRnone;
  if (oracle.full) {
    facetT* facet;
    FORALLfacets { oracle.epsilon = std::min(oracle.epsilon, -facet->offset); }
    if (volume) {
      qh_getarea(qh, qh->facet_list);
      oracle.volume = qh->totvol;
    }
  }
  qh_freeqhull(qh, !qh_ALL);
  int remaining = 0, blocks = 0;
  qh_memfreeshort(qh, &remaining, &blocks);
  std::fclose(quiet);
  return oracle;
}

}  // namespace gfp::test
