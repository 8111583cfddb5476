#include "io/journal_store.hpp"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <filesystem>
#include <iterator>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <thread>
#include <utility>
#include <variant>

#include "io/process_identity.hpp"
#include "io/state_folder.hpp"
#include "io/wall_clock.hpp"

namespace kerf::io {
namespace {

using namespace std::chrono_literals;

constexpr std::size_t kMostWaiting = 2000;
/// A disk that is full is not asked all the time.
constexpr auto kBetweenAttempts = 2s;
/// A disk that hangs must not keep the program from ending.
constexpr auto kLongestFarewell = 5s;

std::string sentence_of_fault(const JournalError& error) {
  return "The job is not written down, so it could not be resumed after a crash: " + error.sentence +
         (error.is_about_the_disk ? ". The job goes on; make room on the disk, or name another folder with --journal."
                                  : " The job goes on.");
}

}  // namespace

std::string journal_path(const JournalOptions& options) {
  const std::string folder = options.folder.empty() ? state_folder() : options.folder;
  return folder.empty() ? std::string() : (std::filesystem::path(folder) / "journal.db").string();
}

void thin_out(std::vector<DatedRecord>& records, std::size_t most) {
  if (records.size() <= most) return;
  // From the newest to the oldest: the first advance of a job that is met is its latest.
  std::set<std::uint32_t> told;
  std::vector<DatedRecord> kept;
  std::size_t notes_to_go = records.size() - most;
  for (const DatedRecord& dated : records) {
    if (std::holds_alternative<job::JobAdvanced>(dated.record.what) && notes_to_go > 0) --notes_to_go;
  }
  for (auto dated = records.rbegin(); dated != records.rend(); ++dated) {
    const bool is_advance = std::holds_alternative<job::JobAdvanced>(dated->record.what);
    if (is_advance && !told.insert(dated->record.job).second) continue;
    kept.push_back(std::move(*dated));
  }
  std::ranges::reverse(kept);
  std::erase_if(kept, [&notes_to_go](const DatedRecord& dated) {
    const bool goes = notes_to_go > 0 && std::holds_alternative<job::JobNoted>(dated.record.what);
    if (goes) --notes_to_go;
    return goes;
  });
  records = std::move(kept);
}

/// What both threads see. It outlives the store where a disk hangs.
struct JournalStore::Shared {
  Shared(EventLoop& its_loop, std::string its_path, std::string its_machine,
         std::function<void(const std::string&)> its_noted)
      : loop(its_loop), path(std::move(its_path)), machine(std::move(its_machine)), noted(std::move(its_noted)) {}

  /// Runs on the writer's thread until the end.
  void write_all();
  void say(std::string sentence);
  void write(std::vector<DatedRecord>& batch);

  EventLoop& loop;
  const std::string path;
  const std::string machine;
  const std::string process = process_identity();
  const std::function<void(const std::string&)> noted;

  std::mutex mutex;
  std::condition_variable changed;
  std::vector<DatedRecord> waiting;
  /// Nothing that was taken from `waiting` is on its way to the disk.
  bool is_all_written = true;
  /// The last attempt to write failed.
  bool is_at_fault = false;
  bool is_ending = false;
  bool has_ended = false;
  /// The store is gone, and maybe its loop too.
  bool is_abandoned = false;

  // The writer's own.
  std::optional<JournalDatabase> database;
  std::map<std::uint32_t, std::int64_t> numbers;
  bool has_fault = false;
};

void JournalStore::Shared::say(std::string sentence) {
  const std::lock_guard lock(mutex);
  if (is_abandoned) return;
  loop.post([told = noted, sentence = std::move(sentence)] {
    if (told) told(sentence);
  });
}

void JournalStore::Shared::write(std::vector<DatedRecord>& batch) {
  std::optional<JournalError> fault;
  if (!database) {
    auto opened = JournalDatabase::open(path);
    if (opened) {
      database.emplace(*std::move(opened));
      if (auto remark = database->take_remark(); !remark.empty()) say(std::move(remark));
    } else {
      fault = opened.error();
    }
  }
  if (database && !batch.empty()) {
    if (const auto written = database->write(batch, machine, process, numbers); !written) fault = written.error();
    // What broke while it was open is put aside, and begun anew, with the next attempt.
    if (fault && fault->is_damaged) database.reset();
  }
  if (!fault) batch.clear();
  if (fault && !has_fault) say(sentence_of_fault(*fault));
  if (!fault && has_fault) say("The job is written down again.");
  has_fault = fault.has_value();
}

void JournalStore::Shared::write_all() {
  std::vector<DatedRecord> batch;
  write(batch);  // so that the first record does not wait for the opening
  std::unique_lock lock(mutex);
  for (is_at_fault = has_fault;;) {
    const auto has_work = [this] { return is_ending || !waiting.empty(); };
    if (has_fault) {
      changed.wait_for(lock, kBetweenAttempts, [this] { return is_ending; });
    } else {
      changed.wait(lock, has_work);
    }
    const bool is_last = is_ending;
    std::ranges::move(waiting, std::back_inserter(batch));
    waiting.clear();
    is_all_written = batch.empty();
    lock.unlock();
    thin_out(batch, kMostWaiting);
    write(batch);
    if (is_last) database.reset();
    lock.lock();
    is_all_written = batch.empty();
    is_at_fault = has_fault;
    changed.notify_all();
    if (!is_last) continue;
    has_ended = true;
    changed.notify_all();
    return;
  }
}

JournalStore::JournalStore(EventLoop& loop, std::string path, std::string machine,
                           std::function<void(const std::string&)> noted)
    : shared_(std::make_shared<Shared>(loop, std::move(path), std::move(machine), std::move(noted))) {
  std::thread([shared = shared_] { shared->write_all(); }).detach();
}

JournalStore::~JournalStore() {
  std::unique_lock lock(shared_->mutex);
  shared_->is_ending = true;
  shared_->changed.notify_all();
  shared_->changed.wait_for(lock, kLongestFarewell, [this] { return shared_->has_ended; });
  shared_->is_abandoned = true;
}

void JournalStore::append(std::vector<job::JournalRecord> records) {
  if (records.empty()) return;
  const WallClock made = wall_clock_now();
  const std::lock_guard lock(shared_->mutex);
  for (job::JournalRecord& record : records) {
    shared_->waiting.push_back({.record = std::move(record), .made = made});
  }
  thin_out(shared_->waiting, kMostWaiting);
  shared_->changed.notify_all();
}

bool JournalStore::wait_until_written(std::chrono::milliseconds patience) {
  std::unique_lock lock(shared_->mutex);
  const auto is_written = [this] { return shared_->waiting.empty() && shared_->is_all_written; };
  shared_->changed.wait_for(lock, patience, [&] { return is_written() || shared_->is_at_fault; });
  if (is_written() || shared_->is_at_fault) return is_written();
  lock.unlock();
  shared_->say("The disk is slow: the beginning of this job is not written down yet. The job goes on.");
  return false;
}

}  // namespace kerf::io
