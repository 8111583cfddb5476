#include "io/power_warnings.hpp"

#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

namespace kerf::io {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

/// A tree like /sys, with one USB device that has a serial port.
class Power : public testing::Test {
 protected:
  Power() : sysfs_(fs::path(testing::TempDir()) / ("kerf-sysfs-" + std::to_string(::getpid()))) {
    fs::remove_all(sysfs_);
    fs::create_directories(sysfs_ / "class" / "tty" / "ttyACM7");
    fs::create_directories(usb() / "1-1:1.0");
    fs::create_directory_symlink(usb() / "1-1:1.0", sysfs_ / "class" / "tty" / "ttyACM7" / "device");
    set(usb() / "idVendor", "2341");
  }
  ~Power() override { fs::remove_all(sysfs_); }

  [[nodiscard]] fs::path usb() const { return sysfs_ / "devices" / "usb1" / "1-1"; }
  static void set(const fs::path& attribute, const std::string& value) {
    fs::create_directories(attribute.parent_path());
    std::ofstream(attribute) << value << '\n';
  }
  void supply(const std::string& name, const std::string& attribute, const std::string& value) const {
    set(sysfs_ / "class" / "power_supply" / name / attribute, value);
  }
  [[nodiscard]] std::vector<std::string> warnings() const {
    return power_warnings(SerialAddress{.path = "/dev/ttyACM7"}, sysfs_.string());
  }

  fs::path sysfs_;
};

TEST_F(Power, NothingIsWrongOnADesktop) {
  set(usb() / "power" / "control", "on");
  supply("AC", "type", "Mains");
  supply("AC", "online", "1");
  EXPECT_THAT(warnings(), IsEmpty());
  EXPECT_THAT(power_warnings(TcpAddress{}, "/nonexistent"), IsEmpty());
}

TEST_F(Power, AUsbDeviceThatMayBeSuspended) {
  set(usb() / "power" / "control", "auto");
  set(usb() / "power" / "autosuspend_delay_ms", "2000");
  ASSERT_THAT(warnings(), SizeIs(1));
  EXPECT_THAT(warnings()[0], HasSubstr("/dev/ttyACM7"));
  EXPECT_THAT(warnings()[0], HasSubstr((usb() / "power" / "control").string()));
  EXPECT_THAT(power_warnings(TcpAddress{}, sysfs_.string()), IsEmpty());
  EXPECT_THAT(power_warnings(SerialAddress{.path = "/dev/ttyS9"}, sysfs_.string()), IsEmpty());
  set(usb() / "power" / "autosuspend_delay_ms", "-1000");
  EXPECT_THAT(warnings(), IsEmpty());
}

TEST_F(Power, ALaptopOnItsBattery) {
  supply("BAT0", "type", "Battery");
  supply("BAT0", "status", "Discharging");
  supply("BAT0", "capacity", "57");
  supply("AC", "type", "Mains");
  supply("AC", "online", "0");
  ASSERT_THAT(warnings(), SizeIs(1));
  EXPECT_THAT(warnings()[0], HasSubstr("battery (57 %)"));
  supply("AC", "online", "1");
  EXPECT_THAT(warnings(), IsEmpty());
}

TEST_F(Power, TheBatteryOfAMouseIsNothing) {
  supply("hidpp_battery_0", "type", "Battery");
  supply("hidpp_battery_0", "scope", "Device");
  supply("hidpp_battery_0", "status", "Discharging");
  EXPECT_THAT(warnings(), IsEmpty());
}

}  // namespace
}  // namespace kerf::io
