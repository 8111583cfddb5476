#pragma once
// The journal of a world: what io's store would hold, in memory, with what a crash takes away.

#include <chrono>
#include <cstdint>
#include <deque>
#include <map>
#include <string>
#include <vector>

#include "common/base/time.hpp"
#include "sender/job/journal.hpp"

namespace kerf::simulation {

/// Numbers jobs from 1 over all sessions of a world, as the store does.
class MemoryJournal {
 public:
  /// A crash takes less than this; what is older is settled.
  static constexpr Duration kMostUnwritten = std::chrono::seconds{1};

  void append(std::vector<job::JournalRecord> records);
  /// While its disk is full, what it is told waits, as in the store.
  void fill_disk(bool is_full);
  /// The sender is gone, and what it told at `from` or later, in the last kMostUnwritten, was not written down.
  void lose_since(Instant from);

  /// The first has number 1.
  [[nodiscard]] std::vector<job::JobHistory> jobs() const;

 private:
  void write(std::vector<job::JournalRecord> records);

  bool is_full_ = false;
  std::vector<job::JournalRecord> waiting_;
  /// What no crash can take.
  std::vector<job::JobHistory> settled_;
  std::deque<job::JournalRecord> recent_;
  std::uint32_t jobs_ = 0;
  /// The session's number of a job -> the journal's.
  std::map<std::uint32_t, std::uint32_t> numbers_;
};

/// What it says of every job, a line each, for a transcript.
[[nodiscard]] std::string notes_of(const MemoryJournal& journal);

}  // namespace kerf::simulation
