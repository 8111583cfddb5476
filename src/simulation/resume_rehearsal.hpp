#pragma once
// A plan to resume, carried out by the virtual controller before a real machine moves.

#include <cstdint>
#include <expected>
#include <string>

#include <boost/describe.hpp>

#include "sender/job/program.hpp"
#include "sender/job/resume_plan.hpp"
#include "sender/machine/capabilities.hpp"
#include "sender/machine/snapshot.hpp"

namespace kerf::simulation {

/// What a rehearsal showed that found nothing wrong.
struct ResumeRehearsal {
  /// Of the file: so far it went. The program may pause there for the operator.
  std::uint32_t last_line = 0;
  bool is_whole = false;
  /// Blocks that moved, and how long they took.
  std::uint32_t blocks = 0;
  double duration_s = 0;
  std::string sentence{};
  bool operator==(const ResumeRehearsal&) const = default;
};
BOOST_DESCRIBE_STRUCT(ResumeRehearsal, (), (last_line, is_whole, blocks, duration_s, sentence))

/// Carries out `plan`, then the rest of `file`, on a virtual machine with these settings that stands where `now` says,
/// with its offsets. Refuses when a line is refused, when anything leaves the travel, or when a rapid of the plan goes
/// sideways or down below the highest cut so far. Of a long program only the beginning is rehearsed, and `last_line`
/// says so.
[[nodiscard]] std::expected<ResumeRehearsal, job::ResumeRefusal> rehearse_resume(
    const job::Program& file, const job::ResumePlan& plan, const machine::Snapshot& now,
    const machine::Capabilities& capabilities);

}  // namespace kerf::simulation
