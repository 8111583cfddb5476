#include "io/wire_log.hpp"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <stdlib.h>

#include "io/text_file.hpp"
#include "io/wire_log_reader.hpp"
#include "sender/session/record_text.hpp"

namespace kerf::io {
namespace {

using namespace std::chrono_literals;
namespace fs = std::filesystem;

class WireLogTest : public testing::Test {
 protected:
  WireLogTest() {
    std::string pattern = (fs::temp_directory_path() / "kerf-log-XXXXXX").string();
    folder_ = ::mkdtemp(pattern.data());
  }
  ~WireLogTest() override { fs::remove_all(folder_); }

  /// Records `count` polls; the path of the first part.
  std::string record_polls(int count, const LogLimits& limits = {}, const std::string& machine = "/dev/ttyUSB0") {
    WireLog log(loop_, {.folder = folder_}, {.machine = machine}, limits);
    std::string first;
    std::uint32_t noise = 1;
    for (int poll = 0; poll < count; ++poll) {
      noise = noise * 1664525 + 1013904223;
      const Instant at{poll * 100ms + Duration{noise % 100'000}};
      log.append({.at = at, .what = session::TimePassed{}});
      log.append({.at = at, .what = session::BytesSent{.realtime = "?", .lines = {}}});
      log.append({.at = at + 3ms, .what = session::BytesReceived{"<Idle|MPos:" + std::to_string(noise) + ">\r\n"}});
      if (first.empty()) first = log.path();
    }
    EXPECT_TRUE(log.is_recording());
    return first;
  }

  static std::pair<std::vector<session::Record>, std::string> read(const std::string& path) {
    auto reader = WireLogReader::open(path);
    EXPECT_TRUE(reader) << path;
    std::vector<session::Record> records;
    while (auto record = reader->next()) records.push_back(*std::move(record));
    return {std::move(records), reader->remark()};
  }

  std::string folder_;
  EventLoop loop_;
};

TEST_F(WireLogTest, WhatIsWrittenIsRead) {
  const auto path = record_polls(100);
  const auto [records, remark] = read(path);
  EXPECT_EQ(remark, "");
  ASSERT_EQ(records.size(), 301U);
  const auto& header = std::get<session::LogHeader>(records[0].what);
  EXPECT_EQ(header.machine, "/dev/ttyUSB0");
  EXPECT_EQ(header.part, 1U);
  EXPECT_EQ(header.began.size(), std::string("2026-11-22T13:05:01.250Z").size());
  EXPECT_EQ(std::get<session::BytesSent>(records[2].what).realtime, "?");
  EXPECT_NE(path.find("ttyUSB0"), std::string::npos);
  EXPECT_EQ(fs::status(path).permissions(), fs::perms::owner_read | fs::perms::owner_write);
}

TEST_F(WireLogTest, ATornFileIsReadUpToItsLastWholeRecord) {
  const auto whole = *read_text_file(record_polls(400));
  const auto [all, none] = read(folder_ + "/" + fs::directory_iterator(folder_)->path().filename().string());
  const std::string torn = folder_ + "/torn";
  std::size_t most = 0;
  for (std::size_t size = 0; size < whole.size(); size += 97) {
    ASSERT_TRUE(replace_text_file(torn, whole.substr(0, size)));
    const auto [records, remark] = read(torn);
    EXPECT_GE(records.size(), most);
    EXPECT_TRUE(!remark.empty() || size < 5) << size;
    most = records.size();
  }
  EXPECT_GT(most, 0U);
  EXPECT_LT(most, all.size());
}

TEST_F(WireLogTest, DamageInTheMiddleIsRemarked) {
  auto bytes = *read_text_file(record_polls(400));
  bytes[bytes.size() / 2] ^= 0x40;
  const std::string damaged = folder_ + "/damaged";
  ASSERT_TRUE(replace_text_file(damaged, bytes));
  EXPECT_NE(read(damaged).second, "");
}

TEST_F(WireLogTest, PlainLinesAreReadToo) {
  const std::string plain = folder_ + "/plain";
  ASSERT_TRUE(replace_text_file(plain, "{\"at\":1,\"kind\":\"time\"}\n{\"at\":2,\"kind\":\"ti"));
  const auto [records, remark] = read(plain);
  EXPECT_EQ(records.size(), 1U);
  EXPECT_EQ(remark, "The log ends in the middle of a record");
}

TEST_F(WireLogTest, PartsFollowEachOther) {
  const auto first = record_polls(20'000, {.part_bytes = 20'000});
  const auto parts = parts_of(first, true);
  ASSERT_GT(parts.size(), 2U);
  EXPECT_EQ(parts_of(parts[1], true), parts);
  EXPECT_EQ(parts_of(parts[1], false).front(), parts[1]);
  Instant before{};
  std::size_t records = 0;
  for (std::size_t index = 0; index < parts.size(); ++index) {
    const auto [part, remark] = read(parts[index]);
    EXPECT_EQ(remark, "");
    EXPECT_EQ(std::get<session::LogHeader>(part.front().what).part, index + 1);
    EXPECT_GE(part.front().at, before);
    before = part.back().at;
    records += part.size() - 1;
  }
  EXPECT_EQ(records, 60'000U);
}

TEST_F(WireLogTest, TheOldestGo) {
  for (int number = 0; number < 5; ++number) {
    record_polls(10, {.kept_files = 3}, "mill" + std::to_string(number));
  }
  const auto kept = list_logs(folder_);
  ASSERT_EQ(kept.size(), 3U);
  EXPECT_NE(kept.back().find("mill4"), std::string::npos);
  record_polls(10, {.kept_bytes = 1}, "mill5");
  ASSERT_EQ(list_logs(folder_).size(), 1U);
  EXPECT_EQ(find_log("latest", folder_), list_logs(folder_).front());
}

TEST_F(WireLogTest, AFolderThatCannotBeIsToldOnce) {
  const std::string file = folder_ + "/file";
  ASSERT_TRUE(replace_text_file(file, "x"));
  WireLog log(loop_, {.folder = file + "/logs"}, {});
  log.append({.at = {}, .what = session::LinkOpened{}});
  log.append({.at = {}, .what = session::TimePassed{}});
  EXPECT_FALSE(log.is_recording());
  const auto fault = log.take_fault();
  ASSERT_TRUE(fault);
  EXPECT_NE(fault->find("is not recorded"), std::string::npos);
  EXPECT_FALSE(log.take_fault());
}

TEST_F(WireLogTest, NothingIsWrittenUnasked) {
  WireLog log(loop_, {.records = false, .folder = folder_}, {});
  log.append({.at = {}, .what = session::LinkOpened{}});
  EXPECT_FALSE(log.take_fault());
  WireLog unused(loop_, {.folder = folder_}, {});
  EXPECT_TRUE(fs::is_empty(folder_));
}

}  // namespace
}  // namespace kerf::io
