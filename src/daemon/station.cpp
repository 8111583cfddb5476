#include "daemon/station.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <set>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "io/journal_database.hpp"
#include "io/journal_store.hpp"
#include "sender/session/refusals.hpp"

namespace kerf::daemon {
namespace {

using namespace std::chrono_literals;

/// The age of what is shown grows.
constexpr Duration kSilenceTick = 500ms;
/// The journal commits within 50 ms, on a slow card within a second.
constexpr Duration kJournalTakes = 1s;

/// Seconds that pass at the machine in one second here. A clock that jumps is as good as endlessly fast.
double clock_speed(const io::MachineUrl& url) {
  constexpr double kJumping = 1e6;
  const auto* address = std::get_if<io::VirtualAddress>(&url);
  return address == nullptr ? 1.0 : address->speed.factor.value_or(kJumping);
}

bool is_network(const io::MachineUrl& url) {
  return std::holds_alternative<io::TcpAddress>(url) || std::holds_alternative<io::WebSocketAddress>(url);
}

}  // namespace

Station::Station(const StationServices& services, MachineRow row, io::MachineUrl url, Callbacks callbacks)
    : services_(services),
      row_(std::move(row)),
      url_(std::move(url)),
      callbacks_(std::move(callbacks)),
      jog_timer_(*services.loop),
      look_timer_(*services.loop),
      retry_timer_(*services.loop),
      silence_timer_(*services.loop),
      starter_(*services.loop, *services.pool,
               {.session = [this] { return session(); },
                .submit = [this](const session::Command& command) { static_cast<void>(submit(command)); },
                .noted =
                    [this](NoteLevel level, std::string sentence) {
                      notes_.add(level, std::move(sentence));
                      callbacks_.changed();
                    },
                .changed = [this] { callbacks_.changed(); },
                .clock_speed = clock_speed(url_)}) {
  connect();
  look_for_interrupted();
}

Station::~Station() {
  // A job that nobody feeds would run dry in the middle of a cut.
  if (host_ && has_job()) host_->submit(session::HoldJob{});
}

bool Station::is_ready() const {
  return host_ && host_->session().phase() == session::SessionPhase::Ready;
}

bool Station::has_job() const {
  return host_ && host_->session().job() && !job::is_final(host_->session().job()->phase);
}

bool Station::is_busy() const {
  return has_job() || starter_.is_busy();
}

void Station::set_phase(LinkPhase phase, std::string sentence) {
  phase_ = phase;
  phase_sentence_ = std::move(sentence);
  phase_since_ = services_.loop->now();
  callbacks_.changed();
}

void Station::connect() {
  retry_timer_.disarm();
  session::SessionOptions options;
  set_phase(LinkPhase::Opening, "Opening the link to " + io::to_string(url_) + ".");
  host_ = std::make_unique<io::SessionHost>(
      *services_.loop, url_, options,
      io::SessionHost::Callbacks{
          .event = [this](const session::Event& event) { on_event(event); },
          .lost = [this](const io::TransportError& error) { on_link_lost(error, false); },
          .noted = [this](const std::string& sentence) { notes_.add(NoteLevel::Warning, sentence); },
          .interrupted = [this](const io::TransportError& error) { on_link_lost(error, true); }},
      services_.recording, io::WordsUse::Recall);
}

void Station::disconnect() {
  retry_timer_.disarm();
  silence_timer_.disarm();
  starter_.end();
  jog_.end();
  busy_.reset();
  awake_.reset();
  host_.reset();
  attempt_ = 0;
  set_phase(LinkPhase::Off, "Not connected.");
}

void Station::on_link_lost(const io::TransportError& error, bool comes_back) {
  starter_.end();
  jog_.end();
  busy_.reset();
  awake_.reset();
  const std::string sentence = io::explain(url_, error);
  if (phase_ != LinkPhase::Lost || phase_sentence_ != sentence) set_phase(LinkPhase::Lost, sentence);
  if (comes_back) return;
  // Never inside of the host's own call.
  retry_timer_.arm(services_.loop->now() + io::wait_before(attempt_++, is_network(url_)), [this] { connect(); });
}

void Station::on_event(const session::Event& event) {
  std::visit([this](const auto& alternative) { on(alternative); }, event);
  starter_.on_event(event);
  callbacks_.changed();
}

void Station::on(const session::FirmwareIdentified&) {
  set_phase(LinkPhase::Greeting, "The firmware is known; asking what it can do.");
}

void Station::on(const session::HandshakeNoted& noted) {
  if (phase_ != LinkPhase::Ready) set_phase(LinkPhase::Greeting, noted.sentence);
}

void Station::on(const session::ControllerFound& found) {
  attempt_ = 0;
  busy_.reset();
  limits_ = limits_of(host_->session().capabilities());
  set_phase(LinkPhase::Ready, found.sentence);
  look_for_interrupted();
}

void Station::on(const session::HandshakeFailed& failed) {
  if (failed.failure == session::HandshakeFailure::LinkLost) return;
  set_phase(LinkPhase::Greeting, failed.sentence);
  notes_.add(NoteLevel::Trouble, failed.sentence);
}

void Station::on(const session::ControllerReset& reset) {
  notes_.add(NoteLevel::Warning, reset.reason);
}

void Station::on(const session::ControllerBusy& busy) {
  if (!is_ready()) set_phase(LinkPhase::Greeting, busy.sentence);
  busy_ = busy.sentence;
  notes_.add(NoteLevel::Warning, busy.sentence);
}

void Station::on(const session::ControllerRestarted& restarted) {
  last_refusal_.reset();
  if (!restarted.asked) {
    notes_.add(NoteLevel::Trouble, "The controller has restarted of its own accord: what it was doing is over.");
  }
}

void Station::on(const session::StatusReported& reported) {
  using vocabulary::MachineState;
  if (reported.after == MachineState::Idle) busy_.reset();
  const machine::Snapshot& snapshot = host_->session().snapshot();
  if (!overrides_.is_over()) {
    for (const char byte : overrides_.on_report(snapshot)) {
      host_->submit(session::SendRealtime{static_cast<std::uint8_t>(byte)});
    }
  }
  jog_.on_report(snapshot);
  send_jogs();
}

void Station::on(const session::CommandRefused& refused) {
  refusal_ = refused;
}

void Station::on(const session::AlarmRaised& alarm) {
  end_jog();
  notes_.add(NoteLevel::Trouble, alarm.explanation.headline);
}

void Station::on(const session::LineRefused& refused) {
  end_jog();
  if (refused.purpose == streaming::Purpose::Operator || refused.purpose == streaming::Purpose::JobLine) {
    last_refusal_ = refused.explanation;
    notes_.add(NoteLevel::Trouble, refused.explanation.headline);
  }
}

void Station::on(const session::LineSent& line) {
  traffic_.add(services_.loop->now(), line);
  callbacks_.traffic();
}

void Station::on(const session::LineReceived& line) {
  traffic_.add(services_.loop->now(), line);
  callbacks_.traffic();
  const auto* feedback = std::get_if<protocol::Feedback>(&line.message);
  if (feedback != nullptr && !line.for_kerf && !feedback->text.empty()) notes_.add(NoteLevel::Note, feedback->text);
}

void Station::on(const session::LinkSilent&) {
  end_jog();
  set_phase(LinkPhase::Silent, "The machine does not answer: check cable and power.");
  const auto tick = [this](const auto& again) -> void {
    if (phase_ != LinkPhase::Silent) return;
    callbacks_.changed();
    silence_timer_.arm(services_.loop->now() + kSilenceTick, [this, again] { again(again); });
  };
  tick(tick);
}

void Station::on(const session::LinkAnswering&) {
  set_phase(is_ready() ? LinkPhase::Ready : LinkPhase::Greeting, "The machine answers again.");
}

void Station::on(const session::PendantTookOver& taken) {
  end_jog();
  busy_ = taken.sentence;
  notes_.add(NoteLevel::Warning, taken.sentence);
}

void Station::on(const session::PendantReleased&) {
  busy_.reset();
  notes_.add(NoteLevel::Note, "The pendant has given the machine back.");
}

void Station::on(const session::JobStarted& started) {
  last_refusal_.reset();
  job_program_ = program_ && program_->name == started.program ? program_->id : "";
  notes_.add(NoteLevel::Note, started.program + " was started.");
  if (std::holds_alternative<io::VirtualAddress>(url_)) return;
  awake_ = std::make_unique<io::SleepInhibitor>(
      *services_.loop, "A job runs on " + row_.name,
      [this](const std::string& sentence) { notes_.add(NoteLevel::Warning, sentence); });
}

void Station::on(const session::JobStalled& stalled) {
  if (job::needs_decision(stalled.stall.cause)) notes_.add(NoteLevel::Warning, stalled.stall.headline);
}

void Station::on(const session::JobEnded& ended) {
  awake_.reset();
  const bool is_well = ended.job.phase == job::JobPhase::Finished;
  notes_.add(is_well ? NoteLevel::Note : NoteLevel::Trouble, ended.job.reason);
  // The journal is written by its own thread.
  look_timer_.arm(services_.loop->now() + kJournalTakes, [this] { look_for_interrupted(); });
}

void Station::on(const session::PathUnwatched& unwatched) {
  notes_.add(NoteLevel::Warning, unwatched.sentence);
}

void Station::on(const session::ProgramSpoke& spoke) {
  notes_.add(NoteLevel::Note, spoke.text);
}

void Station::on(const session::SettingsChanged& changed) {
  limits_ = limits_of(host_->session().capabilities());
  const bool is_well = changed.result.outcome == session::SettingsOutcome::Done ||
                       changed.result.outcome == session::SettingsOutcome::Unchanged;
  notes_.add(is_well ? NoteLevel::Note : NoteLevel::Trouble, changed.result.sentence);
}

void Station::on(const session::SettingsDrifted& drifted) {
  notes_.add(NoteLevel::Warning, drifted.sentence);
}

void Station::look_for_interrupted() {
  const std::string path = io::journal_path(services_.recording.journal);
  if (path.empty()) return;
  services_.pool->run(
      [this, alive = std::weak_ptr(alive_), path, machine = io::to_string(url_)]() -> std::function<void()> {
        const auto journal = io::JournalDatabase::open_to_read(path);
        auto jobs = journal ? journal->jobs() : std::unexpected(journal.error());
        if (!jobs) return {};  // there is none yet
        auto rows = preparation::interrupted_jobs(*jobs);
        std::erase_if(rows, [&](const auto& row) { return row.machine != machine; });
        return [this, alive, rows = std::move(rows)]() mutable {
          if (alive.expired()) return;
          const std::set<std::int64_t> dismissed = services_.store->dismissed_jobs();
          std::erase_if(rows, [&](const auto& row) { return dismissed.contains(row.number); });
          interrupted_ = std::move(rows);
          callbacks_.changed();
        };
      });
}

// Held jogs.

CommandAnswer Station::press_jog(const std::string& client, const JogPress& press) {
  if (!is_ready()) return {Outcome::Refused, "NotIdentified", "The machine is not connected."};
  if (jog_.is_held() && jog_client_ != client) {
    return {Outcome::Refused, "JogHeldElsewhere", "Another screen is jogging this machine."};
  }
  session::JogWish wish{.axes = limits_.axes, .feed_mm_per_min = press.feed_mm_per_min};
  for (const auto& [letter, part] : press.direction) {
    const std::size_t axis = letter.size() == 1 ? wish.axes.find(letter.front()) : std::string::npos;
    if (axis == std::string::npos || axis >= wish.direction.size() || !(std::abs(part) <= 1)) {
      return {Outcome::Invalid, "NoSuchAxis", "This machine has no axis " + letter + ", or that is no direction."};
    }
    wish.direction.at(axis) = part;
  }
  wish.room_mm = room_along(wish.direction);
  if (const auto why = host_->session().why_no_line(services_.loop->now(), "$J=G91X1F1")) {
    return {Outcome::Refused, boost::describe::enum_to_string(*why, "?"), session::sentence_of(*why)};
  }
  if (!jog_.begin(services_.loop->now(), wish, host_->session().snapshot())) {
    return {Outcome::Invalid, "NoDirection",
            "A jog needs a direction, a feed above 0 and a machine that tells its "
            "position."};
  }
  jog_client_ = client;
  send_jogs();
  return {};
}

void Station::renew_jog(const std::string& client) {
  if (!jog_.is_held() || jog_client_ != client) return;
  jog_.renew(services_.loop->now());
  send_jogs();
}

void Station::release_jog(const std::string& client) {
  if (jog_client_ == client) end_jog();
}

void Station::end_jog() {
  if (!jog_.is_held()) return;
  jog_.end();
  jog_client_.clear();
  jog_timer_.disarm();
  if (host_) host_->submit(session::CancelJog{});
  callbacks_.changed();
}

void Station::send_jogs() {
  if (!jog_.is_held()) return;
  for (std::string words = jog_.take_words(); !words.empty(); words = jog_.take_words()) {
    host_->submit(session::Jog{std::move(words)});
  }
  jog_timer_.arm(jog_.next_deadline(), [this] { end_jog(); });
  callbacks_.changed();
}

std::optional<double> Station::room_along(const std::array<double, vocabulary::kMaxAxes>& direction) const {
  const machine::Snapshot& snapshot = host_->session().snapshot();
  const auto& at = snapshot.machine_position_mm;
  if (!limits_.min_mm || !limits_.max_mm || !at || !limits_.soft_limits.value_or(false)) return std::nullopt;
  if (!snapshot.homing.all.value_or(false)) return std::nullopt;
  double square = 0;
  for (const double part : direction) square += part * part;
  std::optional<double> room;
  for (std::size_t axis = 0; axis < limits_.min_mm->size() && axis < at->size(); ++axis) {
    const double part = direction.at(axis) / std::sqrt(square);
    if (part == 0) continue;
    const double end = part > 0 ? (*limits_.max_mm)[axis] : (*limits_.min_mm)[axis];
    const double left = std::max(0.0, (end - (*at)[axis]) / part);
    room = std::min(room.value_or(left), left);
  }
  return room;
}

}  // namespace kerf::daemon
