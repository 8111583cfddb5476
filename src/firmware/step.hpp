#pragma once
// What is left to do for the line being executed, or after a reset: small steps, each of which may have to wait.

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <variant>

#include "common/base/time.hpp"
#include "common/gcode/action.hpp"
#include "common/motion/arc.hpp"
#include "common/protocol/message.hpp"
#include "common/vocabulary/alarms.hpp"
#include "common/vocabulary/axis.hpp"
#include "common/vocabulary/errors.hpp"

namespace kerf::firmware {

/// Says `ok` or `error:N`; the last step of every line.
struct Answer {
  vocabulary::ErrorCode code = vocabulary::ErrorCode::Ok;
};
struct Say {
  protocol::Message message{};
};
/// Says a status report (grblHAL at the start of `$H` and the end of a tool change).
struct SayStatus {};
struct SayProbe {};
/// Queues a straight line; waits for planner room.
struct PlanMove {
  gcode::LinearMove move{};
};
/// Queues an arc chord by chord; waits for planner room each time.
struct PlanArc {
  gcode::ArcMove move{};
  vocabulary::AxisValues start_mm{};
  std::optional<motion::ArcChords> chords{};
  /// Where the chord that waits for room ends.
  std::optional<vocabulary::AxisValues> chord{};
};
/// Queues a jog and starts it.
struct PlanJog {
  gcode::JogMove move{};
};
/// Waits until all motion has come to its end.
struct Synchronize {};
/// Waits; stands still while the machine is held.
struct Dwell {
  Duration left{};
};
/// The main loop is busy and does not even look for realtime requests.
struct Freeze {
  Duration duration{};
  std::optional<Instant> until{};
};
/// Carries out an action that takes no time.
struct Perform {
  gcode::Action action{};
};
/// M0 and single block: holds until cycle start.
struct HoldForCycleStart {
  bool begun = false;
};
struct Probe {
  gcode::ProbeMove move{};
  enum class Phase : std::uint8_t { Check, Moving, Cancelling } phase = Phase::Check;
};
/// One `$H`; the cycles in order.
struct HomeAxes {
  std::deque<vocabulary::AxisMask> cycles{};
  bool begun = false;
};
struct RaiseAlarm {
  vocabulary::AlarmCode code{};
  /// A program did it: nothing is stopped or dropped, but a critical alarm locks the machine.
  bool by_program = false;
};
/// A target lies outside the travel: hold, then ALARM:2.
struct StopAtSoftLimit {
  bool begun = false;
};
/// Nothing but a reset helps from here on.
struct EnterCritical {};
/// The end of a reset: everything is initialised anew.
struct Restart {};
/// Checks what forbids normal operation after the welcome, else queues the startup lines.
struct CheckAtStart {};
/// Runs `$N0` and `$N1`.
struct RunStartupLines {};
/// `$N0=`: its block has been carried out, so it is worth keeping.
struct KeepStartupLine {
  std::size_t index = 0;
  std::string line{};
};
struct RunStartupBlock {
  std::string block{};
};
/// From here on lines come from a file on the card.
struct BeginFileJob {
  std::string path{};
  std::uint64_t bytes = 0;
};
/// The file is let go of, and unread input with it.
struct EndFileJob {};
struct EnterSleep {};
struct EnterToolChange {};
/// Where a tool change has come to, when the way on depends on what happened.
enum class ToolChangePhase : std::uint8_t {
  AtPlace,
  LeftG30,
  SetterFound,
  SetterMeasured,
  AboveWork,
  Back,
  PlateFound,
  PlateMeasured,
  PlateDone,
};
/// M66: reads a user input, or waits for it.
struct WaitForInput {
  gcode::PortWait wait{};
  std::optional<Instant> until{};
  float before = 0;
};
/// Waits until the encoder says that the spindle is at speed; after `limit` without that: ALARM:14 (grblHAL).
struct WaitForSpindle {
  Duration limit{};
  Duration waited{};
  std::optional<Instant> until{};
};
/// G33, G76: the spindle must turn, and overrides rest until the thread is cut.
struct BeginThread {
  float pitch_mm = 0;
  vocabulary::AxisValues start_mm{};
};
struct EndThread {};
/// M6, the motion before it has ended.
struct BeginToolChange {};
struct ContinueToolChange {
  ToolChangePhase phase = ToolChangePhase::AtPlace;
};
/// The new tool is in; the lines that were put aside go on.
struct FinishToolChange {};
/// State Idle and, where the firmware does so, `[MSG:]` and startup lines.
struct FinishHoming {
  vocabulary::AxisMask asked = 0;  ///< 0: all
};

using Step = std::variant<Answer, Say, SayStatus, SayProbe, PlanMove, PlanArc, PlanJog, Synchronize, Dwell, Freeze,
                          Perform, HoldForCycleStart, Probe, HomeAxes, WaitForInput, WaitForSpindle, BeginThread,
                          EndThread, RaiseAlarm, StopAtSoftLimit, EnterCritical, Restart, CheckAtStart, RunStartupLines,
                          KeepStartupLine, RunStartupBlock, BeginFileJob, EndFileJob, EnterSleep, BeginToolChange,
                          EnterToolChange, ContinueToolChange, FinishToolChange, FinishHoming>;

/// What the foreground is waiting for, to be looked at.
enum class WaitingFor : std::uint8_t {
  Nothing,
  PlannerRoom,
  MotionToFinish,
  Time,
  CycleStart,
  Contact,
};

using Steps = std::deque<Step>;

}  // namespace kerf::firmware
