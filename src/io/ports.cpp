#include "io/ports.hpp"

#include <algorithm>
#include <array>
#include <memory>
#include <string_view>

#include <libudev.h>

namespace kerf::io {
namespace {

template <auto Release>
struct Releaser {
  template <typename Object>
  void operator()(Object* object) const {
    Release(object);
  }
};
using Udev = std::unique_ptr<udev, Releaser<udev_unref>>;
using Enumeration = std::unique_ptr<udev_enumerate, Releaser<udev_enumerate_unref>>;
using Device = std::unique_ptr<udev_device, Releaser<udev_device_unref>>;

std::string text_of(const char* text) {
  return text == nullptr ? std::string() : std::string(text);
}

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
  const Enumeration enumeration(udev_enumerate_new(context.get()));
  if (!enumeration) return ports;
  udev_enumerate_add_match_subsystem(enumeration.get(), "tty");
  udev_enumerate_scan_devices(enumeration.get());
  udev_list_entry* entry = nullptr;
  udev_list_entry_foreach(entry, udev_enumerate_get_list_entry(enumeration.get())) {
    const Device device(udev_device_new_from_syspath(context.get(), udev_list_entry_get_name(entry)));
    if (!device) continue;
    const std::string path = text_of(udev_device_get_devnode(device.get()));
    if (is_port(device.get(), path)) ports.push_back(port_of(device.get(), path));
  }
  std::ranges::sort(ports, comes_before);
  return ports;
}

}  // namespace kerf::io
