#pragma once
// The firmware's main loop as data: reads lines, turns each into steps, and carries the steps out as far as it can.

#include <cstdint>
#include <optional>

#include "common/gcode/line_reader.hpp"
#include "firmware/board.hpp"
#include "firmware/cycle.hpp"
#include "firmware/homing.hpp"
#include "firmware/receiver.hpp"
#include "firmware/reporter.hpp"
#include "firmware/step.hpp"
#include "firmware/system_commands.hpp"
#include "firmware/tool_change.hpp"

namespace kerf::firmware {

/// One line is in execution at most; its steps stand in a queue whose front is what the firmware would be blocked in.
class Foreground {
 public:
  Foreground(Board& board, Cycle& cycle, Receiver& receiver, Reporter& reporter)
      : board_(board),
        cycle_(cycle),
        receiver_(receiver),
        reporter_(reporter),
        homing_(board, cycle),
        tool_change_(board),
        commands_(board, reporter, tool_change_),
        reader_(board.interpreter.rules().line) {}

  void power_on();
  /// Goes on as far as possible at `board.now`, without starting queued motion by itself.
  void run();
  /// Starts queued motion if the main loop is idle: it has read everything there is.
  void settle();
  /// 0x18, the reset button: everything is dropped, and an alarm says so if something moved.
  void reset();
  /// 0x19: the line in execution is dropped unanswered.
  void abandon_line();
  /// `~` while the machine waits for a tool.
  void go_on_with_tool_change();
  /// 0xA3: lines are read again while the machine waits for a tool; what was unread waits.
  void acknowledge_tool_change();
  /// The safety door opens, or 0x84 says so.
  void open_door();
  /// The door switch: unlike 0x84 it may be ignored while nothing is cut.
  void open_door_by_switch();
  void emergency_stop();
  /// A status report is wanted as soon as the main loop looks.
  void request_status(bool everything);
  /// Something arrived: the machine does not fall asleep.
  void note_activity() { asleep_at_ = kNever; }
  /// Switches may have changed, by hand or by motion.
  void look_at_switches();

  /// How the line being read treats special bytes.
  [[nodiscard]] Receiver::LineContext line_context() const;
  [[nodiscard]] WaitingFor waiting_for() const { return waiting_for_; }
  [[nodiscard]] Instant next_deadline() const;

  // One step each: true when it is done.
  bool operator()(Answer& step);
  bool operator()(Say& step);
  bool operator()(SayStatus& step);
  bool operator()(SayProbe& step);
  bool operator()(PlanMove& step);
  bool operator()(PlanArc& step);
  bool operator()(PlanJog& step);
  bool operator()(Synchronize& step);
  bool operator()(Dwell& step);
  bool operator()(Freeze& step);
  bool operator()(Perform& step);
  bool operator()(HoldForCycleStart& step);
  bool operator()(Probe& step);
  bool operator()(HomeAxes& step);
  bool operator()(WaitForInput& step);
  bool operator()(WaitForSpindle& step);
  bool operator()(BeginThread& step);
  bool operator()(EndThread& step);
  /// The line ends here, with an error.
  void give_up_line(ErrorCode code);
  bool operator()(RaiseAlarm& step);
  bool operator()(StopAtSoftLimit& step);
  bool operator()(EnterCritical& step);
  bool operator()(Restart& step);
  bool operator()(CheckAtStart& step);
  bool operator()(RunStartupLines& step);
  bool operator()(KeepStartupLine& step);
  bool operator()(RunStartupBlock& step);
  bool operator()(BeginFileJob& step);
  bool operator()(EndFileJob& step);
  bool operator()(EnterSleep& step);
  bool operator()(BeginToolChange& step);
  bool operator()(EnterToolChange& step);
  bool operator()(ContinueToolChange& step);
  bool operator()(FinishToolChange& step);
  bool operator()(FinishHoming& step);

 private:
  bool advance_front();
  bool read_line();
  /// From the file that is run, else from the stream.
  std::optional<char> next_byte();
  std::optional<char> next_file_byte();
  void end_file_job();
  /// A file that ends by force says so.
  [[nodiscard]] std::string file_interruption() const;
  [[nodiscard]] Steps interrupted_file() const;
  void begin_line(const gcode::ReadLine& line);
  void execute_block(std::string_view text);
  [[nodiscard]] bool reads_lines() const;
  [[nodiscard]] bool locks_gcode() const;
  bool wait_for(WaitingFor what);
  void insert_front(Steps steps);
  void append_steps(Steps steps);
  [[nodiscard]] static bool is_program_end(const Step& step);
  [[nodiscard]] Say saying_program_end() const;
  /// True if the target is fine; otherwise the soft limit alarm is under way.
  bool check_travel(const AxisValues& target_mm);
  bool has_planner_room();
  /// Queues a line, and the take-up of backlash before it; false while that has to wait for room.
  bool plan_when_room(const AxisValues& target_mm, const gcode::Feed& feed);
  void fail(vocabulary::AlarmCode code);
  void enter_critical_alarm(vocabulary::AlarmCode code);
  bool begin_probe(Probe& step);
  bool finish_probe(const AxisSteps& contact, bool touched, const gcode::ProbeMove& move);
  void check_at_start_grblhal();
  void check_at_start_grbl();
  [[nodiscard]] bool answers_status() const;
  void say_wanted_status();
  void watch_for_sleep();
  void end_tool_change();
  void owe_first_report();
  [[nodiscard]] Duration auto_report_interval() const;
  void note_work_offset();
  void restore_overrides();

  Board& board_;
  Cycle& cycle_;
  Receiver& receiver_;
  Reporter& reporter_;
  Homing homing_;
  ToolChange tool_change_;
  SystemCommands commands_;
  gcode::LineReader reader_;

  Steps steps_;
  WaitingFor waiting_for_ = WaitingFor::Nothing;
  std::optional<Instant> until_;
  bool in_line_ = false;
  bool is_frozen_ = false;
  std::optional<OverrideState> overrides_before_thread_;
  /// The line that waits for room has been told to the backlash, and what is to be taken up before it.
  bool turn_noted_ = false;
  std::optional<AxisValues> take_up_mm_;
  ErrorCode last_error_ = ErrorCode::Ok;
  bool status_wanted_ = false;
  AxisMask last_limits_ = 0;
  AxisSteps contact_{};
  std::uint8_t last_work_offset_ = 0;
  AxisValues last_tool_length_{};
  Instant next_auto_report_ = kNever;
  Instant asleep_at_ = kNever;
};

}  // namespace kerf::firmware
