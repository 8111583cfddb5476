#pragma once
// How `kerf` ends. The numbers are part of the command line's interface: scripts test them.

namespace kerf::rehearsal {
struct CheckResult;
}

namespace kerf::apps {

enum class ExitStatus {
  Done = 0,
  Usage = 1,         ///< wrong option, or a file that cannot be used
  NoConnection = 2,  ///< no machine there, or none that speaks Grbl
  Refused = 3,  ///< the controller refused a line, or `kerf check` says that it would; `kerf verify`: a talk failed
  Alarm = 4,
  Interrupted = 5,  ///< stopped by the operator, link lost, or a reset from outside
  Warned = 6,       ///< `kerf check`: nothing would be refused, but there are warnings
};

[[nodiscard]] ExitStatus status_of(const rehearsal::CheckResult& result);

}  // namespace kerf::apps
