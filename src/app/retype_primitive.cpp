#include "app/retype_primitive.hpp"

#include <algorithm>

#include "app/builtin_library.hpp"
#include "gfp/primitive/primitive_of_members.hpp"
#include "wire/primitive_file.hpp"

namespace gfp {
namespace {

namespace fs = std::filesystem;

fs::path file_of(const fs::path& folder, const std::string& name) { return folder / (name + ".gfp"); }

bool has_class(const fs::path& folder, const std::string& class_name) {
  const auto own = wire::read_primitive_folder(folder);
  return own && std::any_of(own->begin(), own->end(), [&](const Primitive& primitive) { return primitive.class_name == class_name; });
}

}  // namespace

Result<Primitive> primitive_to_retype(const fs::path& folder, const std::string& name) {
  std::error_code ignored;
  if (!folder.empty() && fs::exists(file_of(folder, name), ignored)) return wire::read_primitive(file_of(folder, name));
  auto found = find_class(builtin_library(), name);
  if (!found) return tl::unexpected(found.error());
  return **found;
}

int set_types_by_hand(const std::vector<bool>& chosen, std::optional<PointType> type, Primitive& primitive) {
  std::vector<std::optional<PointType>> manual = primitive.manual_types;
  manual.resize(primitive.size());
  int changed = 0;
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    if (!chosen[i] || manual[i] == type) continue;
    manual[i] = type;
    ++changed;
  }
  if (changed == 0) return 0;
  if (std::none_of(manual.begin(), manual.end(), [](const auto& set) { return set.has_value(); })) manual.clear();
  set_manual_types(primitive, std::move(manual));
  return changed;
}

Result<fs::path> keep_primitive(const fs::path& folder, const Primitive& primitive) {
  std::error_code ignored;
  fs::create_directories(folder, ignored);
  if (!has_class(folder, primitive.class_name))
    for (const PrimitivePtr& other : builtin_library().all())
      if (other->class_name == primitive.class_name && other->name != primitive.name)
        if (auto written = wire::write_primitive(file_of(folder, other->name), *other); !written) return tl::unexpected(written.error());
  const fs::path file = file_of(folder, primitive.name);
  if (auto written = wire::write_primitive(file, primitive); !written) return tl::unexpected(written.error());
  return file;
}

}  // namespace gfp
