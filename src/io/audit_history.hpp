#pragma once
// The audits of all machines, in the database of the journal (docs/journal.md). One connection; one thread at a time.

#include <cstddef>
#include <cstdint>
#include <expected>
#include <memory>
#include <string>
#include <vector>

#include <boost/describe.hpp>

#include "io/journal_database.hpp"
#include "sender/job/position_audit.hpp"

namespace kerf::io {

/// One audit as it is kept.
struct KeptAudit {
  std::int64_t number = 0;
  /// The address of the machine, as it was given.
  std::string machine{};
  /// When it began.
  std::string began{};
  job::AuditResult result{};
};
BOOST_DESCRIBE_STRUCT(KeptAudit, (), (number, machine, began, result))

class AuditHistory {
 public:
  /// Makes the database when it is not there.
  [[nodiscard]] static std::expected<AuditHistory, JournalError> open(const std::string& path);
  AuditHistory(AuditHistory&&) noexcept;
  AuditHistory& operator=(AuditHistory&&) noexcept;
  ~AuditHistory();

  /// The number of the new one. It is on the disk when this returns, so that what an audit that is cut off has left
  /// undone can be found.
  [[nodiscard]] std::expected<std::int64_t, JournalError> begin(const std::string& machine,
                                                                const job::AuditResult& result);
  [[nodiscard]] std::expected<void, JournalError> update(std::int64_t number, const job::AuditResult& result);
  /// The newest first, at most so many; of one machine, unless that is empty.
  [[nodiscard]] std::expected<std::vector<KeptAudit>, JournalError> audits(const std::string& machine = {},
                                                                           std::size_t most = 100) const;

 private:
  explicit AuditHistory(std::unique_ptr<SQLite::Database> database);
  std::unique_ptr<SQLite::Database> database_;
};

}  // namespace kerf::io
