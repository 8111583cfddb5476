#include "sender/session/replay.hpp"

#include <algorithm>
#include <iterator>
#include <utility>
#include <variant>

#include "common/base/text.hpp"
#include "sender/session/record_text.hpp"

namespace kerf::session {
namespace {

/// "'?', then 'G0X1\\n'"
std::string text_of(const BytesSent& sent) {
  if (sent == BytesSent{}) return "nothing";
  std::string text;
  if (!sent.realtime.empty()) text = "'" + base::escape(sent.realtime) + "'";
  if (!sent.lines.empty()) text += (text.empty() ? "'" : ", then '") + base::escape(sent.lines) + "'";
  return text;
}

}  // namespace

std::optional<ReplayStop> Replay::feed(const Record& record) {
  ++tally_.records;
  const bool is_header = std::holds_alternative<LogHeader>(record.what);
  if (!session_ && !is_header) return stop(ReplayEnd::NoHeader, record.at);
  const bool is_sent = std::holds_alternative<BytesSent>(record.what);
  // Every input is followed by what it led to: the log has nothing there.
  if (!is_sent && !is_header && owed_ != BytesSent{}) return differ(record.at, {});
  return std::visit([&](const auto& what) { return follow(record.at, what); }, record.what);
}

Replay::Stop Replay::stop(ReplayEnd end, Instant at, std::string program) const {
  return ReplayStop{.end = end, .record = tally_.records, .at = at, .program = std::move(program)};
}

Replay::Stop Replay::differ(Instant at, const BytesSent& logged) const {
  return ReplayStop{
      .end = ReplayEnd::Different, .record = tally_.records, .at = at, .logged = logged, .replayed = owed_};
}

Replay::Stop Replay::follow(Instant at, const LogHeader& header) {
  if (header.version != LogHeader{}.version) return stop(ReplayEnd::OtherVersion, at);
  if (header.part != part_ + 1) return stop(ReplayEnd::MiddlePart, at);
  part_ = header.part;
  listening_ = header.listening;
  if (!session_) session_ = std::make_unique<RecordedSession>(header.options);
  return std::nullopt;
}

Replay::Stop Replay::follow(Instant at, const LinkOpened& opened) {
  if (listening_) return std::nullopt;
  session_->on_open(at, opened.opening);
  settle();
  return std::nullopt;
}

Replay::Stop Replay::follow(Instant at, const BytesReceived& received) {
  tally_.bytes_received += received.bytes.size();
  session_->on_bytes(at, received.bytes);
  settle();
  return std::nullopt;
}

Replay::Stop Replay::follow(Instant at, const BytesSent& sent) {
  if (sent != owed_) return differ(at, sent);
  tally_.bytes_sent += sent.realtime.size() + sent.lines.size();
  owed_ = {};
  return std::nullopt;
}

Replay::Stop Replay::follow(Instant at, const ProgramLoaded& loaded) {
  program_.reset();
  if (loaded.text.empty() && loaded.size_bytes > 0) return stop(ReplayEnd::ProgramMissing, at, loaded.name);
  auto program = job::Program::load(loaded.name, loaded.text);
  if (!program) return stop(ReplayEnd::ProgramBad, at, loaded.name);
  program_ = *std::move(program);
  return std::nullopt;
}

Replay::Stop Replay::follow(Instant at, const CommandGiven& given) {
  ++tally_.commands;
  if (const auto* start = std::get_if<StartJob>(&given.command)) {
    if (!program_) return stop(ReplayEnd::ProgramMissing, at);
    session_->submit(at, StartJob{.program = program_, .options = start->options});
  } else {
    session_->submit(at, given.command);
  }
  settle();
  return std::nullopt;
}

Replay::Stop Replay::follow(Instant at, const TimePassed&) {
  session_->advance_to(at);
  settle();
  return std::nullopt;
}

Replay::Stop Replay::follow(Instant at, const LinkGone& gone) {
  session_->on_closed(at, gone.loss);
  settle();
  return std::nullopt;
}

void Replay::settle() {
  // The replay's own records tell the bytes without passwords, as the log does.
  for (Record& record : session_->take_records()) {
    if (auto* sent = std::get_if<BytesSent>(&record.what)) owed_ = std::move(*sent);
  }
  auto out = session_->take_outbox();
  events_.insert(events_.end(), std::make_move_iterator(out.events.begin()), std::make_move_iterator(out.events.end()));
}

std::string sentence_of(const ReplayStop& stop) {
  const std::string where =
      "Record " + std::to_string(stop.record) + ", at " + base::to_fixed(base::to_seconds(stop.at), 6) + " s: ";
  switch (stop.end) {
    case ReplayEnd::Different:
      return where + "the log has " + text_of(stop.logged) + ", and this Kerf sends " + text_of(stop.replayed) + ".";
    case ReplayEnd::NoHeader: return where + "the log does not begin with its header: nothing can be repeated from it.";
    case ReplayEnd::MiddlePart:
      return where + "a part of the connection is missing before this one: put all its parts into one folder.";
    case ReplayEnd::OtherVersion: return where + "this format is not known here: use the Kerf that wrote the log.";
    case ReplayEnd::ProgramMissing:
      return where + "the log names the program '" + stop.program + "' but does not hold it: supply the file.";
    case ReplayEnd::ProgramBad: return where + "'" + stop.program + "' is no program that Kerf would send.";
    case ReplayEnd::NotARecord: return where + "the line after it is no record.";
  }
  return where;
}

std::optional<ReplayStop> replay_text(std::string_view log) {
  Replay replay;
  Instant at{};
  while (!log.empty()) {
    const std::size_t end = std::min(log.find('\n'), log.size());
    const auto record = parse_record(log.substr(0, end));
    log.remove_prefix(std::min(end + 1, log.size()));
    if (!record) return ReplayStop{.end = ReplayEnd::NotARecord, .record = replay.tally().records, .at = at};
    at = record->at;
    if (auto stop = replay.feed(*record)) return stop;
  }
  return std::nullopt;
}

}  // namespace kerf::session
