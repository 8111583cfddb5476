#pragma once
// The tables of a journal, and what is in them. One connection; one thread at a time.

#include <cstdint>
#include <expected>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "io/wall_clock.hpp"
#include "sender/job/journal.hpp"

namespace SQLite {
class Database;
}

namespace kerf::io {

/// A job as the journal has it.
struct JournaledJob {
  std::int64_t number = 0;
  /// The address of the machine, as it was given.
  std::string machine{};
  WallClock began{};
  /// When the last record was made.
  WallClock last{};
  /// The Kerf that runs it is still there.
  bool is_running = false;
  job::JobHistory history{};
  /// Records that could not be read any more.
  std::size_t damaged_records = 0;
};

/// Why there is no journal to work with, in one sentence.
struct JournalError {
  std::string sentence;
  /// The database itself is broken; another one in its place would do.
  bool is_damaged = false;
  /// The disk is full or cannot be written: it may do later.
  bool is_about_the_disk = false;
};

/// A record, and the time of day when it was made.
struct DatedRecord {
  job::JournalRecord record;
  WallClock made{};
};

class JournalDatabase {
 public:
  /// Opens it, and makes it when it is not there. A damaged one is put aside and what can be read of it is taken over;
  /// `take_remark()` says so.
  [[nodiscard]] static std::expected<JournalDatabase, JournalError> open(const std::string& path);
  /// Opens one that is there, and changes nothing.
  [[nodiscard]] static std::expected<JournalDatabase, JournalError> open_to_read(const std::string& path);
  JournalDatabase(JournalDatabase&&) noexcept;
  JournalDatabase& operator=(JournalDatabase&&) noexcept;
  ~JournalDatabase();

  /// All of them or none, on the disk when it returns. `numbers` maps a session's jobs to the journal's, and grows.
  [[nodiscard]] std::expected<void, JournalError> write(const std::vector<DatedRecord>& records,
                                                        std::string_view machine, std::string_view process,
                                                        std::map<std::uint32_t, std::int64_t>& numbers);

  /// The newest first, at most so many.
  [[nodiscard]] std::expected<std::vector<JournaledJob>, JournalError> jobs(std::size_t most = 200) const;
  [[nodiscard]] std::expected<std::optional<JournaledJob>, JournalError> job(std::int64_t number) const;

  [[nodiscard]] std::string take_remark() { return std::exchange(remark_, {}); }

 private:
  explicit JournalDatabase(std::unique_ptr<SQLite::Database> database);
  [[nodiscard]] static std::expected<JournalDatabase, JournalError> try_open(const std::string& path);
  void make_tables();
  /// The number of jobs that came with it.
  std::size_t take_over(const std::string& aside);
  void take_over_records(const JournalDatabase& damaged, std::int64_t number);
  void write_one(const DatedRecord& dated, std::string_view machine, std::string_view process,
                 std::map<std::uint32_t, std::int64_t>& numbers);
  void forget_old_jobs();
  [[nodiscard]] JournaledJob read_job(std::int64_t number, std::string machine, std::string_view process) const;

  std::unique_ptr<SQLite::Database> database_;
  std::string remark_;
};

/// So many jobs are kept.
inline constexpr int kJobsKept = 200;

}  // namespace kerf::io
