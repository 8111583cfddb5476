#include "io/settings_archive.hpp"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kerf::io {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::SizeIs;

machine::Capabilities machine_with_rate(const std::string& rate) {
  machine::Capabilities machine;
  machine.firmware = "Grbl";
  machine.family = vocabulary::Firmware::Grbl;
  machine.settings = {{.id = "110", .value = rate, .type = 6}, {.id = "75", .value = "sesame", .type = 8}};
  return machine;
}

class SettingsArchiveTest : public ::testing::Test {
 protected:
  SettingsArchiveTest() {
    std::string pattern = (fs::temp_directory_path() / "kerf-archive-XXXXXX").string();
    base = mkdtemp(pattern.data());
  }
  ~SettingsArchiveTest() override { fs::remove_all(base); }
  SettingsArchiveTest(const SettingsArchiveTest&) = delete;
  SettingsArchiveTest& operator=(const SettingsArchiveTest&) = delete;

  fs::path base;
};

TEST_F(SettingsArchiveTest, KeepsWhatIsNew) {
  const SettingsArchive archive{(base / "m" / "settings").string()};
  EXPECT_FALSE(archive.latest());
  EXPECT_EQ(archive.store(machine_with_rate("500.000"), "first\nconnection", "monday").value(), 1);
  EXPECT_EQ(archive.store(machine_with_rate("500"), "again", "tuesday").value(), 0);
  EXPECT_EQ(archive.store(machine_with_rate("600.000"), "faster", "wednesday").value(), 2);
  const auto versions = archive.versions();
  ASSERT_THAT(versions, SizeIs(2));
  EXPECT_EQ(versions[0].reason, "first connection");
  EXPECT_EQ(versions[1].taken, "wednesday");
  EXPECT_TRUE(versions[1].machine.starts_with("Grbl"));
  EXPECT_THAT(versions[1].settings, ElementsAre(machine::SettingAssignment{"110", "600.000"}));
  EXPECT_EQ(archive.find(1)->settings[0].value, "500.000");
  EXPECT_FALSE(archive.find(7));
}

TEST_F(SettingsArchiveTest, ADamagedVersionIsPassedOver) {
  const SettingsArchive archive{base.string()};
  EXPECT_EQ(archive.store(machine_with_rate("500.000"), "first", "now").value(), 1);
  std::ofstream(base / "0002.settings") << "; taken: later\n$110=6";
  std::ofstream(base / "0003.settings") << "\x01\x02 no settings";
  std::ofstream(base / "notes.txt") << "hello";
  EXPECT_EQ(archive.latest()->number, 2);
  EXPECT_EQ(archive.store(machine_with_rate("700.000"), "next", "now").value(), 4);
}

TEST_F(SettingsArchiveTest, WithoutAPlaceNothingIsKept) {
  const SettingsArchive archive{{}};
  EXPECT_EQ(archive.store(machine_with_rate("500.000"), "first", "now").value(), 0);
  EXPECT_THAT(archive.versions(), SizeIs(0));
}

TEST(MachineIdentity, SaysWhichMachineItIs) {
  machine::Capabilities machine = machine_with_rate("1");
  EXPECT_EQ(machine_identity(TcpAddress{.host = "mill.local", .port = 23}, machine), "tcp-mill.local-23-grbl");
  EXPECT_EQ(machine_identity(PtyAddress{.path = "/tmp/kerf-grbl"}, machine), "pty--tmp-kerf-grbl-grbl");
  EXPECT_EQ(machine_identity(VirtualAddress{}, machine), "");
  machine.build_rows = {{.key = "WIFI MAC", .value = "AA:BB:CC:00:11:22"}};
  EXPECT_EQ(machine_identity(TcpAddress{.host = "mill.local", .port = 23}, machine), "mac-AA-BB-CC-00-11-22-grbl");
}

}  // namespace
}  // namespace kerf::io
