#include "io/journal_store.hpp"

#include <array>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "io/process_identity.hpp"

namespace kerf::io {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

job::JournalRecord begun(std::uint32_t job = 1) {
  return {.at = Instant{1s}, .job = job, .what = job::JobBegun{.program = "part.nc", .hash = "ab", .lines = 9000}};
}

job::JournalRecord advanced(std::uint32_t line, std::uint32_t job = 1) {
  return {.at = Instant{1s} + line * 40ms, .job = job, .what = job::JobAdvanced{.line_acknowledged = line}};
}

job::JournalRecord noted(std::string text, std::uint32_t job = 1) {
  return {.job = job, .what = job::JobNoted{.text = std::move(text)}};
}

/// The size that a file may have, for a while: what a full disk is to a program.
class FullDisk {
 public:
  explicit FullDisk(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{.rlim_cur = bytes, .rlim_max = before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FullDisk() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }
  FullDisk(const FullDisk&) = delete;
  FullDisk& operator=(const FullDisk&) = delete;

 private:
  rlimit before_{};
  void (*handler_)(int);
};

class Journal : public testing::Test {
 protected:
  Journal() : folder_(fs::path(testing::TempDir()) / ("kerf-journal-" + std::to_string(::getpid()))) {
    fs::remove_all(folder_);
  }
  ~Journal() override { fs::remove_all(folder_); }

  [[nodiscard]] std::string path() const { return journal_path({.keeps = true, .folder = folder_.string()}); }
  [[nodiscard]] std::vector<JournaledJob> jobs() const {
    const auto opened = JournalDatabase::open_to_read(path());
    if (!opened) return {};
    return opened->jobs().value_or(std::vector<JournaledJob>{});
  }
  /// Everything that was appended is on the disk when it returns.
  void write(std::vector<job::JournalRecord> records) {
    EventLoop loop;
    {
      JournalStore store(loop, path(), "/dev/ttyUSB0", [this](const std::string& said) { said_.push_back(said); });
      store.append(std::move(records));
    }
    loop.post([&loop] { loop.stop(); });
    loop.run();
  }
  void garble(const std::string& file, std::streamoff from, std::size_t bytes) {
    std::fstream stream(file, std::ios::in | std::ios::out | std::ios::binary);
    stream.seekp(from);
    stream << std::string(bytes, '\x5A');
  }

