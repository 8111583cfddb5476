#pragma once
// Folds what a controller says into one Snapshot. Makes no decisions.

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "common/base/time.hpp"
#include "common/protocol/message.hpp"
#include "common/vocabulary/dialect.hpp"
#include "sender/machine/snapshot.hpp"

namespace kerf::machine {

/// Keeps the snapshot. Fields may come in any order and any report; what a report leaves out stays as it was, except
/// inputs, whose absence means "off" (protocol.md 3.1).
class MachineModel {
 public:
  /// Whose alarm codes these are.
  void speak(const vocabulary::Dialect& dialect) { dialect_ = &dialect; }

  void fold(Instant now, const protocol::Message& message);
  /// A line was answered with ok: `$13=1` changes the units of all reports after it, G-code the parser's state.
  void on_line_accepted(std::string_view line);
  /// The controller restarted without being asked: it may have been without power, and then no axis knows where it is.
  void on_power_doubt();
  /// Somebody else may have changed modes and offsets: a pendant, a file on the card.
  void on_strange_hands();
  /// The link is gone: nothing is known any more.
  void forget();

  [[nodiscard]] const Snapshot& snapshot() const { return snapshot_.units_are_known ? snapshot_ : told_; }

 private:
  void fold_report(Instant now, const protocol::StatusReport& report);
  void fold_position(const protocol::StatusReport& report);
  void fold_motion(const protocol::StatusReport& report);
  void fold_spindles(const protocol::StatusReport& report);
  void fold_inputs(const protocol::StatusReport& report);
  void fold_accessories(const protocol::StatusReport& report);
  void fold_modes(const protocol::StatusReport& report);
  void fold_homed(const protocol::StatusReport& report);
  void fold_alarm_state(const protocol::StatusReport& report);
  void fold_card(const protocol::StatusReport& report);
  void fold_parser_state(const protocol::ParserState& state);
  void fold_home(const protocol::HomePosition& home);
  void fold_welcome();
  void fold_setting(std::string_view id, std::string_view value);
  void fold_message(Instant now, std::string_view text);
  void set_inches(bool inches);
  void raise_alarm(int code);
  void note_homed(std::string_view axes);
  void forget_homing();
  [[nodiscard]] std::string letters_of(unsigned axis_mask) const;
  [[nodiscard]] std::vector<double> in_mm(std::vector<double> values) const;
  [[nodiscard]] double scale() const { return snapshot_.reports_inches ? 25.4 : 1.0; }

  /// Without millimetres that may be inches; counts while the units are not known.
  void tell_without_units();

  Snapshot snapshot_;
  Snapshot told_;
  /// `$10`, where it is known.
  std::optional<std::uint32_t> report_mask_;
  /// The state in which the prompt counts.
  vocabulary::MachineState prompt_state_ = vocabulary::MachineState::Unknown;
  const vocabulary::Dialect* dialect_ = &vocabulary::dialect_of(vocabulary::Firmware::Unknown);
};

}  // namespace kerf::machine
