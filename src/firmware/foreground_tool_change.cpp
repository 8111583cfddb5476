// M6 as the foreground sees it: state Tool, what 0xA3 and `~` do in it, and its end (grblHAL stream.c,
// state_machine.c).

#include "firmware/foreground.hpp"

namespace kerf::firmware {

void Foreground::acknowledge_tool_change() {
  if (board_.state != MachineState::Tool || board_.tool_acknowledged) return;
  board_.tool_acknowledged = true;
  if (!board_.job.is_running()) receiver_.set_aside();
}

void Foreground::go_on_with_tool_change() {
  if (!tool_change_.is_guided()) {
    end_tool_change();
    return;
  }
  insert_front(tool_change_.on_cycle_start());
}

void Foreground::end_tool_change() {
  if (board_.state != MachineState::Tool) return;
  const AxisValues length = board_.interpreter.offsets().tool_length;
  board_.interpreter.complete_tool_change();
  if (board_.interpreter.offsets().tool_length != length) note_work_offset();
  board_.changes_tool = false;
  board_.tool_acknowledged = false;
  receiver_.restore();
  board_.job.resume();
  board_.state = MachineState::Idle;
  cycle_.auto_start();
  board_.report.tool = true;
  reporter_.say_status(receiver_.free());
}

bool Foreground::operator()(BeginToolChange& /*step*/) {
  if (board_.state == MachineState::Check) {
    board_.interpreter.complete_tool_change();
  } else {
    insert_front(tool_change_.begin());
  }
  return true;
}

bool Foreground::operator()(EnterToolChange& /*step*/) {
  board_.changes_tool = true;
  board_.state = MachineState::Tool;
  board_.tool_acknowledged = false;
  if (board_.job.is_running()) {
    board_.job.suspend();
    receiver_.clear();
  }
  return true;
}

bool Foreground::operator()(ContinueToolChange& step) {
  insert_front(tool_change_.go_on(step.phase));
  return true;
}

bool Foreground::operator()(FinishToolChange& /*step*/) {
  end_tool_change();
  if (board_.workcell.is_active(Input::Door)) cycle_.open_door();
  return true;
}

}  // namespace kerf::firmware
