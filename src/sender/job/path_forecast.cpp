#include "sender/job/path_forecast.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <variant>

#include "common/base/overloaded.hpp"
#include "common/base/text.hpp"
#include "common/motion/arc.hpp"

namespace kerf::job {
namespace {

/// Two readings of one place agree within the last bits of a float.
constexpr float kSamePlace = 1e-4F;
/// A machine at rest is seen where its last line leads, but for the last digit and half a step.
constexpr float kSeenAt = 0.01F;
/// Two roundings of the last digit that is printed, of inches at worst.
constexpr float kSameOffset = 0.0026F;
/// How far apart two readers are set to find out what depends on an unknown place.
constexpr float kDoubt = 1.0F;
constexpr std::size_t kZ = 2;
/// Feed override ends at 200 % (protocol.md 2).
constexpr double kMostOverride = 2.0;
/// 16-bit step timers cannot step more slowly, so very slow feeds run faster than they say (motion.md 1.2).
constexpr double kSlowestStepsPerS = 40.0;
/// Rounding of lengths and rates must not make a time too long.
constexpr double kCaution = 0.98;
/// Many turns of one line are not worth the memory.
constexpr std::size_t kMostChords = 20'000;
/// Reports with an old offset may still be on their way when its successor is answered.
constexpr std::size_t kOldWorkOffsets = 2;

/// Lines of a program that ask and change nothing.
constexpr std::string_view kQuestions[] = {"$", "$$", "$#", "$G", "$I", "$N"};

bool computes(std::string_view text) {
  bool in_comment = false;
  for (const char letter : text) {
    if (letter == ';') break;
    if (letter == '(' || letter == ')') in_comment = letter == '(';
    if (!in_comment && (letter == '#' || letter == '[')) return true;
  }
  return base::starts_with_ignoring_case(text, "O");
}

const AxisValues* end_of(const gcode::Action& action) {
  return std::visit(base::Overloaded{
                        [](const gcode::LinearMove& move) { return &move.target_mm; },
                        [](const gcode::ArcMove& move) { return &move.target_mm; },
                        [](const gcode::ProbeMove& move) { return &move.target_mm; },
                        [](const auto&) -> const AxisValues* { return nullptr; },
                    },
                    action);
}

/// Its answer comes after the motion before it has ended.
bool waits_for_motion(const gcode::Action& action) {
  return std::visit(base::Overloaded{
                        [](const gcode::Dwell&) { return true; },
                        [](const gcode::SpindleChange&) { return true; },
                        [](const gcode::SpindleSpeedChange&) { return true; },
                        [](const gcode::CoolantChange& change) { return change.waits; },
                        [](const gcode::ProgramPause& pause) { return !pause.optional; },
                        [](const gcode::ProbeMove&) { return true; },
                        [](const auto&) { return false; },
                    },
                    action);
}

AxisMask difference(const AxisValues& left, const AxisValues& right, float same = kSamePlace) {
  AxisMask mask = 0;
  for (std::size_t axis = 0; axis < left.size(); ++axis) {
    if (std::abs(left[axis] - right[axis]) > same) mask = static_cast<AxisMask>(mask | 1U << axis);
  }
  return mask;
}

}  // namespace

void PathForecast::begin(const gcode::Interpreter& reader, const AxisValues& at_mm, const PathRules& rules) {
  *this = {};
  reader_ = reader;
  lines_.emplace(reader.rules().line);
  rules_ = rules;
  at_mm_ = reader.state().position_mm;
  // Where the machine stands before the first line.
  add_pause(0);
  if (difference(at_mm, at_mm_, kSeenAt) != 0) pieces_.back().unknown_axes = std::numeric_limits<AxisMask>::max();
  note_work_offset();
}

void PathForecast::open(std::uint32_t file_line, std::string_view reason) {
  if (is_open()) return;
  open_reason_ = std::string{reason};
  open_from_line_ = file_line;
  reader_.reset();
  shadow_.reset();
}

void PathForecast::on_sent(std::uint32_t file_line, std::string_view text) {
  line_sent_ = std::max(line_sent_, file_line);
  ++lines_sent_;
  SentLine line{.file_line = file_line};
  if (reader_ && !is_open()) {
    if (const auto reason = read(line, base::trim(text))) open(file_line, *reason);
  }
  line.end = first_piece_ + pieces_.size();
  unanswered_.push_back(line);
}

void PathForecast::on_acknowledged() {
  if (unanswered_.empty()) return;
  const SentLine line = unanswered_.front();
  unanswered_.pop_front();
  line_acknowledged_ = std::max(line_acknowledged_, line.file_line);
  ++lines_answered_;
  while (work_offsets_.size() > kOldWorkOffsets && work_offsets_[kOldWorkOffsets].line <= lines_answered_) {
    work_offsets_.pop_front();
  }
  if (line.end < first_piece_) return;
  if (line.waits_for_motion) {
    surely_over_ = std::max(surely_over_, line.end);
    return;
  }
  // What was taken and does not fit into the planner and its prepared segments is over.
  const auto held = static_cast<std::uint64_t>(rules_.planner_blocks + rules_.motion.segment_slots + 1);
  if (rules_.planner_blocks == 0 || line.end == first_piece_) return;
  const std::uint64_t taken = pieces_[static_cast<std::size_t>(line.end - first_piece_ - 1)].blocks;
  if (taken <= held) return;
  std::uint64_t over = std::max(surely_over_, first_piece_);
  while (over < line.end && pieces_[static_cast<std::size_t>(over - first_piece_)].blocks <= taken - held) ++over;
  surely_over_ = over;
}

void PathForecast::forget_before(std::uint64_t piece) {
  for (; first_piece_ < piece && !pieces_.empty(); ++first_piece_) pieces_.pop_front();
}

std::optional<std::string_view> PathForecast::why_unreadable(std::string_view text) const {
  if (text.starts_with('$')) {
    const auto asks = [&](std::string_view question) { return base::iequals(text, question); };
    if (std::ranges::any_of(kQuestions, asks)) return std::nullopt;
    return "it is a command to the controller that may move the machine or change its settings";
  }
  if (computes(text)) return "it computes with parameters, of which only the controller knows the values";
  return std::nullopt;
}

std::string_view PathForecast::as_read(std::string_view text) {
  const auto line = lines_->push_line(text);
  return line ? line->text : std::string_view{};
}

std::optional<std::string_view> PathForecast::read(SentLine& line, std::string_view text) {
  if (const auto reason = why_unreadable(text)) return reason;
  text = as_read(text);
  if (text.empty() || text.starts_with('$')) return std::nullopt;
  actions_.clear();
  const auto before = knows_only_sum_ ? std::optional{reader_->offsets()} : std::nullopt;
  const std::uint8_t selected = reader_->state().modal.work_offset;
  if (!reader_->interpret(text, actions_)) return "Kerf does not understand it";
  if (before && (*before != reader_->offsets() || selected != reader_->state().modal.work_offset))
    return "it changes offsets of which Kerf knows only the sum since they were set by hand";
  if (reader_->state().modal_macro) return "it calls a macro";
  const auto length = reader_->state().modal.tool_length;
  const bool from_table = length == gcode::ToolLengthMode::FromTable || length == gcode::ToolLengthMode::Additional;
  if (from_table && reader_->settings().tools > 0)
    return "it takes a length from the tool table, which Kerf has not read";
  if (shadow_) {
    if (const auto reason = read_shadow(text)) return reason;
  }
  for (std::size_t index = 0; index < actions_.size(); ++index) {
    line.waits_for_motion = line.waits_for_motion || waits_for_motion(actions_[index]);
    if (const auto reason = add(actions_[index], index, line)) return reason;
    if (reader_->state().modal.canned_cycle) add_strokes_by_chance(index, line.file_line);
  }
  if (shadow_ && shadow_->state() == reader_->state() && shadow_->offsets() == reader_->offsets()) shadow_.reset();
  note_work_offset();
  return std::nullopt;
}

std::optional<std::string_view> PathForecast::read_shadow(std::string_view text) {
  constexpr std::string_view kDepends = "where it leads depends on a place that only the controller knows";
  shadow_actions_.clear();
  if (!shadow_->interpret(text, shadow_actions_)) return kDepends;
  const auto same_kind = [](const auto& left, const auto& right) { return left.index() == right.index(); };
  if (!std::ranges::equal(actions_, shadow_actions_, same_kind)) return kDepends;
  return std::nullopt;
}

AxisMask PathForecast::doubt_about(std::size_t index) const {
  if (!shadow_ || index >= shadow_actions_.size()) return 0;
  const AxisValues* const end = end_of(actions_[index]);
  return end == nullptr ? AxisMask{0} : difference(*end, *end_of(shadow_actions_[index]));
}

std::optional<std::string_view> PathForecast::add(const gcode::Action& action, std::size_t index, SentLine& line) {
  const AxisMask doubt = doubt_about(index);
  const auto unknown = static_cast<AxisMask>(doubtful_at_ | doubt);
  std::optional<std::string_view> reason;
  std::visit(base::Overloaded{
                 [&](const gcode::LinearMove& move) { add_line(move.target_mm, move.feed, line.file_line, unknown); },
                 [&](const gcode::ArcMove& move) { reason = add_arc(move, line.file_line, unknown); },
                 [&](const gcode::ProbeMove& move) {
                   const double before_s = reached_s_;
                   add_line(move.target_mm, move.feed, line.file_line, unknown);
                   // It may touch at once.
                   pieces_.back().least_s = 0;
                   pieces_.back().feed_mm_per_min = 0;
                   reached_s_ = before_s;
                   begin_doubt(move.start_mm);
                 },
                 [&](const gcode::ToolChange&) {
                   add_pause(line.file_line);
                   reader_->complete_tool_change();
                   if (shadow_) shadow_->complete_tool_change();
                   begin_tool_doubt();
                 },
                 [&](const gcode::Dwell&) { add_pause(line.file_line); },
                 [&](const gcode::ProgramPause&) { add_pause(line.file_line); },
                 [&](const gcode::AlarmRequest&) { reason = "it raises an alarm"; },
                 [](const auto&) {},
             },
             action);
  if (std::holds_alternative<gcode::ProbeMove>(action) || std::holds_alternative<gcode::ToolChange>(action)) {
    // What follows in the same line was read before anybody knew.
    if (index + 1 < actions_.size() && end_of(actions_[index + 1]) != nullptr) {
      return "it moves on from a place that only the controller knows";
    }
    return reason;
  }
  if (end_of(action) != nullptr) doubtful_at_ = doubt;
  return reason;
}

void PathForecast::begin_doubt(const AxisValues& from_mm) {
  reader_->sync_position(at_mm_);
  AxisValues other = from_mm;
  if (shadow_) {
    const AxisValues& before = shadow_->state().position_mm;
    for (std::size_t axis = 0; axis < other.size(); ++axis) {
      if (std::abs(before[axis] - at_mm_[axis]) > kSamePlace) other[axis] = before[axis];
    }
  } else {
    shadow_ = reader_;
  }
  shadow_->sync_position(other);
  doubtful_at_ = difference(other, at_mm_);
}

void PathForecast::begin_doubt_everywhere() {
  AxisValues elsewhere = at_mm_;
  for (float& mm : elsewhere) mm += kDoubt;
  begin_doubt(elsewhere);
}

void PathForecast::begin_tool_doubt() {
  begin_doubt_everywhere();
  shadow_->set_tool_length(kZ, reader_->offsets().tool_length[kZ] + kDoubt);
}

void PathForecast::on_tool_state() {
  if (is_open() || (shadow_ && doubtful_at_ == std::numeric_limits<AxisMask>::max())) return;
  begin_tool_doubt();
  add_pause(line_sent_);
}

void PathForecast::on_work_by_hand(std::string_view text) {
  const auto asks = [text](std::string_view question) { return base::iequals(base::trim(text), question); };
  if (std::ranges::any_of(kQuestions, asks)) return;
  open(line_sent_, "offsets or tool length may have been set by hand");
}

bool PathForecast::stand(const AxisValues& at_mm, const AxisValues& offset_mm) {
  if (!seeks_place() || is_open()) return false;
  const std::uint8_t active = reader_->state().modal.work_offset;
  gcode::Offsets& offsets = reader_->offsets();
  const gcode::Offsets& doubtful = shadow_->offsets();
  const AxisValues counted = reader_->work_coordinate_offset();
  for (std::size_t axis = 0; axis < at_mm.size(); ++axis) {
    const float more = offset_mm[axis] - counted[axis];
    if (std::abs(more) <= kSameOffset) continue;
    float* const parts[] = {&offsets.work[active][axis], &offsets.g92[axis], &offsets.tool_length[axis]};
    const float others[] = {doubtful.work[active][axis], doubtful.g92[axis], doubtful.tool_length[axis]};
    float* changed = nullptr;
    int changes = 0;
    for (std::size_t part = 0; part < std::size(parts); ++part) {
      if (*parts[part] == others[part]) continue;
      if (changed == nullptr) changed = parts[part];
      ++changes;
    }
    if (changes == 0) {
      open(line_sent_, "offsets are others than the program made them");
      return false;
    }
    *changed += more;
    knows_only_sum_ = knows_only_sum_ || changes > 1;
  }
  reader_->reload_offsets();
  AxisValues place = reader_->state().position_mm;
  for (std::size_t axis = 0; axis < at_mm.size(); ++axis) {
    if (std::abs(place[axis] - at_mm[axis]) > kSeenAt) place[axis] = at_mm[axis];
  }
  reader_->sync_position(place);
  at_mm_ = place;
  doubtful_at_ = 0;
  shadow_.reset();
  forget_before(first_piece_ + pieces_.size());
  add_pause(line_sent_);
  note_work_offset();
  return true;
}

void PathForecast::add_line(const AxisValues& end_mm, const gcode::Feed& feed, std::uint32_t file_line,
                            AxisMask unknown) {
  AxisValues way{};
  double square = 0;
  bool takes_block = false;
  for (std::size_t axis = 0; axis < way.size(); ++axis) {
    way[axis] = end_mm[axis] - at_mm_[axis];
    square += static_cast<double>(way[axis]) * static_cast<double>(way[axis]);
    takes_block = takes_block || std::abs(way[axis]) * rules_.settings.steps_per_mm[axis] >= 1.0F;
  }
  const double length_mm = std::sqrt(square);
  if (takes_block) ++blocks_;
  PathPiece piece{.start_mm = at_mm_,
                  .end_mm = end_mm,
                  .unknown_axes = unknown,
                  .file_line = file_line,
                  .line_number = feed.line_number,
                  .rapid = feed.rapid,
                  .reached_s = reached_s_,
                  .least_s = unknown == 0 ? least_time_s(way, length_mm, feed) : 0.0,
                  .blocks = blocks_};
  const bool has_feed = !feed.rapid && !feed.per_revolution && !feed.synchronized;
  if (has_feed) {
    piece.feed_mm_per_min = feed.inverse_time
                                ? static_cast<float>(length_mm * static_cast<double>(feed.rate_mm_per_min))
                                : feed.rate_mm_per_min;
  }
  const bool turns_steadily = feed.spindle != gcode::SpindleDirection::Off && !feed.laser_dynamic && has_feed &&
                              !rules_.settings.laser_mode && !reader_->state().modal.surface_speed;
  if (turns_steadily) piece.spindle_rpm = feed.spindle_rpm;
  reached_s_ += piece.least_s;
  at_mm_ = end_mm;
  pieces_.push_back(piece);
}

std::optional<std::string_view> PathForecast::add_arc(const gcode::ArcMove& move, std::uint32_t file_line,
                                                      AxisMask unknown) {
  const gcode::PlaneAxes plane = gcode::axes_of(move.plane);
  const auto in_plane = static_cast<AxisMask>(1U << plane.first | 1U << plane.second);
  if ((unknown & in_plane) != 0) return "its arc begins at a place that only the controller knows";
  motion::ArcChords chords{motion::arc_of(move, at_mm_), rules_.motion, rules_.settings};
  gcode::Feed feed = move.feed;
  // The firmware takes the product for mm/min (gnea/grbl motion_control.c).
  if (feed.inverse_time && !chords.is_one_line()) {
    feed.inverse_time = false;
    feed.rate_mm_per_min *= static_cast<float>(chords.inverse_time_factor());
  }
  std::size_t count = 0;
  while (const auto end = chords.next()) {
    if (++count > kMostChords) return "it has more turns than Kerf follows";
    add_line(*end, feed, file_line, unknown);
  }
  return std::nullopt;
}

void PathForecast::add_strokes_by_chance(std::size_t index, std::uint32_t file_line) {
  // The last moves up to this one, latest first.
  std::array<const gcode::LinearMove*, 3> moves{};
  std::size_t found = 0;
  for (std::size_t at = index + 1; at-- > 0 && found < moves.size();) {
    if (const auto* const move = std::get_if<gcode::LinearMove>(&actions_[at])) moves.at(found++) = move;
  }
  if (moves[0] == nullptr || !std::holds_alternative<gcode::LinearMove>(actions_[index])) return;
  const auto loosen = [&] {
    PathPiece& piece = pieces_.back();
    piece.least_s = 0;
    reached_s_ = piece.reached_s;
    blocks_ = piece.blocks = pieces_.size() > 1 ? pieces_[pieces_.size() - 2].blocks : 0;
  };
  if (moves[2] != nullptr && difference(moves[0]->target_mm, moves[2]->target_mm, kSeenAt) == 0) loosen();
  if (moves[2] == nullptr || moves[1]->feed.rapid) return;
  for (const auto* const move : {moves[1], moves[0]}) {
    add_line(move->target_mm, move->feed, file_line, doubtful_at_);
    loosen();
  }
}

void PathForecast::add_pause(std::uint32_t file_line) {
  pieces_.push_back({.start_mm = at_mm_,
                     .end_mm = at_mm_,
                     .unknown_axes = doubtful_at_,
                     .file_line = file_line,
                     .reached_s = reached_s_,
                     .blocks = blocks_});
}

void PathForecast::note_work_offset() {
  const AxisValues offset = reader_->work_coordinate_offset();
  if (!work_offsets_.empty() && difference(work_offsets_.back().mm, offset) == 0) return;
  work_offsets_.push_back({.line = lines_sent_, .mm = offset});
}

double PathForecast::least_time_s(const AxisValues& way_mm, double length_mm, const gcode::Feed& feed) const {
  constexpr double kMinute = 60.0;
  const motion::MotionSettings& settings = rules_.settings;
  double least_s = 0;
  double slowest_mm_per_s = 0;
  for (std::size_t axis = 0; axis < way_mm.size(); ++axis) {
    const double way = std::abs(static_cast<double>(way_mm[axis]));
    const auto rate = static_cast<double>(settings.max_rate_mm_per_min[axis]);
    if (rate > 0) least_s = std::max(least_s, way / rate * kMinute);
    const auto steps = static_cast<double>(settings.steps_per_mm[axis]);
    if (steps > 0 && way > 0) slowest_mm_per_s = std::max(slowest_mm_per_s, kSlowestStepsPerS / steps);
  }
  if (!feed.rapid && !feed.per_revolution && !feed.synchronized) {
    const auto rate = static_cast<double>(feed.rate_mm_per_min);
    const double programmed = (feed.inverse_time ? length_mm * rate : rate) / kMinute;
    // The length is the axes' common one, so a slow axis does not slow down the others.
    const double fastest =
        std::max({programmed * kMostOverride, slowest_mm_per_s * static_cast<double>(way_mm.size()), 1.0 / kMinute});
    least_s = std::max(least_s, length_mm / fastest);
  }
  return least_s * kCaution;
}

}  // namespace kerf::job
