#pragma once

#include <string>
#include <vector>

#include "gfp/core/error.hpp"

namespace gfp {

/// A sensor that is plugged in, as a configuration would name it.
struct Device {
  std::string driver;  ///< SensorConfig::driver.
  std::string input;   ///< SensorConfig::input, for openni2 and bumblebee.
  std::string serial;  ///< freenect.serial, for freenect.
  std::string name;    ///< For people.
};

/// What one driver found, or why it could not look.
struct DeviceSearch {
  std::string driver;
  Result<std::vector<Device>> devices;
};

/// Asks every driver that this build has and that has devices, in a fixed order.
std::vector<DeviceSearch> find_devices();

}  // namespace gfp
