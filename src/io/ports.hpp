#pragma once
// Which serial ports this computer has. Any thread, one at a time.

#include <string>
#include <vector>

#include <boost/describe.hpp>

namespace kerf::io {

/// A serial port, with what its USB device says about itself; empty where it says nothing or is no USB device.
struct SerialPort {
  std::string path;     ///< "/dev/ttyUSB0"
  std::string url;      ///< what `--machine` takes
  std::string by_id;    ///< a name that stays the same when the port number changes
  std::string vendor;   ///< "1a86"
  std::string product;  ///< "7523"
  std::string maker;
  std::string name;
  std::string serial_number;
};
BOOST_DESCRIBE_STRUCT(SerialPort, (), (path, url, by_id, vendor, product, maker, name, serial_number))

/// Ports that a controller could be on, in the order of their names: USB (`ttyUSB`, `ttyACM`) and real UARTs, without
/// the empty sockets that the kernel lists as `ttyS*`.
[[nodiscard]] std::vector<SerialPort> list_serial_ports();

}  // namespace kerf::io
