// `kerf resume`: which jobs were interrupted.

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>
#include <vector>

#include <boost/describe.hpp>
#include <fmt/format.h>
#include <sys/stat.h>

#include "apps/commands.hpp"
#include "common/base/content_hash.hpp"
#include "io/journal_database.hpp"
#include "io/journal_store.hpp"
#include "io/json.hpp"
#include "io/wall_clock.hpp"

namespace kerf::apps {
namespace {

/// Whether a job's file is still what was cut.
enum class FileNow { Same, Changed, Missing, NotAFile, SavedSince };
BOOST_DESCRIBE_ENUM(FileNow, Same, Changed, Missing, NotAFile, SavedSince)

/// Files up to this size are compared for the list; resuming compares every one.
constexpr std::uint64_t kMostCompared = std::uint64_t{64} << 20U;
/// Byte order mark and end mark are in the file, and not in the size of the program.
constexpr std::uint64_t kMarks = 4;

std::string hash_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::vector<char> piece(std::size_t{1} << 20U);
  base::ContentHash hash;
  while (file.read(piece.data(), static_cast<std::streamsize>(piece.size())) || file.gcount() > 0) {
    hash.add({piece.data(), static_cast<std::size_t>(file.gcount())});
  }
  return hash.digits();
}

FileNow file_now(const job::JobBegun& begun, io::WallClock began) {
  const std::string& path = begun.origin.path;
  if (path.empty()) return FileNow::NotAFile;
  struct stat now{};
  if (::stat(path.c_str(), &now) != 0 || !S_ISREG(now.st_mode)) return FileNow::Missing;
  const auto size = static_cast<std::uint64_t>(now.st_size);
  const bool is_whole = begun.origin.file_hash.empty();
  if (is_whole && (size < begun.size_bytes || size > begun.size_bytes + kMarks)) return FileNow::Changed;
  // Content, name and owner are as they were before the job.
  const auto touched = std::chrono::seconds{std::max(now.st_ctim.tv_sec, now.st_mtim.tv_sec)};
  if (touched < began.time_since_epoch()) return FileNow::Same;
  if (size > kMostCompared) return FileNow::SavedSince;
  return hash_of(path) == (is_whole ? begun.hash : begun.origin.file_hash) ? FileNow::Same : FileNow::Changed;
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
                     .file = file_now(history.begun, job.began),
                     .machine = job.machine,
                     .began = io::to_string(job.began),
                     .stopped = io::to_string(job.last),
                     .outcome = history.outcome(),
                     .why = "Kerf was killed, or the computer lost its power.",
                     .lines = job::file_line_of(history.begun.origin, history.begun.lines),
                     .damaged_records = job.damaged_records};
  if (history.closed) {
    row.why = history.closed->state.reason;
    row.position_suspect = history.closed->state.position_suspect;
  }
  if (const auto* const last = history.latest()) {
    const auto file_line = [&history](std::uint32_t line) {
      return line == 0 ? 0 : job::file_line_of(history.begun.origin, line);
    };
    row.line_acknowledged = file_line(last->line_acknowledged);
    row.line_sent = file_line(last->line_sent);
    row.executing = {.from = file_line(last->executing.from),
                     .to = file_line(last->executing.to),
                     .known_by = last->executing.known_by};
  }
  return row;
}

/// Of the file, also where the job began in its middle.
std::string where_of(const InterruptedJob& row) {
  if (row.executing.known_by != job::ExecutingKnownBy::Nothing) {
    return row.executing.from == row.executing.to
               ? fmt::format("It was cutting line {} of {}.", row.executing.from, row.lines)
               : fmt::format("It was cutting line {} to {} of {}.", row.executing.from, row.executing.to, row.lines);
  }
  if (row.line_sent == 0) return "No line of it was sent.";
  return fmt::format("The machine had taken line {} of {}, and line {} was sent.", row.line_acknowledged, row.lines,
                     row.line_sent);
}

/// A moment of the journal as the clock on the wall shows it.
std::string clock_time(const std::string& moment) {
  const auto at = io::parse_wall_clock(moment);
  if (!at) return moment;
  const std::time_t seconds = std::chrono::system_clock::to_time_t(*at);
  std::tm local{};
  std::array<char, 40> text{};
  ::localtime_r(&seconds, &local);
  return {text.data(), std::strftime(text.data(), text.size(), "%Y-%m-%d %H:%M:%S", &local)};
}

std::string_view sentence_of(FileNow file) {
  switch (file) {
    case FileNow::Same: return "The file is as it was cut.";
    case FileNow::Changed: return "The file has changed since: it cannot be resumed without the old one.";
    case FileNow::Missing: return "The file is not there any more; --file names another place.";
    case FileNow::SavedSince: return "The file was saved since; resuming compares its content.";
    case FileNow::NotAFile: break;
  }
  return "It came from no file; --file names one.";
}

void print_row(const InterruptedJob& row) {
  const std::string name = row.path.empty() ? row.program : row.path;
  fmt::print("{:>5}  {}\n", row.number, name);
  fmt::print("       On {}, from {} to {}.\n", row.machine, clock_time(row.began), clock_time(row.stopped));
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
  if (rows.empty()) {
    fmt::print("No job was interrupted.\n");
    return ExitStatus::Done;
  }
  fmt::print("Interrupted jobs, the newest first:\n");
  for (const InterruptedJob& row : rows) print_row(row);
  fmt::print("kerf resume {} --dry-run shows how the first would go on; nothing moves.\n", rows.front().number);
  return ExitStatus::Done;
}

}  // namespace kerf::apps
