#include "io/ports.hpp"

#include <gtest/gtest.h>

namespace kerf::io {
namespace {

SerialPort port(std::string path, std::string by_id, std::string number) {
  SerialPort port;
  port.path = std::move(path);
  port.by_id = std::move(by_id);
  port.serial_number = std::move(number);
  return port;
}

TEST(SerialPath, FindsAPortUnderItsNumberOfTheDay) {
  const std::vector<SerialPort> ports{port("/dev/ttyACM3", "/dev/serial/by-id/usb-Teensy_1234", "1234"),
                                      port("/dev/ttyUSB0", "", "")};
  EXPECT_EQ(serial_path("usb/1234", ports), "/dev/ttyACM3");
  EXPECT_EQ(serial_path("by-id/usb-Teensy_1234", ports), "/dev/ttyACM3");
  EXPECT_EQ(serial_path("/dev/ttyUSB0", ports), "/dev/ttyUSB0");
  EXPECT_EQ(serial_path("usb/9", ports), std::nullopt);
  EXPECT_EQ(serial_path("usb/", ports), std::nullopt);
  EXPECT_EQ(serial_path("by-id/other", ports), "/dev/serial/by-id/other");
}

TEST(SerialPath, APortIsFollowedByItsNumberIfThatIsItsOwn) {
  const std::vector<SerialPort> before{port("/dev/ttyUSB0", "", "A9"), port("/dev/ttyUSB1", "", "0001"),
                                       port("/dev/ttyUSB2", "", "0001"), port("/dev/ttyS0", "", "")};
  EXPECT_EQ(lasting_name("/dev/ttyUSB0", before), "usb/A9");
  EXPECT_EQ(lasting_name("usb/A9", before), "usb/A9");
  EXPECT_EQ(lasting_name("/dev/ttyUSB1", before), "/dev/ttyUSB1");
  EXPECT_EQ(lasting_name("/dev/ttyS0", before), "/dev/ttyS0");
  EXPECT_EQ(lasting_name("/dev/other", before), "/dev/other");
  const std::vector<SerialPort> after{port("/dev/ttyUSB7", "", "A9"), port("/dev/ttyUSB0", "", "B2")};
  EXPECT_EQ(serial_path(lasting_name("/dev/ttyUSB0", before), after), "/dev/ttyUSB7");
}

}  // namespace
}  // namespace kerf::io
