#include "io/journal_database.hpp"

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <utility>
#include <variant>

#include <SQLiteCpp/SQLiteCpp.h>
#include <SQLiteCpp/VariadicBind.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <sqlite3.h>
#include <unistd.h>

#include "common/base/content_hash.hpp"
#include "io/process_identity.hpp"
#include "sender/job/journal_text.hpp"

namespace kerf::io {
namespace {

namespace fs = std::filesystem;

constexpr int kSchemaVersion = 1;
constexpr int kBusyPatienceMs = 5000;
constexpr mode_t kOnlyMine = 0600;
/// Old JobAdvanced of a job are deleted whenever so many came in.
constexpr std::int64_t kBetweenDeletions = 64;

constexpr const char* kTables =
    "CREATE TABLE jobs("
    "  number INTEGER PRIMARY KEY AUTOINCREMENT,"
    "  machine TEXT NOT NULL,"
    "  process TEXT NOT NULL,"
    "  began TEXT NOT NULL"
    ") STRICT;"
    "CREATE TABLE records("
    "  job INTEGER NOT NULL,"
    "  serial INTEGER NOT NULL,"
    "  at_ns INTEGER NOT NULL,"
    "  made TEXT NOT NULL,"
    "  kind TEXT NOT NULL,"
    "  body TEXT NOT NULL,"
    "  checksum TEXT NOT NULL,"
    "  PRIMARY KEY(job, serial)"
    ") STRICT, WITHOUT ROWID;";

/// SQLite's pages carry no checksum: this one tells a record from what a disk made of it.
std::string checksum_of(std::string_view kind, std::string_view body) {
  return base::content_hash(std::string(kind) + " " + std::string(body)).substr(0, 16);
}

JournalError error_of(const SQLite::Exception& fault, const std::string& path) {
  const int code = fault.getErrorCode() & 0xFF;
  const bool is_damaged = code == SQLITE_CORRUPT || code == SQLITE_NOTADB;
  const bool is_disk =
      code == SQLITE_FULL || code == SQLITE_IOERR || code == SQLITE_CANTOPEN || code == SQLITE_READONLY;
  return {
      .sentence = fmt::format("{} ({})", path, fault.what()), .is_damaged = is_damaged, .is_about_the_disk = is_disk};
}

/// Runs `work`; what SQLite throws becomes a value.
template <typename Work>
auto guarded(const std::string& path, const Work& work) -> std::expected<decltype(work()), JournalError> {
  try {
    if constexpr (std::is_void_v<decltype(work())>) {
      work();
      return {};
    } else {
      return work();
    }
  } catch (const SQLite::Exception& fault) {
    return std::unexpected(error_of(fault, path));
  }
}

/// SQLite would make it readable for everybody.
std::expected<void, JournalError> make_private(const std::string& path) {
  std::error_code fault;
  const bool is_new = fs::create_directories(fs::path(path).parent_path(), fault);
  if (fault) {
    return std::unexpected(
        JournalError{.sentence = fmt::format("{} ({})", path, fault.message()), .is_about_the_disk = true});
  }
  if (is_new) fs::permissions(fs::path(path).parent_path(), fs::perms::owner_all, fault);
  const int descriptor = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, kOnlyMine);
  if (descriptor < 0) {
    return std::unexpected(JournalError{
        .sentence = fmt::format("{} ({})", path, std::generic_category().message(errno)), .is_about_the_disk = true});
  }
  ::close(descriptor);
  return {};
}

/// What was wrong with it: out of the way, so that people can look at it.
std::string put_aside(const std::string& path) {
  std::string moment = to_string(wall_clock_now());
  std::ranges::replace(moment, ':', '-');
  const std::string aside = path + ".damaged-" + moment;
  std::error_code ignored;
  for (const char* suffix : {"", "-wal", "-shm"}) fs::rename(path + suffix, aside + suffix, ignored);
  return aside;
}

}  // namespace

JournalDatabase::JournalDatabase(std::unique_ptr<SQLite::Database> database) : database_(std::move(database)) {}
JournalDatabase::JournalDatabase(JournalDatabase&&) noexcept = default;
JournalDatabase& JournalDatabase::operator=(JournalDatabase&&) noexcept = default;
JournalDatabase::~JournalDatabase() = default;

