// The stereo kernels for CPUs with AVX2: CMakeLists.txt compiles this file for x86-64-v3, where there is one.
#include "cloud/stereo_kernels.hpp"

#ifdef __x86_64__
#define GFP_AVX2_STEREO_KERNELS
#include "cloud/stereo_kernels.cpp"
#else
namespace gfp {
const StereoKernels kAvx2StereoKernels{};
}  // namespace gfp
#endif