  fs::path folder_;
  std::vector<std::string> said_;
};

TEST_F(Journal, GivesBackWhatWasWritten) {
  write({begun(), advanced(5), noted("x"), advanced(6)});
  write({begun(), {.job = 1, .what = job::JobClosed{}}});
  EXPECT_THAT(said_, IsEmpty());
  const auto found = jobs();
  ASSERT_THAT(found, SizeIs(2));
  EXPECT_EQ(found[0].number, 2);
  EXPECT_EQ(found[1].number, 1);
  EXPECT_EQ(found[1].machine, "/dev/ttyUSB0");
  EXPECT_EQ(found[1].history.latest()->line_acknowledged, 6U);
  EXPECT_EQ(found[1].history.latest(), &found[1].history.advances[1]);
  EXPECT_THAT(found[1].history.notes, SizeIs(1));
  EXPECT_TRUE(found[1].is_running);  // by this very process
  EXPECT_FALSE(found[0].is_running);
  EXPECT_LT(wall_clock_now() - found[1].began, 60s);
  struct stat status{};
  ASSERT_EQ(::stat(path().c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777U, 0600U);
}

TEST_F(Journal, TellsWhenItIsOnTheDisk) {
  EventLoop loop;
  JournalStore store(loop, path(), "m", [this](const std::string& said) { said_.push_back(said); });
  store.append({begun()});
  EXPECT_TRUE(store.wait_until_written(20s));
  EXPECT_THAT(jobs(), SizeIs(1));
  store.append({advanced(8), noted("x")});
  EXPECT_TRUE(store.wait_until_written(20s));
  EXPECT_EQ(jobs().at(0).history.latest()->line_acknowledged, 8U);
}

TEST_F(Journal, NobodyWaitsForADiskThatIsAtFault) {
  EventLoop loop;
  std::ofstream(folder_) << "a file where the folder should be";
  JournalStore store(loop, path(), "m", [this](const std::string& said) { said_.push_back(said); });
  store.append({begun()});
  const auto before = std::chrono::steady_clock::now();
  EXPECT_FALSE(store.wait_until_written(60s));
  EXPECT_LT(std::chrono::steady_clock::now() - before, 30s);
  loop.post([&loop] { loop.stop(); });
  loop.run();
  EXPECT_THAT(said_, SizeIs(1));
}

TEST_F(Journal, KeepsTheLatestOfManyAdvances) {
  std::vector<job::JournalRecord> records{begun(), noted("x")};
  for (std::uint32_t line = 1; line <= 1500; ++line) records.push_back(advanced(line));
  write(std::move(records));
  const auto found = jobs();
  ASSERT_THAT(found, SizeIs(1));
  EXPECT_EQ(found[0].history.latest()->line_acknowledged, 1500U);
  EXPECT_LT(found[0].history.advances.size(), 600U);
  EXPECT_THAT(found[0].history.notes, SizeIs(1));
}

TEST_F(Journal, AGarbledRecordIsPassedOver) {
  write({begun(), noted("this was written to be found"), advanced(6)});
  std::ifstream stream(path(), std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(stream), {}};
  const auto at = bytes.find("written to be");
  ASSERT_NE(at, std::string::npos);
  garble(path(), static_cast<std::streamoff>(at), 4);
  const auto found = jobs();
  ASSERT_THAT(found, SizeIs(1));
  EXPECT_EQ(found[0].damaged_records, 1U);
  EXPECT_EQ(found[0].history.latest()->line_acknowledged, 6U);
}

TEST_F(Journal, WhatIsNoDatabaseIsPutAside) {
  fs::create_directories(folder_);
  std::ofstream(path()) << "this is no database, but somebody's shopping list: milk, bread, end mills";
  write({begun(), advanced(6)});
  EXPECT_THAT(jobs(), SizeIs(1));
  ASSERT_THAT(said_, SizeIs(1));
  EXPECT_THAT(said_[0], HasSubstr("damaged"));
}

TEST_F(Journal, WhatCanBeReadOfADamagedOneIsTakenOver) {
  std::vector<job::JournalRecord> records{begun()};
  for (int note = 0; note < 500; ++note) records.push_back(noted("note " + std::to_string(note)));
  write(std::move(records));
  write({begun(), advanced(7)});
  const auto size = static_cast<std::streamoff>(fs::file_size(path()));
  garble(path(), size / 2, 8192);
  write({begun(), advanced(8)});
  ASSERT_FALSE(said_.empty());
  EXPECT_THAT(said_[0], HasSubstr("damaged"));
  EXPECT_EQ(jobs().at(0).history.latest()->line_acknowledged, 8U);
}

TEST_F(Journal, ATruncatedOneDoesNotKeepAnybodyFromWorking) {
  write({begun(), advanced(6)});
  for (const std::uintmax_t left : {std::uintmax_t{0}, std::uintmax_t{1}, std::uintmax_t{512}, std::uintmax_t{5000}}) {
    fs::resize_file(path(), left);
    write({begun(), advanced(7)});
    ASSERT_FALSE(jobs().empty()) << left;
    EXPECT_EQ(jobs()[0].history.latest()->line_acknowledged, 7U) << left;
  }
}

TEST_F(Journal, ANewerOneIsLeftAlone) {
  write({begun()});
  {
    std::fstream stream(path(), std::ios::in | std::ios::out | std::ios::binary);
    stream.seekp(60);  // user_version (SQLite file format, 1.3)
    stream << std::string("\0\0\0\x63", 4);
  }
  write({begun()});
  ASSERT_THAT(said_, SizeIs(1));
  EXPECT_THAT(said_[0], HasSubstr("newer Kerf"));
  EXPECT_FALSE(fs::exists(path() + ".damaged"));
}

TEST_F(Journal, AFullDiskIsToldOnceAndItGoesOnWhenThereIsRoom) {
  EventLoop loop;
  write({begun(), advanced(1)});
  {
    auto full = std::make_optional<FullDisk>(fs::file_size(path()) + 4096);
    JournalStore store(loop, path(), "m", [&](const std::string& said) {
      said_.push_back(said);
      if (said_.size() == 1) full.reset();  // somebody makes room
      if (said_.size() == 2) loop.stop();
    });
    std::vector<job::JournalRecord> records{begun()};
    for (int note = 0; note < 500; ++note) records.push_back(noted(std::string(300, 'x')));
    records.push_back(advanced(77));
    store.append(std::move(records));
    loop.run();
  }
  ASSERT_THAT(said_, SizeIs(2));
  EXPECT_THAT(said_[0], HasSubstr("The job goes on; make room on the disk"));
  EXPECT_THAT(said_[1], HasSubstr("again"));
  ASSERT_THAT(jobs(), SizeIs(2));
  EXPECT_EQ(jobs()[0].history.latest()->line_acknowledged, 77U);
}

TEST_F(Journal, WithoutAPlaceTheJobGoesOn) {
  EventLoop loop;
  {
    JournalStore store(loop, "/proc/nowhere/journal.db", "m", [&](const std::string& said) {
      said_.push_back(said);
      loop.stop();
    });
    store.append({begun()});
    loop.run();
  }
  EXPECT_THAT(said_, SizeIs(1));
}

TEST(ThinOut, KeepsWhatResumingNeeds) {
  std::vector<DatedRecord> records{{.record = begun(1)}, {.record = begun(2)}};
  for (std::uint32_t line = 1; line <= 100; ++line) records.push_back({.record = advanced(line, 1 + line % 2)});
  for (int note = 0; note < 100; ++note) records.push_back({.record = noted(std::to_string(note))});
  thin_out(records, 20);
  ASSERT_LE(records.size(), 20U + 4U);
  EXPECT_TRUE(std::holds_alternative<job::JobBegun>(records[0].record.what));
  EXPECT_TRUE(std::holds_alternative<job::JobBegun>(records[1].record.what));
  EXPECT_EQ(std::get<job::JobAdvanced>(records[2].record.what).line_acknowledged, 99U);
  EXPECT_EQ(std::get<job::JobAdvanced>(records[3].record.what).line_acknowledged, 100U);
  EXPECT_EQ(std::get<job::JobNoted>(records.back().record.what).text, "99");
}

TEST(ProcessIdentity, TellsTheLivingFromTheDead) {
  EXPECT_TRUE(is_running(process_identity()));
  EXPECT_FALSE(is_running(process_identity() + "1"));
  EXPECT_FALSE(is_running(""));
  EXPECT_FALSE(is_running("boot/1"));
  EXPECT_FALSE(is_running("boot/999999999/5"));
}

TEST(ProcessIdentity, AProcessThatNobodyHasWaitedForIsDead) {
  std::array<int, 2> pipe{};
  ASSERT_EQ(::pipe(pipe.data()), 0);
  const pid_t child = ::fork();
  if (child == 0) {
    const std::string identity = process_identity();
    static_cast<void>(!::write(pipe[1], identity.data(), identity.size()));
    ::_exit(0);
  }
  std::array<char, 200> buffer{};
  const ssize_t length = ::read(pipe[0], buffer.data(), buffer.size());
  ASSERT_GT(length, 0);
  siginfo_t ended{};
  ASSERT_EQ(::waitid(P_PID, static_cast<id_t>(child), &ended, WEXITED | WNOWAIT), 0);
  EXPECT_FALSE(is_running(std::string_view{buffer.data(), static_cast<std::size_t>(length)}));
  ::waitpid(child, nullptr, 0);
  for (const int end : pipe) ::close(end);
}

}  // namespace
}  // namespace kerf::io
