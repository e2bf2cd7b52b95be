#include "freenect/freenect_api.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <atomic>
#include <cstdlib>

namespace gfp {
namespace {

std::atomic<bool> folder_is_playing{false};

}  // namespace

Result<std::unique_ptr<FreenectApi>> FreenectApi::load(const std::string& library, const std::filesystem::path& folder) {
  std::unique_ptr<FreenectApi> api(new FreenectApi);
  if (!folder.empty()) {
    if (folder_is_playing.exchange(true)) return failure(ErrorCode::kUnsupported, fmt::format("{}: fakenect plays one folder at a time", folder.string()));
    api->plays_folder_ = true;
    setenv("FAKENECT_PATH", folder.c_str(), 1);
  }
  const std::string name = !library.empty() ? library : folder.empty() ? "libfreenect.so.0.5" : GFP_FAKENECT_LIBRARY;
  api->library_ = dlopen(name.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (api->library_ == nullptr) return failure(ErrorCode::kUnsupported, fmt::format("libfreenect: {}", dlerror()));
#define GFP_FREENECT_FIND(function) api->function = reinterpret_cast<decltype(api->function)>(dlsym(api->library_, "freenect_" #function));
#define GFP_FREENECT_FIND_REQUIRED(function) \
  GFP_FREENECT_FIND(function)                \
  if (api->function == nullptr) return failure(ErrorCode::kUnsupported, fmt::format("{}: has no freenect_" #function, name));
  GFP_FREENECT_REQUIRED(GFP_FREENECT_FIND_REQUIRED)
  GFP_FREENECT_OPTIONAL(GFP_FREENECT_FIND)
#undef GFP_FREENECT_FIND_REQUIRED
#undef GFP_FREENECT_FIND
  return api;
}

FreenectApi::~FreenectApi() {
  if (library_ != nullptr) dlclose(library_);
  if (plays_folder_) folder_is_playing = false;
}

}  // namespace gfp
