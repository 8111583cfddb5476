#pragma once
// How a job goes on in the middle of its program: what is done first, why, and where the tool goes, as one value that
// is shown to the operator and rehearsed before anything moves. All of it is pure.
//
// The order is that of a careful machinist: straight up to a height that is known to be clear, spindle and coolant on,
// across, down in rapid only as far as nothing was cut yet, the rest of the way down fed, then the modes of the line.

#include <array>
#include <cstdint>
#include <expected>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <boost/describe.hpp>

#include "sender/job/executing_lines.hpp"
#include "sender/job/journal.hpp"
#include "sender/job/program.hpp"
#include "sender/machine/capabilities.hpp"
#include "sender/machine/snapshot.hpp"

namespace kerf::job {

/// Why there is no plan.
enum class ResumeProblem {
  NothingLeft,      ///< every line was executed
  NoSuchLine,       ///< the program is shorter
  OtherProgram,     ///< the file is not the one that was cut
  OtherMachine,     ///< another firmware, or other axes
  StartUnknown,     ///< the machine before the first line is not known
  MachineUnknown,   ///< the machine now is not known well enough
  MachineNotReady,  ///< it moves, or is in alarm
  StateUnknown,     ///< a line before makes the state uncertain
  PositionUnknown,  ///< nobody says that the machine is where it thinks
  OffsetsDiffer,    ///< work offsets, G92 or tool length are not those that the program left
  CannotRestore,    ///< a mode that cannot be brought back safely
  NoSafeHeight,     ///< no height that is known to be clear
  OutsideTravel,    ///< the way leads out of the travel
  RehearsalFailed,  ///< the virtual controller says no
};
BOOST_DESCRIBE_ENUM(ResumeProblem, NothingLeft, NoSuchLine, OtherProgram, OtherMachine, StartUnknown, MachineUnknown,
                    MachineNotReady, StateUnknown, PositionUnknown, OffsetsDiffer, CannotRestore, NoSafeHeight,
                    OutsideTravel, RehearsalFailed)

/// `line` is 0 where it is about no line. `sentence` says what, `next` what to do about it.
struct ResumeRefusal {
  ResumeProblem problem{};
  std::uint32_t line = 0;
  std::string sentence{};
  std::string next{};
  bool operator==(const ResumeRefusal&) const = default;
};
BOOST_DESCRIBE_STRUCT(ResumeRefusal, (), (problem, line, sentence, next))

/// Which work offsets, tool length and G92 count when the machine has others than the program left.
enum class OffsetsChoice {
  MustAgree,  ///< refuse and say which
  Present,    ///< the machine's: the work or the cutter was zeroed anew
  AsThen,     ///< those of the journal are written back
};
BOOST_DESCRIBE_ENUM(OffsetsChoice, MustAgree, Present, AsThen)

/// What the operator may decide; empty means that the plan decides.
struct ResumeChoice {
  std::optional<std::uint32_t> from_line{};
  /// Machine coordinates.
  std::optional<double> safe_height_mm{};
  std::optional<double> plunge_mm_per_min{};
  std::optional<double> spin_up_s{};
  /// How far above everything that was cut the rapid ends.
  double clearance_mm = 1.0;
  OffsetsChoice offsets = OffsetsChoice::MustAgree;
  /// The operator has seen that the machine is where it says, where it cannot be homed.
  bool position_is_confirmed = false;
  bool operator==(const ResumeChoice&) const = default;
};
BOOST_DESCRIBE_STRUCT(ResumeChoice, (),
                      (from_line, safe_height_mm, plunge_mm_per_min, spin_up_s, clearance_mm, offsets,
                       position_is_confirmed))

/// What is known about the job and the machine.
struct ResumeFacts {
  /// Before the first line of the file.
  MachineAtStart start{};
  /// Now. At rest; homed if it is to be homed.
  MachineAtStart present{};
  /// The machine has not answered for so long; empty while it does.
  std::optional<double> silent_for_s{};
  /// Of the machine now.
  machine::Capabilities capabilities{};
  /// Lines of the file.
  ExecutingLines executing{};
  std::string executing_because{};
  /// Why the position may be wrong; empty where it is trusted.
  std::string position_doubt{};
  /// Of the file that was cut; empty where nobody knows.
  std::string file_hash{};
  /// The machine will be homed before the plan is carried out.
  bool will_be_homed = false;
  /// What the operator ought to know besides: overrides that were in force, a suspect end.
  std::vector<std::string> remarks{};
};

enum class ResumeStepKind {
  CheckPosition,
  CheckTool,
  Prepare,   ///< modes in which the way there is told
  Retract,   ///< straight up
  SwitchOn,  ///< spindle, coolant, outputs
  Travel,    ///< across, at the safe height
  Offsets,
  Descend,  ///< rapid, not below anything that was cut
  Plunge,   ///< fed
  Modes,
  GoOn,  ///< the program
};
BOOST_DESCRIBE_ENUM(ResumeStepKind, CheckPosition, CheckTool, Prepare, Retract, SwitchOn, Travel, Offsets, Descend,
                    Plunge, Modes, GoOn)

struct ResumeStep {
  ResumeStepKind kind{};
  std::string text{};
  std::string reason{};
  /// What the controller is told.
  std::vector<std::string> lines{};
  /// The operator has to see to it.
  bool asks = false;
  bool operator==(const ResumeStep&) const = default;
};
BOOST_DESCRIBE_STRUCT(ResumeStep, (), (kind, text, reason, lines, asks))

enum class ResumeMotion { Rapid, Fed, Cut };
BOOST_DESCRIBE_ENUM(ResumeMotion, Rapid, Fed, Cut)

/// The end of a straight motion; the first point is where the machine stands. Machine coordinates, one number an axis.
/// `line` is that of the file; 0 on the way there.
struct ResumePoint {
  ResumeMotion kind{};
  std::vector<double> position_mm{};
  std::uint32_t line = 0;
  bool operator==(const ResumePoint&) const = default;
};
BOOST_DESCRIBE_STRUCT(ResumePoint, (), (kind, position_mm, line))

/// A line of the file that is sent otherwise: a mode of motion that needs axis words comes with it.
struct RewrittenLine {
  std::uint32_t line = 0;
  std::string text{};
  bool operator==(const RewrittenLine&) const = default;
};
BOOST_DESCRIBE_STRUCT(RewrittenLine, (), (line, text))

struct ResumePlan {
  std::string program{};
  /// The lines that may have been executing, and how that is known.
  ExecutingLines executing{};
  /// The first line of the file that is sent again.
  std::uint32_t from_line = 1;
  std::string from_because{};
  /// Nothing was cut before: the program runs from its beginning. Without steps the machine stands as it stood then.
  bool is_from_the_beginning = false;
  /// Machine coordinates are those of the homing switches, so the travel is known.
  bool is_homed = false;
  double safe_height_mm = 0;
  /// Nothing was cut above this so far; empty where nothing was cut.
  std::optional<double> highest_cut_mm{};
  std::vector<double> resume_position_mm{};
  double plunge_mm_per_min = 0;
  double spin_up_s = 0;
  std::vector<ResumeStep> steps{};
  std::vector<ResumePoint> path{};
  std::vector<std::string> warnings{};
  std::optional<RewrittenLine> rewritten{};

