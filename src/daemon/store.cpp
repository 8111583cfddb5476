#include "daemon/store.hpp"

#include <filesystem>
#include <system_error>
#include <utility>

#include <SQLiteCpp/SQLiteCpp.h>
#include <SQLiteCpp/VariadicBind.h>
#include <fmt/format.h>

namespace kerf::daemon {
namespace {

namespace fs = std::filesystem;

constexpr int kBusyPatienceMs = 5000;

constexpr const char* kTables =
    "CREATE TABLE IF NOT EXISTS programs("
    "  id TEXT PRIMARY KEY,"
    "  name TEXT NOT NULL,"
    "  bytes INTEGER NOT NULL,"
    "  lines INTEGER NOT NULL,"
    "  added_at TEXT NOT NULL,"
    "  example INTEGER NOT NULL"
    ") STRICT;"
    "CREATE TABLE IF NOT EXISTS machines(id TEXT PRIMARY KEY, name TEXT NOT NULL, url TEXT NOT NULL) STRICT;"
    "CREATE TABLE IF NOT EXISTS dismissed_jobs(number INTEGER PRIMARY KEY) STRICT;";

/// Runs one statement with these values.
template <typename... Values>
std::expected<void, std::string> carry_out(SQLite::Database& database, const char* sql, const Values&... values) {
  try {
    SQLite::Statement statement(database, sql);
    SQLite::bind(statement, values...);
    statement.exec();
    return {};
  } catch (const SQLite::Exception& error) {
    return std::unexpected(fmt::format("This cannot be remembered ({}).", error.what()));
  }
}

}  // namespace

Store::Store(std::unique_ptr<SQLite::Database> database) : database_(std::move(database)) {}
Store::~Store() = default;

std::expected<std::unique_ptr<Store>, std::string> Store::open(const std::string& path) {
  std::error_code fault;
  fs::create_directories(fs::path(path).parent_path(), fault);
  if (fault) {
    return std::unexpected(fmt::format("Nothing can be kept in {} ({}): name another folder with --state.",
                                       fs::path(path).parent_path().string(), fault.message()));
  }
  try {
    auto database =
        std::make_unique<SQLite::Database>(path, SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE, kBusyPatienceMs);
    database->exec("PRAGMA journal_mode=WAL");
    database->exec("PRAGMA synchronous=NORMAL");
    database->exec(kTables);
    return std::unique_ptr<Store>(new Store(std::move(database)));
  } catch (const SQLite::Exception& error) {
    return std::unexpected(fmt::format("{} cannot be opened ({}). Move it away, or name another folder with --state.",
                                       path, error.what()));
  }
}

std::map<std::string, ProgramView> Store::programs() const {
  std::map<std::string, ProgramView> programs;
  SQLite::Statement rows(*database_, "SELECT id, name, bytes, lines, added_at, example FROM programs");
  while (rows.executeStep()) {
    programs[rows.getColumn(0).getString()] = {.name = rows.getColumn(1).getString(),
                                               .bytes = static_cast<std::uint64_t>(rows.getColumn(2).getInt64()),
                                               .lines = static_cast<std::uint64_t>(rows.getColumn(3).getInt64()),
                                               .added_at = rows.getColumn(4).getString(),
                                               .example = rows.getColumn(5).getInt() != 0};
  }
  return programs;
}

std::expected<void, std::string> Store::put_program(const std::string& id, const ProgramView& program) {
  return carry_out(*database_, "INSERT OR REPLACE INTO programs VALUES(?, ?, ?, ?, ?, ?)", id, program.name,
                   static_cast<std::int64_t>(program.bytes), static_cast<std::int64_t>(program.lines), program.added_at,
                   program.example ? 1 : 0);
}

std::expected<void, std::string> Store::remove_program(const std::string& id) {
  return carry_out(*database_, "DELETE FROM programs WHERE id=?", id);
}

std::map<std::string, MachineRow> Store::machines() const {
  std::map<std::string, MachineRow> machines;
  SQLite::Statement rows(*database_, "SELECT id, name, url FROM machines");
  while (rows.executeStep()) {
    machines[rows.getColumn(0).getString()] = {.name = rows.getColumn(1).getString(),
                                               .url = rows.getColumn(2).getString()};
  }
  return machines;
}

std::expected<void, std::string> Store::put_machine(const std::string& id, const MachineRow& machine) {
  return carry_out(*database_, "INSERT OR REPLACE INTO machines VALUES(?, ?, ?)", id, machine.name, machine.url);
}

std::expected<void, std::string> Store::remove_machine(const std::string& id) {
  return carry_out(*database_, "DELETE FROM machines WHERE id=?", id);
}

std::set<std::int64_t> Store::dismissed_jobs() const {
  std::set<std::int64_t> numbers;
  SQLite::Statement rows(*database_, "SELECT number FROM dismissed_jobs");
  while (rows.executeStep()) numbers.insert(rows.getColumn(0).getInt64());
  return numbers;
}

std::expected<void, std::string> Store::dismiss_job(std::int64_t number) {
  return carry_out(*database_, "INSERT OR IGNORE INTO dismissed_jobs VALUES(?)", number);
}

}  // namespace kerf::daemon
