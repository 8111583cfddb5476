#pragma once
// Measuring other processes: what `kerf` is given, and the stock grblHAL simulator.

#include <optional>
#include <string>
#include <vector>

#include "child_process.hpp"
#include "programs.hpp"

namespace kerf::bench {

/// The programs as files for as long as this lives; their names are put before those in `files`.
class ScratchFiles {
 public:
  ScratchFiles(const std::vector<BenchProgram>& programs, std::vector<std::string>& files);

 private:
  ScratchFolder folder_;
};

/// The first `lines` lines of a program.
[[nodiscard]] BenchProgram head_of(const BenchProgram& program, int lines);

struct PeerTook {
  /// From the first byte of the program until the simulator says Idle.
  double wall_s = 0;
  int refused_lines = 0;
};

/// Starts the simulator at `-t 0` with a blank memory, writes the settings, and streams the program by character
/// counting. The simulator listens on every interface, so this refuses to run in a network namespace that has more than
/// the loopback; and it ends on SIGKILL only. Nothing if it is refused, cannot be reached, or stands still for a
/// minute.
[[nodiscard]] std::optional<PeerTook> run_peer(const std::string& simulator, const BenchProgram& program);

}  // namespace kerf::bench
