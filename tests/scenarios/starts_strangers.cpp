// Connecting to something that is no Grbl: it is named, gets no line and no reset, and a Grbl that comes later is
// taken.

#include <chrono>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sender/machine/baud_guess.hpp"
#include "starts.hpp"

namespace kerf::scenarios {
namespace {

using namespace std::chrono_literals;
using machine::HandshakeFailure;
using machine::heard_at;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;
using vocabulary::Firmware;

/// Who is on the link, and what it says, a piece every 200 ms.
struct Stranger {
  const char* name;
  std::vector<std::string> says;
  HandshakeFailure failure{};
  const char* words;
};

std::vector<Stranger> strangers() {
  using enum HandshakeFailure;
  const std::string rom = "ets Jul 29 2019 12:21:46\r\n\r\n";
  return {
      {"Silence", {}, Silent, "Nothing answers"},
      {"AGlitchOnOpening", {"\xFF"}, Silent, "Nothing answers"},
      {"Esp32WaitsForDownload",
       {rom + "rst:0x1 (POWERON_RESET),boot:0x3 (DOWNLOAD_BOOT(UART0/UART1/SDIO_REI_REO_V2))\r\n",
        "waiting for download\r\n"},
       Bootloader,
       "waits for a firmware"},
      {"Esp32S3WaitsForDownload",
       {"ESP-ROM:esp32s3-20210327\r\nrst:0x15 (USB_UART_CHIP_RESET),boot:0x0 (DOWNLOAD(USB/UART0))\r\n"},
       Bootloader,
       "waits for a firmware"},
      {"Esp32WithoutFirmware",
       {rom + "rst:0x10 (RTCWDT_RTC_RESET),boot:0x13 (SPI_FAST_FLASH_BOOT)\r\ninvalid header: 0xffffffff\r\n"},
       Bootloader,
       "without a firmware"},
      {"Esp32StartsAgainAndAgain",
       std::vector<std::string>(12, rom + "rst:0xc (SW_CPU_RESET),boot:0x13 (SPI_FAST_FLASH_BOOT)\r\n"), Restarting,
       "power supply"},
      {"Optiboot", {"\x14\x10", "\x14\x10"}, Bootloader, "bootloader of an Arduino"},
      {"Marlin",
       {"start\r\necho:Marlin 2.1.2.1\r\n", "echo: Last Updated: 2023-05-16\r\necho:SD init fail\r\n"},
       NotGrbl,
       "Marlin"},
      {"MarlinsRelative", {"start\r\necho: External Reset\r\n"}, NotGrbl, "3D printers"},
      {"Smoothie", {"Smoothie\r\nok\r\n"}, NotGrbl, "Smoothieware"},
      {"SmoothieThatWasUp",
       {"<Idle,MPos:0.0000,0.0000,0.0000,WPos:0.0000,0.0000,0.0000>\r\n"},
       NotGrbl,
       "older language"},
      {"Grbl09", {"\r\nGrbl 0.9j ['$' for help]\r\n"}, NotGrbl, "older language"},
      {"TinyG", {"{\"r\":{\"fv\":0.970,\"fb\":440.20},\"f\":[1,0,0,8]}\r\n"}, NotGrbl, "TinyG"},
      {"Modem", {"\r\nNO CARRIER\r\n"}, NotGrbl, "a modem"},
      {"SatelliteReceiver",
       {"$GPGGA,123519,4807.038,N,01131.000,E,1,08,0.9,545.4,M,46.9,M,,*47\r\n"},
       NotGrbl,
       "satellite"},
      {"Computer", {"\r\nDebian GNU/Linux 12 pi ttyAMA0\r\n\r\npi login: "}, NotGrbl, "console of a computer"},
      {"Scales", {"  12.04 kg\r\n", "  12.05 kg\r\n"}, NotGrbl, "no Grbl controller; it sent \"  12.04 kg"},
  };
}

class Strangers : public testing::TestWithParam<Stranger> {};
INSTANTIATE_TEST_SUITE_P(Everybody, Strangers, testing::ValuesIn(strangers()),
                         [](const auto& param) { return std::string{param.param.name}; });

/// A wire on which nobody of Grbl's family is: the virtual controller is switched off.
WorldOptions empty_wire() {
  return quick_serial(Firmware::Grbl);
}

TEST_P(Strangers, IsNamedAndLeftAlone) {
  World world{empty_wire()};
  ASSERT_TRUE(world.order("power off"));
  world.open();
  for (const std::string& piece : GetParam().says) {
    world.inject_to_session(piece);
    world.run_for(200ms);
  }
  ASSERT_TRUE(world.run_until(has_failed, 1min));
  const auto failed = told<session::HandshakeFailed>(world);
  ASSERT_THAT(failed, SizeIs(1));
  EXPECT_EQ(failed[0].failure, GetParam().failure) << failed[0].sentence;
  EXPECT_THAT(failed[0].sentence, HasSubstr(GetParam().words));
  EXPECT_TRUE(failed[0].sentence.ends_with('.'));
  EXPECT_THAT(told<session::LineSent>(world), IsEmpty());
  EXPECT_EQ(resets_sent(world), 0U);
}

TEST_P(Strangers, GivesWayToTheGrblThatIsPluggedInInstead) {
  World world{empty_wire()};
  ASSERT_TRUE(world.order("power off"));
  world.open();
  for (const std::string& piece : GetParam().says) world.inject_to_session(piece);
  world.run_for(20s);
  world.cut_link();
  ASSERT_TRUE(world.order("power on"));
  world.open();
  EXPECT_TRUE(world.run_until(is_ready, 1min));
}

TEST(OnTheWire, BootTextOfAnEsp32BeforeTheWelcomeIsNoStranger) {
  auto options = quick_serial(Firmware::Rabbit);
  World world{options};
  ASSERT_TRUE(world.order("power off"));
  world.open();
  world.inject_to_session(
      "ets Jul 29 2019 12:21:46\r\n\r\nrst:0x1 (POWERON_RESET),boot:0x13 (SPI_FAST_FLASH_BOOT)\r\n"
      "configsip: 0, SPIWP:0xee\r\nmode:DIO, clock div:1\r\nload:0x3fff0030,len:1344\r\nentry 0x400806b4\r\n");
  world.run_for(1500ms);
  ASSERT_TRUE(world.order("power on"));
  ASSERT_TRUE(world.run_until(is_ready, 1min));
  EXPECT_EQ(resets_sent(world), 0U);
}

TEST(OnTheWire, AnEchoIsRecognised) {
  World world{empty_wire()};
  ASSERT_TRUE(world.order("power off"));
  world.open();
  std::size_t echoed = 0;
  for (int tick = 0; tick < 100; ++tick) {
    world.run_for(50ms);
    std::string sent;
    for (const auto& entry : world.transcript()) {
      if (entry.direction == Direction::ToController) sent += entry.bytes;
    }
    world.inject_to_session(sent.substr(echoed));
    echoed = sent.size();
  }
  ASSERT_THAT(told<session::HandshakeFailed>(world), SizeIs(1));
  EXPECT_THAT(outcome(world), HasSubstr("only sends back"));
  EXPECT_THAT(told<session::LineSent>(world), IsEmpty());
}

TEST(OnTheWire, NoiseAtTheWrongRateComesWithTheLikelyOne) {
  for (const int sent : {9600, 38400, 57600, 230400}) {
    World world{empty_wire()};
    ASSERT_TRUE(world.order("power off"));
    world.open();
    world.inject_to_session(heard_at("\r\nGrbl 1.1h ['$' for help]\r\n", sent, 115200, machine::BadFrames::Kept));
    world.run_for(10s);
    EXPECT_EQ(told<session::HandshakeFailed>(world)[0].failure, HandshakeFailure::Noise);
    EXPECT_THAT(outcome(world), HasSubstr("looks like " + std::to_string(sent) + " baud"));
    EXPECT_EQ(resets_sent(world), 0U);
  }
}

TEST(OnTheWire, PlainNoiseIsCalledNoise) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    std::mt19937 random{seed};
    World world{empty_wire()};
    ASSERT_TRUE(world.order("power off"));
    world.open();
    for (int piece = 0; piece < 10; ++piece) {
      std::string noise;
      for (auto count = random() % 40; count > 0; --count) noise += static_cast<char>(random() % 256);
      world.inject_to_session(noise);
      world.run_for(200ms);
    }
    world.run_for(20s);
    EXPECT_EQ(told<session::HandshakeFailed>(world)[0].failure, HandshakeFailure::Noise) << outcome(world);
    EXPECT_THAT(told<session::LineSent>(world), IsEmpty());
  }
}

TEST(OnTheWire, AGrblThatRestartsAgainAndAgainIsGivenUp) {
  auto options = empty_wire();
  World world{options};
  world.open();
  for (int times = 0; times < 12 && !has_failed(world); ++times) {
    ASSERT_TRUE(world.order("reboot"));
    world.run_for(250ms);
  }
  EXPECT_EQ(told<session::HandshakeFailed>(world)[0].failure, HandshakeFailure::Restarting);
}

TEST(OnTheWire, AGrblThatFallsSilentIsNotCalledAStranger) {
  World world{empty_wire()};
  world.open();
  world.run_for(600ms);
  ASSERT_TRUE(world.run_until([](const auto& w) { return w.session().snapshot().reports > 0; }, 10s));
  ASSERT_TRUE(world.order("link silent"));
  ASSERT_TRUE(world.run_until(has_failed, 1min));
  EXPECT_THAT(outcome(world), HasSubstr("fallen silent"));
}

}  // namespace
}  // namespace kerf::scenarios
