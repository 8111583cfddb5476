#include "io/power_warnings.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <optional>
#include <system_error>
#include <variant>

#include <fmt/format.h>

#include "io/ports.hpp"

namespace kerf::io {
namespace {

namespace fs = std::filesystem;

/// The line that an attribute of sysfs holds; empty where there is none.
std::string attribute(const fs::path& path) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  return line;
}

/// Documentation/ABI/testing/sysfs-class-power of the kernel.
std::optional<std::string> battery_warning(const fs::path& supplies) {
  std::error_code fault;
  std::string charge;
  bool discharges = false;
  for (const auto& supply : fs::directory_iterator(supplies, fault)) {
    const fs::path& path = supply.path();
    const std::string type = attribute(path / "type");
    if (type != "Battery") {
      if (attribute(path / "online") == "1") return std::nullopt;
      continue;
    }
    // Scope "Device" is the battery of a mouse.
    if (attribute(path / "scope") == "Device" || attribute(path / "status") != "Discharging") continue;
    discharges = true;
    charge = attribute(path / "capacity");
  }
  if (!discharges) return std::nullopt;
  return fmt::format("This computer runs on its battery{}: plug it in, or the job may end with it.",
                     charge.empty() ? "" : " (" + charge + " %)");
}

/// The USB device that a serial port belongs to: the folder above it that has a vendor.
std::optional<fs::path> usb_device_of(const fs::path& tty) {
  std::error_code fault;
  fs::path folder = fs::canonical(tty / "device", fault);
  if (fault) return std::nullopt;
  for (; folder.has_relative_path(); folder = folder.parent_path()) {
    if (fs::exists(folder / "idVendor", fault)) return folder;
  }
  return std::nullopt;
}

/// Documentation/driver-api/usb/power-management.rst of the kernel; the driver of CDC devices suspends open ports too.
std::optional<std::string> autosuspend_warning(const std::string& device, const fs::path& ttys) {
  std::error_code fault;
  const fs::path real = fs::canonical(device, fault);
  const auto usb = usb_device_of(ttys / (fault ? fs::path(device) : real).filename());
  if (!usb || attribute(*usb / "power" / "control") != "auto") return std::nullopt;
  if (attribute(*usb / "power" / "autosuspend_delay_ms").starts_with('-')) return std::nullopt;
  return fmt::format("The system may suspend the USB device behind {}, and a job with it: as root, echo on > {}",
                     device, (*usb / "power" / "control").string());
}

/// The device file of a serial port, whatever it is called in the address.
std::string device_of(const SerialAddress& address) {
  return serial_path(address.path, list_serial_ports()).value_or(address.path);
}

}  // namespace

std::vector<std::string> power_warnings(const MachineUrl& url, const std::string& sysfs) {
  std::vector<std::string> warnings;
  if (auto battery = battery_warning(fs::path(sysfs) / "class" / "power_supply")) warnings.push_back(*battery);
  if (const auto* serial = std::get_if<SerialAddress>(&url)) {
    auto suspend = autosuspend_warning(device_of(*serial), fs::path(sysfs) / "class" / "tty");
    if (suspend) warnings.push_back(*suspend);
  }
  return warnings;
}

}  // namespace kerf::io
