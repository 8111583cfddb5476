#pragma once
// What the host knows about a link at the moment when it opens.

#include <string>

#include <boost/describe.hpp>

namespace kerf::machine {

struct LinkOpening {
  /// What was done to the port, for the log: "DTR and RTS raised together on … (Arduino Uno): opening restarts it".
  std::string sentence{};
  /// Opening may have restarted the controller: its bootloader wants a moment without bytes before the welcome comes.
  bool may_restart = false;
  bool operator==(const LinkOpening&) const = default;
};
BOOST_DESCRIBE_STRUCT(LinkOpening, (), (sentence, may_restart))

}  // namespace kerf::machine
