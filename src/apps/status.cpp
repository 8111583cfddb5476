// `kerf status`: what the machine is doing, once or for as long as somebody watches.

#include <array>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <unistd.h>

#include "apps/commands.hpp"
#include "apps/inquiry.hpp"
#include "apps/output.hpp"
#include "apps/status_text.hpp"
#include "apps/terminal.hpp"
#include "io/json.hpp"
#include "io/session_host.hpp"

namespace kerf::apps {
namespace {

using namespace std::chrono_literals;

/// Between two reports the display only has to grow older where none comes.
constexpr Duration kStaleAfter = 1s;
constexpr Duration kStaleRedraw = 250ms;
/// An observer of JSON lines hears this often that nothing has changed.
constexpr Duration kHeartbeat = 10s;

MachineStatus status_of(const session::Session& session, Instant now) {
  return {.firmware = session.capabilities().firmware,
          .machine = session.snapshot(),
          .link = session.link_health(now),
          .alarm = session.alarm_explanation()};
}

void print_json(const MachineStatus& status, int indent) {
  put("{}\n", io::print(io::to_json(status), indent));
  std::fflush(stdout);
}

/// One line, refreshed in place.
class Line {
 public:
  ~Line() {
    if (!shown_.empty()) put("\n");
  }
  void show(const std::string& text) {
    if (text == shown_) return;
    put("\r{}\x1b[K", text);
    std::fflush(stdout);
    shown_ = text;
  }

 private:
  std::string shown_;
};

/// What a JSON observer wants to hear of: everything but the passing of time.
class Changes {
 public:
  [[nodiscard]] bool is_news(const session::Session& session, Instant now) {
    machine::Snapshot snapshot = session.snapshot();
    snapshot.reports = 0;
    snapshot.reported_at.reset();
    const bool is_silent = session.link_health(now).silent_for_s.has_value();
    const bool same = last_ && *last_ == snapshot && was_silent_ == is_silent && now < told_at_ + kHeartbeat;
    if (same) return false;
    last_ = std::move(snapshot);
    was_silent_ = is_silent;
    told_at_ = now;
    return true;
  }

 private:
  std::optional<machine::Snapshot> last_;
  bool was_silent_ = false;
  Instant told_at_{};
};

/// Shows every report until interrupted.
class Watch {
 public:
  Watch(io::EventLoop& loop, io::MachineUrl url, bool json, const io::RecordingOptions& recording)
      : loop_(loop), url_(std::move(url)), json_(json), recording_(recording), stale_(loop) {}

  ExitStatus run() {
    constexpr std::array<int, 2> kSignals{SIGINT, SIGTERM};
    const io::SignalWatch signals(loop_, kSignals, [this](int) { finish(ExitStatus::Done); });
    session::SessionOptions options;
    options.reset_policy = session::ResetPolicy::Never;
    options.enumerate = false;
    host_ = std::make_unique<io::SessionHost>(
        loop_, url_, options,
        io::SessionHost::Callbacks{.event = [this](const session::Event& event) { on_event(event); },
                                   .lost = [this](const io::TransportError& error) { on_lost(error); },
                                   .noted = [](const std::string& sentence) { complain(sentence); },
                                   .interrupted = [this](const io::TransportError& error) { on_interrupted(error); }},
        recording_);
    loop_.run();
    return status_.value_or(ExitStatus::Done);
  }

 private:
  void on_event(const session::Event& event) {
    if (status_) return;
    if (const auto* failed = std::get_if<session::HandshakeFailed>(&event)) {
      if (failed->failure != session::HandshakeFailure::LinkLost) fail(failed->sentence, ExitStatus::NoConnection);
    } else if (std::holds_alternative<session::StatusReported>(event) ||
               std::holds_alternative<session::ControllerFound>(event)) {
      show();
      stale_.arm(loop_.now() + kStaleAfter, [this] { grow_old(); });
    }
  }

  void grow_old() {
    show();
    stale_.arm(loop_.now() + kStaleRedraw, [this] { grow_old(); });
  }

  void show() {
    const Instant now = loop_.now();
    const session::Session& session = host_->session();
    has_shown_ = true;
    if (!json_) {
      line_.show(
          status_line({.firmware = {}, .machine = session.snapshot(), .link = session.link_health(now), .alarm = {}},
                      terminal_columns()));
    } else if (changes_.is_news(session, now)) {
      print_json(status_of(session, now), -1);
    }
  }

  /// Once a loss, however often somebody takes the connection and closes it again.
  void on_interrupted(const io::TransportError& error) {
    const std::uint64_t reports = host_->session().snapshot().reports;
    if (status_ || std::exchange(told_at_report_, reports) == reports) return;
    if (!json_ && has_shown_) put("\n");
    complain(io::explain(url_, error) + " Kerf connects again as soon as it can.");
  }

  void on_lost(const io::TransportError& error) {
    fail(io::explain(url_, error), has_shown_ ? ExitStatus::Interrupted : ExitStatus::NoConnection);
  }

  void fail(const std::string& sentence, ExitStatus status) {
    if (status_) return;
    if (!json_ && has_shown_) put("\n");
    complain(sentence);
    finish(status);
  }

  void finish(ExitStatus status) {
    if (!status_) status_ = status;
    stale_.disarm();
    loop_.stop();
  }

  io::EventLoop& loop_;
  const io::MachineUrl url_;
  const bool json_;
  const io::RecordingOptions& recording_;
  io::Timer stale_;
  Line line_;
  Changes changes_;
  bool has_shown_ = false;
  std::optional<std::uint64_t> told_at_report_;
  std::optional<ExitStatus> status_;
  std::unique_ptr<io::SessionHost> host_;
};

ExitStatus watch(const StatusOptions& options) {
  const auto url = io::parse_machine_url(options.machine);
  if (!url) {
    complain(io::explain(url.error()));
    return ExitStatus::Usage;
  }
  io::EventLoop loop;
  Watch view(loop, *url, options.json || !is_terminal(STDOUT_FILENO), options.recording);
  return view.run();
}

}  // namespace

ExitStatus show_status(const StatusOptions& options) {
  if (options.watch) return watch(options);
  bool in_alarm = false;
  // The codes of this controller, in its own words, are part of the explanation.
  const VisitOptions how{.enumerate = true, .takes_busy = true, .recording = options.recording};
  const ExitStatus status = visit(options.machine, how, [&](const io::SessionHost& host) {
    const MachineStatus known = status_of(host.session(), host.now());
    in_alarm = known.machine.state == vocabulary::MachineState::Alarm;
    if (options.json) {
      print_json(known, 2);
    } else {
      for (const std::string& line : status_lines(known)) put("{}\n", line);
    }
  });
  return status == ExitStatus::Done && in_alarm ? ExitStatus::Alarm : status;
}

}  // namespace kerf::apps
