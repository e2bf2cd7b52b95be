#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "app/examine_machine.hpp"
#include "cli/command.hpp"

namespace gfp {
namespace {

using Level = Finding::Level;

/// A machine made of files.
struct Machine {
  test::TemporaryFolder folder;
  MachineUser user{false, {"plugdev", "video"}, true};

  void put(const std::string& file, const std::string& text) const {
    std::filesystem::create_directories((folder / file).parent_path());
    std::ofstream(folder / file) << text << "\n";
  }
  /// One where nothing is to be found fault with.
  void make_fit() const {
    put("usr/lib/udev/rules.d/60-libfreenect.rules", R"(ATTRS{idVendor}=="045e", ATTRS{idProduct}=="02ae", MODE="0660")");
    put("lib/udev/rules.d/60-libopenni2-0.rules", R"(ATTRS{idVendor}=="1d27", MODE="0660")");
    put("proc/modules", "usbcore 1 0 - Live 0x0");
    put("proc/sys/net/core/rmem_max", "4194304");
    put("proc/cpuinfo", "flags\t: fpu avx avx2 bmi2");
    put("sys/devices/system/clocksource/clocksource0/current_clocksource", "tsc");
    put("sys/class/net/eth0/speed", "1000");
    put("sys/class/net/eth0/mtu", "9000");
  }
  std::vector<Finding> faults() const {
    auto findings = examine_machine(folder.path(), user);
    std::erase_if(findings, [](const Finding& finding) { return finding.level == Level::kOk; });
    return findings;
  }
};

TEST(Doctor, AFitMachineHasNoFaults) {
  const Machine machine;
  machine.make_fit();
  EXPECT_TRUE(machine.faults().empty());
}

// Each fault alone is found, and comes with a line that mends it.
TEST(Doctor, EveryFaultIsFoundAndHasAFix) {
  const struct {
    const char *file, *text, *check, *in_what, *in_fix;
    Level level;
  } cases[] = {
      {"usr/lib/udev/rules.d/60-libfreenect.rules", "nothing", "udev rules", "Kinect", "libfreenect0.5", Level::kProblem},
      {"lib/udev/rules.d/60-libopenni2-0.rules", "nothing", "udev rules", "Xtion", "libopenni2-0", Level::kProblem},
      {"proc/modules", "videodev 1 0 -\ngspca_kinect 16384 0 - Live 0x0", "kernel driver", "gspca_kinect is loaded", "blacklist", Level::kProblem},
      {"proc/sys/net/core/rmem_max", "212992", "receive buffer", "212992, expected at least 4194304", "sysctl", Level::kProblem},
      {"proc/cpuinfo", "flags\t: fpu sse2", "processor", "no AVX2", "processor", Level::kWarning},
      {"sys/devices/system/clocksource/clocksource0/current_clocksource", "hpet", "clock", "hpet", "tsc", Level::kWarning},
      {"sys/class/net/eth0/speed", "100", "network", "100 Mbit/s", "cable", Level::kWarning},
      {"sys/module/usbcore/parameters/usbfs_memory_mb", "16", "USB memory", "16, expected at least 64", "usbfs_memory_mb", Level::kWarning},
      {"sys/bus/pci/devices/0000:03:00.0/class", "0x0c0010", "FireWire", "0000:03:00.0", "modprobe firewire-ohci", Level::kProblem},
      {".dockerenv", "", "container", "/dev/bus/usb", "--device-cgroup-rule", Level::kWarning},
  };
  for (const auto& one : cases) {
    const Machine machine;
    machine.make_fit();
    machine.put(one.file, one.text);
    const auto faults = machine.faults();
    ASSERT_EQ(faults.size(), 1U) << one.file;
    EXPECT_EQ(faults[0].check, one.check);
    EXPECT_EQ(faults[0].level, one.level) << one.file;
    EXPECT_NE(faults[0].what.find(one.in_what), std::string::npos) << faults[0].what;
    EXPECT_NE(faults[0].fix.find(one.in_fix), std::string::npos) << faults[0].fix;
  }
}

TEST(Doctor, TwoKinectsOnOneBusAreTooMany) {
  const Machine machine;
  machine.make_fit();
  for (const char* port : {"1-1", "1-2", "2-1"}) {
    const std::string device = std::string("sys/bus/usb/devices/") + port + "/";
    machine.put(device + "idVendor", "045e");
    machine.put(device + "idProduct", "02ae");
    machine.put(device + "busnum", std::string(1, port[0]));
  }
  const auto faults = machine.faults();
  ASSERT_EQ(faults.size(), 1U);
  EXPECT_EQ(faults[0].what, "bus 1: Kinects = 2, expected at most 1");
}

TEST(Doctor, TheUserMustBeInTheGroupsUnlessItIsRoot) {
  Machine machine;
  machine.make_fit();
  machine.user = {false, {"plugdev"}, false};
  const auto faults = machine.faults();
  ASSERT_EQ(faults.size(), 2U);
  EXPECT_EQ(faults[0].fix, "usermod -aG video $USER, then log in anew");
  EXPECT_EQ(faults[1].check, "clock");
  machine.user = {true, {}, true};
  EXPECT_TRUE(machine.faults().empty());
}

TEST(Doctor, TheCommandTellsJsonAndItsExitCode) {
  const auto result = test::run_gfp("doctor --json");
  EXPECT_TRUE(result.exit_code == 0 || result.exit_code == 69) << result.exit_code << result.err;
  const auto document = nlohmann::json::parse(result.out, nullptr, false);
  ASSERT_TRUE(document.is_object()) << result.out;
  bool problem = false;
  for (const auto& finding : document["findings"]) {
    EXPECT_EQ(finding["fix"].is_null(), finding["level"] == "ok") << finding;
    problem |= finding["level"] == "problem";
  }
  EXPECT_GE(document["findings"].size(), 8U);
  EXPECT_EQ(result.exit_code, problem ? 69 : 0);
}

TEST(Devices, EveryDriverOfThisBuildSaysWhatItFound) {
  const auto result = test::run_gfp("devices --json");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const auto document = nlohmann::json::parse(result.out, nullptr, false);
  ASSERT_TRUE(document.is_object()) << result.out;
  for (const auto& driver : document["drivers"]) {
    EXPECT_TRUE(driver["driver"].is_string());
    EXPECT_TRUE(driver["devices"].is_array());
    for (const auto& device : driver["devices"]) EXPECT_FALSE(device["name"].get<std::string>().empty());
  }
  EXPECT_EQ(test::run_gfp("devices").exit_code, 0);
}

}  // namespace
}  // namespace gfp
