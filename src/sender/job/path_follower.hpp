#pragma once
// Whether the machine is where the program says, from its status reports.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <boost/describe.hpp>

#include "common/base/time.hpp"
#include "sender/job/executing_lines.hpp"
#include "sender/job/path_forecast.hpp"
#include "sender/job/step_loss.hpp"

namespace kerf::job {

/// What does not agree with the program.
enum class DepartureKind {
  Position,  ///< off the path
  Time,      ///< on it, but sooner than it can get there
  Feed,
  Spindle,
};
BOOST_DESCRIBE_ENUM(DepartureKind, Position, Time, Feed, Spindle)

/// The machine does something else than the program says.
struct PathDeparture {
  DepartureKind kind = DepartureKind::Position;
  /// Line of the program that it should be executing.
  std::uint32_t file_line = 0;
  /// Machine coordinates, mm: the place that was reported, and the nearest one on the path.
  std::vector<double> reported_mm{};
  std::vector<double> expected_mm{};
  double distance_mm = 0;
  /// Of the other kinds: mm/min or rpm, as reported and as programmed.
  double reported_value = 0;
  double expected_value = 0;
  bool operator==(const PathDeparture&) const = default;
};
BOOST_DESCRIBE_STRUCT(PathDeparture, (),
                      (kind, file_line, reported_mm, expected_mm, distance_mm, reported_value, expected_value))

/// For people: what differs, by how much and where.
[[nodiscard]] std::string describe(const PathDeparture& departure);

/// A status report, as far as it is about the path.
struct PathReport {
  Instant arrived{};
  /// It was made later than that; empty where nobody asked for it.
  std::optional<Instant> asked{};
  AxisValues machine_mm{};
  /// Where the controller reports work positions: then the offset that `machine_mm` was computed with may be old.
  std::optional<AxisValues> work_mm{};
  std::size_t axes = 0;
  /// The machine executes: speeds mean something.
  bool runs = false;
  std::optional<double> feed_mm_per_min{};
  std::optional<double> spindle_rpm{};
  int feed_override = 100;
  int spindle_override = 100;
  std::optional<long> line_number{};
};

/// What the follower needs besides the forecast.
struct FollowerRules {
  /// Reported positions lie this near to the path (tolerance_mm()).
  double tolerance_mm = 0;
  /// Seconds of the machine's clock in one of ours.
  double clock = 1.0;
  /// Feeds are printed in whole inches.
  bool reports_inches = false;
  /// `$31` and `$30`; 0 where unknown.
  double least_rpm = 0;
  double most_rpm = 0;
};

/// How far a reported position may lie off the path of a faultless machine: motors move in whole steps, one axis up to
/// a step behind the other, and positions and offsets are rounded to the last digit printed.
[[nodiscard]] double tolerance_mm(const PathRules& rules, bool reports_inches);

/// Follows the reports along the forecast, forwards only: each one must lie on the path, not before the earliest place
/// of the last one, and no further than a machine can get in that time (two reports that are further say so). What fits
/// is an interval, because a path may cross itself.
class PathFollower {
 public:
  /// `start_mm`: where the machine stands, machine coordinates.
  void begin(Instant now, const AxisValues& start_mm, const PathRules& path, const FollowerRules& rules);
  /// The forecast knows the place again: the machine rests there (PathForecast::stand).
  void stand(Instant now, const PathForecast& forecast);
  /// Empty when the report fits, and where the path is not known. Forgets pieces that are behind.
  [[nodiscard]] std::optional<PathDeparture> on_report(PathForecast& forecast, PathReport report);
  /// Motion that the program does not know of (a door, parking): speeds are not compared until it is back.
  void on_interlude() { strange_speeds_ = 0; }
  /// The machine goes on in mid-motion: what its firmware loses by that is no departure.
  void on_restart() { loss_.on_restart(); }
  [[nodiscard]] ExecutingLines executing(const PathForecast& forecast) const;

 private:
  struct Place {
    std::uint64_t piece = 0;
    double part = 0;
  };
  struct Fit {
    std::optional<Place> first;
    Place last;
    /// The nearest place, if none fits.
    Place nearest;
    double distance_mm = 0;
    /// The machine may have come to the end of what is known.
    bool reaches_end = false;
  };

  [[nodiscard]] Fit fit(const PathForecast& forecast, const AxisValues& told_mm, double limit_s) const;
  [[nodiscard]] double limit_s(const PathReport& report) const;
  [[nodiscard]] Fit fit_with_any_offset(const PathForecast& forecast, PathReport& report, double limit) const;
  [[nodiscard]] bool is_possible(const PathForecast& forecast, const PathReport& report) const;
  /// Since the last report it moved clearly faster than `$110`.. and the feeds of the path up to `to` allow, by our
  /// clock. Where lines were lost it moves at their speed.
  [[nodiscard]] bool is_too_fast(const PathForecast& forecast, const PathReport& report, const Place& to) const;
  /// The last piece of which the controller may tell the speed: it tells that of the motion that it has prepared, which
  /// is ahead of the position (gnea/grbl stepper.c st_get_realtime_rate).
  [[nodiscard]] std::uint64_t last_prepared(const PathForecast& forecast, int feed_override) const;
  [[nodiscard]] std::optional<PathDeparture> check_speeds(const PathForecast& forecast, const PathReport& report);
  [[nodiscard]] PathDeparture departure(const PathForecast& forecast, const PathReport& report, const Fit& best) const;
  void move_to(PathForecast& forecast, const Fit& found, const PathReport& report);
  void note(const PathReport& report);
  void learn_loss(const PathForecast& forecast, const PathReport& report);
  [[nodiscard]] AxisValues without_loss(const AxisValues& told_mm) const;
  /// Of places, with what restarts may have cost.
  [[nodiscard]] double tolerance() const;

  FollowerRules rules_;
  StepLoss loss_;
  Place first_;
  /// `first_` of the report before. A damaged report may fit further on, and then the next one does not fit: only with
  /// that one it is certain that what lies before has been executed.
  Place confirmed_;
  Place last_;
  /// Of `last_`: PathPiece::reached_s.
  double last_s_ = 0;
  bool reaches_end_ = false;
  bool is_lost_ = false;
  bool has_report_ = false;
  /// The last report was not made before this.
  Instant made_after_{};
  AxisValues reported_mm_{};
  int impossible_ = 0;
  int early_ = 0;
  int strange_speeds_ = 0;
  int feed_override_ = 100;
  int spindle_override_ = 100;
  Instant override_changed_{};
  std::optional<std::uint32_t> line_by_number_;
};

}  // namespace kerf::job
