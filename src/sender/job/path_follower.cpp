#include "sender/job/path_follower.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <string_view>

#include "common/base/text.hpp"

namespace kerf::job {
namespace {

using namespace std::chrono_literals;

constexpr double kUnlimited = std::numeric_limits<double>::infinity();
/// Offsets, start and position are each printed with three decimals of mm or four of inches, and computed in 32 bits.
constexpr double kLastDigitMm = 0.001;
constexpr double kLastDigitInchMm = 0.00254;
constexpr double kRoundings = 2.5;
constexpr double kFloatMm = 0.002;
/// Where the steps are not known.
constexpr double kUsualTolerance = 0.02;
/// A report is made, and its question read, between two passes of the controller's main loop.
constexpr Duration kSlack = 50ms;
/// A report that no machine could follow is a damaged one: the next one decides.
constexpr int kImpossibleAtMost = 1;
constexpr double kJumpSlackMm = 1.0;
/// Speeds are told when the report is made, overrides now and then.
constexpr int kStrangeSpeeds = 3;
constexpr Duration kOverrideSettles = 2s;
/// What a segment of prepared motion takes on every firmware (motion.md 1.3).
constexpr Duration kSegmentTime = 10ms;
constexpr double kFeedTolerance = 1.05;
constexpr double kFeedSlack = 10.0;
constexpr double kHalfInchMm = 12.7;
constexpr double kRpmTolerance = 0.02;
constexpr double kRpmSlack = 2.0;
constexpr double kPercent = 100.0;
/// Departures of 0.05 mm are always seen where a step is smaller.
constexpr double kWidest = 0.045;
/// Where a report fits more pieces it says too little about where the machine is.
constexpr std::uint64_t kMostCandidates = 8;
/// Beyond that, what the answers prove to be over is let go: 4 MB.
constexpr std::size_t kMostPieces = 50'000;

bool is_unknown(const PathPiece& piece, std::size_t axis) {
  return (piece.unknown_axes >> axis & 1U) != 0;
}

bool is_nowhere(const PathPiece& piece, std::size_t axes) {
  const auto all = (1U << axes) - 1;
  return (piece.unknown_axes & all) == all;
}

/// The part of a piece that lies within a distance of a place, and its nearest point.
struct Overlap {
  double from = 1;
  double to = 0;
  double nearest = 0;
  double distance_mm = 0;
  [[nodiscard]] bool is_empty() const { return from > to; }
};

Overlap overlap(const PathPiece& piece, const AxisValues& at_mm, std::size_t axes, double within_mm) {
  double way_way = 0;
  double way_off = 0;
  double off_off = 0;
  for (std::size_t axis = 0; axis < axes; ++axis) {
    if (is_unknown(piece, axis)) continue;
    const auto start = static_cast<double>(piece.start_mm[axis]);
    const double way = static_cast<double>(piece.end_mm[axis]) - start;
    const double off = static_cast<double>(at_mm[axis]) - start;
    way_way += way * way;
    way_off += way * off;
    off_off += off * off;
  }
  Overlap result;
  if (way_way > 0) result.nearest = std::clamp(way_off / way_way, 0.0, 1.0);
  const double t = result.nearest;
  result.distance_mm = std::sqrt(std::max(0.0, off_off - 2 * t * way_off + t * t * way_way));
  if (result.distance_mm > within_mm) return result;
  if (way_way == 0) {
    result.from = 0;
    result.to = 1;
    return result;
  }
  const double middle = way_off / way_way;
  const double square = middle * middle - (off_off - within_mm * within_mm) / way_way;
  const double half = std::sqrt(std::max(0.0, square));
  result.from = std::clamp(middle - half, 0.0, 1.0);
  result.to = std::clamp(middle + half, 0.0, 1.0);
  return result;
}

std::string position_text(const std::vector<double>& mm) {
  constexpr int kDecimals = 3;
  std::string text;
  for (std::size_t axis = 0; axis < mm.size(); ++axis) {
    if (axis > 0) text += ' ';
    text += vocabulary::kAxisLetters[axis];
    base::append_fixed(text, mm[axis], kDecimals);
  }
  return text;
}

std::vector<double> vector_of(const AxisValues& values, std::size_t axes) {
  std::vector<double> result;
  for (std::size_t axis = 0; axis < axes; ++axis) result.push_back(static_cast<double>(values.at(axis)));
  return result;
}

}  // namespace

std::string describe(const PathDeparture& departure) {
  const std::string line = "line " + std::to_string(departure.file_line);
  switch (departure.kind) {
    case DepartureKind::Feed:
      return "The machine moves at " + base::to_fixed(departure.reported_value, 0) + " mm/min where " + line +
             " allows " + base::to_fixed(departure.expected_value, 0) + " mm/min";
    case DepartureKind::Spindle:
      return "The spindle is set to " + base::to_fixed(departure.reported_value, 0) + " rpm where " + line + " wants " +
             base::to_fixed(departure.expected_value, 0) + " rpm";
    case DepartureKind::Time:
      return "The machine is at " + position_text(departure.reported_mm) +
             " (machine coordinates) sooner than it can get there by the program, which is at " + line +
             ": a line may have been lost";
    case DepartureKind::Position: break;
  }
  return "The machine is " + base::to_fixed(departure.distance_mm, 3) + " mm off the path at " + line +
         " of the program: it reports " + position_text(departure.reported_mm) +
         " (machine coordinates), and the nearest point of the path is " + position_text(departure.expected_mm);
}

double tolerance_mm(const PathRules& rules, bool reports_inches) {
  double square = 0;
  for (int axis = 0; axis < rules.settings.axes; ++axis) {
    const auto steps = static_cast<double>(rules.settings.steps_per_mm.at(static_cast<std::size_t>(axis)));
    if (steps <= 0) return kUsualTolerance;
    square += 1 / (steps * steps);
  }
  return std::sqrt(square) + kRoundings * (reports_inches ? kLastDigitInchMm : kLastDigitMm) + kFloatMm;
}

void PathFollower::begin(Instant now, const AxisValues& start_mm, const PathRules& path, const FollowerRules& rules) {
  const StepLoss before = loss_;
  *this = {};
  rules_ = rules;
  loss_ = before;
  loss_.round_by(kRoundings * (rules.reports_inches ? kLastDigitInchMm : kLastDigitMm) + kFloatMm);
  loss_.begin(path);
  reported_mm_ = start_mm;
  made_after_ = now;
  override_changed_ = now;
}

void PathFollower::stand(Instant now, const PathForecast& forecast) {
  const PathPiece& rest = forecast.pieces().front();
  first_ = last_ = confirmed_ = {.piece = forecast.first_piece(), .part = 0};
  last_s_ = rest.reached_s;
  reaches_end_ = is_lost_ = false;
  impossible_ = early_ = strange_speeds_ = 0;
  line_by_number_.reset();
  reported_mm_ = rest.start_mm;
  made_after_ = now;
  // Moving by itself a controller counts steps anew, or goes on with what it has lost.
  loss_.begin(forecast.rules());
}

double PathFollower::limit_s(const PathReport& report) const {
  if (!report.asked || rules_.clock == kUnlimited) return kUnlimited;
  return last_s_ + base::to_seconds(report.arrived - made_after_ + kSlack) * rules_.clock;
}

PathFollower::Fit PathFollower::fit(const PathForecast& forecast, const AxisValues& told_mm, double limit) const {
  const AxisValues at_mm = without_loss(told_mm);
  const double within_mm = tolerance();
  const auto axes = static_cast<std::size_t>(forecast.rules().settings.axes);
  const auto& pieces = forecast.pieces();
  Fit found;
  found.distance_mm = kUnlimited;
  std::uint64_t number = std::max(first_.piece, forecast.first_piece());
  // Where nothing is known every place fits: answers tell when that is over.
  while (number < forecast.surely_over() && number + 1 < forecast.first_piece() + pieces.size() &&
         is_nowhere(pieces[static_cast<std::size_t>(number - forecast.first_piece())], axes)) {
    ++number;
  }
  for (; number < forecast.first_piece() + pieces.size(); ++number) {
    const PathPiece& piece = pieces[static_cast<std::size_t>(number - forecast.first_piece())];
    if (piece.reached_s > limit) return found;
    Overlap part = overlap(piece, at_mm, axes, within_mm);
    if (part.distance_mm < found.distance_mm) {
      found.distance_mm = part.distance_mm;
      found.nearest = {.piece = number, .part = part.nearest};
    }
    if (part.is_empty()) continue;
    if (number == first_.piece) part.from = std::max(part.from, first_.part);
    if (piece.least_s > 0) part.to = std::min(part.to, (limit - piece.reached_s) / piece.least_s);
    if (part.is_empty()) continue;
    if (!found.first) found.first = Place{.piece = number, .part = part.from};
    found.last = {.piece = number, .part = part.to};
  }
  found.reaches_end = pieces.empty() || pieces.back().reached_s + pieces.back().least_s <= limit;
  return found;
}

std::optional<PathDeparture> PathFollower::on_report(PathForecast& forecast, PathReport report) {
  Fit found = fit_with_any_offset(forecast, report, limit_s(report));
  if (!found.first && forecast.is_open() && (found.reaches_end || is_lost_)) {
    is_lost_ = true;
    note(report);
    return std::nullopt;
  }
  bool is_early = false;
  if (!found.first) {
    const Fit later = fit_with_any_offset(forecast, report, kUnlimited);
    is_early = later.first.has_value();
    // No machine with this program is that fast: a simulator, whose clock is not ours.
    if (is_early && is_too_fast(forecast, report, *later.first)) rules_.clock = kUnlimited;
    if (is_early && rules_.clock != kUnlimited && ++early_ == 1) {
      return std::nullopt;  // the next report says whether that was a doubtful time
    }
    if (rules_.clock == kUnlimited) found = later;
  }
  if (found.first) {
    impossible_ = early_ = 0;
    move_to(forecast, found, report);
    learn_loss(forecast, report);
    if (forecast.is_open() && reaches_end_) return std::nullopt;
    return check_speeds(forecast, report);
  }
  if (!is_possible(forecast, report) && ++impossible_ <= kImpossibleAtMost) return std::nullopt;
  PathDeparture result = departure(forecast, report, found);
  if (is_early) result.kind = DepartureKind::Time;
  return result;
}

void PathFollower::move_to(PathForecast& forecast, const Fit& found, const PathReport& report) {
  confirmed_ = first_;
  first_ = *found.first;
  last_ = found.last;
  // A path that covers itself again and again fits at its beginning for ever.
  const std::uint64_t over = std::min(forecast.surely_over(), last_.piece);
  if (forecast.pieces().size() > kMostPieces && over > first_.piece) first_ = {.piece = over, .part = 0};
  reaches_end_ = found.reaches_end;
  is_lost_ = false;
  forecast.forget_before(confirmed_.piece);
  const auto& pieces = forecast.pieces();
  const PathPiece& piece = pieces[static_cast<std::size_t>(last_.piece - forecast.first_piece())];
  last_s_ = piece.reached_s + last_.part * piece.least_s;
  line_by_number_.reset();
  for (std::uint64_t number = first_.piece; report.runs && report.line_number && number <= last_.piece; ++number) {
    const PathPiece& candidate = pieces[static_cast<std::size_t>(number - forecast.first_piece())];
    if (candidate.line_number == *report.line_number) line_by_number_ = candidate.file_line;
  }
  note(report);
  has_report_ = true;
}

void PathFollower::note(const PathReport& report) {
  if (report.asked) made_after_ = std::max(made_after_, *report.asked);
  reported_mm_ = report.machine_mm;
}

PathFollower::Fit PathFollower::fit_with_any_offset(const PathForecast& forecast, PathReport& report,
                                                    double limit) const {
  const AxisValues told = report.machine_mm;
  Fit result = fit(forecast, told, limit);
  if (!report.work_mm) return result;
  const auto is_before = [](const Place& left, const Place& right) {
    return left.piece != right.piece ? left.piece < right.piece : left.part < right.part;
  };
  for (const auto& offset : forecast.work_offsets()) {
    AxisValues at = told;
    for (std::size_t axis = 0; axis < report.axes; ++axis) at[axis] = (*report.work_mm)[axis] + offset.mm[axis];
    const Fit other = fit(forecast, at, limit);
    if (!other.first) continue;
    if (!result.first) {
      result = other;
      report.machine_mm = at;
      continue;
    }
    // The report may mean either place.
    if (is_before(*other.first, *result.first)) result.first = other.first;
    if (is_before(result.last, other.last)) result.last = other.last;
  }
  return result;
}

bool PathFollower::is_possible(const PathForecast& forecast, const PathReport& report) const {
  if (!report.asked) return true;
  constexpr double kMinute = 60.0;
  const double time_s = base::to_seconds(report.arrived - made_after_ + kSlack) * rules_.clock;
  for (std::size_t axis = 0; axis < report.axes; ++axis) {
    const auto rate = static_cast<double>(forecast.rules().settings.max_rate_mm_per_min[axis]);
    if (rate <= 0) return true;
    const double way = std::abs(static_cast<double>(report.machine_mm[axis] - reported_mm_[axis]));
    if (way > rate / kMinute * time_s + kJumpSlackMm) return false;
  }
  return true;
}

bool PathFollower::is_too_fast(const PathForecast& forecast, const PathReport& report, const Place& to) const {
  constexpr double kMinute = 60.0;
  constexpr double kClearly = 1.2;
  const auto& pieces = forecast.pieces();
  double feed_mm_per_min = 0;
  bool is_rapid = false;
  for (std::uint64_t number = std::max(first_.piece, forecast.first_piece()); number <= to.piece; ++number) {
    const PathPiece& piece = pieces[static_cast<std::size_t>(number - forecast.first_piece())];
    const auto programmed = static_cast<double>(piece.feed_mm_per_min);
    feed_mm_per_min = std::max(feed_mm_per_min, programmed * report.feed_override / kPercent);
    is_rapid = is_rapid || (programmed == 0 && piece.least_s > 0);
  }
  const double time_min = base::to_seconds(report.arrived - made_after_) * rules_.clock / kMinute;
  double square = 0;
  for (std::size_t axis = 0; axis < report.axes; ++axis) {
    const auto rate = static_cast<double>(forecast.rules().settings.max_rate_mm_per_min[axis]);
    const double way = std::abs(static_cast<double>(report.machine_mm[axis] - reported_mm_[axis]));
    if (way > kClearly * rate * time_min + rules_.tolerance_mm) return true;
    square += way * way;
  }
  return !is_rapid && std::sqrt(square) > kClearly * feed_mm_per_min * time_min + rules_.tolerance_mm;
}

PathDeparture PathFollower::departure(const PathForecast& forecast, const PathReport& report, const Fit& best) const {
  const auto& pieces = forecast.pieces();
  PathDeparture result{.reported_mm = vector_of(report.machine_mm, report.axes), .distance_mm = best.distance_mm};
  if (pieces.empty()) return result;
  const std::uint64_t at =
      std::clamp(best.nearest.piece, forecast.first_piece(), forecast.first_piece() + pieces.size() - 1);
  const PathPiece& piece = pieces[static_cast<std::size_t>(at - forecast.first_piece())];
  AxisValues nearest{};
  for (std::size_t axis = 0; axis < report.axes; ++axis) {
    nearest[axis] = is_unknown(piece, axis)
                        ? report.machine_mm[axis]
                        : std::lerp(piece.start_mm[axis], piece.end_mm[axis], static_cast<float>(best.nearest.part));
  }
  result.file_line = piece.file_line;
  result.expected_mm = vector_of(nearest, report.axes);
  return result;
}

std::uint64_t PathFollower::last_prepared(const PathForecast& forecast, int feed_override) const {
  constexpr double kMinute = 60.0;
  // A segment is longer where it would hold less than a step (motion.md 1.3).
  constexpr double kStepsOfSegment = 2.0;
  const auto& pieces = forecast.pieces();
  const motion::MotionSettings& settings = forecast.rules().settings;
  double step_mm = 0;
  double fastest_mm_per_s = 0;
  for (std::size_t axis = 0; axis < static_cast<std::size_t>(settings.axes); ++axis) {
    const auto steps = static_cast<double>(settings.steps_per_mm[axis]);
    if (steps > 0) step_mm = std::max(step_mm, 1 / steps);
    fastest_mm_per_s = std::max(fastest_mm_per_s, static_cast<double>(settings.max_rate_mm_per_min[axis]) / kMinute);
  }
  double segments = forecast.rules().motion.segment_slots + 1;
  std::uint64_t number = last_.piece;
  double part = last_.part;
  for (; number + 1 < forecast.first_piece() + pieces.size(); ++number, part = 0) {
    const PathPiece& piece = pieces[static_cast<std::size_t>(number - forecast.first_piece())];
    double square = 0;
    for (std::size_t axis = 0; axis < piece.start_mm.size(); ++axis) {
      const auto way = static_cast<double>(piece.end_mm[axis] - piece.start_mm[axis]);
      square += way * way;
    }
    const double feed_mm_per_s = static_cast<double>(piece.feed_mm_per_min) / kMinute * feed_override / kPercent;
    const double speed_mm_per_s = feed_mm_per_s > 0 ? feed_mm_per_s : fastest_mm_per_s;
    const double segment_mm =
        std::max(speed_mm_per_s * base::to_seconds(kSegmentTime), kStepsOfSegment * std::max(step_mm, kLastDigitMm));
    segments -= std::sqrt(square) * (1 - part) / segment_mm;
    if (segments < 0) break;
  }
  return number;
}

std::optional<PathDeparture> PathFollower::check_speeds(const PathForecast& forecast, const PathReport& report) {
  if (report.feed_override != feed_override_ || report.spindle_override != spindle_override_) {
    feed_override_ = report.feed_override;
    spindle_override_ = report.spindle_override;
    override_changed_ = report.arrived;
  }
  const bool is_settled = report.arrived - override_changed_ >= kOverrideSettles;
  if (!report.runs || !is_settled) {
    strange_speeds_ = 0;
    return std::nullopt;
  }
  const auto piece_at = [&forecast](std::uint64_t number) -> const PathPiece& {
    return forecast.pieces()[static_cast<std::size_t>(number - forecast.first_piece())];
  };
  PathDeparture strange{.file_line = piece_at(first_.piece).file_line};
  double most_feed = 0;
  bool spindle_fits = !report.spindle_rpm;
  const std::uint64_t prepared = last_prepared(forecast, report.feed_override);
  for (std::uint64_t number = first_.piece; number <= prepared; ++number) {
    const PathPiece& piece = piece_at(number);
    const bool has_feed = piece.feed_mm_per_min > 0;
    most_feed = std::max(most_feed, has_feed ? static_cast<double>(piece.feed_mm_per_min) : kUnlimited);
    if (!piece.spindle_rpm || !report.spindle_rpm || spindle_fits) {
      spindle_fits = true;
      continue;
    }
    double rpm = static_cast<double>(*piece.spindle_rpm) * report.spindle_override / kPercent;
    if (rules_.most_rpm > 0) rpm = std::clamp(rpm, std::min(rules_.least_rpm, rules_.most_rpm), rules_.most_rpm);
    spindle_fits = std::abs(rpm - *report.spindle_rpm) <= rpm * kRpmTolerance + kRpmSlack;
    strange.expected_value = rpm;
  }
  const double allowed = most_feed * report.feed_override / kPercent;
  const double slack = kFeedSlack + (rules_.reports_inches ? kHalfInchMm : 0);
  const bool feed_fits = !report.feed_mm_per_min || *report.feed_mm_per_min <= allowed * kFeedTolerance + slack;
  if (feed_fits && spindle_fits) {
    strange_speeds_ = 0;
    return std::nullopt;
  }
  if (++strange_speeds_ < kStrangeSpeeds) return std::nullopt;
  strange.kind = feed_fits ? DepartureKind::Spindle : DepartureKind::Feed;
  strange.reported_value = feed_fits ? *report.spindle_rpm : *report.feed_mm_per_min;
  if (!feed_fits) strange.expected_value = allowed;
  strange.reported_mm = vector_of(report.machine_mm, report.axes);
  strange.expected_mm = strange.reported_mm;
  return strange;
}

double PathFollower::tolerance() const {
  return std::max(rules_.tolerance_mm, std::min(rules_.tolerance_mm + loss_.reach_mm(), kWidest));
}

void PathFollower::learn_loss(const PathForecast& forecast, const PathReport& report) {
  // A report that means one of two places says nothing.
  if (report.work_mm && forecast.work_offsets().size() > 1) return;
  if (last_.piece - first_.piece > kMostCandidates) return;
  const auto axes = static_cast<std::size_t>(forecast.rules().settings.axes);
  std::vector<PathPiece> candidates;
  for (std::uint64_t number = first_.piece; number <= last_.piece; ++number) {
    const PathPiece& piece = forecast.pieces()[static_cast<std::size_t>(number - forecast.first_piece())];
    if (piece.unknown_axes != 0) return;
    if (!overlap(piece, without_loss(report.machine_mm), axes, tolerance()).is_empty()) candidates.push_back(piece);
  }
  loss_.narrow(candidates, report.machine_mm);
}

AxisValues PathFollower::without_loss(const AxisValues& told_mm) const {
  AxisValues at = told_mm;
  for (std::size_t axis = 0; axis < at.size(); ++axis) at[axis] -= loss_.middle_mm()[axis];
  return at;
}

ExecutingLines PathFollower::executing(const PathForecast& forecast) const {
  const auto& pieces = forecast.pieces();
  if (pieces.empty()) return {};
  const std::uint64_t end = forecast.first_piece() + pieces.size();
  const auto at = [&](std::uint64_t number) -> const PathPiece& {
    return pieces[static_cast<std::size_t>(number - forecast.first_piece())];
  };
  ExecutingLines lines{.from = 1, .to = forecast.line_sent(), .known_by = ExecutingKnownBy::PlannerBlocks};
  const std::uint64_t first = std::max({confirmed_.piece, forecast.surely_over(), forecast.first_piece()});
  lines.from = std::max(1U, first < end ? at(first).file_line : forecast.line_acknowledged());
  const bool is_known = has_report_ && !is_lost_ && !(forecast.is_open() && reaches_end_);
  if (is_known) {
    lines.known_by = ExecutingKnownBy::Position;
    const std::uint64_t next = last_.piece + 1;
    if (last_.part < 1 && at(last_.piece).file_line > 0) {
      lines.to = at(last_.piece).file_line;
    } else if (next < end) {
      // Lines without motion before the next motion may have begun.
      lines.to = std::max(at(last_.piece).file_line, at(next).file_line - 1);
    }
    if (line_by_number_ && *line_by_number_ >= lines.from) {
      lines.to = std::min(lines.to, *line_by_number_);
      lines.known_by = ExecutingKnownBy::LineNumber;
    }
  }
  lines.to = std::max(lines.to, lines.from);
  return lines;
}

}  // namespace kerf::job
