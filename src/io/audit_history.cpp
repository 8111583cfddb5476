#include "io/audit_history.hpp"

#include <optional>
#include <utility>

#include <SQLiteCpp/SQLiteCpp.h>
#include <SQLiteCpp/VariadicBind.h>

#include "io/json.hpp"
#include "io/wall_clock.hpp"

namespace kerf::io {
namespace {

constexpr int kBusyPatienceMs = 5000;
constexpr const char* kTable =
    "CREATE TABLE IF NOT EXISTS audits("
    "  number INTEGER PRIMARY KEY AUTOINCREMENT,"
    "  machine TEXT NOT NULL,"
    "  began TEXT NOT NULL,"
    "  body TEXT NOT NULL"
    ") STRICT";

/// Runs `work`; what SQLite throws becomes a value.
template <typename Work>
auto guarded(const Work& work) -> std::expected<decltype(work()), JournalError> {
  try {
    if constexpr (std::is_void_v<decltype(work())>) {
      work();
      return {};
    } else {
      return work();
    }
  } catch (const SQLite::Exception& fault) {
    return std::unexpected(JournalError{.sentence = fault.what()});
  }
}

template <typename Enum>
Enum enum_of(const Json& json, const char* key, Enum otherwise) {
  Enum value = otherwise;
  const std::string name = json.value(key, "");
  return boost::describe::enum_from_string(name.c_str(), value) ? value : otherwise;
}

template <typename Number>
std::optional<Number> number_of(const Json& json, const char* key) {
  const auto found = json.find(key);
  if (found == json.end() || !found->is_number()) return std::nullopt;
  return found->get<Number>();
}

job::AuditResult parse_result(const std::string& body) {
  const Json json = Json::parse(body, nullptr, false);
  if (!json.is_object()) return {.sentence = "What was kept of it is damaged."};
  job::AuditResult result{.outcome = enum_of(json, "outcome", job::AuditOutcome::Unfinished),
                          .sentence = json.value("sentence", ""),
                          .tolerance_mm = json.value("tolerance_mm", 0.0),
                          .is_homed = json.value("is_homed", false)};
  for (const Json& axis : json.value("axes", Json::array())) {
    result.axes.push_back({.axis = axis.value("axis", ""),
                           .verdict = enum_of(axis, "verdict", job::AxisVerdict::NotMeasured),
                           .difference_mm = number_of<double>(axis, "difference_mm"),
                           .difference_steps = number_of<std::int64_t>(axis, "difference_steps"),
                           .before_mm = number_of<double>(axis, "before_mm"),
                           .after_mm = number_of<double>(axis, "after_mm"),
                           .step_mm = axis.value("step_mm", 0.0)});
  }
  for (const Json& setting : json.value("left_off", Json::array())) {
    result.left_off.push_back({.id = setting.value("id", ""), .value = setting.value("value", "")});
  }
  return result;
}

}  // namespace

AuditHistory::AuditHistory(std::unique_ptr<SQLite::Database> database) : database_(std::move(database)) {}
AuditHistory::AuditHistory(AuditHistory&&) noexcept = default;
AuditHistory& AuditHistory::operator=(AuditHistory&&) noexcept = default;
AuditHistory::~AuditHistory() = default;

std::expected<AuditHistory, JournalError> AuditHistory::open(const std::string& path) {
  // The journal itself sees to the file: its mode, its state after a crash.
  if (const auto journal = JournalDatabase::open(path); !journal) return std::unexpected(journal.error());
  return guarded([&] {
    auto database = std::make_unique<SQLite::Database>(path, SQLite::OPEN_READWRITE, kBusyPatienceMs);
    database->exec("PRAGMA synchronous=FULL");
    database->exec(kTable);
    return AuditHistory(std::move(database));
  });
}

std::expected<std::int64_t, JournalError> AuditHistory::begin(const std::string& machine,
                                                              const job::AuditResult& result) {
  return guarded([&]() -> std::int64_t {
    SQLite::Statement add(*database_, "INSERT INTO audits(machine, began, body) VALUES(?, ?, ?)");
    SQLite::bind(add, machine, to_string(wall_clock_now()), print(to_json(result)));
    add.exec();
    return database_->getLastInsertRowid();
  });
}

std::expected<void, JournalError> AuditHistory::update(std::int64_t number, const job::AuditResult& result) {
  return guarded([&] {
    SQLite::Statement change(*database_, "UPDATE audits SET body=? WHERE number=?");
    SQLite::bind(change, print(to_json(result)), number);
    change.exec();
  });
}

std::expected<std::vector<KeptAudit>, JournalError> AuditHistory::audits(const std::string& machine,
                                                                         std::size_t most) const {
  return guarded([&] {
    std::vector<KeptAudit> found;
    SQLite::Statement rows(*database_,
                           "SELECT number, machine, began, body FROM audits WHERE ?1='' OR machine=?1 "
                           "ORDER BY number DESC LIMIT ?2");
    SQLite::bind(rows, machine, static_cast<std::int64_t>(most));
    while (rows.executeStep()) {
      found.push_back({.number = rows.getColumn(0).getInt64(),
                       .machine = rows.getColumn(1).getString(),
                       .began = rows.getColumn(2).getString(),
                       .result = parse_result(rows.getColumn(3).getString())});
    }
    return found;
  });
}

}  // namespace kerf::io
