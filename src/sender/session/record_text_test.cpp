#include "sender/session/record_text.hpp"

#include <chrono>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

namespace kerf::session {
namespace {

using namespace std::chrono_literals;

std::string line_of(const Record& record) {
  std::string line;
  append_line(line, record);
  line.pop_back();
  return line;
}

/// Written, read and written again.
std::string again(const Record& record) {
  const auto read = parse_record(line_of(record));
  return read ? line_of(*read) : "no record";
}

TEST(RecordText, IsOneObjectALine) {
  EXPECT_EQ(line_of({.at = Instant{1250ms}, .what = BytesReceived{"ok\r\n"}}),
            R"({"at":1.250000000,"kind":"received","bytes":"ok\r\n"})");
  EXPECT_EQ(line_of({.at = Instant{1ns}, .what = BytesSent{.realtime = "?", .lines = "G0\n"}}),
            R"({"at":0.000000001,"kind":"sent","realtime":"?","lines":"G0\n"})");
  EXPECT_EQ(line_of({.at = Instant{2s}, .what = CommandGiven{SendLine{"$X"}}}),
            R"({"at":2.000000000,"kind":"command","command":"SendLine","text":"$X"})");
  EXPECT_EQ(line_of({.at = Instant{2s}, .what = LinkGone{LinkLoss::Unplugged}}),
            R"({"at":2.000000000,"kind":"closed","loss":"Unplugged"})");
}

TEST(RecordText, EveryKindComesBack) {
  SessionOptions options;
  options.link = {.baud = 115200, .network = true};
  options.reset_policy = ResetPolicy::Never;
  options.enumerate = false;
  const std::vector<decltype(Record::what)> all = {
      LogHeader{
          .kerf = "1.2.3", .machine = "/dev/ttyUSB0", .began = "now", .part = 7, .listening = true, .options = options},
      LinkOpened{},
      BytesReceived{"\xFF\x18?"},
      BytesSent{.realtime = "\x85", .lines = "G1X1\n"},
      ProgramLoaded{.name = "a.nc", .path = "/a.nc", .size_bytes = 3, .hash = "99aa06d3014798d8", .text = "G0\n"},
      CommandGiven{SendRealtime{0x18}},
      TimePassed{},
      LinkGone{LinkLoss::TimedOut}};
  ASSERT_EQ(all.size(), std::variant_size_v<decltype(Record::what)>);
  for (const auto& what : all) {
    const Record record{.at = Instant{123456789ns}, .what = what};
    EXPECT_EQ(again(record), line_of(record));
  }
}

TEST(RecordText, EveryCommandComesBack) {
  boost::mp11::mp_for_each<boost::mp11::mp_iota_c<std::variant_size_v<Command>>>([](auto index) {
    const Command command = std::variant_alternative_t<index, Command>{};
    EXPECT_FALSE(name_of(command).empty());
    const Record record{.at = {}, .what = CommandGiven{command}};
    EXPECT_EQ(again(record), line_of(record));
  });
}

TEST(RecordText, NoOptionIsForgotten) {
  // Does not compile when an option is new: describe it in session.hpp (window.hpp), and count it here.
  const auto& [link, reset_policy, enumerate, automatic_reports] = SessionOptions{};
  const auto& [baud, network] = link;
  static_cast<void>(baud);
  static_cast<void>(network);
  static_cast<void>(reset_policy);
  static_cast<void>(enumerate);
  static_cast<void>(automatic_reports);
  const auto& [on_error, flow, optional_stop, block_delete] = JobOptions{};
  static_cast<void>(on_error);
  static_cast<void>(flow);
  static_cast<void>(optional_stop);
  static_cast<void>(block_delete);
}

TEST(RecordText, SaysWhyALineIsNoRecord) {
  EXPECT_EQ(parse_record(R"({"at":1.25,"kind":"rec)").error(), RecordFault::NotJson);
  EXPECT_EQ(parse_record(R"(["at"])").error(), RecordFault::NotJson);
  EXPECT_EQ(parse_record(R"({"at":1.25})").error(), RecordFault::NotARecord);
  EXPECT_EQ(parse_record(R"({"at":1e9,"kind":"time"})").error(), RecordFault::NotARecord);
  EXPECT_EQ(parse_record(R"({"at":1.25,"kind":"received","bytes":7})").error(), RecordFault::NotARecord);
  EXPECT_EQ(parse_record(R"({"at":1.25,"kind":"smell"})").error(), RecordFault::UnknownKind);
  EXPECT_EQ(parse_record(R"({"at":1.25,"kind":"command","command":"Dance"})").error(), RecordFault::UnknownKind);
}

TEST(RecordText, WhatANewerKerfAddsIsPassedOver) {
  const auto record = parse_record(R"({"at":1,"kind":"received","colour":{"a":[1]},"bytes":"x"})");
  ASSERT_TRUE(record);
  EXPECT_EQ(std::get<BytesReceived>(record->what).bytes, "x");
}

RC_GTEST_PROP(RecordText, InstantsAreExact, (std::int64_t nanoseconds)) {
  const std::int64_t count = nanoseconds % 9'000'000'000'000'000'000;
  const auto record = parse_record(line_of({.at = Instant{Duration{count}}, .what = TimePassed{}}));
  RC_ASSERT(record.has_value());
  RC_ASSERT(record->at == Instant{Duration{count}});
}

}  // namespace
}  // namespace kerf::session
