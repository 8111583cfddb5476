#pragma once
// Which serial ports this computer has. Any thread, one at a time.

#include <optional>
#include <span>
#include <string>
#include <vector>

#include <boost/describe.hpp>

namespace kerf::io {

/// A serial port, with what its USB device says about itself; empty where it says nothing or is no USB device.
struct SerialPort {
  std::string path;         ///< "/dev/ttyUSB0"
  std::string url;          ///< what `--machine` takes
  std::string lasting_url;  ///< another one, which finds the port under every number
  std::string by_id;        ///< a name that stays the same when the port number changes
  std::string vendor;       ///< "1a86"
  std::string product;      ///< "7523"
  std::string maker;
  std::string name;
  std::string serial_number;
};
BOOST_DESCRIBE_STRUCT(SerialPort, (), (path, url, lasting_url, by_id, vendor, product, maker, name, serial_number))

/// Ports that a controller could be on, in the order of their names: USB (`ttyUSB`, `ttyACM`) and real UARTs, without
/// the empty sockets that the kernel lists as `ttyS*`.
[[nodiscard]] std::vector<SerialPort> list_serial_ports();
/// The port at `path`, which may be a link to it; only the path is filled in for one that is not in that list.
[[nodiscard]] SerialPort find_serial_port(const std::string& path);

/// Where the port of that name is now: `by-id/NAME` is udev's name, `usb/NUMBER` a USB serial number, anything else a
/// path already. Empty when no port has the number.
[[nodiscard]] std::optional<std::string> serial_path(const std::string& name, std::span<const SerialPort> ports);

/// The name by which the port of `name` is found again under another path: its USB serial number, if it has one of its
/// own; else `name`.
[[nodiscard]] std::string lasting_name(const std::string& name, std::span<const SerialPort> ports);

}  // namespace kerf::io
