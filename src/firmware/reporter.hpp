#pragma once
// Status reports and the other things a controller says about its state.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "firmware/board.hpp"

namespace kerf::firmware {

/// Makes reports from the board. A status report pays the board's report debts and moves its counters (protocol.md 3).
class Reporter {
 public:
  explicit Reporter(Board& board) : board_(board) {}

  /// Says `<...>`, and on grblHAL with `$10` bit 9 the parser state behind it when it has changed.
  void say_status(std::size_t rx_free);
  /// A report that only the pendant asked for; it has debts and counters of its own (grblHAL stream.c).
  void say_status_to_pendant(std::size_t rx_free, bool everything);
  void restart_pendant_counters() { pendant_debts_.override_counter = pendant_debts_.work_offset_counter = 0; }
  /// `[GC:...]`
  void say_parser_state();
  void say_parser_state(Port port);
  /// `[TLO:...]`
  void say_tool_length_offset();
  /// `[PRB:...]`
  void say_probe();
  /// Everything of `$#`.
  void say_parameters();

  [[nodiscard]] protocol::StatusReport status(std::size_t rx_free);

 private:
  void add_position(protocol::StatusReport& report) const;
  void add_speed(protocol::StatusReport& report) const;
  void add_counted(protocol::StatusReport& report);
  void add_counted_grbl(protocol::StatusReport& report);
  void add_counted_grblhal(protocol::StatusReport& report);
  void add_changed(protocol::StatusReport& report) const;
  void add_card(protocol::StatusReport& report, bool everything);
  void say_changed_parser_state();

  [[nodiscard]] std::string pins() const;
  [[nodiscard]] std::string accessory_letters(bool with_tool_change) const;
  /// One value an axis, in the units of `$13`.
  [[nodiscard]] std::vector<double> in_report_units(const AxisValues& mm) const;
  [[nodiscard]] bool is_busy() const;

  /// The pendant is owed what the others are told from now on.
  void owe_pendant();

  Board& board_;
  ReportDebts pendant_debts_;
  /// What of the board's debts the pendant has been told already.
  ReportDebts told_pendant_;
  /// What the last pushed parser state said.
  struct TrackedValues {
    float feed_rate = 0;
    float spindle_rpm = 0;
    std::uint32_t tool = 0;
    bool operator==(const TrackedValues&) const = default;
  };
  TrackedValues last_values_;
  bool last_g92_active_ = false;
  std::optional<gcode::ModalState> last_modal_;
};

/// The number behind the state's colon in a status report.
[[nodiscard]] std::optional<int> substate_of(const Board& board);

}  // namespace kerf::firmware
