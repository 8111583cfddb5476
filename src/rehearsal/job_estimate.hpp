#pragma once
// How long a program takes on a machine, and what the time is spent on: the program as Kerf would send it, cut by the
// virtual controller with the machine's settings.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <boost/describe.hpp>

#include "sender/job/program.hpp"
#include "simulation/case_runner.hpp"
#include "simulation/motion_trace.hpp"

namespace kerf::rehearsal {

/// Seconds; together the whole time.
struct UseOfTime {
  double cutting_s = 0;
  double rapid_s = 0;
  double dwell_s = 0;        ///< G4
  double tool_change_s = 0;  ///< what the controller itself does at M6; nobody knows how long a person takes
  double other_s = 0;        ///< spindle delays, waiting for lines, and standing still for other reasons
};
BOOST_DESCRIBE_STRUCT(UseOfTime, (), (cutting_s, rapid_s, dwell_s, tool_change_s, other_s))

/// A tool or an operation: what was done with it, in all its places.
struct PartEstimate {
  std::string name;
  std::uint32_t first_line = 0;
  std::uint32_t last_line = 0;
  double total_s = 0;
  double cutting_mm = 0;
  double rapid_mm = 0;
};
BOOST_DESCRIBE_STRUCT(PartEstimate, (), (name, first_line, last_line, total_s, cutting_mm, rapid_mm))

/// Cutting moves with a programmed feed from this one up to the next bin's, mm/min.
struct FeedBin {
  double from_mm_per_min = 0;
  double total_s = 0;
  double cutting_mm = 0;
};
BOOST_DESCRIBE_STRUCT(FeedBin, (), (from_mm_per_min, total_s, cutting_mm))

struct JobEstimate {
  double total_s = 0;
  std::size_t blocks = 0;
  std::uint32_t lines = 0;
  std::uint32_t lines_answered = 0;
  UseOfTime use{};
  double cutting_mm = 0;
  double rapid_mm = 0;
  /// In the order in which they first cut; before the first is told, "".
  std::vector<PartEstimate> tools;
  std::vector<PartEstimate> operations;
  /// Those that occur, lowest feed first.
  std::vector<FeedBin> feeds;
  /// Lines at which the program waits for the operator.
  std::vector<std::uint32_t> stops;
  std::vector<simulation::RefusedLine> errors;
  std::vector<int> alarms;
  /// Ends, in seconds, of equal shares of the lines: to compare two estimates of one program.
  std::vector<double> marks_s;
};

/// Lines that take longer than they have to.
struct LostTime {
  std::uint32_t first_line = 0;
  std::uint32_t last_line = 0;
  double lost_s = 0;
};
BOOST_DESCRIBE_STRUCT(LostTime, (), (first_line, last_line, lost_s))

/// Over `link`, from a cutter at rest at the machine's zero, with overrides of 100 %.
[[nodiscard]] JobEstimate estimate_job(const job::Program& program, const simulation::CaseMachine& machine,
                                       simulation::ProgramLink link = {});

/// Where `world` needs longer than `planner`: there the link cannot keep the planner full. The longest loss comes
/// first.
[[nodiscard]] std::vector<LostTime> lost_on_the_link(const JobEstimate& planner, const JobEstimate& world);

}  // namespace kerf::rehearsal
