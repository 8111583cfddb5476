#include "firmware/block_steps.hpp"

#include <algorithm>

#include "common/base/overloaded.hpp"

namespace kerf::firmware {

namespace {

bool is_motion(const gcode::Action& action) {
  return std::holds_alternative<gcode::LinearMove>(action) || std::holds_alternative<gcode::ArcMove>(action);
}

/// Appends steps action by action; knows where each motion begins.
class BlockSteps {
 public:
  BlockSteps(Board& board, const AxisValues& start_mm, bool has_motion, Steps& steps)
      : board_(board), at_mm_(start_mm), has_motion_(has_motion), steps_(steps) {}

  void operator()(const gcode::LinearMove& move) {
    steps_.emplace_back(PlanMove{.move = move});
    at_mm_ = move.target_mm;
  }
  void operator()(const gcode::ArcMove& move) {
    steps_.emplace_back(PlanArc{.move = move, .start_mm = at_mm_, .chords = std::nullopt});
    at_mm_ = move.target_mm;
  }
  void operator()(const gcode::ProbeMove& move) {
    steps_.insert(steps_.end(), {Synchronize{}, Probe{.move = move}});
    at_mm_ = move.target_mm;
  }
  void operator()(const gcode::Dwell& dwell) {
    steps_.insert(steps_.end(), {Synchronize{}, Dwell{.left = motion::dwell_duration(board_.planner.rules(), dwell.dwell_s)}});
  }
  void operator()(const gcode::SpindleChange& change) { synchronised(change); }
  void operator()(const gcode::SpindleSpeedChange& change) { synchronised(change); }
  void operator()(const gcode::CoolantChange& change) {
    if (change.waits) steps_.emplace_back(Synchronize{});
    steps_.emplace_back(Perform{.action = change});
  }
  void operator()(const gcode::OverrideControl& control) { synchronised(control); }
  void operator()(const gcode::ProgramEnd& end) { synchronised(end); }
  void operator()(const gcode::WorkOffsetChange& change) {
    const bool synchronises = !board_.personality.has_work_offset_sync_bit ||
                              board_.reports(vocabulary::ReportBit::SyncOnWorkOffsetChange);
    if (synchronises) steps_.emplace_back(Synchronize{});
    steps_.emplace_back(Perform{.action = change});
  }
  void operator()(const gcode::StoredOffsetWrite& write) {
    if (board_.personality.stored_writes_synchronise) steps_.emplace_back(Synchronize{});
    steps_.emplace_back(Perform{.action = write});
  }
  void operator()(const gcode::ToolSelect& select) { steps_.emplace_back(Perform{.action = select}); }
  void operator()(const gcode::ToolChange&) { steps_.insert(steps_.end(), {Synchronize{}, EnterToolChange{}}); }
  void operator()(const gcode::ProgramPause&) { steps_.insert(steps_.end(), {Synchronize{}, HoldForCycleStart{}}); }
  void operator()(const gcode::ProgramDemarcation&) {}
  void operator()(const gcode::OperatorMessage& message) {
    if (has_motion_ && board_.state != MachineState::Check) {
      board_.motion_messages.push_back({.block = board_.blocks_planned + 1, .text = message.text});
    } else {
      steps_.emplace_back(Say{.message = protocol::Feedback{.text = message.text}});
    }
  }

 private:
  void synchronised(const gcode::Action& action) {
    steps_.insert(steps_.end(), {Synchronize{}, Perform{.action = action}});
  }

  Board& board_;
  AxisValues at_mm_;
  bool has_motion_;
  Steps& steps_;
};

}  // namespace

std::expected<void, ErrorCode> add_block_steps(Board& board, std::string_view block, Steps& steps) {
  const AxisValues start_mm = board.interpreter.state().position_mm;
  std::vector<gcode::Action> actions;
  if (const auto result = board.interpreter.interpret(block, actions); !result) return result;
  BlockSteps add{board, start_mm, std::ranges::any_of(actions, is_motion), steps};
  for (const gcode::Action& action : actions) std::visit(add, action);
  if (board.switches.single_block) steps.insert(steps.end(), {Synchronize{}, HoldForCycleStart{}});
  return {};
}

}  // namespace kerf::firmware
