#include "firmware/block_steps.hpp"

#include <algorithm>

#include "common/base/text.hpp"

namespace kerf::firmware {

namespace {

/// grblHAL reports which axes are scaled when that changes.
void note_scaling(Board& board) {
  const AxisValues& factors = board.interpreter.state().scale_factor;
  if (factors == board.last_scale_factors) return;
  board.last_scale_factors = factors;
  board.report.scaling = true;
}

bool is_motion(const gcode::Action& action) {
  return std::holds_alternative<gcode::LinearMove>(action) || std::holds_alternative<gcode::ArcMove>(action);
}

/// False for lines that the interpreter leaves before it looks at program flow: comments only, `%`, deleted blocks.
bool has_words(const Board& board, std::string_view block) {
  const std::string text = normalised_block(block);
  if (text.empty() || text == "%") return false;
  return !(text.front() == '/' && (text.size() == 1 || board.switches.block_delete));
}

/// Manual tool changes raise the tool first, and touch-off modes want more axes homed (grblHAL tool_change.c).
bool tool_change_needs_homing(const Board& board) {
  constexpr AxisMask kXyz = 0b111;
  const auto mode = static_cast<int>(board.settings.number(setting::kToolChangeMode));
  if (mode < 1 || mode > 3) return false;
  const auto linear = gcode::axes_of(board.interpreter.state().modal.plane).linear;
  const AxisMask wanted = mode == 1 ? static_cast<AxisMask>(1U << linear) : kXyz;
  return (board.homed & wanted) != wanted;
}

bool cuts_thread(const gcode::LinearMove& move) {
  return move.feed.synchronized && !move.feed.per_revolution;
}

/// Of the thread that the block cuts, if it does (G33, G76).
std::optional<float> pitch_of(const std::vector<gcode::Action>& actions) {
  for (const gcode::Action& action : actions) {
    const auto* move = std::get_if<gcode::LinearMove>(&action);
    if (move != nullptr && cuts_thread(*move)) return move->feed.rate_mm_per_min;
  }
  return std::nullopt;
}

/// Appends steps action by action; knows where each motion begins.
class BlockSteps {
 public:
  BlockSteps(Board& board, const AxisValues& start_mm, const std::vector<gcode::Action>& actions, Steps& steps)
      : board_(board),
        at_mm_(start_mm),
        has_motion_(std::ranges::any_of(actions, is_motion)),
        pitch_mm_(board.settings.has_spindle_encoder() ? pitch_of(actions) : std::nullopt),
        steps_(steps) {
    for (const gcode::Action& action : actions) std::visit(*this, action);
    if (in_thread_) steps_.insert(steps_.end(), {Synchronize{}, EndThread{}});
  }

  void operator()(const gcode::LinearMove& move) {
    if (pitch_mm_ && !in_thread_) begin_thread();
    const bool cuts = cuts_thread(move);
    if (cuts != cutting_) steps_.emplace_back(Synchronize{});
    cutting_ = cuts;
    steps_.emplace_back(PlanMove{.move = move});
    at_mm_ = move.target_mm;
  }
  void operator()(const gcode::ArcMove& move) {
    steps_.emplace_back(PlanArc{.move = move, .start_mm = at_mm_, .chords = std::nullopt, .chord = std::nullopt});
    at_mm_ = move.target_mm;
  }
  void operator()(const gcode::ProbeMove& move) {
    steps_.insert(steps_.end(), {Synchronize{}, Probe{.move = move}});
    at_mm_ = move.target_mm;
  }
  void operator()(const gcode::Dwell& dwell) {
    const Duration duration = motion::dwell_duration(board_.planner.rules(), dwell.dwell_s);
    if (duration == Duration::zero() && board_.personality.skips_empty_dwell) return;
    steps_.insert(steps_.end(), {Synchronize{}, Dwell{.left = duration}});
  }
  void operator()(const gcode::SpindleChange& change) {
    synchronised(change);
    const bool stops = change.direction == gcode::SpindleDirection::Off;
    wait_for_spindle(stops ? setting::kSpindleOffDelay : setting::kSpindleOnDelay);
  }
  void operator()(const gcode::SpindleSpeedChange& change) { synchronised(change); }
  void operator()(const gcode::CoolantChange& change) {
    if (change.waits) steps_.emplace_back(Synchronize{});
    steps_.emplace_back(Perform{.action = change});
  }
  void operator()(const gcode::OverrideControl& control) { synchronised(control); }
  void operator()(const gcode::ProgramEnd& end) { synchronised(end); }
  void operator()(const gcode::WorkOffsetChange& change) {
    const bool synchronises =
        !board_.personality.has_work_offset_sync_bit || board_.reports(vocabulary::ReportBit::SyncOnWorkOffsetChange);
    if (synchronises) steps_.emplace_back(Synchronize{});
    steps_.emplace_back(Perform{.action = change});
  }
  void operator()(const gcode::StoredOffsetWrite& write) {
    if (board_.personality.stored_writes_synchronise) steps_.emplace_back(Synchronize{});
    steps_.emplace_back(Perform{.action = write});
  }
  void operator()(const gcode::ToolTableWrite& write) { steps_.emplace_back(Perform{.action = write}); }
  void operator()(const gcode::PortOutput& output) { steps_.emplace_back(Perform{.action = output}); }
  void operator()(const gcode::PortWait& wait) { steps_.emplace_back(WaitForInput{.wait = wait}); }
  void operator()(const gcode::ToolSelect& select) { steps_.emplace_back(Perform{.action = select}); }
  void operator()(const gcode::ToolChange&) { steps_.insert(steps_.end(), {Synchronize{}, BeginToolChange{}}); }
  void operator()(const gcode::ProgramPause&) { steps_.insert(steps_.end(), {Synchronize{}, HoldForCycleStart{}}); }
  void operator()(const gcode::ProgramDemarcation& mark) { steps_.emplace_back(Perform{.action = mark}); }
  void operator()(const gcode::AlarmRequest& request) {
    if (request.code == 0) return;
    steps_.emplace_back(RaiseAlarm{.code = static_cast<vocabulary::AlarmCode>(request.code), .by_program = true});
  }
  void operator()(const gcode::OperatorMessage& message) {
    if (has_motion_ && board_.state != MachineState::Check) {
      board_.motion_messages.push_back({.block = board_.blocks_planned + 1, .text = message.text});
    } else {
      steps_.emplace_back(Say{.message = protocol::Feedback{.text = message.text}});
    }
  }

