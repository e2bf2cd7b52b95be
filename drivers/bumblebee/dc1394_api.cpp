#include "bumblebee/dc1394_api.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

namespace gfp {

Result<std::unique_ptr<Dc1394Api>> Dc1394Api::load(const std::string& library) {
  std::unique_ptr<Dc1394Api> api(new Dc1394Api);
  api->library_ = dlopen(library.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (api->library_ == nullptr) return failure(ErrorCode::kUnsupported, fmt::format("libdc1394: {} (Debian: libdc1394-25)", dlerror()));
#define GFP_DC1394_FIND(name)                                                                                \
  api->name##_ = reinterpret_cast<decltype(api->name##_)>(dlsym(api->library_, "dc1394_" #name));            \
  if (api->name##_ == nullptr) return failure(ErrorCode::kUnsupported, fmt::format("{}: has no dc1394_" #name, library));
  GFP_DC1394_FUNCTIONS(GFP_DC1394_FIND)
#undef GFP_DC1394_FIND
  return api;
}

Dc1394Api::~Dc1394Api() {
  if (library_ != nullptr) dlclose(library_);
}

}  // namespace gfp
