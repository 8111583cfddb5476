#include "simulation/memory_journal.hpp"

#include <algorithm>
#include <iterator>
#include <utility>
#include <variant>

#include <boost/describe/enum_to_string.hpp>

namespace kerf::simulation {
namespace {

void fold(std::vector<job::JobHistory>& jobs, const job::JournalRecord& record) {
  jobs.resize(std::max<std::size_t>(jobs.size(), record.job));
  jobs[record.job - 1].fold(record);
}

}  // namespace

void MemoryJournal::append(std::vector<job::JournalRecord> records) {
  if (!is_full_) return write(std::move(records));
  waiting_.insert(waiting_.end(), std::make_move_iterator(records.begin()), std::make_move_iterator(records.end()));
}

void MemoryJournal::fill_disk(bool is_full) {
  is_full_ = is_full;
  if (!is_full_) write(std::exchange(waiting_, {}));
}

void MemoryJournal::write(std::vector<job::JournalRecord> records) {
  for (job::JournalRecord& record : records) {
    if (std::holds_alternative<job::JobBegun>(record.what)) numbers_[record.job] = ++jobs_;
    record.job = numbers_.at(record.job);
    recent_.push_back(std::move(record));
  }
  while (!recent_.empty() && recent_.front().at < recent_.back().at - kMostUnwritten) {
    fold(settled_, recent_.front());
    recent_.pop_front();
  }
}

void MemoryJournal::lose_since(Instant from) {
  waiting_.clear();
  std::erase_if(recent_, [from](const job::JournalRecord& record) { return record.at >= from; });
  numbers_.clear();
  jobs_ = static_cast<std::uint32_t>(settled_.size());
  for (const job::JournalRecord& record : recent_) jobs_ = std::max(jobs_, record.job);
}

std::vector<job::JobHistory> MemoryJournal::jobs() const {
  std::vector<job::JobHistory> jobs = settled_;
  for (const job::JournalRecord& record : recent_) fold(jobs, record);
  return jobs;
}

std::string notes_of(const MemoryJournal& journal) {
  std::string text;
  int number = 0;
  for (const job::JobHistory& job : journal.jobs()) {
    const std::string start = "job " + std::to_string(++number) + " ";
    for (const job::TimedNote& timed : job.notes) {
      text += start + boost::describe::enum_to_string(timed.note.kind, "?") + " at line " +
              std::to_string(timed.note.line) + ": " + timed.note.text + "\n";
    }
  }
  return text;
}

}  // namespace kerf::simulation
