#include "gfp/primitive/primitive_library.hpp"

#include <algorithm>
#include <utility>

namespace gfp {

PrimitiveLibrary::PrimitiveLibrary(std::vector<PrimitivePtr> primitives) : primitives_(std::move(primitives)) {
  std::sort(primitives_.begin(), primitives_.end(), [](const PrimitivePtr& a, const PrimitivePtr& b) { return a->class_name < b->class_name; });
}

PrimitivePtr PrimitiveLibrary::find(std::string_view class_name) const {
  for (const auto& primitive : primitives_)
    if (primitive->class_name == class_name) return primitive;
  for (const auto& primitive : primitives_)
    if (std::find(primitive->aliases.begin(), primitive->aliases.end(), class_name) != primitive->aliases.end()) return primitive;
  return nullptr;
}

}  // namespace gfp
