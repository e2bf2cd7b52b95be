#include "app/builtin_library.hpp"

#include <cassert>
#include <memory>
#include <set>
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

namespace {

PrimitiveLibrary with_upsampling(PrimitiveLibrary library, int levels) {
  if (levels == 0) return library;
  std::vector<PrimitivePtr> finer;
  for (const PrimitivePtr& primitive : library.all()) finer.push_back(std::make_shared<const Primitive>(upsampled(*primitive, levels)));
  return PrimitiveLibrary(std::move(finer));
}

}  // namespace

Result<PrimitiveLibrary> library_with(const std::filesystem::path& folder, int upsampling) {
  if (folder.empty()) return with_upsampling(builtin_library(), upsampling);
  auto own = wire::read_primitive_folder(folder);
  if (!own) return tl::unexpected(own.error());
  if (own->empty()) return failure(ErrorCode::kNotFound, folder.string() + ": no primitives, expected *.gfp files (gfp primitive build)");
  std::set<std::string> names, classes;
  std::vector<PrimitivePtr> primitives;
  for (Primitive& primitive : *own) {
    if (!names.insert(primitive.name).second) return failure(ErrorCode::kCorruptData, folder.string() + ": two primitives are named " + primitive.name);
    classes.insert(primitive.class_name);
    primitives.push_back(std::make_shared<const Primitive>(std::move(primitive)));
  }
  for (const PrimitivePtr& primitive : builtin_library().all())
    if (!names.contains(primitive->name) && !classes.contains(primitive->class_name)) primitives.push_back(primitive);
  return with_upsampling(PrimitiveLibrary(std::move(primitives)), upsampling);
}

Result<PrimitiveLibrary> library_of_configuration(const std::string& primitives, int upsampling, const std::filesystem::path& configuration) {
  auto library = library_with(primitives.empty() ? std::filesystem::path() : configuration.parent_path() / primitives, upsampling);
  if (!library) return failure(library.error().code, "primitives: " + library.error().what);
  return library;
}

Result<PrimitivePtr> find_class(const PrimitiveLibrary& library, std::string_view class_name) {
  if (PrimitivePtr primitive = library.find(class_name)) return primitive;
  std::string known;
  for (const PrimitivePtr& primitive : library.all()) known += (known.empty() ? "" : ", ") + primitive->name;
  return failure(ErrorCode::kNotFound, "class = " + std::string(class_name) + ", expected one of " + known);
}

}  // namespace gfp
