#pragma once
// Whether Kerf sees that a machine leaves the path of its program, and keeps silent while it does not: jobs made up by
// chance, with a clean wire and with a byte of them damaged.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/base/time.hpp"
#include "common/vocabulary/firmware.hpp"

namespace kerf::simulation {

/// A job on a clean wire, with holds, overrides, doors and pauses at random instants.
struct CleanRun {
  double hours = 0;
  /// Job lines, and status reports while the job ran.
  std::size_t lines = 0;
  std::size_t reports = 0;
  /// What Kerf said about a departure: a false alarm.
  std::optional<std::string> false_alarm;
  /// Where it did not watch, and why.
  std::optional<std::string> gap;
  /// The job did not come to its end.
  std::optional<std::string> unfinished;
  std::string program;
  /// What was said on the wire, where it was to be kept.
  std::string conversation;
};

[[nodiscard]] CleanRun clean_run(vocabulary::Firmware firmware, std::uint64_t seed, bool keeps_conversation = false);

enum class DamagedRunEnd : std::uint8_t {
  NoDeparture,  ///< the machine kept to the path all the same
  Refused,      ///< the controller refused a line, raised an alarm or stopped answering before the machine was off
  Held,         ///< Kerf held the machine, and said why
  Untold,       ///< it left the path and was back before a report was made
  Missed,       ///< the machine was off its path, and Kerf did not notice in time
};

/// A job of which one byte is lost, doubled or changed.
struct DamagedRun {
  DamagedRunEnd end = DamagedRunEnd::NoDeparture;
  /// The damage, as the machine's log tells it.
  std::string damage;
  /// From the instant at which the machine was more than 0.05 mm off the path to the hold.
  Duration noticed_after{};
  /// Status reports made in between, the one that showed it included.
  int reports = 0;
  std::string said;
  std::string program;
  std::string conversation;
};

[[nodiscard]] DamagedRun damaged_run(vocabulary::Firmware firmware, std::uint64_t seed,
                                     bool keeps_conversation = false);

}  // namespace kerf::simulation
