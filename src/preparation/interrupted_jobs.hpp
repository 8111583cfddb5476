#pragma once
// The jobs of a journal that could go on, and what their resuming begins from. Any thread.

#include <cstdint>
#include <expected>
#include <optional>
#include <string>
#include <vector>

#include <boost/describe.hpp>

#include "io/journal_database.hpp"
#include "preparation/resume_preparation.hpp"
#include "sender/job/executing_lines.hpp"
#include "sender/job/journal.hpp"

namespace kerf::preparation {

/// Whether a job's file is still what was cut.
enum class FileNow { Same, Changed, Missing, NotAFile, SavedSince };
BOOST_DESCRIBE_ENUM(FileNow, Same, Changed, Missing, NotAFile, SavedSince)

/// What one row of the list says. The member names are the keys of `kerf resume --list --json`.
struct InterruptedJob {
  std::int64_t number = 0;
  std::string program{};
  std::string path{};
  FileNow file = FileNow::Missing;
  std::string machine{};
  std::string began{};
  std::string stopped{};
  job::JobOutcome outcome = job::JobOutcome::CutOff;
  std::string why{};
  std::uint32_t lines = 0;
  std::uint32_t line_acknowledged = 0;
  std::uint32_t line_sent = 0;
  job::ExecutingLines executing{};
  bool position_suspect = false;
  std::uint64_t damaged_records = 0;
};
BOOST_DESCRIBE_STRUCT(InterruptedJob, (),
                      (number, program, path, file, machine, began, stopped, outcome, why, lines, line_acknowledged,
                       line_sent, executing, position_suspect, damaged_records))

/// The jobs that are neither complete nor running, and were not gone on with by a later one; in the order of `jobs`.
[[nodiscard]] std::vector<InterruptedJob> interrupted_jobs(const std::vector<io::JournaledJob>& jobs);

/// The job with that number, or the newest; one sentence where it cannot be resumed. It comes with the machine as it
/// was before the first line of the file.
[[nodiscard]] std::expected<InterruptedWork, std::string> find_interrupted_work(const io::JournalDatabase& journal,
                                                                                std::optional<std::int64_t> number);

}  // namespace kerf::preparation
