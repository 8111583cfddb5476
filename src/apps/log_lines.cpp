#include "apps/log_lines.hpp"

#include <algorithm>
#include <chrono>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "common/base/text.hpp"
#include "io/json.hpp"
#include "sender/session/record_text.hpp"

namespace kerf::apps {
namespace {

/// "StatusReport" becomes "status_report".
std::string kind_of(const protocol::Message& message) {
  std::string kind;
  for (const char letter : protocol::name_of(message)) {
    const bool is_capital = letter >= 'A' && letter <= 'Z';
    if (is_capital && !kind.empty()) kind += '_';
    kind += is_capital ? static_cast<char>(letter - 'A' + 'a') : letter;
  }
  return kind;
}

bool begins_with_one_of(std::string_view kind, const std::vector<std::string>& beginnings) {
  return std::ranges::any_of(beginnings, [kind](const std::string& beginning) { return kind.starts_with(beginning); });
}

/// "13:05", "13:05:01", "13:05:01.5"
bool is_time_of_day(std::string_view text) {
  const auto parts = base::split(text, ':');
  if (parts.size() < 2 || parts.size() > 3) return false;
  return std::ranges::all_of(parts, [](std::string_view part) {
    return part.size() >= 2 && base::is_digit(part[0]) && base::is_digit(part[1]) && base::parse_decimal(part);
  });
}

/// True when the entry lies before the moment.
bool is_before(const LogEntry& entry, const std::string& moment) {
  if (const auto seconds = base::parse_decimal(moment)) return base::to_seconds(entry.at) < *seconds;
  if (entry.clock.empty()) return false;
  if (const auto whole = io::parse_wall_clock(moment)) return entry.clock < io::to_string(*whole);
  const std::size_t time_at = entry.clock.find('T') + 1;
  return entry.clock.substr(time_at, moment.size()) < moment;
}

template <typename T>
std::string members_of(const T& command) {
  std::string text;
  const io::Json json = io::to_json(command);
  for (const auto& [name, value] : json.items()) text += fmt::format(" {}={}", name, io::print(value));
  return text;
}

}  // namespace

void LogLines::add(Instant at, LogDirection direction, std::string kind, std::string text) {
  std::string clock;
  if (began_) clock = io::to_string(*began_ + std::chrono::floor<std::chrono::milliseconds>(at - began_at_));
  entries_.push_back(
      {.at = at, .clock = std::move(clock), .direction = direction, .kind = std::move(kind), .text = std::move(text)});
}

std::vector<LogEntry> LogLines::read(const session::Record& record) {
  last_ = record.at;
  std::visit([&](const auto& what) { read_what(record.at, what); }, record.what);
  return std::exchange(entries_, {});
}

std::vector<LogEntry> LogLines::finish() {
  if (!reader_.pending().empty()) {
    add(last_, LogDirection::Received, "unfinished", base::escape(reader_.pending()));
  }
  reader_.reset();
  return std::exchange(entries_, {});
}

void LogLines::read_what(Instant at, const session::LogHeader& header) {
  began_ = io::parse_wall_clock(header.began);
  began_at_ = at;
  std::string text = fmt::format("kerf {} at {}, {}", header.kerf, header.machine, header.began);
  if (header.part > 1) text += fmt::format(", part {}", header.part);
  if (header.listening) text += ", listening only";
  if (!header.talk.empty()) text += ", the talk " + header.talk;
  add(at, LogDirection::None, "header", std::move(text));
}

void LogLines::read_what(Instant at, const session::LinkOpened&) {
  reader_.reset();
  add(at, LogDirection::None, "opened", "The link is open.");
}

void LogLines::read_what(Instant at, const session::BytesReceived& received) {
  for (const auto& line : reader_.read(received.bytes)) {
    add(at, LogDirection::Received, kind_of(line.message), base::escape(line.raw));
  }
}

void LogLines::read_what(Instant at, const session::BytesSent& sent) {
  if (!sent.realtime.empty()) add(at, LogDirection::Sent, "realtime", base::escape(sent.realtime));
  std::string_view rest = sent.lines;
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    add(at, LogDirection::Sent, "line", base::escape(rest.substr(0, end)));
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
}

void LogLines::read_what(Instant at, const session::ProgramLoaded& loaded) {
  add(at, LogDirection::None, "program",
      fmt::format("The program {} has {} bytes{}, hash {}.", loaded.name, loaded.size_bytes,
                  loaded.text.empty() ? ", which are not in the log" : "", loaded.hash));
}

void LogLines::read_what(Instant at, const session::CommandGiven& given) {
  std::string text(session::name_of(given.command));
  text += std::visit([](const auto& command) { return members_of(command); }, given.command);
  add(at, LogDirection::None, "command", std::move(text));
}

void LogLines::read_what(Instant at, const session::TimePassed&) {
  add(at, LogDirection::None, "time", "A deadline passed.");
}

void LogLines::read_what(Instant at, const session::LinkGone& gone) {
  for (auto& entry : finish()) entries_.push_back(std::move(entry));
  add(at, LogDirection::None, "closed",
      fmt::format("The link is gone: {}.", boost::describe::enum_to_string(gone.loss, "?")));
}

bool is_moment(std::string_view text) {
  return base::parse_decimal(text) || is_time_of_day(text) || io::parse_wall_clock(text);
}

bool passes(const LogFilter& filter, const LogEntry& entry) {
  if (filter.direction != LogDirection::None && entry.direction != filter.direction) return false;
  if (filter.kinds.empty() ? entry.kind == "time" : !begins_with_one_of(entry.kind, filter.kinds)) return false;
  if (begins_with_one_of(entry.kind, filter.hidden)) return false;
  if (!filter.since.empty() && is_before(entry, filter.since)) return false;
  if (!filter.until.empty() && !is_before(entry, filter.until)) return false;
  return !filter.pattern || std::regex_search(entry.text, *filter.pattern);
}

std::string shown(const LogEntry& entry, bool by_clock) {
  char sign = ' ';
  if (entry.direction == LogDirection::Sent) sign = entry.kind == "realtime" ? '!' : '>';
  if (entry.direction == LogDirection::Received) sign = '<';
  const std::string when = by_clock ? entry.clock : fmt::format("{:>13.6f}", base::to_seconds(entry.at));
  return fmt::format("{} {} {}", when, sign, entry.text);
}

}  // namespace kerf::apps
