#include <tbb/parallel_for.h>

#include <numbers>
#include <utility>

#include "gfp/core/random.hpp"
#include "gfp/evaluation/cases.hpp"
#include "gfp/primitive/families.hpp"
#include "table_view.hpp"

namespace gfp {
namespace {

constexpr std::uint64_t kHeldOut = 0x6865'6C64'206F'7574ULL;  // keeps these members apart from every other use of the seed
constexpr double kResolution = 1.3;                           // another tessellation than the primitive's

using ShapePtr = std::shared_ptr<const TruthShape>;

Result<ShapePtr> sample_member(const std::string& family, std::uint64_t index, const CaseOptions& options) {
  Random random = Random(options.seed ^ kHeldOut).fork(index);
  SampleFamilyOptions sampling;
  sampling.resolution = kResolution;
  sampling.free_form = options.free_form;
  FamilyInstance member = sample_family(family, random, sampling);
  auto shape = make_truth_shape(family + "/" + std::to_string(index), member.class_name, std::move(member.mesh), options.truth);
  if (!shape) return tl::unexpected(shape.error());
  return std::make_shared<const TruthShape>(std::move(*shape));
}

}  // namespace

Result<std::vector<CaseSpec>> list_family_cases(const CaseOptions& options) {
  const auto families = family_names();
  const std::size_t instances = static_cast<std::size_t>(options.instances);
  std::vector<Result<ShapePtr>> members(families.size() * instances);
  tbb::parallel_for(std::size_t{0}, members.size(), [&](std::size_t i) {
    if (options.wants(families[i / instances], "")) members[i] = sample_member(families[i / instances], i, options);
  });
  std::vector<CaseSpec> specs;
  for (std::size_t i = 0; i < members.size(); ++i) {
    if (!members[i]) return tl::unexpected(members[i].error());
    if (!*members[i]) continue;  // not wanted
    add_table_cases("families", *members[i], options, i, specs);
  }
  return specs;
}

}  // namespace gfp
