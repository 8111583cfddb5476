#pragma once
// How far a job has come, from the lines that the controller has acknowledged.

#include <cstdint>
#include <optional>

#include <boost/describe.hpp>

#include "common/base/time.hpp"

namespace kerf::job {

/// Progress as shown to people. Acknowledged means "parsed and queued", so the tool is up to one planner buffer behind.
struct Progress {
  std::uint32_t lines_total = 0;
  /// File lines that need no more attention: acknowledged, or never sent because they are empty.
  std::uint32_t lines_acknowledged = 0;
  std::uint64_t bytes_total = 0;
  std::uint64_t bytes_acknowledged = 0;
  /// File line acknowledged last; 0 before the first.
  std::uint32_t file_line = 0;
  double percent = 0;
  double elapsed_s = 0;
  /// Time held, stopped at M0 or at a door, already in `elapsed_s`.
  double held_s = 0;
  /// What is left if the rest of the file takes as long a byte as the part before; empty until there is something to go
  /// by.
  std::optional<double> remaining_at_this_pace_s;
  bool operator==(const Progress&) const = default;
};
BOOST_DESCRIBE_STRUCT(Progress, (),
                      (lines_total, lines_acknowledged, bytes_total, bytes_acknowledged, file_line, percent, elapsed_s,
                       held_s, remaining_at_this_pace_s))

/// Keeps the account behind a Progress.
class ProgressMeter {
 public:
  void start(Instant now, std::uint32_t lines_total, std::uint64_t bytes_total);
  /// Everything up to and including `file_line`, which ends at `bytes`, is dealt with.
  void acknowledge(std::uint32_t file_line, std::uint64_t bytes);
  void set_held(Instant now, bool held);
  /// The whole file is dealt with.
  void complete();
  /// Progress at `now`; time stands still after `stop`.
  [[nodiscard]] Progress at(Instant now) const;
  void stop(Instant now);

 private:
  Progress progress_;
  Instant started_at_{};
  std::optional<Instant> held_since_;
  std::optional<Instant> stopped_at_;
  Duration held_{};
};

}  // namespace kerf::job