  /// Lines of all steps, in order.
  [[nodiscard]] std::vector<std::string> preamble() const;
  bool operator==(const ResumePlan&) const = default;
};
BOOST_DESCRIBE_STRUCT(ResumePlan, (),
                      (program, executing, from_line, from_because, is_from_the_beginning, is_homed, safe_height_mm,
                       highest_cut_mm, resume_position_mm, plunge_mm_per_min, spin_up_s, steps, path, warnings,
                       rewritten))

/// What to do so that `program` goes on, or why that cannot be said.
[[nodiscard]] std::expected<ResumePlan, ResumeRefusal> plan_resume(const Program& program, const ResumeFacts& facts,
                                                                   const ResumeChoice& choice);

/// A program that carries out a plan, and what the journal must know of it.
struct ResumedProgram {
  std::shared_ptr<const Program> program;
  JobOrigin origin;
};

/// The text of that program without a copy of the file: blank lines, which keep the numbers of those behind them, then
/// the plan's lines, then the rest of the file.
struct ResumedText {
  std::size_t blank_lines = 0;
  std::string head{};
  /// As long as the file's text lives.
  std::string_view rest{};
};
[[nodiscard]] ResumedText resumed_text(const Program& file, const ResumePlan& plan);
[[nodiscard]] JobOrigin origin_of(const ResumePlan& plan);

/// The plan's lines, then the rest of `file`. Lines keep their numbers where there is room before them for the plan's;
/// the origin tells in any case.
[[nodiscard]] ResumedProgram resumed_program(const Program& file, const ResumePlan& plan);

/// The plan for a terminal, a line each.
[[nodiscard]] std::vector<std::string> text_of(const ResumePlan& plan);

}  // namespace kerf::job
