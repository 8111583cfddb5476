#include "sender/job/journal.hpp"

#include "common/base/overloaded.hpp"

namespace kerf::job {

std::uint32_t file_line_of(const JobOrigin& origin, std::uint32_t line) {
  if (line <= origin.preamble_lines) return origin.first_line;
  return line - origin.preamble_lines + origin.first_line - 1;
}

void JobHistory::fold(const JournalRecord& record) {
  last_at = record.at;
  std::visit(base::Overloaded{
                 [&](const JobBegun& first) {
                   begun = first;
                   began_at = record.at;
                 },
                 [&](const JobAdvanced& advanced) {
                   if (advances.size() >= 2 * kAdvancesKept) {
                     advances.erase(advances.begin(), advances.end() - kAdvancesKept);
                   }
                   advances.push_back(advanced);
                 },
                 [&](const JobNoted& note) { notes.push_back({.at = record.at, .note = note}); },
                 [&](const JobClosed& last) { closed = last; },
             },
             record.what);
}

JobOutcome JobHistory::outcome() const {
  if (!closed) return JobOutcome::CutOff;
  return closed->state.phase == JobPhase::Finished ? JobOutcome::Complete : JobOutcome::Unfinished;
}

}  // namespace kerf::job
