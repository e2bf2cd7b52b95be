#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "gfp/primitive/primitive_library.hpp"
#include "recognition/view_descriptor.hpp"

namespace gfp {

/// The training views of all primitives, whitened: kernel densities of how each looks in each stable pose. Immutable; safe from any
/// thread.
class ViewIndex {
 public:
  explicit ViewIndex(const PrimitiveLibrary& library);

  /// Log likelihood (natural, up to a common constant) of a view under every class and stable pose.
  struct Likelihood {
    int primitive = 0, stable_pose = 0;
    double log_likelihood = 0;
  };
  std::vector<Likelihood> likelihoods(const ViewDescriptor& view) const;

 private:
  struct Group {
    int primitive = 0, stable_pose = 0;
    std::vector<ViewDescriptor> views;  ///< Whitened.
  };
  std::vector<Group> groups_;
  Eigen::Matrix<double, kDescriptorSize, kDescriptorSize> whitening_;
};

/// The index of a library, made at first use and kept for the process. Safe from any thread.
std::shared_ptr<const ViewIndex> view_index(const PrimitiveLibrary& library);

}  // namespace gfp
