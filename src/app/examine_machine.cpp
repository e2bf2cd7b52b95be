#include "app/examine_machine.hpp"

#include <fmt/format.h>
#include <grp.h>
#include <sys/timex.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <fstream>
#include <map>
#include <optional>

namespace gfp {
namespace {

namespace fs = std::filesystem;
using Level = Finding::Level;

constexpr long kReceiveBuffer = 4 << 20;   // what a GigE camera's bursts need (drivers/bumblebee asks for it)
constexpr long kUsbMemory_mb = 64;         // buffers of a USB3 Vision camera
constexpr long kGigabit_mbit = 1000;
constexpr long kUsb2Kinects = 1;           // a Kinect fills a USB 2 bus

std::string read(const fs::path& file) {
  std::ifstream in(file);
  std::string text(std::size_t{1} << 20, '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(std::max<std::streamsize>(0, in.gcount())));
  while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) text.pop_back();
  return text;
}

std::optional<long> number(const fs::path& file) {
  const std::string text = read(file);
  long value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc{} && end == text.data() + text.size() ? std::optional(value) : std::nullopt;
}

/// Sorted; empty where there is no such folder.
std::vector<fs::path> entries(const fs::path& folder) {
  std::error_code error;
  std::vector<fs::path> found;
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) found.push_back(at->path());
  std::sort(found.begin(), found.end());
  return found;
}

class Examination {
 public:
  Examination(fs::path root, const MachineUser& user) : root_(std::move(root)), user_(user) {}

  std::vector<Finding> run() {
    udev_rules("Kinect", "02ae", "libfreenect0.5");
    udev_rules("Xtion, Carmine", "1d27", "libopenni2-0");
    groups();
    kernel_driver();
    usb();
    firewire();
    receive_buffer();
    network();
    clock();
    container();
    processor();
    return std::move(findings_);
  }

 private:
  void add(std::string check, Level level, std::string what, std::string fix = {}) { findings_.push_back({std::move(check), level, std::move(what), level == Level::kOk ? std::string() : std::move(fix)}); }

  void udev_rules(const char* device, const char* id, const char* package) {
    for (const char* folder : {"etc/udev/rules.d", "run/udev/rules.d", "usr/lib/udev/rules.d", "lib/udev/rules.d"})
      for (const fs::path& file : entries(root_ / folder))
        if (file.extension() == ".rules" && read(file).find(id) != std::string::npos) return add("udev rules", Level::kOk, fmt::format("{}: {}", device, ("/" / fs::relative(file, root_)).string()));
    add("udev rules", Level::kProblem, fmt::format("{}: no rule names USB id {}, so only root may open it", device, id), fmt::format("apt-get install {} && udevadm control --reload && udevadm trigger", package));
  }

  void groups() {
    if (user_.is_root) return add("groups", Level::kOk, "running as root");
    for (const char* group : {"plugdev", "video"})
      if (user_.groups.contains(group)) add("groups", Level::kOk, fmt::format("in {}", group));
      else add("groups", Level::kWarning, fmt::format("not in {}, which the rules open devices to", group), fmt::format("usermod -aG {} $USER, then log in anew", group));
  }

  void kernel_driver() {
    std::string modules("\n");
    modules += read(root_ / "proc/modules");
    const bool loaded = modules.find("\ngspca_kinect ") != std::string::npos;
    if (!loaded) return add("kernel driver", Level::kOk, "gspca_kinect, which takes a Kinect's camera away, is not loaded");
    add("kernel driver", Level::kProblem, "gspca_kinect is loaded and takes a Kinect's camera away", "echo 'blacklist gspca_kinect' > /etc/modprobe.d/gfp.conf && modprobe -r gspca_kinect");
  }

  void usb() {
    if (const auto memory = number(root_ / "sys/module/usbcore/parameters/usbfs_memory_mb"))
      add("USB memory", *memory == 0 || *memory >= kUsbMemory_mb ? Level::kOk : Level::kWarning, fmt::format("usbfs_memory_mb = {}, expected at least {} for USB3 Vision cameras", *memory, kUsbMemory_mb),
          fmt::format("echo {} > /sys/module/usbcore/parameters/usbfs_memory_mb", kUsbMemory_mb));
    std::map<std::string, long> kinects;  // a bus
    for (const fs::path& device : entries(root_ / "sys/bus/usb/devices"))
      if (read(device / "idProduct") == "02ae" && read(device / "idVendor") == "045e") ++kinects[read(device / "busnum")];
    for (const auto& [bus, count] : kinects)
      add("USB bandwidth", count <= kUsb2Kinects ? Level::kOk : Level::kProblem, fmt::format("bus {}: Kinects = {}, expected at most {}", bus, count, kUsb2Kinects), "plug one of them into another host controller");
  }

