#include "sender/session/recorded_session.hpp"

#include <algorithm>
#include <iterator>
#include <type_traits>
#include <utility>
#include <variant>

#include <boost/mp11.hpp>

#include "sender/session/hidden_passwords.hpp"

namespace kerf::session {
namespace {

/// Texts of an operator may hold a password as a line does.
template <typename T>
void mask_texts(T& command, PasswordMask& mask) {
  boost::mp11::mp_for_each<boost::describe::describe_members<T, boost::describe::mod_public>>([&](auto member) {
    auto& value = command.*member.pointer;
    using Value = std::remove_cvref_t<decltype(value)>;
    if constexpr (std::is_same_v<Value, std::string>) value = mask.masked_line(value);
    if constexpr (std::is_same_v<Value, std::vector<machine::SettingAssignment>>) {
      for (machine::SettingAssignment& setting : value) {
        const std::string front = "$" + setting.id + "=";
        setting.value = mask.masked_line(front + setting.value).substr(front.size());
      }
    }
  });
}

Command masked(Command command, PasswordMask& mask) {
  std::visit([&mask](auto& known) { mask_texts(known, mask); }, command);
  return command;
}

}  // namespace

void RecordedSession::on_open(Instant now, const machine::LinkOpening& opening) {
  catch_up();
  note(now, LinkOpened{opening});
  Session::on_open(now, opening);
  settle(now);
}

void RecordedSession::on_bytes(Instant now, std::string_view bytes) {
  waiting_.lines += feed_ahead(now, bytes);
  catch_up();
}

std::string RecordedSession::feed_ahead(Instant now, std::string_view bytes) {
  catch_up();
  heard_ = Heard{.at = now, .bytes = std::string{bytes}, .lines = Session::feed_ahead(now, bytes)};
  return heard_->lines;
}

void RecordedSession::catch_up() {
  if (!heard_) return;
  Heard heard = std::move(*heard_);
  heard_.reset();
  note(heard.at, BytesReceived{received_mask_.push(heard.bytes, mask_)});
  settle(heard.at, std::move(heard.lines));
}

void RecordedSession::on_closed(Instant now, LinkLoss loss) {
  catch_up();
  if (auto held = received_mask_.finish(); !held.empty()) note(now, BytesReceived{std::move(held)});
  note(now, LinkGone{loss});
  journal_.on_link_closed(now, loss);
  Session::on_closed(now, loss);
  waiting_.realtime.clear();
  waiting_.lines.clear();
  settle(now);
}

void RecordedSession::submit(Instant now, const Command& command) {
  catch_up();
  if (const auto* recalled = std::get_if<RecallWords>(&command)) {
    for (const auto& answer : recalled->words.answers) {
      for (const std::string& line : answer.lines) mask_.recall_from(line);
    }
  }
  if (const auto* start = std::get_if<StartJob>(&command)) {
    note_program(now, *start);
    note(now, CommandGiven{StartJob{.options = start->options}});
    journal_.on_command(now, command);
  } else {
    Command given = masked(command, mask_);
    journal_.on_command(now, given);
    note(now, CommandGiven{std::move(given)});
  }
  Session::submit(now, command);
  settle(now);
}

void RecordedSession::advance_to(Instant now) {
  catch_up();
  note(now, TimePassed{});
  Session::advance_to(now);
  settle(now);
}

void RecordedSession::note_program(Instant now, const StartJob& start) {
  if (start.program == nullptr || start.program == program_) return;
  program_ = start.program;
  ProgramLoaded loaded{.name = program_->name(), .size_bytes = program_->size_bytes()};
  loaded.hash = program_->hash();
  if (program_->size_bytes() <= kMostEmbeddedBytes) loaded.text = mask_.masked_text(program_->text());
  note(now, std::move(loaded));
}

void RecordedSession::settle(Instant now, std::string ahead) {
  Outbox out = Session::take_outbox();
  ahead += out.lines;
  if (!out.realtime.empty() || !ahead.empty()) {
    note(now, BytesSent{.realtime = out.realtime, .lines = mask_.masked_text(ahead)});
  }
  for (Event& event : out.events) hide_passwords(event, mask_.secrets());
  journal_.on_events(now, out.events, *this, mask_.secrets());
  for (job::JournalRecord& record : journal_.take_records()) waiting_.journal.push_back(std::move(record));
  waiting_.realtime += out.realtime;
  waiting_.lines += out.lines;
  if (waiting_.events.empty()) {
    waiting_.events = std::move(out.events);
    return;
  }
  waiting_.events.insert(waiting_.events.end(), std::make_move_iterator(out.events.begin()),
                         std::make_move_iterator(out.events.end()));
}

Instant RecordedSession::next_deadline() const {
  return std::min(Session::next_deadline(), journal_.next_deadline());
}

Outbox RecordedSession::take_outbox() {
  catch_up();
  return std::exchange(waiting_, {});
}

std::vector<Record> RecordedSession::take_records() {
  catch_up();
  return std::exchange(records_, {});
}

}  // namespace kerf::session
