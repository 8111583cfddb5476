#include "preparation/interrupted_jobs.hpp"

#include <algorithm>
#include <chrono>
#include <fstream>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <sys/stat.h>

#include "common/base/content_hash.hpp"

namespace kerf::preparation {
namespace {

/// A job may continue another one, which may continue another one; a ring would be a broken journal.
constexpr int kMostContinued = 1000;

template <typename Value>
using Found = std::expected<Value, std::string>;

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

bool is_interrupted(const io::JournaledJob& job) {
  return !job.is_running && !job.history.begun.hash.empty() && job.history.outcome() != job::JobOutcome::Complete;
}

std::unexpected<std::string> unreadable(const io::JournalError& error) {
  return std::unexpected{"The journal of jobs cannot be read: " + error.sentence + "."};
}

/// The job that continues job `number`; empty if none does.
std::optional<std::int64_t> continued_by(const std::vector<io::JournaledJob>& jobs, std::int64_t number) {
  // Newest first.
  const auto next = std::ranges::find_if(jobs, [number](const io::JournaledJob& job) {
    return job.history.begun.origin.continues == number && !job.history.begun.hash.empty();
  });
  return next == jobs.end() ? std::nullopt : std::optional{next->number};
}

/// Why this job cannot be resumed; empty if it can.
std::string why_not(const io::JournaledJob& job, const std::vector<io::JournaledJob>& jobs) {
  if (job.is_running) {
    return fmt::format("Job {} is still running on {}: another Kerf has it. Stop it there first.", job.number,
                       job.machine);
  }
  if (const auto next = continued_by(jobs, job.number)) {
    return fmt::format("Job {} was gone on with as job {}: kerf resume {}.", job.number, *next, *next);
  }
  if (!is_interrupted(job)) {
    return fmt::format("Job {} ({}) ran to its end: there is nothing to resume. kerf run cuts it again.", job.number,
                       job.history.begun.program);
  }
  return {};
}

Found<io::JournaledJob> find_job(const io::JournalDatabase& journal, std::optional<std::int64_t> number) {
  auto jobs = journal.jobs();
  if (!jobs) return unreadable(jobs.error());
  // Newest first. Without a number the newest counts: one behind a complete job is history.
  const auto found = std::ranges::find_if(*jobs, [number](const io::JournaledJob& job) {
    return number ? job.number == *number : !job.is_running && !job.history.begun.hash.empty();
  });
  if (found == jobs->end()) {
    return std::unexpected{
        number ? fmt::format("There is no job {}: kerf resume --list shows those that can be resumed.", *number)
               : std::string{"No job was interrupted: there is nothing to resume."}};
  }
  const std::string why = why_not(*found, *jobs);
  if (why.empty()) return std::move(*found);
  return std::unexpected{number ? why : why + " To resume an older one, name it (kerf resume --list)."};
}

/// The machine before the first line of the file: that of the first job of the chain.
Found<job::MachineAtStart> start_of(const io::JournalDatabase& journal, const job::JobHistory& history) {
  job::JobBegun begun = history.begun;
  for (int i = 0; begun.origin.continues && i < kMostContinued; ++i) {
    auto before = journal.job(*begun.origin.continues);
    if (!before || !*before) {
      return std::unexpected{"Job " + std::to_string(*begun.origin.continues) +
                             ", which this one continues, is not in the journal any more."};
    }
    begun = (*before)->history.begun;
  }
  return begun.machine;
}

}  // namespace

std::vector<InterruptedJob> interrupted_jobs(const std::vector<io::JournaledJob>& jobs) {
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

std::expected<InterruptedWork, std::string> find_interrupted_work(const io::JournalDatabase& journal,
                                                                  std::optional<std::int64_t> number) {
  auto found = find_job(journal, number);
  if (!found) return std::unexpected{found.error()};
  auto start = start_of(journal, found->history);
  if (!start) return std::unexpected{start.error()};
  return InterruptedWork{.number = found->number,
                         .machine = std::move(found->machine),
                         .history = std::move(found->history),
                         .file_start = *std::move(start)};
}

}  // namespace kerf::preparation
