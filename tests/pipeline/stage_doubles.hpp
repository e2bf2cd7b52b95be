#pragma once

#include <atomic>
#include <map>
#include <string>
#include <vector>

#include "gfp/frame/frame.hpp"
#include "gfp/primitive/primitive_library.hpp"
#include "support/block_scene.hpp"

// Stand-ins for the stages, in place of the libraries': what the pipeline does with their answers is the claim under test.
namespace gfp::test {

/// What the doubles do and have done since reset().
struct StageScript {
  std::map<std::string, double> cost_of_class;     ///< Registration and contour cost; 1 where not named.
  std::atomic<int> recognised{0}, registered{0}, contoured{0}, followed{0}, superquadrics{0}, planned{0};
  void reset();
};
StageScript& script();

/// One primitive per name, without any shape.
PrimitiveLibrary library_of(const std::vector<std::string>& class_names);

/// A frame that the segmentation double takes apart: one segment per depth other than `kPlaneMm`.
inline constexpr std::uint16_t kPlaneMm = 1000;
Frame block_frame(const std::vector<Block>& blocks, std::uint64_t sequence = 0);

}  // namespace gfp::test
