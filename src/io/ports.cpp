#include "io/ports.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <utility>

#include "io/udev_objects.hpp"

namespace kerf::io {
namespace {

std::string text_of(const char* text) {
  return text == nullptr ? std::string() : std::string(text);
}

constexpr std::string_view kById = "by-id/";
constexpr std::string_view kByNumber = "usb/";

/// Names of drivers that are real ports. `ttyS` needs a look at its hardware, everything else (consoles, ptys) is none.
bool is_port(udev_device* device, std::string_view path) {
  constexpr std::array<std::string_view, 5> kNames{"/dev/ttyUSB", "/dev/ttyACM", "/dev/ttyAMA", "/dev/ttyTHS",
                                                   "/dev/rfcomm"};
  if (std::ranges::any_of(kNames, [&](std::string_view name) { return path.starts_with(name); })) return true;
  if (!path.starts_with("/dev/ttyS")) return false;
  // The kernel lists 4 or more PC ports whether they exist or not; type 0 is "unknown", no chip was found.
  const std::string type = text_of(udev_device_get_sysattr_value(device, "type"));
  return !type.empty() && type != "0";
}

SerialPort port_of(udev_device* device, const std::string& path) {
  SerialPort port;
  port.path = path;
  port.url = "serial://" + path + "?baud=115200";
  udev_list_entry* link = nullptr;
  udev_list_entry_foreach(link, udev_device_get_devlinks_list_entry(device)) {
    const std::string name = text_of(udev_list_entry_get_name(link));
    if (name.starts_with("/dev/serial/by-id/")) port.by_id = name;
  }
  udev_device* usb = udev_device_get_parent_with_subsystem_devtype(device, "usb", "usb_device");
  if (usb == nullptr) return port;
  port.vendor = text_of(udev_device_get_sysattr_value(usb, "idVendor"));
  port.product = text_of(udev_device_get_sysattr_value(usb, "idProduct"));
  port.maker = text_of(udev_device_get_sysattr_value(usb, "manufacturer"));
  port.name = text_of(udev_device_get_sysattr_value(usb, "product"));
  port.serial_number = text_of(udev_device_get_sysattr_value(usb, "serial"));
  if (!port.serial_number.empty()) port.lasting_url = "serial://" + std::string(kByNumber) + port.serial_number;
  return port;
}

/// ttyUSB2 before ttyUSB10.
bool comes_before(const SerialPort& left, const SerialPort& right) {
  return std::pair(left.path.size(), left.path) < std::pair(right.path.size(), right.path);
}

}  // namespace

std::vector<SerialPort> list_serial_ports() {
  std::vector<SerialPort> ports;
  const Udev context(udev_new());
  if (!context) return ports;
  const UdevEnumeration enumeration(udev_enumerate_new(context.get()));
  if (!enumeration) return ports;
  udev_enumerate_add_match_subsystem(enumeration.get(), "tty");
  udev_enumerate_scan_devices(enumeration.get());
  udev_list_entry* entry = nullptr;
  udev_list_entry_foreach(entry, udev_enumerate_get_list_entry(enumeration.get())) {
    const UdevDevice device(udev_device_new_from_syspath(context.get(), udev_list_entry_get_name(entry)));
    if (!device) continue;
    const std::string path = text_of(udev_device_get_devnode(device.get()));
    if (is_port(device.get(), path)) ports.push_back(port_of(device.get(), path));
  }
  std::ranges::sort(ports, comes_before);
  return ports;
}

std::optional<std::string> serial_path(const std::string& name, std::span<const SerialPort> ports) {
  const auto path_where = [&](auto matches) -> std::optional<std::string> {
    const auto found = std::ranges::find_if(ports, matches);
    if (found == ports.end()) return std::nullopt;
    return found->path;
  };
  if (name.starts_with(kById)) {
    const std::string link = "/dev/serial/" + name;
    return path_where([&](const SerialPort& port) { return port.by_id == link; }).value_or(link);
  }
  if (!name.starts_with(kByNumber)) return name;
  return path_where([&](const SerialPort& port) {
    return !port.serial_number.empty() && port.serial_number == std::string_view(name).substr(kByNumber.size());
  });
}

std::string lasting_name(const std::string& name, std::span<const SerialPort> ports) {
  const auto path = serial_path(name, ports);
  const auto found = std::ranges::find_if(ports, [&](const SerialPort& port) { return path && port.path == *path; });
  if (found == ports.end() || found->serial_number.empty()) return name;
  // Makers give a whole batch the same number ("0001"): then it says nothing.
  const auto has_its_number = [&](const SerialPort& port) { return port.serial_number == found->serial_number; };
  return std::ranges::count_if(ports, has_its_number) == 1 ? std::string(kByNumber) + found->serial_number : name;
}

SerialPort find_serial_port(const std::string& path) {
  std::error_code ignored;
  const auto real = std::filesystem::canonical(path, ignored);
  for (SerialPort& port : list_serial_ports()) {
    if (port.path == real.string()) return std::move(port);
  }
  SerialPort unknown;
  unknown.path = path;
  return unknown;
}

}  // namespace kerf::io
