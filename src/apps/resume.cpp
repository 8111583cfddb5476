// `kerf resume`: which jobs were interrupted.

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include <boost/describe.hpp>
#include <fmt/format.h>

#include "apps/commands.hpp"
#include "common/base/content_hash.hpp"
#include "io/journal_database.hpp"
#include "io/journal_store.hpp"
#include "io/json.hpp"
#include "io/text_file.hpp"

namespace kerf::apps {
namespace {

/// Whether a job's file is still what was cut.
enum class FileNow { Same, Changed, Missing, NotAFile };
BOOST_DESCRIBE_ENUM(FileNow, Same, Changed, Missing, NotAFile)

FileNow file_now(const job::JobBegun& begun) {
  if (begun.origin.path.empty()) return FileNow::NotAFile;
  const auto text = io::read_text_file(begun.origin.path);
  if (!text) return FileNow::Missing;
  const std::string& then = begun.origin.file_hash.empty() ? begun.hash : begun.origin.file_hash;
  return base::content_hash(*text) == then ? FileNow::Same : FileNow::Changed;
}

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

InterruptedJob row_of(const io::JournaledJob& job) {
  const job::JobHistory& history = job.history;
  InterruptedJob row{.number = job.number,
                     .program = history.begun.program,
                     .path = history.begun.origin.path,
                     .file = file_now(history.begun),
                     .machine = job.machine,
                     .began = io::to_string(job.began),
                     .stopped = io::to_string(job.last),
                     .outcome = history.outcome(),
                     .why = "Kerf was killed, or the computer lost its power.",
                     .lines = history.begun.lines,
                     .damaged_records = job.damaged_records};
  if (history.closed) {
    row.why = history.closed->state.reason;
    row.position_suspect = history.closed->state.position_suspect;
  }
  if (const auto* const last = history.latest()) {
    row.line_acknowledged = last->line_acknowledged;
    row.line_sent = last->line_sent;
    row.executing = last->executing;
  }
  return row;
}

std::string where_of(const InterruptedJob& row) {
  if (row.executing.known_by != job::ExecutingKnownBy::Nothing) {
    return row.executing.from == row.executing.to
               ? fmt::format("It was cutting line {} of {}.", row.executing.from, row.lines)
               : fmt::format("It was cutting a line from {} to {} of {}.", row.executing.from, row.executing.to,
                             row.lines);
  }
  return fmt::format("Line {} of {} was taken last, line {} sent last.", row.line_acknowledged, row.lines,
                     row.line_sent);
}

std::string_view sentence_of(FileNow file) {
  switch (file) {
    case FileNow::Same: return "The file is unchanged.";
    case FileNow::Changed: return "The file is not the same any more.";
    case FileNow::Missing: return "The file is not there any more.";
    case FileNow::NotAFile: break;
  }
  return "It came from no file.";
}

void print_row(const InterruptedJob& row) {
  fmt::print("{:>5}  {}  on {}, begun {}, stopped {}\n", row.number, row.program, row.machine, row.began, row.stopped);
  fmt::print("       {} {}\n       {}\n", row.why, where_of(row), sentence_of(row.file));
  if (row.damaged_records > 0) {
    fmt::print("       {} records of it in the journal were damaged and are passed over.\n", row.damaged_records);
  }
}

/// Neither complete nor running, and not gone on with by a later one.
std::vector<InterruptedJob> interrupted(const std::vector<io::JournaledJob>& jobs) {
  std::set<std::int64_t> continued;
  for (const io::JournaledJob& job : jobs) {
    if (job.history.begun.origin.continues) continued.insert(*job.history.begun.origin.continues);
  }
  std::vector<InterruptedJob> rows;
  for (const io::JournaledJob& job : jobs) {
    const bool is_over = job.history.outcome() == job::JobOutcome::Complete;
    if (is_over || job.is_running || continued.contains(job.number) || job.history.begun.hash.empty()) continue;
    rows.push_back(row_of(job));
  }
  return rows;
}

}  // namespace

ExitStatus resume(const ResumeOptions& options) {
  if (!options.list) return resume_job(options);
  const std::string path = io::journal_path(options.recording.journal);
  std::vector<InterruptedJob> rows;
  if (!path.empty() && std::filesystem::exists(path)) {
    const auto journal = io::JournalDatabase::open_to_read(path);
    const auto jobs = journal ? journal->jobs() : std::unexpected(journal.error());
    if (!jobs) {
      complain("The journal of jobs cannot be read: " + jobs.error().sentence + ".");
      return ExitStatus::Usage;
    }
    rows = interrupted(*jobs);
  }
  if (options.json) {
    fmt::print("{}\n", io::print(io::to_json(rows)));
    return ExitStatus::Done;
  }
  if (rows.empty()) fmt::print("No job was interrupted.\n");
  for (const InterruptedJob& row : rows) print_row(row);
  return ExitStatus::Done;
}

}  // namespace kerf::apps
