#include "gfp/primitive/primitive_library.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace gfp {
namespace {

bool has_alias(const Primitive& primitive, std::string_view name) {
  return std::find(primitive.aliases.begin(), primitive.aliases.end(), name) != primitive.aliases.end();
}

template <class Predicate>
std::vector<PrimitivePtr> those(const std::vector<PrimitivePtr>& all, Predicate&& wanted) {
  std::vector<PrimitivePtr> found;
  std::copy_if(all.begin(), all.end(), std::back_inserter(found), [&](const PrimitivePtr& primitive) { return wanted(*primitive); });
  return found;
}

}  // namespace

PrimitiveLibrary::PrimitiveLibrary(std::vector<PrimitivePtr> primitives) : primitives_(std::move(primitives)) {
  std::sort(primitives_.begin(), primitives_.end(), [](const PrimitivePtr& a, const PrimitivePtr& b) { return a->name < b->name; });
}

PrimitivePtr PrimitiveLibrary::find(std::string_view name) const {
  for (const auto& primitive : primitives_)
    if (primitive->name == name) return primitive;
  const auto others = of_class(name);
  return others.empty() ? nullptr : others.front();
}

std::vector<PrimitivePtr> PrimitiveLibrary::of_class(std::string_view name) const {
  auto found = those(primitives_, [&](const Primitive& primitive) { return primitive.class_name == name; });
  if (found.empty()) found = those(primitives_, [&](const Primitive& primitive) { return primitive.name == name || has_alias(primitive, name); });
  return found;
}

}  // namespace gfp
