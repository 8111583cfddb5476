// `kerf audit`: did the machine lose steps since it was homed?

#include <array>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>

#include "apps/commands.hpp"
#include "apps/output.hpp"
#include "apps/terminal.hpp"
#include "common/base/text.hpp"
#include "io/audit_history.hpp"
#include "io/journal_store.hpp"
#include "io/json.hpp"
#include "io/session_host.hpp"
#include "sender/job/position_audit.hpp"
#include "sender/session/audit_talk.hpp"

namespace kerf::apps {
namespace {

using namespace std::chrono_literals;
using machine::SettingAssignment;

/// A machine that is busy with something else is not waited for longer than this.
constexpr Duration kBusyLimit = 5s;
/// The controller may tell what it is, and its first full report a moment later.
constexpr Duration kUntilReported = 500ms;

ExitStatus status_of(job::AuditOutcome outcome) {
  switch (outcome) {
    case job::AuditOutcome::Kept: return ExitStatus::Done;
    case job::AuditOutcome::Shifted: return ExitStatus::Alarm;
    case job::AuditOutcome::Stopped: return ExitStatus::Interrupted;
    default: return ExitStatus::Refused;
  }
}

std::string names_of(const std::vector<SettingAssignment>& settings) {
  std::string text;
  for (const SettingAssignment& setting : settings) text += (text.empty() ? "$" : ", $") + setting.id;
  return text;
}

/// What an audit that did not come to its end has left off; empty if the newest one of the machine came to its end.
std::vector<SettingAssignment> left_off_by(const std::optional<io::AuditHistory>& history, const std::string& machine) {
  if (!history) return {};
  const auto newest = history->audits(machine, 1);
  if (!newest || newest->empty()) return {};
  return newest->front().result.left_off;
}

class AuditRunner {
 public:
  AuditRunner(io::EventLoop& loop, io::MachineUrl url, const AuditOptions& options,
              std::optional<io::AuditHistory> history)
      : loop_(loop), url_(std::move(url)), options_(options), history_(std::move(history)), timer_(loop) {}

  ExitStatus run() {
    constexpr std::array<int, 2> kSignals{SIGINT, SIGTERM};
    const io::SignalWatch signals(loop_, kSignals, [this](int) { stop(); });
    session::SessionOptions options;
    options.reset_policy = session::ResetPolicy::Never;
    options.enumerate = false;
    host_ = std::make_unique<io::SessionHost>(
        loop_, url_, options,
        io::SessionHost::Callbacks{.event = [this](const session::Event& event) { on_event(event); },
                                   .lost = [this](const io::TransportError& error) { on_lost(error); },
                                   .noted = [](const std::string& sentence) { complain(sentence); }},
        options_.recording);
    loop_.run();
    return status_.value_or(ExitStatus::NoConnection);
  }

 private:
  void on_event(const session::Event& event) {
    if (status_) return;
    if (audit_) {
      follow(event);
    } else if (std::holds_alternative<session::ControllerFound>(event)) {
      timer_.arm(loop_.now() + kUntilReported, [this] { plan(); });
    } else if (const auto* failed = std::get_if<session::HandshakeFailed>(&event)) {
      // The link itself says better what became of it.
      if (failed->failure != session::HandshakeFailure::LinkLost) fail(failed->sentence, ExitStatus::NoConnection);
    } else if (const auto* busy = std::get_if<session::ControllerBusy>(&event)) {
      timer_.arm(loop_.now() + kBusyLimit, [this, sentence = busy->sentence] {
        fail(sentence + " Audit it when it is idle.", ExitStatus::Refused);
      });
    }
  }

  void plan() {
    const session::Session& session = host_->session();
    auto plan = job::plan_audit(session.capabilities(), session.snapshot(), options_.axes,
                                left_off_by(history_, options_.machine));
    if (!plan) return fail(plan.error(), ExitStatus::Refused);
    plan_ = *std::move(plan);
    if (options_.yes) return begin();
    tell_plan();
    if (options_.json || !is_terminal(STDIN_FILENO) || !is_terminal(STDOUT_FILENO)) {
      return fail("The machine would move, and nobody can be asked here: --yes says that it may.", ExitStatus::Usage);
    }
    put("Begin? [y/N] ");
    std::fflush(stdout);
    keys_ = std::make_unique<KeyReader>(loop_, [this](char key) { on_key(key); });
  }

  void tell_plan() const {
    if (options_.json) return;
    std::string axes;
    for (const job::AuditAxis& axis : plan_.axes) axes += (axes.empty() ? "" : ", ") + std::string{axis.letter};
    put("The machine moves now, one axis after the other ({}), to its homing switch, at the rate of homing: first fast "
        "until {:.0f} mm before it, then in short moves until it closes. Then it homes, and measures once more.\n",
        axes, job::kAuditRangeMm);
    if (!plan_.protections_off.empty()) {
      put("At the switch a limit would stop it, so these settings are 0 meanwhile and are put back afterwards: {}. "
          "Each "
          "move is at most 0.25 mm there, and none goes more than {:.0f} mm beyond the switch's place.\n",
          names_of(plan_.protections_off), job::kAuditRangeMm);
    }
    if (!plan_.is_known_homed) {
      put("This firmware does not say whether it was homed. If it was only unlocked ($X) since it was switched on, the "
          "result means nothing.\n");
    }
    put("Is the spindle off, and the way up and to the switches free?\n");
  }

