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
  note(now, LinkOpened{opening});
  Session::on_open(now, opening);
  settle(now);
}

void RecordedSession::on_bytes(Instant now, std::string_view bytes) {
  note(now, BytesReceived{received_mask_.push(bytes, mask_)});
  Session::on_bytes(now, bytes);
  settle(now);
}

void RecordedSession::on_closed(Instant now, LinkLoss loss) {
  if (auto held = received_mask_.finish(); !held.empty()) note(now, BytesReceived{std::move(held)});
  note(now, LinkGone{loss});
  journal_.on_link_closed(now, loss);
  Session::on_closed(now, loss);
  waiting_.realtime.clear();
  waiting_.lines.clear();
  settle(now);
}

void RecordedSession::submit(Instant now, const Command& command) {
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

void RecordedSession::settle(Instant now) {
  Outbox out = Session::take_outbox();
  if (!out.realtime.empty() || !out.lines.empty()) {
    note(now, BytesSent{.realtime = out.realtime, .lines = mask_.masked_text(out.lines)});
  }
  for (Event& event : out.events) hide_passwords(event, mask_.secrets());
  journal_.on_events(now, out.events, *this, mask_.secrets());
  for (job::JournalRecord& record : journal_.take_records()) waiting_.journal.push_back(std::move(record));
  waiting_.realtime += out.realtime;
  waiting_.lines += out.lines;
  waiting_.events.insert(waiting_.events.end(), std::make_move_iterator(out.events.begin()),
                         std::make_move_iterator(out.events.end()));
}

Instant RecordedSession::next_deadline() const {
  return std::min(Session::next_deadline(), journal_.next_deadline());
}

Outbox RecordedSession::take_outbox() {
  return std::exchange(waiting_, {});
}

std::vector<Record> RecordedSession::take_records() {
  return std::exchange(records_, {});
}

}  // namespace kerf::session
