#include "app/devices.hpp"

#ifdef GFP_HAS_BUMBLEBEE
#include "bumblebee/bumblebee_source.hpp"
#endif
#ifdef GFP_HAS_FREENECT
#include "freenect/freenect_source.hpp"
#endif
#ifdef GFP_HAS_OPENNI2
#include "openni2/openni2_source.hpp"
#endif

namespace gfp {
namespace {

#ifdef GFP_HAS_FREENECT
Result<std::vector<Device>> freenect_devices() {
  return list_freenect_devices().map([](const std::vector<std::string>& serials) {
    std::vector<Device> devices;
    for (const std::string& serial : serials) devices.push_back({"freenect", {}, serial, "Kinect v1"});
    return devices;
  });
}
#endif

#ifdef GFP_HAS_OPENNI2
Result<std::vector<Device>> openni2_devices() {
  return list_openni2_devices().map([](const std::vector<OpenNi2Device>& found) {
    std::vector<Device> devices;
    for (const OpenNi2Device& device : found) devices.push_back({"openni2", device.uri, {}, device.vendor + " " + device.name});
    return devices;
  });
}
#endif

#ifdef GFP_HAS_BUMBLEBEE
Result<std::vector<Device>> bumblebee_devices() {
  std::vector<Device> devices;
  for (const BumblebeeDevice& device : list_bumblebee_devices()) devices.push_back({"bumblebee", device.id, device.serial, device.model});
  return devices;
}
#endif

}  // namespace

std::vector<DeviceSearch> find_devices() {
  std::vector<DeviceSearch> searches;
#ifdef GFP_HAS_FREENECT
  searches.push_back({"freenect", freenect_devices()});
#endif
#ifdef GFP_HAS_OPENNI2
  searches.push_back({"openni2", openni2_devices()});
#endif
#ifdef GFP_HAS_BUMBLEBEE
  searches.push_back({"bumblebee", bumblebee_devices()});
#endif
  return searches;
}

}  // namespace gfp
