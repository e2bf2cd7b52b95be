#include "app/builtin_library.hpp"

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "gfp/primitive/families.hpp"

namespace gfp {

const PrimitiveLibrary& builtin_library() {
  static const PrimitiveLibrary library = [] {
    std::vector<PrimitivePtr> primitives;
    for (const std::string& name : family_names()) primitives.push_back(std::make_shared<const Primitive>(build_family_primitive(name)));
    return PrimitiveLibrary(std::move(primitives));
  }();
  return library;
}

Result<PrimitivePtr> find_class(const PrimitiveLibrary& library, std::string_view class_name) {
  if (PrimitivePtr primitive = library.find(class_name)) return primitive;
  std::string known;
  for (const PrimitivePtr& primitive : library.all()) known += (known.empty() ? "" : ", ") + primitive->class_name;
  return failure(ErrorCode::kNotFound, "class = " + std::string(class_name) + ", expected one of " + known);
}

}  // namespace gfp
