#pragma once
// The answers to the last commands, by their keys: one that is sent again because an answer got lost has no second
// effect. Loop's thread only.

#include <cstddef>
#include <deque>
#include <map>
#include <string>

#include "daemon/machine_park.hpp"

namespace kerf::daemon {

class Answers {
 public:
  explicit Answers(MachinePark& park) : park_(park) {}

  /// Obeys the command of `request`, which has `machine`, `command`, perhaps `key`, and the members of the command.
  /// `origin` says who asks.
  [[nodiscard]] CommandAnswer obey(const std::string& machine, Json request, const std::string& origin);

 private:
  [[nodiscard]] CommandAnswer carry_out(const std::string& machine, Json request);

  MachinePark& park_;
  std::map<std::string, CommandAnswer> known_;
  std::deque<std::string> order_;
};

}  // namespace kerf::daemon