  void on_key(char key) {
    keys_.reset();
    put("{}\n", key == '\n' || key == '\r' ? 'n' : key);
    if (key == 'y' || key == 'Y') return begin();
    fail("Nothing was moved.", ExitStatus::Interrupted);
  }

  void begin() {
    // On disk before anything is switched off: who is killed cannot put it back.
    job::AuditResult begun{.tolerance_mm = options_.tolerance_mm, .left_off = plan_.protections};
    if (history_) {
      const auto number = history_->begin(options_.machine, begun);
      if (number) {
        number_ = *number;
      } else {
        complain("The audit is not kept: " + number.error().sentence + ".");
      }
    }
    audit_.emplace(loop_.now(), plan_, options_.tolerance_mm);
    settle();
  }

  void follow(const session::Event& event) {
    session::tell_audit(*audit_, loop_.now(), event, host_->session().snapshot());
    settle();
  }

  void settle() {
    for (const job::AuditOrder& order : audit_->take_orders()) {
      if (const auto command = session::command_of(order)) {
        host_->submit(*command);
      } else if (const auto* note = std::get_if<job::AuditNote>(&order); note != nullptr && !options_.json) {
        put("{}\n", note->sentence);
        std::fflush(stdout);
      }
    }
    if (audit_->is_over()) return tell();
    timer_.arm(audit_->next_deadline(), [this] {
      audit_->advance_to(loop_.now());
      settle();
    });
  }

  void tell() {
    const job::AuditResult& result = audit_->result();
    if (history_ && number_) {
      if (const auto kept = history_->update(*number_, result); !kept) {
        complain("The audit is not kept: " + kept.error().sentence + ".");
      }
    }
    const bool is_measured = result.outcome == job::AuditOutcome::Kept || result.outcome == job::AuditOutcome::Shifted;
    if (options_.json) {
      put("{}\n", io::print(io::to_json(result), 2));
    } else if (is_measured) {
      for (const job::AxisAudit& axis : result.axes) put("{}\n", job::sentence_of(axis));
      put("{}\n", result.sentence);
      if (number_) put("Kept as audit {}: kerf audit --history lists them all.\n", *number_);
    } else {
      complain(result.sentence);
    }
    finish(status_of(result.outcome));
  }

  void stop() {
    if (!audit_) return finish(ExitStatus::Interrupted);
    audit_->stop(loop_.now());
    settle();
  }

  void on_lost(const io::TransportError& error) {
    const std::string sentence = io::explain(url_, error);
    if (!audit_) return fail(sentence, ExitStatus::NoConnection);
    if (status_) return;
    audit_->on_link_lost(sentence);
    settle();
  }

  void fail(const std::string& sentence, ExitStatus status) {
    if (status_) return;
    complain(sentence);
    finish(status);
  }

  void finish(ExitStatus status) {
    if (!status_) status_ = status;
    timer_.disarm();
    keys_.reset();
    loop_.stop();
  }

  io::EventLoop& loop_;
  const io::MachineUrl url_;
  const AuditOptions& options_;
  std::optional<io::AuditHistory> history_;
  io::Timer timer_;
  job::AuditPlan plan_;
  std::optional<job::PositionAudit> audit_;
  std::optional<std::int64_t> number_;
  std::unique_ptr<KeyReader> keys_;
  std::optional<ExitStatus> status_;
  std::unique_ptr<io::SessionHost> host_;
};

void print_row(const io::KeptAudit& audit) {
  put("{:>5}  {}  {}\n", audit.number, audit.began, audit.machine);
  for (const job::AxisAudit& axis : audit.result.axes) {
    if (axis.difference_mm) put("       {}\n", job::sentence_of(axis));
  }
  put("       {}\n",
      audit.result.outcome == job::AuditOutcome::Unfinished ? "It was cut off before its end." : audit.result.sentence);
}

ExitStatus list(const AuditOptions& options, const std::string& path) {
  std::vector<io::KeptAudit> rows;
  if (!path.empty() && std::filesystem::exists(path)) {
    const auto history = io::AuditHistory::open(path);
    auto audits = history ? history->audits() : std::unexpected(history.error());
    if (!audits) {
      complain("The history of audits cannot be read: " + audits.error().sentence + ".");
      return ExitStatus::Usage;
    }
    rows = *std::move(audits);
  }
  if (options.json) {
    put("{}\n", io::print(io::to_json(rows), 2));
  } else if (rows.empty()) {
    put("No machine was audited yet.\n");
  } else {
    for (const io::KeptAudit& row : rows) print_row(row);
  }
  return ExitStatus::Done;
}

}  // namespace

ExitStatus audit(const AuditOptions& options) {
  const std::string path = io::journal_path(options.recording.journal);
  if (options.history) return list(options, path);
  const auto url = io::parse_machine_url(options.machine);
  if (!url) {
    complain(io::explain(url.error()));
    return ExitStatus::Usage;
  }
  AuditOptions wanted = options;
  for (char& letter : wanted.axes) letter = base::to_upper(letter);
  std::optional<io::AuditHistory> history;
  if (wanted.recording.journal.keeps && !path.empty()) {
    auto opened = io::AuditHistory::open(path);
    if (opened) {
      history = *std::move(opened);
    } else {
      complain("The audit is not kept: " + opened.error().sentence + ".");
    }
  }
  io::EventLoop loop;
  AuditRunner runner(loop, *url, wanted, std::move(history));
  return runner.run();
}

}  // namespace kerf::apps
