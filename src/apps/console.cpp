#include <array>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <unistd.h>

#include "apps/commands.hpp"
#include "apps/line_editor.hpp"
#include "apps/output.hpp"
#include "apps/progress_text.hpp"
#include "apps/status_text.hpp"
#include "apps/terminal.hpp"
#include "common/base/text.hpp"
#include "io/session_host.hpp"
#include "io/state_folder.hpp"

namespace kerf::apps {
namespace {

using namespace std::chrono_literals;
using vocabulary::MachineState;

/// After the last line of a pipe the console waits this long for something more to come.
constexpr Duration kLastWords = 300ms;

/// In the state folder; empty without one.
std::string history_file() {
  const std::string folder = io::state_folder();
  return folder.empty() ? std::string() : folder + "/console_history";
}

class Console {
 public:
  Console(io::EventLoop& loop, io::MachineUrl url, const ConsoleOptions& options)
      : loop_(loop),
        url_(std::move(url)),
        recording_(options.recording),
        may_reset_(options.may_reset),
        verbose_(options.verbose),
        last_words_(loop) {}

  ExitStatus run() {
    constexpr std::array<int, 2> kSignals{SIGINT, SIGTERM};
    const io::SignalWatch signals(loop_, kSignals, [this](int signal) { on_signal(signal); });
    session::SessionOptions options;
    options.reset_policy = may_reset_ ? session::ResetPolicy::WhenSilentToo : session::ResetPolicy::Never;
    io::SessionHost::Callbacks callbacks{.event = [this](const session::Event& event) { on_event(event); },
                                         .lost = [this](const io::TransportError& error) { on_lost(error); },
                                         .noted = [this](const std::string& sentence) { show(sentence); }};
    // The lines of a pipe would be refused while there is no link, and nobody would be there to repeat them.
    if (is_terminal(STDIN_FILENO) && is_terminal(STDOUT_FILENO)) {
      callbacks.interrupted = [this](const io::TransportError& error) { on_interrupted(error); };
    }
    host_ =
        std::make_unique<io::SessionHost>(loop_, url_, options, std::move(callbacks), recording_, io::WordsUse::Recall);
    loop_.run();
    return status_.value_or(ExitStatus::Done);
  }

 private:
  void on_event(const session::Event& event) {
    if (status_) return;
    std::visit([this](const auto& alternative) { on(alternative); }, event);
  }

  void on(const session::ControllerFound& found) {
    if (input_ && !std::exchange(is_interrupted_, false)) return;
    show(found.sentence);
    begin();
  }
  void on(const session::ControllerReset& reset) { show(reset.reason); }
  void on(const session::ControllerRestarted& restarted) {
    if (!restarted.asked) show("The controller has restarted of its own accord: what it was doing is over.");
  }
  void on(const session::HandshakeMoved& moved) {
    if (!verbose_) return;
    const auto& [at, from, to, cause, evidence] = moved.change;
    show(fmt::format("    {:.3f} s: {}, from {} to {}{}", base::to_seconds(at),
                     boost::describe::enum_to_string(cause, "?"), boost::describe::enum_to_string(from, "?"),
                     boost::describe::enum_to_string(to, "?"), evidence.empty() ? "" : ", seen from: " + evidence));
  }
  void on(const session::HandshakeNoted& noted) {
    if (verbose_) show("    " + noted.sentence);
  }
  void on(const session::ControllerBusy& busy) {
    show(busy.sentence + (input_ ? "" : " You may watch and use the realtime keys."));
    begin();
  }
  void on(const session::HandshakeFailed& failed) {
    // on_lost() says better what became of the link.
    if (failed.failure == session::HandshakeFailure::LinkLost) return;
    if (is_interrupted_) return show(failed.sentence);
    fail(failed.sentence, ExitStatus::NoConnection);
  }
  void on(const session::CommandRefused& refused) { show(refused.sentence); }
  void on(const session::SettingsDrifted& drift) { show(drift.sentence); }
  void on(const session::LinkSilent& silent) {
    show(fmt::format("The machine has not answered for {:.0f} s: check cable and power.", silent.silent_for_s));
  }
  void on(const session::LinkAnswering&) { show("The machine answers again."); }
  void on(const session::PendantTookOver& taken) { show(taken.sentence + " ':take' takes it back."); }
  void on(const session::PendantReleased&) { show("The pendant has given the machine back."); }
  void on(const session::LineReceived& line) {
    if (line.for_kerf) return;
    if (!input_ || (line.answers && line.answers->purpose != streaming::Purpose::Operator)) return;
    std::visit([&](const auto& message) { show_message(message, line.raw); }, line.message);
    if (has_ended_ && !std::holds_alternative<protocol::StatusReport>(line.message)) wait_for_last_words();
  }
  void on(const session::LineRefused& refused) {
    if (refused.purpose != streaming::Purpose::Operator) return;
    show("    " + refused.explanation.headline);
    show("    " + refused.refusal.meaning);
  }
  void on(const session::AlarmRaised& alarm) { show_explanation(alarm.explanation); }
  template <typename Other>
  void on(const Other&) {}

