#pragma once
// For tests (behind <gtest/gtest.h>): a session that talks to a controller made of a reply table, on a clock that the
// test moves.

#include <algorithm>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "sender/job/program.hpp"
#include "sender/session/record_text.hpp"
#include "sender/session/recorded_session.hpp"
#include "sender/session/replay.hpp"

namespace kerf::session {

/// Answers whole lines from a table and realtime bytes from a few strings. A line that is not in the table gets `ok`.
struct ReplyTable {
  std::map<std::string, std::string, std::less<>> lines;
  /// A memory of settings: `$n=value` changes it, `$n` and `$$` tell it. Empty: only `lines` counts.
  std::map<std::string, std::string> settings{};
  std::string status = "<Idle|MPos:0.000,0.000,0.000|FS:0,0|WCO:0.000,0.000,0.000>\r\n";
  /// Answer to 0x87; empty: the byte is dropped.
  std::string full_status;
  /// Answer to 0x83; empty: the byte is dropped.
  std::string parser_report;
  /// Answer to 0x18; empty: no reset.
  std::string welcome;
  bool answers_lines = true;
  bool answers_status = true;

  [[nodiscard]] std::string reply_to_byte(char byte) const {
    if (byte == '?') return answers_status ? status : "";
    if (byte == '\x87') return full_status;
    if (byte == '\x83') return parser_report;
    if (byte == '\x18') return welcome;
    return {};
  }
  [[nodiscard]] std::string reply_to_line(const std::string& line) {
    if (!answers_lines) return {};
    const auto found = lines.find(line);
    const bool is_about_settings = !settings.empty() && line.starts_with('$');
    if (is_about_settings && (found == lines.end() || line == "$$")) return reply_about_settings(line);
    return found == lines.end() ? "ok\r\n" : found->second;
  }

  // $110=500.000
  [[nodiscard]] std::string reply_about_settings(const std::string& line) {
    const auto equals = line.find('=');
    const std::string id = line.substr(1, equals - 1);
    if (equals != std::string::npos) {
      if (settings.contains(id)) settings[id] = line.substr(equals + 1);
      return "ok\r\n";
    }
    std::string reply;
    for (const auto& [known, value] : settings) {
      if (line == "$$" || known == id) reply += "$" + known + "=" + value + "\r\n";
    }
    return reply + "ok\r\n";
  }
};

inline ReplyTable grbl_replies() {
  ReplyTable table;
  table.lines = {
      {"$I", "[VER:1.1h.20190830:mill]\r\n[OPT:V,15,128]\r\nok\r\n"},
      {"$G", "[GC:G0 G54 G17 G21 G90 G94 M5 M9 T0 F0 S0]\r\nok\r\n"},
      {"$#",
       "[G54:1.000,2.000,3.000]\r\n[G92:0.000,0.000,0.000]\r\n[TLO:0.000]\r\n[PRB:0.000,0.000,0.000:0]\r\nok\r\n"},
      {"$$", "$0=10\r\n$13=0\r\n$110=500.000\r\nok\r\n"}};
  table.welcome = "\r\nGrbl 1.1h ['$' for help]\r\n";
  return table;
}

inline ReplyTable grblhal_replies() {
  ReplyTable table = grbl_replies();
  table.lines["$I"] = "error:3\r\n";
  table.lines["$I+"] =
      "[VER:1.1f.20260817:]\r\n[OPT:VNML+,100,1024,3,0]\r\n[AXS:3:XYZ]\r\n[NEWOPT:ENUMS,RT+,SED]\r\n"
      "[FIRMWARE:grblHAL]\r\nok\r\n";
  table.lines["$EA"] = "[ALARMCODE:1||Hard limit has been triggered. Home again.]\r\nok\r\n";
  table.lines["$EE"] = "[ERRORCODE:20||Unsupported G-code command found in block]\r\nok\r\n";
  table.lines["$EG"] = "[SETTINGGROUP:43|42|X-axis]\r\nok\r\n";
  table.lines["$ES"] = "[SETTING:110|43|X-axis maximum rate|mm/min|6|#####0.000|||0|0]\r\nok\r\n";
  table.lines["$ESH"] =
      "$-Code\tSetting\tUnits\tDatatype\tData format\tSetting Description\tMin\tMax\r\n"
      "110\tX-axis maximum rate\tmm/min\tfloat\t#####0.000\tMaximum rate.\t\t\t0\t0\r\nok\r\n";
  table.lines["$SPINDLESH"] = "[SPINDLE:0|0|0|*DRV|PWM|0.0,1000.0]\r\nok\r\n";
  table.full_status = "<Idle|MPos:0.000,0.000,0.000|Bf:100,1023|FS:0,0|WCO:0.000,0.000,0.000|MPG:0|FW:grblHAL>\r\n";
  table.parser_report = "[GC:G0 G54 G17 G21 G90 G94 G49 G98 G50 M5 M9 T0 F0 S0.]\r\n";
  table.welcome = "\r\nGrblHAL 1.1f ['$' or '$HELP' for help]\r\n";
  return table;
}

inline ReplyTable rabbit_replies() {
  ReplyTable table = grbl_replies();
  table.lines["$I"] = "[VER:1.1h.20260315]\r\n[OPT:PHL]\r\nok\r\n";
  table.lines["$EA"] = "[ALARMCODE:1|Hard limit|A switch was hit.]\r\nok\r\n";
  table.lines["$EE"] = "[ERRORCODE:20|Unsupported|Not known here.]\r\nok\r\n";
  table.welcome = "\r\nRabbit GRBL v1.6.0 Build 20260315  \r\n";
  return table;
}

/// Both ends. What it recorded is replayed at its end, and must give the same bytes. Everything that the session sends
/// is kept in `sent`, realtime bytes and lines in the order in which they left.
class Conversation {
 public:
  explicit Conversation(ReplyTable table, SessionOptions options = {}) : replies(std::move(table)), session(options) {
    append_line(wire_log_, {.at = now, .what = LogHeader{.options = options}});
  }
  ~Conversation() {
    keep_records();
    if (const auto stop = replay_text(wire_log_)) ADD_FAILURE() << "Replay: " << sentence_of(*stop);
  }
  Conversation(Conversation&&) = default;

