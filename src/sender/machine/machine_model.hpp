#pragma once
// Folds what a controller says into one Snapshot. Makes no decisions.

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
  /// A line was answered with ok: `$13=1` changes the units of all reports after it.
  void on_line_accepted(std::string_view line);
  /// The link is gone: nothing is known any more.
  void forget() { snapshot_ = {}; }

  [[nodiscard]] const Snapshot& snapshot() const { return snapshot_; }

 private:
  void fold_report(Instant now, const protocol::StatusReport& report);
  void fold_position(const protocol::StatusReport& report);
  void fold_optional_fields(const protocol::StatusReport& report);
  void fold_alarm_state(const protocol::StatusReport& report);
  void fold_controller_file(const protocol::StatusReport& report);
  void fold_parser_state(const protocol::ParserState& state);
  void fold_welcome();
  void fold_setting(std::string_view id, std::string_view value);
  void raise_alarm(int code);
  void keep_message(std::string_view text);
  [[nodiscard]] std::vector<double> in_mm(std::vector<double> values) const;
  [[nodiscard]] double scale() const { return snapshot_.reports_inches ? 25.4 : 1.0; }

  Snapshot snapshot_;
  const vocabulary::Dialect* dialect_ = &vocabulary::dialect_of(vocabulary::Firmware::Unknown);
};

}  // namespace kerf::machine
