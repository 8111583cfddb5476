#pragma once
// What a daemon remembers: programs, machines that were added, interrupted jobs that nobody wants to resume. An SQLite
// database; jobs themselves are in the journal. Loop's thread; every call takes about a millisecond.

#include <cstdint>
#include <expected>
#include <map>
#include <memory>
#include <set>
#include <string>

#include "daemon/machine_view.hpp"

namespace SQLite {
class Database;
}

namespace kerf::daemon {

/// A machine as it was added: how it is called and where it is.
struct MachineRow {
  std::string name;
  std::string url;
  bool operator==(const MachineRow&) const = default;
};

/// Every fault is one sentence.
class Store {
 public:
  [[nodiscard]] static std::expected<std::unique_ptr<Store>, std::string> open(const std::string& path);
  ~Store();
  Store(const Store&) = delete;
  Store& operator=(const Store&) = delete;

  /// By id.
  [[nodiscard]] std::map<std::string, ProgramView> programs() const;
  [[nodiscard]] std::expected<void, std::string> put_program(const std::string& id, const ProgramView& program);
  [[nodiscard]] std::expected<void, std::string> remove_program(const std::string& id);

  [[nodiscard]] std::map<std::string, MachineRow> machines() const;
  [[nodiscard]] std::expected<void, std::string> put_machine(const std::string& id, const MachineRow& machine);
  [[nodiscard]] std::expected<void, std::string> remove_machine(const std::string& id);

  /// Numbers of the journal.
  [[nodiscard]] std::set<std::int64_t> dismissed_jobs() const;
  [[nodiscard]] std::expected<void, std::string> dismiss_job(std::int64_t number);

 private:
  explicit Store(std::unique_ptr<SQLite::Database> database);

  std::unique_ptr<SQLite::Database> database_;
};

}  // namespace kerf::daemon