 private:
  /// grblHAL spindle_control.c: time to spin up or down.
  void wait_for_spindle(int delay_setting) {
    const double delay_s = board_.settings.number(delay_setting);
    if (board_.settings.has_spindle_encoder() && board_.settings.number(setting::kSpindleAtSpeedTolerance) > 0) {
      constexpr double kLongestSeconds = 60;
      steps_.emplace_back(WaitForSpindle{.limit = base::from_seconds(delay_s > 0 ? delay_s : kLongestSeconds)});
    } else if (delay_s > 0) {
      steps_.emplace_back(board_.delay_step(delay_setting));
    }
  }
  void begin_thread() {
    in_thread_ = true;
    steps_.insert(steps_.end(), {Synchronize{}, BeginThread{.pitch_mm = *pitch_mm_, .start_mm = at_mm_}});
  }
  void synchronised(const gcode::Action& action) {
    steps_.insert(steps_.end(), {Synchronize{}, Perform{.action = action}});
  }

  Board& board_;
  AxisValues at_mm_;
  bool has_motion_;
  std::optional<float> pitch_mm_;
  bool in_thread_ = false;
  bool cutting_ = false;
  Steps& steps_;
};

/// grblHAL: a block that begins with `$` is a jog, whatever its next two letters are: `/$J=X1F100`, `$N0=$J=X1F100`.
std::optional<std::string> jog_words(const Board& board, std::string_view block) {
  if (!board.personality.blocks_may_jog || block.find('$') == std::string_view::npos) return std::nullopt;
  std::string text = normalised_block(block);
  const bool had_slash = text.starts_with('/') && !board.switches.block_delete;
  if (had_slash) text.erase(0, 1);
  constexpr std::string_view kPrefix = "$J=";
  if (!text.starts_with(kPrefix.front())) return std::nullopt;
  // `$G` is so short that what stood in the buffer before is read: the line as it came, or behind a slash the line
  // before it, after a setting its `=`.
  if (text.size() < kPrefix.size()) {
    return std::string{had_slash ? "=" : block.substr(std::min(kPrefix.size(), block.size()))};
  }
  text.erase(0, kPrefix.size());
  return text;
}

}  // namespace

std::string normalised_block(std::string_view block) {
  std::string text;
  bool in_comment = false;
  for (const char letter : block) {
    if (letter == ';') break;
    if (letter == '(') in_comment = true;
    if (!in_comment && letter != ')' && !base::is_blank(letter)) text += base::to_upper(letter);
    if (letter == ')') in_comment = false;
  }
  return text;
}

std::expected<void, ErrorCode> add_jog_steps(Board& board, std::string_view words, Steps& steps) {
  auto move = board.interpreter.interpret_jog(words);
  if (!move) return std::unexpected(move.error());
  if (board.personality.has_extended_settings && board.settings.flag(setting::kLimitJogs)) {
    move->target_mm = board.clipped_to_travel(move->target_mm);
  } else if (board.settings.flag(setting::kSoftLimits) && !board.is_within_travel(move->target_mm)) {
    return std::unexpected(ErrorCode::TravelExceeded);
  }
  steps.emplace_back(PlanJog{.move = *move});
  return {};
}

std::expected<void, ErrorCode> add_block_steps(Board& board, std::string_view block, Steps& steps) {
  if (const auto words = jog_words(board, block)) return add_jog_steps(board, *words, steps);
  const AxisValues start_mm = board.interpreter.state().position_mm;
  std::vector<gcode::Action> actions;
  if (const auto result = board.interpreter.interpret(block, actions); !result) {
    // What was done before the block failed stays done: the motion before a macro that does not exist.
    BlockSteps{board, start_mm, actions, steps};
    return result;
  }
  const auto changes_tool = [](const gcode::Action& action) {
    return std::holds_alternative<gcode::ToolChange>(action);
  };
  if (std::ranges::any_of(actions, changes_tool) && tool_change_needs_homing(board)) {
    board.interpreter.abort_tool_change();
    return std::unexpected(ErrorCode::HomingRequired);
  }
  BlockSteps{board, start_mm, actions, steps};
  note_scaling(board);
  if (board.switches.single_block && has_words(board, block))
    steps.insert(steps.end(), {Synchronize{}, HoldForCycleStart{}});
  return {};
}

}  // namespace kerf::firmware
