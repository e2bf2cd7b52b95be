#include "app/builtin_library.hpp"

#include <cassert>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "app/embedded_primitives.hpp"
#include "wire/primitive_file.hpp"

namespace gfp {

const PrimitiveLibrary& builtin_library() {
  static const PrimitiveLibrary library = [] {
    auto built_in = wire::decode_primitives(embedded_primitives());
    assert(built_in);
    std::vector<PrimitivePtr> primitives;
    for (auto& primitive : *built_in) primitives.push_back(std::make_shared<const Primitive>(std::move(primitive)));
    return PrimitiveLibrary(std::move(primitives));
  }();
  return library;
}

Result<PrimitiveLibrary> library_with(const std::filesystem::path& folder) {
  auto own = wire::read_primitive_folder(folder);
  if (!own) return tl::unexpected(own.error());
  std::map<std::string, PrimitivePtr> by_name;
  for (const PrimitivePtr& primitive : builtin_library().all()) by_name[primitive->name] = primitive;
  for (auto& primitive : *own) by_name[primitive.name] = std::make_shared<const Primitive>(primitive);
  std::vector<PrimitivePtr> primitives;
  for (auto& [name, primitive] : by_name) primitives.push_back(std::move(primitive));
  return PrimitiveLibrary(std::move(primitives));
}

Result<PrimitivePtr> find_class(const PrimitiveLibrary& library, std::string_view class_name) {
  if (PrimitivePtr primitive = library.find(class_name)) return primitive;
  std::string known;
  for (const PrimitivePtr& primitive : library.all()) known += (known.empty() ? "" : ", ") + primitive->name;
  return failure(ErrorCode::kNotFound, "class = " + std::string(class_name) + ", expected one of " + known);
}

}  // namespace gfp
