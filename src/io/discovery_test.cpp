#include "io/discovery.hpp"

#include <gtest/gtest.h>

namespace kerf::io {
namespace {

using Machines = std::vector<std::pair<std::string, std::string>>;

Machines found_among(const std::vector<Announcement>& announcements) {
  Machines found;
  for (const NetworkMachine& machine : machines_among(announcements)) found.emplace_back(machine.url, machine.firmware);
  return found;
}

TEST(Discovery, AGrblHalByTelnetAndWebSocket) {
  const std::vector<std::string> texts{"model=grblHAL", "version=1.1f"};
  EXPECT_EQ(found_among({{"_http._tcp", "Grbl", "router.local", "192.168.5.1", 80, texts},
                         {"_websocket._tcp", "Grbl", "router.local", "192.168.5.1", 81, texts},
                         {"_telnet._tcp", "Grbl", "router.local", "192.168.5.1", 23, texts},
                         {"_telnet._tcp", "Grbl", "router.local", "192.168.5.1", 23, texts}}),
            (Machines{{"tcp://192.168.5.1:23", "grblHAL"}, {"ws://192.168.5.1:81/", "grblHAL"}}));
}

TEST(Discovery, AFluidNcThatAnnouncesOnlyItsPage) {
  EXPECT_EQ(found_among({{"_http._tcp", "fluidnc", "fluidnc.local", "10.0.0.7", 80, {}}}),
            (Machines{{"ws://10.0.0.7:81/", "FluidNC"}}));
}

TEST(Discovery, APrintersPageIsNoMachine) {
  EXPECT_EQ(found_among({{"_http._tcp", "LaserJet", "printer.local", "10.0.0.9", 80, {}}}), Machines{});
}

TEST(Discovery, AnUnknownTelnetIsShownWithoutAName) {
  EXPECT_EQ(found_among({{"_telnet._tcp", "mill", "mill.local", "10.0.0.3", 5001, {}}}),
            (Machines{{"tcp://10.0.0.3:5001", ""}}));
}

}  // namespace
}  // namespace kerf::io
