#include "gfp/selection/context.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace gfp {
namespace {

/// How much larger than its class's mean a model is, standard deviations of the mean log size.
double size_deviation(const FittedModel& model) {
  const Primitive& primitive = *model.primitive;
  const double sigma = std::sqrt(primitive.log_size_covariance.sum()) / 3;
  const double deviation = (model.size_m.array().log().matrix() - primitive.log_size_mean).mean();
  return sigma > 0 ? deviation / sigma : 0;
}

bool holds(const std::vector<std::string>& group, const std::string& name) { return std::find(group.begin(), group.end(), name) != group.end(); }

}  // namespace

Context::Context(const ContextOptions& options) : options_(options) {
  for (const std::string& line : options.groups) {
    std::istringstream words(line);
    groups_.emplace_back();
    for (std::string name; words >> name;) groups_.back().push_back(name);
  }
}

bool Context::share_a_group(const std::string& one, const std::string& other) const {
  return std::any_of(groups_.begin(), groups_.end(), [&](const auto& group) { return holds(group, one) && holds(group, other); });
}

bool Context::in_any_group(const std::string& name) const {
  return std::any_of(groups_.begin(), groups_.end(), [&](const auto& group) { return holds(group, name); });
}

double Context::log_odds(const FittedModel& one, const FittedModel& other) const {
  if (options_.weight <= 0 || !one.primitive || !other.primitive) return 0;
  double sum = 0;
  if (share_a_group(one.class_name, other.class_name)) sum += options_.together;
  else if (in_any_group(one.class_name) && in_any_group(other.class_name)) sum += options_.apart;
  const double r = options_.size_correlation, rest = 1 - r * r;
  const double a = size_deviation(one), b = size_deviation(other);
  sum += -0.5 * std::log(rest) - (r * r * (a * a + b * b) - 2 * r * a * b) / (2 * rest);
  return options_.weight * sum;
}

}  // namespace gfp
