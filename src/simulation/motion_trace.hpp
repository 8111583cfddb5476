#pragma once
// A program on the virtual controller, in virtual time: when each block ends, where the machine is, how long it takes.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/time.hpp"
#include "common/vocabulary/axis.hpp"
#include "simulation/case_runner.hpp"
#include "simulation/program_text.hpp"

namespace kerf::simulation {

/// How the program reaches the controller. Without a baud rate the receive buffer is kept full; with one, bytes of ten
/// bits arrive one after the other, and the sender counts characters.
struct ProgramLink {
  std::optional<int> baud;
};

/// One block, in the order of execution. `line`, `length_mm` and `rate_mm_per_min` are those of the block that was
/// planned at this place in the order; a block that a hold interrupts has its end where the machine came to rest.
struct BlockTrace {
  std::uint32_t line = 0;
  double start_s = 0;
  double end_s = 0;
  double length_mm = 0;
  double rate_mm_per_min = 0;
  bool rapid = false;
  /// Axes that the machine lacks stay 0; an array, because there may be millions of blocks.
  vocabulary::AxisSteps end_steps{};
};

struct ProgramRun {
  std::string program;
  ProgramLink link{};
  /// Counted from the first byte of the program.
  std::vector<InjectedByte> inject{};
  std::optional<Duration> sample_every{};
  /// False: trace_program() only counts blocks; there may be millions.
  bool keeps_blocks = true;
  /// Somebody presses Cycle Start at once whenever the program waits for that.
  bool operator_goes_on = false;
};

struct PositionSample {
  double at_s = 0;
  std::vector<std::int32_t> steps;
};

/// A line of the program (the first is 1) and the number behind `error:`.
struct RefusedLine {
  std::uint32_t line = 0;
  int code = 0;
};

struct MotionTrace {
  /// When the last motion ended or the last line was answered, whichever was later.
  double total_s = 0;
  /// Lines that were answered, of `lines`.
  std::uint32_t lines_answered = 0;
  std::uint32_t lines = 0;
  std::size_t block_count = 0;
  /// Empty if they are not kept.
  std::vector<BlockTrace> blocks;
  std::vector<PositionSample> positions;
  std::vector<std::int32_t> final_steps;
  std::vector<double> final_mm;
  std::vector<RefusedLine> errors;
  /// Numbers behind `ALARM:`.
  std::vector<int> alarms;
  /// Lines at which the program waited for Cycle Start.
  std::vector<std::uint32_t> stops;
};

/// Runs the program to its end, or until the machine waits for something that never comes. Blank lines count, and line
/// ends may be LF or CR LF.
[[nodiscard]] MotionTrace trace_program(const ProgramRun& run, const CaseMachine& machine);

/// The same piece by piece, for whoever wants the blocks of a long program without keeping them all.
class ProgramTracer {
 public:
  /// Both must outlive it.
  ProgramTracer(const ProgramRun& run, const CaseMachine& machine);
  /// The same for a text that nobody holds as a whole; `run.program` means nothing then.
  ProgramTracer(const ProgramRun& run, const CaseMachine& machine, std::unique_ptr<ProgramText> text);
  ~ProgramTracer();
  ProgramTracer(const ProgramTracer&) = delete;
  ProgramTracer& operator=(const ProgramTracer&) = delete;

  /// Goes on until some blocks more have ended, which are appended to `ended`; false at the end of the program.
  bool run_on(std::vector<BlockTrace>& ended);
  /// Once run_on() gave false: everything but the blocks.
  [[nodiscard]] MotionTrace finish();

 private:
  class Run;
  std::unique_ptr<Run> run_;
};

}  // namespace kerf::simulation
