#pragma once
// How far a job has come, from the lines that the controller has acknowledged and, where there was one, the rehearsal.

#include <cstdint>
#include <memory>
#include <optional>

#include <boost/describe.hpp>

#include "common/base/time.hpp"
#include "sender/job/executing_lines.hpp"
#include "sender/job/timeline.hpp"

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
  /// File line that the tool is cutting, as far as the rehearsal can tell; empty without one.
  std::optional<std::uint32_t> cutting_line;
  /// Lines that the machine may really be executing, from what it reports.
  ExecutingLines executing{};
  /// Of the rehearsed time, else of the file's bytes.
  double percent = 0;
  double elapsed_s = 0;
  /// Time held, stopped at M0 or at a door, already in `elapsed_s`.
  double held_s = 0;
  /// What is left of the rehearsed time at the present overrides, and at the pace that the job has kept so far. Without
  /// a rehearsal: what is left if the rest of the file takes as long a byte as the part before. Empty until there is
  /// something to go by.
  std::optional<double> remaining_s;

  /// The line to show to people: the one being cut if that is known, else the one taken last.
  [[nodiscard]] std::uint32_t shown_line() const { return cutting_line.value_or(file_line); }
  bool operator==(const Progress&) const = default;
};
BOOST_DESCRIBE_STRUCT(Progress, (),
                      (lines_total, lines_acknowledged, bytes_total, bytes_acknowledged, file_line, cutting_line,
                       executing, percent, elapsed_s, held_s, remaining_s))

/// Keeps the account behind a Progress.
class ProgressMeter {
 public:
  /// `timeline` may be null.
  void start(Instant now, std::uint32_t lines_total, std::uint64_t bytes_total,
             std::shared_ptr<const Timeline> timeline = nullptr);
  /// Everything up to and including `file_line`, which ends at `bytes`, is dealt with.
  void acknowledge(std::uint32_t file_line, std::uint64_t bytes);
  void set_held(Instant now, bool held);
  /// The overrides of feed and rapids, which the rehearsal did not know. Percent; nothing changes unless both are
  /// above 0.
  void set_overrides(Instant now, int feed_percent, int rapid_percent);
  void set_executing(const ExecutingLines& lines) { progress_.executing = lines; }
  /// The whole file is dealt with.
  void complete();
  /// Progress at `now`; time stands still after `stop`.
  [[nodiscard]] Progress at(Instant now) const;
  void stop(Instant now);

 private:
  /// Rehearsed seconds that should have passed since `counted_at_`.
  [[nodiscard]] double due_s_since_count(Instant at) const;
  [[nodiscard]] double machining_s_at(Instant at) const;
  [[nodiscard]] double pace_at(Instant at) const;
  void count_until(Instant now);
  void estimate(Progress& progress, Instant at) const;

  Progress progress_;
  std::shared_ptr<const Timeline> timeline_;
  bool is_complete_ = false;
  double override_factor_ = 1.0;
  /// Rehearsed seconds that had passed at `counted_at_`.
  double machining_s_ = 0;
  /// Rehearsed seconds that should have passed by then, had the machine kept to the rehearsal.
  double due_s_ = 0;
  Instant counted_at_{};
  Instant started_at_{};
  std::optional<Instant> held_since_;
  std::optional<Instant> stopped_at_;
  Duration held_{};
};

}  // namespace kerf::job
