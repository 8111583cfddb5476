#pragma once
// What is known about a machine, in words. Pure.

#include <optional>
#include <string>
#include <vector>

#include <boost/describe.hpp>

#include "sender/machine/capabilities.hpp"
#include "sender/machine/explanation.hpp"
#include "sender/machine/snapshot.hpp"
#include "sender/session/status_poller.hpp"

namespace kerf::apps {

/// Everything that `kerf status` tells.
struct MachineStatus {
  std::string firmware;
  machine::Snapshot machine;
  session::LinkHealth link;
  std::optional<machine::Explanation> alarm;
};
BOOST_DESCRIBE_STRUCT(MachineStatus, (), (firmware, machine, link, alarm))

/// A line each: a headline, then facts by name, then why it is in alarm.
[[nodiscard]] std::vector<std::string> status_lines(const MachineStatus& status);

/// State, position, feed, spindle, what is active, and how stale it is, in at most `columns`.
[[nodiscard]] std::string status_line(const MachineStatus& status, int columns);

/// "2.3 s"
[[nodiscard]] std::string age_text(double seconds);

}  // namespace kerf::apps