std::expected<JournalDatabase, JournalError> JournalDatabase::open(const std::string& path) {
  if (auto made = make_private(path); !made) return std::unexpected(made.error());
  auto opened = try_open(path);
  if (opened || !opened.error().is_damaged) return opened;
  const std::string aside = put_aside(path);
  if (auto made = make_private(path); !made) return std::unexpected(made.error());
  opened = try_open(path);
  if (!opened) return opened;
  const std::size_t saved = opened->take_over(aside);
  opened->remark_ = fmt::format(
      "The journal of jobs was damaged ({}). It is kept as {}; {} of its jobs could be read and are in the new one.",
      path, aside, saved);
  return opened;
}

std::expected<JournalDatabase, JournalError> JournalDatabase::try_open(const std::string& path) {
  using Opened = std::expected<JournalDatabase, JournalError>;
  auto opened = guarded(path, [&]() -> Opened {
    JournalDatabase journal(std::make_unique<SQLite::Database>(path, SQLite::OPEN_READWRITE, kBusyPatienceMs));
    SQLite::Database& database = *journal.database_;
    const int version = database.execAndGet("PRAGMA user_version").getInt();
    if (version > kSchemaVersion) {
      return std::unexpected(JournalError{
          .sentence = fmt::format("{} was written by a newer Kerf: use that one, or name another folder.", path)});
    }
    database.exec("PRAGMA journal_mode=WAL");
    database.exec("PRAGMA synchronous=FULL");
    if (version == 0) {
      journal.make_tables();
    } else if (const std::string verdict = database.execAndGet("PRAGMA quick_check(1)").getString(); verdict != "ok") {
      return std::unexpected(JournalError{.sentence = path + ": " + verdict, .is_damaged = true});
    }
    return journal;
  });
  if (!opened) return std::unexpected(opened.error());
  return *std::move(opened);
}

std::expected<JournalDatabase, JournalError> JournalDatabase::open_to_read(const std::string& path) {
  return guarded(path, [&] {
    // Not read-only: what a process that was killed left in the WAL has to be found first.
    return JournalDatabase(std::make_unique<SQLite::Database>(path, SQLite::OPEN_READWRITE, kBusyPatienceMs));
  });
}

void JournalDatabase::make_tables() {
  SQLite::Transaction transaction(*database_, SQLite::TransactionBehavior::IMMEDIATE);
  // Another Kerf may have been quicker.
  if (database_->execAndGet("PRAGMA user_version").getInt() == 0) {
    database_->exec(kTables);
    database_->exec(fmt::format("PRAGMA user_version={}", kSchemaVersion));
  }
  transaction.commit();
}

std::size_t JournalDatabase::take_over(const std::string& aside) {
  const auto damaged = open_to_read(aside);
  if (!damaged) return 0;
  const auto saved = guarded(aside, [&] {
    SQLite::Statement jobs(*damaged->database_, "SELECT number, machine, process, began FROM jobs ORDER BY number");
    std::size_t count = 0;
    while (jobs.executeStep()) {
      SQLite::Statement add(*database_, "INSERT INTO jobs(number, machine, process, began) VALUES(?, ?, ?, ?)");
      SQLite::bind(add, jobs.getColumn(0).getInt64(), jobs.getColumn(1).getString(), jobs.getColumn(2).getString(),
                   jobs.getColumn(3).getString());
      add.exec();
      take_over_records(*damaged, jobs.getColumn(0).getInt64());
      ++count;
    }
    return count;
  });
  return saved.value_or(database_->execAndGet("SELECT count(*) FROM jobs").getInt());
}

void JournalDatabase::take_over_records(const JournalDatabase& damaged, std::int64_t number) {
  // As far as they can be read: the rest of the job may be gone.
  static_cast<void>(guarded("", [&] {
    SQLite::Statement records(
        *damaged.database_,
        "SELECT serial, at_ns, made, kind, body, checksum FROM records WHERE job=? ORDER BY serial");
    records.bind(1, number);
    while (records.executeStep()) {
      SQLite::Statement add(*database_, "INSERT INTO records VALUES(?, ?, ?, ?, ?, ?, ?)");
      SQLite::bind(add, number, records.getColumn(0).getInt64(), records.getColumn(1).getInt64(),
                   records.getColumn(2).getString(), records.getColumn(3).getString(), records.getColumn(4).getString(),
                   records.getColumn(5).getString());
      add.exec();
    }
  }));
}

std::expected<void, JournalError> JournalDatabase::write(const std::vector<DatedRecord>& records,
                                                         std::string_view machine, std::string_view process,
                                                         std::map<std::uint32_t, std::int64_t>& numbers) {
  auto grown = numbers;
  auto written = guarded(database_->getFilename(), [&] {
    SQLite::Transaction transaction(*database_, SQLite::TransactionBehavior::IMMEDIATE);
    for (const DatedRecord& dated : records) write_one(dated, machine, process, grown);
    transaction.commit();
  });
  if (written) numbers = std::move(grown);
  return written;
}

