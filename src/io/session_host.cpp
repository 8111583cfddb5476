#include "io/session_host.hpp"

#include <algorithm>
#include <chrono>
#include <thread>
#include <utility>
#include <variant>

#include "io/link_recorder.hpp"

namespace kerf::io {
namespace {

using namespace std::chrono_literals;

/// A commit takes some milliseconds; on an SD card, seconds.
constexpr auto kPatienceAtBeginning = 2000ms;

session::SessionOptions with_traits_of(const MachineUrl& url, session::SessionOptions options) {
  if (const auto* serial = std::get_if<SerialAddress>(&url)) options.link.baud = serial->baud;
  options.link.network = std::holds_alternative<TcpAddress>(url) || std::holds_alternative<WebSocketAddress>(url);
  if (const auto* address = std::get_if<VirtualAddress>(&url)) {
    // A clock that jumps is as good as endlessly fast.
    constexpr double kJumping = 1e6;
    options.machine_clock = address->speed.factor.value_or(kJumping);
  }
  return options;
}

}  // namespace

SessionHost::SessionHost(EventLoop& loop, const MachineUrl& url, session::SessionOptions options, Callbacks callbacks,
                         const RecordingOptions& recording, WordsUse words)
    : loop_(loop),
      session_(with_traits_of(url, options)),
      log_(loop, recording, {.machine = to_string(url), .options = with_traits_of(url, options)}),
      callbacks_(std::move(callbacks)),
      keeper_(url),
      words_(url, words),
      timer_(loop),
      link_(loop, url, callbacks_.interrupted ? Persistence::Again : Persistence::Once,
            {.opened =
                 [this] {
                   is_open_ = true;
                   session_.on_open(loop_.now(), link_.transport().opening());
                   settle();
                 },
             .received =
                 [this](std::string_view bytes) {
                   const std::string lines = session_.feed_ahead(loop_.now(), bytes);
                   if (!lines.empty()) {
                     link_.transport().write_lines(lines);
                     // A pty passes bytes on in a thread of the kernel, which may wait for this core.
                     std::this_thread::yield();
                   }
                   settle();
                 },
             .lost = [this](const TransportError& error) { on_lost(error); }}) {
  open_journal(url, recording.journal);
}

void SessionHost::open_journal(const MachineUrl& url, const JournalOptions& options) {
  // A virtual machine in this process is gone with it: there would be nothing to resume.
  const bool is_asked_for = !options.folder.empty() || !std::holds_alternative<VirtualAddress>(url);
  if (!options.keeps || !is_asked_for) return;
  const std::string path = journal_path(options);
  if (path.empty()) {
    if (callbacks_.noted)
      callbacks_.noted("Jobs are not written down: there is no home folder. Name one with --journal.");
    return;
  }
  journal_ = std::make_unique<JournalStore>(loop_, path, to_string(url), callbacks_.noted);
}

SessionHost::~SessionHost() {
  if (!is_open_) return;
  callbacks_ = {};  // whoever listened may be half gone
  session_.on_closed(loop_.now(), session::LinkLoss::HungUp);
  write_down();
  session::Outbox last = session_.take_outbox();
  if (journal_) journal_->append(std::move(last.journal));
}

void SessionHost::submit(const session::Command& command) {
  session_.submit(loop_.now(), command);
  settle();
}

void SessionHost::on_lost(const TransportError& error) {
  if (is_open_) {
    is_open_ = false;
    session_.on_closed(loop_.now(), loss_of(error.fault));
    settle();
  }
  timer_.disarm();
  if (link_.is_trying()) return callbacks_.interrupted(error);
  callbacks_.lost(error);
}

void SessionHost::write_down() {
  for (const session::Record& record : session_.take_records()) {
    log_.append(record);
    if (callbacks_.recorded) callbacks_.recorded(record);
  }
  const auto fault = log_.take_fault();
  if (fault && callbacks_.noted) callbacks_.noted(*fault);
}

void SessionHost::write_lines(session::Outbox& outbox) {
  const bool begins_job = std::ranges::any_of(
      outbox.journal, [](const auto& record) { return std::holds_alternative<job::JobBegun>(record.what); });
  if (journal_ && begins_job) {
    // Nothing moves yet. Behind this, a kill always leaves a job that can be found.
    journal_->append(std::exchange(outbox.journal, {}));
    journal_->wait_until_written(kPatienceAtBeginning);
  }
  if (!outbox.lines.empty()) link_.transport().write_lines(outbox.lines);
  if (journal_) journal_->append(std::move(outbox.journal));
}

void SessionHost::settle() {
  if (is_settling_) return;  // an observer submitted a command: the loop below goes on with it
  is_settling_ = true;
  for (session::Outbox outbox = session_.take_outbox(); !outbox.empty(); outbox = session_.take_outbox()) {
    if (!outbox.realtime.empty()) link_.transport().write_realtime(outbox.realtime);
    write_lines(outbox);
    write_down();  // behind the bytes: they have no time to lose
    for (const session::Event& event : outbox.events) {
      if (const auto command = keeper_.on_event(event, session_)) session_.submit(loop_.now(), *command);
      const auto fault = keeper_.take_fault();
      if (fault && callbacks_.noted) callbacks_.noted(*fault);
      if (const auto command = words_.on_event(event)) session_.submit(loop_.now(), *command);
      callbacks_.event(event);
    }
  }
  is_settling_ = false;
  write_down();
  timer_.arm(session_.next_deadline(), [this] {
    session_.advance_to(loop_.now());
    settle();
  });
}

}  // namespace kerf::io
