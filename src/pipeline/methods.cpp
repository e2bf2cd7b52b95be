#include "pipeline/methods.hpp"

#include <algorithm>
#include <array>
#include <string>

namespace gfp {
namespace {

constexpr std::array kMethods{
    Method{"gfp_robust", &fit_gfp_robust},
    Method{"gfp_paper", &fit_gfp_paper},
    Method{"gfp_grid26", &fit_gfp_grid26},
    Method{"sphere_snake", &fit_sphere_snake_only},
    Method{"superquadric", &fit_superquadric_only},
    Method{"multi_superquadric", &fit_multi_superquadric_only},
    Method{"simple_primitive", &fit_simple_primitive_only},
    Method{"nearest_instance", &fit_nearest_instance},
};

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

}  // namespace

std::vector<std::string> profile_names() { return {"robust", "paper"}; }

std::vector<std::string> method_names() {
  std::vector<std::string> names;
  for (const Method& method : kMethods) names.emplace_back(method.name);
  return names;
}

Result<Method> find_method(std::string_view name) {
  const auto found = std::find_if(kMethods.begin(), kMethods.end(), [&](const Method& method) { return method.name == name; });
  if (found == kMethods.end())
    return failure(ErrorCode::kNotFound, "method = " + std::string(name) + ", expected one of " + joined(method_names()));
  return *found;
}

Result<void> validate(const PipelineOptions& options) {
  const std::vector<std::string> profiles = profile_names();
  if (std::find(profiles.begin(), profiles.end(), options.profile) == profiles.end())
    return failure(ErrorCode::kNotFound, "profile = " + options.profile + ", expected one of " + joined(profiles));
  if (const auto method = find_method(options.method); !method) return tl::unexpected(method.error());
  if (const auto shadow = find_method(options.shadow); !options.shadow.empty() && !shadow)
    return failure(shadow.error().code, "shadow: " + shadow.error().what);
  return {};
}

}  // namespace gfp