  void open(std::string_view greeting = {}) {
    session.on_open(now);
    drain();
    if (!greeting.empty()) hear(greeting);
  }
  void hear(std::string_view bytes) {
    session.on_bytes(now, bytes);
    drain();
  }
  void submit(const Command& command) {
    session.submit(now, command);
    drain();
  }
  void pass(Duration time) {
    const Instant end = now + time;
    while (session.next_deadline() <= end) {
      now = std::max(now, session.next_deadline());
      session.advance_to(now);
      drain();
    }
    now = end;
  }
  void connect() {
    open();
    pass(std::chrono::seconds{10});
    sent.clear();
  }
  void run(std::string_view text, std::string name = "part.nc") {
    submit(StartJob{*job::Program::load(std::move(name), std::string{text})});
  }

  template <class Kind>
  [[nodiscard]] std::vector<Kind> told() const {
    std::vector<Kind> found;
    for (const auto& event : events) {
      if (const auto* kind = std::get_if<Kind>(&event)) found.push_back(*kind);
    }
    return found;
  }
  [[nodiscard]] std::size_t count_sent(char byte) const {
    return static_cast<std::size_t>(std::ranges::count(sent, byte));
  }

  [[nodiscard]] const std::string& wire_log() const { return wire_log_; }

  ReplyTable replies;
  RecordedSession session;
  Instant now{};
  std::string sent;
  std::vector<std::string> lines_sent;
  std::vector<Event> events;
  std::vector<job::JournalRecord> journal;

 private:
  void keep_records() {
    for (const Record& happened : session.take_records()) append_line(wire_log_, happened);
  }
  void drain() {
    keep_records();
    for (auto out = session.take_outbox(); !out.empty(); out = session.take_outbox()) {
      events.insert(events.end(), out.events.begin(), out.events.end());
      journal.insert(journal.end(), out.journal.begin(), out.journal.end());
      sent += out.realtime + out.lines;
      std::string heard;
      for (const char byte : out.realtime) heard += replies.reply_to_byte(byte);
      for (const char byte : out.lines) {
        if (byte != '\n') {
          line_ += byte;
          continue;
        }
        lines_sent.push_back(line_);
        heard += replies.reply_to_line(line_);
        line_.clear();
      }
      if (!heard.empty()) session.on_bytes(now, heard);
      keep_records();
    }
  }

  std::string line_;
  std::string wire_log_;
};

}  // namespace kerf::session
