#pragma once
// Which lines of a program the machine may really be executing: never a guess, always an interval.

#include <cstdint>

#include <boost/describe.hpp>

namespace kerf::job {

/// What an interval of executing lines was concluded from, the weakest first.
enum class ExecutingKnownBy {
  Nothing,        ///< not known: `from` and `to` mean nothing
  Silence,        ///< the link was silent at `from`, and what was sent there may have got lost
  PlannerBlocks,  ///< what the planner can hold behind the line acknowledged last
  Position,       ///< where on the predicted path the machine was reported
  LineNumber,     ///< `Ln:` of a status report
};
BOOST_DESCRIBE_ENUM(ExecutingKnownBy, Nothing, Silence, PlannerBlocks, Position, LineNumber)

/// File lines from 1, both ends included: everything before `from` has surely been executed, nothing after `to` has
/// begun.
struct ExecutingLines {
  std::uint32_t from = 0;
  std::uint32_t to = 0;
  ExecutingKnownBy known_by = ExecutingKnownBy::Nothing;
  bool operator==(const ExecutingLines&) const = default;
};
BOOST_DESCRIBE_STRUCT(ExecutingLines, (), (from, to, known_by))

}  // namespace kerf::job
