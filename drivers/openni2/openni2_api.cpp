#include "openni2/openni2_api.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <filesystem>

#include "gfp/core/mutex.hpp"

namespace gfp {
namespace {

Mutex shared_mutex;
std::weak_ptr<OpenNi2Api> shared GFP_GUARDED_BY(shared_mutex);

/// OpenNI2 and its drivers lose 24 kB each time they are loaded (their static objects): once loaded they stay, and are only initialised anew.
void keep_drivers_loaded(const void* library_symbol) {
  Dl_info info{};
  if (dladdr(library_symbol, &info) == 0 || info.dli_fname == nullptr) return;
  std::error_code error;
  for (const auto& driver : std::filesystem::directory_iterator(std::filesystem::path(info.dli_fname).parent_path() / "OpenNI2" / "Drivers", error))
    dlopen(driver.path().c_str(), RTLD_NOW | RTLD_NOLOAD | RTLD_NODELETE);
}

}  // namespace

Result<std::shared_ptr<OpenNi2Api>> OpenNi2Api::acquire(const std::string& library) {
  MutexLock lock(shared_mutex);
  if (auto in_use = shared.lock()) {
    if (in_use->name_ == library) return in_use;
    return failure(ErrorCode::kUnsupported, fmt::format("openni2.library = {}, expected {}, which this process uses already", library, in_use->name_));
  }
  std::shared_ptr<OpenNi2Api> api(new OpenNi2Api);
  if (auto loaded = api->load(library); !loaded) return tl::unexpected<Error>(loaded.error());
  shared = api;
  return api;
}

Result<void> OpenNi2Api::load(const std::string& library) {
  name_ = library;
  library_ = dlopen(library.c_str(), RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
  if (library_ == nullptr) return failure(ErrorCode::kUnsupported, fmt::format("OpenNI2: {}", dlerror()));
#define GFP_OPENNI2_FIND(function)                                                            \
  function = reinterpret_cast<decltype(function)>(dlsym(library_, "oni" #function));          \
  if (function == nullptr) return failure(ErrorCode::kUnsupported, fmt::format("{}: has no oni" #function, library));
  GFP_OPENNI2_FUNCTIONS(GFP_OPENNI2_FIND)
#undef GFP_OPENNI2_FIND
  if (Initialize(ONI_API_VERSION) != ONI_STATUS_OK) return failure(ErrorCode::kIo, "OpenNI2: " + why());
  initialised_ = true;
  keep_drivers_loaded(reinterpret_cast<const void*>(Initialize));
  return {};
}

OpenNi2Api::~OpenNi2Api() {
  if (initialised_) Shutdown();
  if (library_ != nullptr) dlclose(library_);
}

std::string OpenNi2Api::why() const {
  std::string text = GetExtendedError();
  while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) text.pop_back();
  return text.empty() ? "no reason given" : text;
}

}  // namespace gfp