  template <typename Message>
  void show_message(const Message&, const std::string& raw) {
    show(base::escape(raw));
  }
  /// The session asks for reports all the time; only those that were asked for here are shown.
  void show_message(const protocol::StatusReport&, const std::string& raw) {
    if (reports_asked_ == 0) return;
    --reports_asked_;
    show(base::escape(raw));
    const machine::Snapshot& snapshot = host_->session().snapshot();
    std::string meaning = state_text(snapshot);
    if (const std::string where = position_text(snapshot); !where.empty()) meaning += " at " + where;
    if (snapshot.feed_mm_per_min) meaning += fmt::format(", feed {:.0f} mm/min", *snapshot.feed_mm_per_min);
    show("    " + meaning);
  }

  void show_explanation(const machine::Explanation& explanation) {
    show("    " + explanation.headline);
    for (const std::string& line : machine::details_of(explanation)) show("    " + line);
  }

  /// Lines that begin with a colon are for Kerf.
  bool obey_kerf_word(std::string_view line) {
    if (line == ":take") {
      host_->submit(session::TakeControl{});
    } else if (line == ":why") {
      const auto explanation = host_->session().alarm_explanation();
      if (explanation) return show_explanation(*explanation), true;
      show("The machine is not in alarm.");
    } else if (line == ":status") {
      const session::Session& session = host_->session();
      for (const std::string& row : status_lines({.firmware = {},
                                                  .machine = session.snapshot(),
                                                  .link = session.link_health(loop_.now()),
                                                  .alarm = session.alarm_explanation()})) {
        show(row);
      }
    } else {
      return false;
    }
    return true;
  }

  void begin() {
    if (input_) return;
    const InputCallbacks callbacks{.line = [this](std::string_view line) { send(line); },
                                   .realtime_key = [this](char key) { press(key); },
                                   .ended = [this] { end(); }};
    if (is_terminal(STDIN_FILENO) && is_terminal(STDOUT_FILENO)) {
      put("At the start of a line ? ! ~ and Ctrl-X act at once. :status, :why and :take are for Kerf. Ctrl-D "
          "leaves.\n");
      input_ = make_line_editor(loop_, "> ", history_file(), callbacks);
    } else {
      input_ = make_plain_reader(loop_, callbacks);
    }
  }

  void send(std::string_view line) {
    if (!obey_kerf_word(line)) host_->submit(session::SendLine{std::string(line)});
    if (has_ended_) wait_for_last_words();
  }

  void press(char key) {
    if (key == '?') ++reports_asked_;
    if (key == 0x18) show("Reset.");
    host_->submit(session::SendRealtime{static_cast<std::uint8_t>(key)});
  }

  /// The input is over. A pipe's answers are still to come; at a terminal somebody pressed Ctrl-D.
  void end() {
    if (is_terminal(STDIN_FILENO)) return finish(ExitStatus::Done);
    has_ended_ = true;
    wait_for_last_words();
  }

  void wait_for_last_words() {
    last_words_.arm(loop_.now() + kLastWords, [this] {
      if (host_->session().bytes_in_flight() > 0 || reports_asked_ > 0) return wait_for_last_words();
      finish(ExitStatus::Done);
    });
  }

  void on_signal(int signal) {
    const MachineState state = host_->session().snapshot().state;
    const bool moves = state == MachineState::Run || state == MachineState::Jog || state == MachineState::Home;
    if (signal != SIGINT || !input_ || !moves) {
      if (signal == SIGINT && input_ && input_->clear_line()) return;
      return finish(input_ ? ExitStatus::Done : ExitStatus::Interrupted);
    }
    show("Holding. ~ goes on, Ctrl-X resets.");
    host_->submit(session::SendRealtime{'!'});
  }

  void on_interrupted(const io::TransportError& error) {
    if (std::exchange(is_interrupted_, true))
      return;  // somebody takes the connection and closes it again: once is enough
    show(io::explain(url_, error));
    show("Kerf connects again as soon as it can, and asks the machine how it is. Nothing goes on by itself.");
  }

  void on_lost(const io::TransportError& error) {
    fail(io::explain(url_, error), input_ ? ExitStatus::Interrupted : ExitStatus::NoConnection);
  }

  void show(const std::string& line) {
    if (input_) {
      input_->print(line);
    } else {
      put("{}\n", line);
      std::fflush(stdout);
    }
  }

  void fail(const std::string& sentence, ExitStatus status) {
    if (status_) return;
    input_.reset();
    complain(sentence);
    finish(status);
  }

  void finish(ExitStatus status) {
    if (!status_) status_ = status;
    loop_.stop();
  }

  io::EventLoop& loop_;
  const io::MachineUrl url_;
  const io::RecordingOptions& recording_;
  const bool may_reset_;
  const bool verbose_;
  io::Timer last_words_;
  std::optional<ExitStatus> status_;
  int reports_asked_ = 0;
  bool has_ended_ = false;
  bool is_interrupted_ = false;  ///< the link was lost, and the machine is not known again yet
  std::unique_ptr<io::SessionHost> host_;
  std::unique_ptr<InputReader> input_;
};

}  // namespace

ExitStatus console(const ConsoleOptions& options) {
  const auto url = io::parse_machine_url(options.machine);
  if (!url) {
    complain(io::explain(url.error()));
    return ExitStatus::Usage;
  }
  io::EventLoop loop;
  Console console(loop, *url, options);
  return console.run();
}

}  // namespace kerf::apps
