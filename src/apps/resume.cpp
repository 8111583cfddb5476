// `kerf resume`: which jobs were interrupted.

#include <array>
#include <chrono>
#include <cstdint>
#include <ctime>
#include <filesystem>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "apps/commands.hpp"
#include "io/journal_database.hpp"
#include "io/journal_store.hpp"
#include "io/json.hpp"
#include "io/wall_clock.hpp"
#include "preparation/interrupted_jobs.hpp"

namespace kerf::apps {
namespace {

using preparation::FileNow;
using preparation::InterruptedJob;

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
    rows = preparation::interrupted_jobs(*jobs);
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
