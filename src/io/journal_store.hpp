#pragma once
// The journal on disk: docs/journal.md. An SQLite database in WAL mode with full synchronisation, written by a thread
// of its own: what the session tells is on the disk as soon as the disk allows, and the stream never waits for it.

#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "io/event_loop.hpp"
#include "io/journal_database.hpp"
#include "io/journal_options.hpp"
#include "sender/job/journal.hpp"

namespace kerf::io {

/// The database that the options name; empty without a home.
[[nodiscard]] std::string journal_path(const JournalOptions& options);

/// Writes the jobs of one session down. Made and used on the loop's thread; the writing is done by a thread that it
/// owns. Whatever the disk does, the job goes on: a fault is told once, and once more when it is over.
class JournalStore {
 public:
  /// Opens the database `path` in the background. `machine` is the address, as given.
  JournalStore(EventLoop& loop, std::string path, std::string machine,
               std::function<void(const std::string& sentence)> noted);
  /// Waits, but not for ever, until everything is written.
  ~JournalStore();
  JournalStore(const JournalStore&) = delete;
  JournalStore& operator=(const JournalStore&) = delete;

  /// Never waits. What no disk takes for long is thinned out: of how far a job was only the latest counts.
  void append(std::vector<job::JournalRecord> records);
  /// Waits until everything that was appended is on the disk, but no longer than `patience`, and not at all for a disk
  /// that is at fault. False when it is not, which is told.
  bool wait_until_written(std::chrono::milliseconds patience);

 private:
  struct Shared;
  std::shared_ptr<Shared> shared_;
};

/// Makes room in what could not be written yet: of how far a job was only the latest counts, and of its notes the
/// newest. Beginnings and ends stay whatever `most` is.
void thin_out(std::vector<DatedRecord>& records, std::size_t most);

}  // namespace kerf::io