  void firewire() {
    for (const fs::path& device : entries(root_ / "sys/bus/pci/devices"))
      if (read(device / "class") == "0x0c0010" && !fs::exists(root_ / "sys/bus/firewire"))
        add("FireWire", Level::kProblem, fmt::format("{}: a controller without its driver, so no Bumblebee2 or XB3 can be seen", device.filename().string()), "modprobe firewire-ohci && echo firewire-ohci > /etc/modules-load.d/gfp.conf");
  }

  void receive_buffer() {
    const auto bytes = number(root_ / "proc/sys/net/core/rmem_max");
    if (!bytes) return add("receive buffer", Level::kWarning, "net.core.rmem_max cannot be read", "mount /proc");
    add("receive buffer", *bytes >= kReceiveBuffer ? Level::kOk : Level::kProblem, fmt::format("net.core.rmem_max = {}, expected at least {} for GigE cameras", *bytes, kReceiveBuffer),
        fmt::format("echo 'net.core.rmem_max={}' > /etc/sysctl.d/60-gfp.conf && sysctl --system", kReceiveBuffer));
  }

  void network() {
    int links = 0;
    for (const fs::path& link : entries(root_ / "sys/class/net")) {
      const std::string name = link.filename().string();
      const auto speed = number(link / "speed");
      if (name == "lo" || !speed || *speed <= 0) continue;  // virtual, wireless or without a cable
      ++links;
      const auto mtu = number(link / "mtu").value_or(1500);
      add("network", *speed >= kGigabit_mbit ? Level::kOk : Level::kWarning, fmt::format("{}: {} Mbit/s, MTU {}, expected at least {} Mbit/s for a GigE camera", name, *speed, mtu, kGigabit_mbit), "another port or cable");
    }
    if (links == 0) add("network", Level::kOk, "no wired link tells its speed: only of interest for GigE cameras");
  }

  void clock() {
    add("clock", user_.clock_synchronised ? Level::kOk : Level::kWarning, user_.clock_synchronised ? "synchronised" : "the kernel's clock is not synchronised: stamps of several machines cannot be compared", "timedatectl set-ntp true");
    const std::string source = read(root_ / "sys/devices/system/clocksource/clocksource0/current_clocksource");
    const bool slow = source == "hpet" || source == "acpi_pm" || source == "jiffies" || source == "refined-jiffies";
    if (!source.empty()) add("clock", slow ? Level::kWarning : Level::kOk, fmt::format("clock source = {}, expected one that costs no system call", source), "boot with clocksource=tsc");
  }

  void container() {
    const bool inside = fs::exists(root_ / ".dockerenv") || fs::exists(root_ / "run/.containerenv");
    if (!inside) return add("container", Level::kOk, "none");
    const bool usb = !entries(root_ / "dev/bus/usb").empty();
    add("container", usb ? Level::kOk : Level::kWarning, usb ? "USB devices are there" : "no /dev/bus/usb: no USB camera can be seen, nor one that is plugged in again",
        "start it with -v /dev/bus/usb:/dev/bus/usb --device-cgroup-rule 'c 189:* rmw'; for GigE cameras with --network host");
  }

  void processor() {
    const std::string info = read(root_ / "proc/cpuinfo");
    if (info.empty()) return;
    const bool fast = info.find(" avx2") != std::string::npos;
    add("processor", fast ? Level::kOk : Level::kWarning, fast ? "has AVX2" : "has no AVX2: the kernels run at a third of their speed", "a processor of the last ten years");
    const std::string governor = read(root_ / "sys/devices/system/cpu/cpu0/cpufreq/scaling_governor");
    if (!governor.empty()) add("processor", governor == "powersave" ? Level::kWarning : Level::kOk, fmt::format("governor = {}", governor), "cpupower frequency-set -g schedutil");
  }

  const fs::path root_;
  const MachineUser& user_;
  std::vector<Finding> findings_;
};

}  // namespace

std::string_view to_string(Finding::Level level) { return level == Level::kOk ? "ok" : level == Level::kWarning ? "warning" : "problem"; }

MachineUser current_user() {
  MachineUser user;
  user.is_root = geteuid() == 0;
  std::vector<gid_t> ids(static_cast<std::size_t>(std::max(0, getgroups(0, nullptr))));
  ids.resize(static_cast<std::size_t>(std::max(0, getgroups(static_cast<int>(ids.size()), ids.data()))));
  for (const gid_t id : ids)
    if (const group* entry = getgrgid(id)) user.groups.insert(entry->gr_name);
  timex query{};
  user.clock_synchronised = adjtimex(&query) != TIME_ERROR;
  return user;
}

std::vector<Finding> examine_machine(const fs::path& root, const MachineUser& user) { return Examination(root, user).run(); }

}  // namespace gfp