void JournalDatabase::write_one(const DatedRecord& dated, std::string_view machine, std::string_view process,
                                std::map<std::uint32_t, std::int64_t>& numbers) {
  const job::JournalRecord& record = dated.record;
  if (std::holds_alternative<job::JobBegun>(record.what)) {
    SQLite::Statement add(*database_, "INSERT INTO jobs(machine, process, began) VALUES(?, ?, ?)");
    SQLite::bind(add, std::string(machine), std::string(process), to_string(dated.made));
    add.exec();
    numbers[record.job] = database_->getLastInsertRowid();
    forget_old_jobs();
  }
  const auto known = numbers.find(record.job);
  if (known == numbers.end()) return;  // its beginning was never written
  const std::string kind(kind_of(record));
  const std::string body = body_of(record);
  SQLite::Statement add(*database_,
                        "INSERT INTO records SELECT ?1, ifnull(max(serial), 0) + 1, ?2, ?3, ?4, ?5, ?6 FROM records "
                        "WHERE job=?1 RETURNING serial");
  SQLite::bind(add, known->second, static_cast<std::int64_t>(record.at.time_since_epoch().count()),
               to_string(dated.made), kind, body, checksum_of(kind, body));
  add.executeStep();
  const std::int64_t serial = add.getColumn(0).getInt64();
  add.reset();
  if (serial % kBetweenDeletions != 0) return;
  SQLite::Statement forget(*database_, "DELETE FROM records WHERE job=? AND kind='advanced' AND serial<?");
  SQLite::bind(forget, known->second, serial - static_cast<std::int64_t>(job::kAdvancesKept));
  forget.exec();
}

void JournalDatabase::forget_old_jobs() {
  SQLite::Statement limit(*database_, "SELECT number FROM jobs ORDER BY number DESC LIMIT 1 OFFSET ?");
  limit.bind(1, kJobsKept);
  if (!limit.executeStep()) return;
  const std::int64_t last = limit.getColumn(0).getInt64();
  for (const char* const forget : {"DELETE FROM records WHERE job<=?", "DELETE FROM jobs WHERE number<=?"}) {
    SQLite::Statement statement(*database_, forget);
    statement.bind(1, last);
    statement.exec();
  }
}

JournaledJob JournalDatabase::read_job(std::int64_t number, std::string machine, std::string_view process) const {
  JournaledJob job{.number = number, .machine = std::move(machine)};
  SQLite::Statement records(*database_,
                            "SELECT at_ns, made, kind, body, checksum FROM records WHERE job=? ORDER BY serial");
  records.bind(1, number);
  while (records.executeStep()) {
    const std::string kind = records.getColumn(2).getString();
    const std::string body = records.getColumn(3).getString();
    auto what = job::parse_body(kind, body);
    if (!what || checksum_of(kind, body) != records.getColumn(4).getString()) {
      ++job.damaged_records;
      continue;
    }
    const auto made = parse_wall_clock(records.getColumn(1).getString());
    if (made && job.began == WallClock{}) job.began = *made;
    if (made) job.last = *made;
    job.history.fold({.at = Instant{Duration{records.getColumn(0).getInt64()}}, .job = 0, .what = *std::move(what)});
  }
  job.is_running = !job.history.closed && io::is_running(process);
  return job;
}

std::expected<std::vector<JournaledJob>, JournalError> JournalDatabase::jobs(std::size_t most) const {
  return guarded(database_->getFilename(), [&] {
    std::vector<JournaledJob> found;
    SQLite::Statement jobs(*database_, "SELECT number, machine, process FROM jobs ORDER BY number DESC LIMIT ?");
    jobs.bind(1, static_cast<std::int64_t>(most));
    while (jobs.executeStep()) {
      found.push_back(
          read_job(jobs.getColumn(0).getInt64(), jobs.getColumn(1).getString(), jobs.getColumn(2).getString()));
    }
    return found;
  });
}

std::expected<std::optional<JournaledJob>, JournalError> JournalDatabase::job(std::int64_t number) const {
  return guarded(database_->getFilename(), [&]() -> std::optional<JournaledJob> {
    SQLite::Statement jobs(*database_, "SELECT number, machine, process FROM jobs WHERE number=?");
    jobs.bind(1, number);
    if (!jobs.executeStep()) return std::nullopt;
    return read_job(number, jobs.getColumn(1).getString(), jobs.getColumn(2).getString());
  });
}

}  // namespace kerf::io
