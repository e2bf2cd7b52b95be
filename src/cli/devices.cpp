// gfp devices: the sensors that are plugged in, as a configuration names them.
#include <iostream>
#include <memory>

#include <nlohmann/json.hpp>

#include "app/devices.hpp"
#include "cli/commands.hpp"

namespace gfp {
namespace {

nlohmann::json to_json(const std::vector<DeviceSearch>& searches) {
  nlohmann::json drivers = nlohmann::json::array();
  for (const DeviceSearch& search : searches) {
    nlohmann::json entry{{"driver", search.driver}, {"devices", nlohmann::json::array()}, {"error", nullptr}};
    if (!search.devices) entry["error"] = search.devices.error().what;
    else
      for (const Device& device : *search.devices) entry["devices"].push_back({{"input", device.input}, {"serial", device.serial}, {"name", device.name}});
    drivers.push_back(entry);
  }
  return {{"drivers", drivers}};
}

void print(const std::vector<DeviceSearch>& searches) {
  bool any = false;
  for (const DeviceSearch& search : searches) {
    if (!search.devices) {
      std::cout << search.driver << ": " << search.devices.error().what << "\n";
      continue;
    }
    if (search.devices->empty()) std::cout << search.driver << ": no device\n";
    any |= !search.devices->empty();
    for (const Device& device : *search.devices)
      std::cout << search.driver << ": " << device.name << (device.serial.empty() ? "" : ", serial " + device.serial) << (device.input.empty() ? "" : ", input " + device.input) << "\n";
  }
  if (!any) std::cout << "`gfp doctor` says what may be in the way\n";
}

}  // namespace

void add_devices_command(CLI::App& app, ExitStatus&) {
  CLI::App& command = *app.add_subcommand("devices", "List the sensors that are plugged in");
  const auto json = std::make_shared<bool>(false);
  command.add_flag("--json", *json, "One JSON document");
  command.callback([json] {
    const auto searches = find_devices();
    if (*json) std::cout << to_json(searches).dump(2) << "\n";
    else print(searches);
  });
}

}  // namespace gfp
