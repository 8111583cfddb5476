#pragma once
// What of a file's line goes to the wire.

#include <string>
#include <string_view>

#include <boost/describe.hpp>

#include "common/vocabulary/dialect.hpp"

namespace kerf::job {

/// A switch of the program's that a machine may have too.
enum class ProgramSwitch {
  AsMachine,  ///< as this controller does it
  On,
  Off,
};
BOOST_DESCRIBE_ENUM(ProgramSwitch, AsMachine, On, Off)

/// What a controller can use besides the words themselves.
struct WireForm {
  /// `(MSG,…)`, `(PRINT,…)` and `(DEBUG,…)` are for the operator and come back as messages.
  bool keeps_messages = false;
  /// A lone `%` is understood; Grbl answers it with an error, so it is left out there (protocol.md 6.3).
  bool keeps_percent = false;
  /// A leading `/` is understood. Where it is not, it is taken off, and the line is cut: what Grbl does, while Rabbit
  /// answers with an error (protocol.md 6.3).
  bool keeps_slash = false;
  /// Leaves out lines that begin with `/` (On), or cuts them (Off).
  ProgramSwitch block_delete = ProgramSwitch::AsMachine;
  /// M1 becomes M0 (On), or is left out (Off).
  ProgramSwitch optional_stop = ProgramSwitch::AsMachine;
};

[[nodiscard]] WireForm wire_form_of(const vocabulary::Dialect& dialect);

/// Appends `line` without blanks, comments and bytes that are no ASCII text: shorter, and the same to every parser.
/// Nothing is appended when nothing is left. Lines that begin with `$` keep their inner blanks.
void append_wire_form(std::string& out, std::string_view line, WireForm form);

}  // namespace kerf::job
