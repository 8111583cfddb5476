// `kerf info`: what a controller is and can do, as it tells itself.

#include <array>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <optional>
#include <string>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "apps/commands.hpp"
#include "apps/output.hpp"
#include "io/json.hpp"
#include "io/session_host.hpp"

namespace kerf::apps {
namespace {

using machine::Capabilities;
using machine::FactSource;
using namespace std::chrono_literals;

/// A machine that is busy with something else is not waited for longer than this.
constexpr Duration kBusyLimit = 5s;

std::string_view source_text(FactSource source) {
  switch (source) {
    case FactSource::Told: return "";
    case FactSource::Inferred: return " (concluded)";
    case FactSource::Assumed: return " (assumed: it does not say)";
  }
  return "";
}

void print_row(std::string_view name, std::string_view value) {
  if (!value.empty()) put("  {:<14} {}\n", name, value);
}

void print_codes(std::string_view title, const std::vector<machine::CodeFact>& codes) {
  if (codes.empty()) return;
  put("\n{} ({})\n", title, codes.size());
  for (const machine::CodeFact& code : codes) {
    // grblHAL has texts whose beginning serves as the title.
    const bool is_repeated = code.text.starts_with(code.title);
    const std::string meaning = is_repeated ? code.text : code.title + (code.text.empty() ? "" : ": ") + code.text;
    if (!meaning.empty()) put("  {:>3}  {}\n", code.id, meaning);
  }
}

void print_settings(const std::vector<machine::SettingFact>& settings) {
  if (settings.empty()) return;
  put("\nSettings ({})\n", settings.size());
  for (const machine::SettingFact& setting : settings) {
    const std::string unit = setting.unit.empty() ? "" : " " + setting.unit;
    put("  {:<22} {}\n", fmt::format("${}={}{}", setting.id, setting.value.value_or(""), unit), setting.name);
  }
}

void print_text(const Capabilities& machine) {
  print_row("Firmware",
            fmt::format("{} {}{}", machine.firmware, machine.version, source_text(machine.firmware_source)));
  print_row("Build", machine.build);
  print_row("Welcome", machine.welcome);
  print_row("Its name", machine.user_text);
  print_row("Axes",
            fmt::format("{} ({}){}", machine.axes.count, machine.axes.letters, source_text(machine.axes.source)));
  print_row("Receive buffer",
            fmt::format("{} bytes{}", machine.buffers.rx_bytes, source_text(machine.buffers.rx_source)));
  print_row("Planner",
            fmt::format("{} blocks{}", machine.buffers.planner_blocks, source_text(machine.buffers.planner_source)));
  print_row("Longest line",
            fmt::format("{} characters{}", machine.buffers.line_length, source_text(machine.buffers.line_source)));
  if (machine.tools) print_row("Tools", fmt::format("{}", *machine.tools));
  print_row("Options", machine.options);
  print_row("Capabilities", fmt::format("{}", fmt::join(machine.capabilities, " ")));
  for (const machine::BuildFact& row : machine.build_rows) print_row(row.key, row.value);
  print_codes("Alarms", machine.alarms);
  print_codes("Errors", machine.errors);
  print_settings(machine.settings);
  if (!machine.complete) put("\nThe machine left a question unanswered, so this may not be everything.\n");
}

/// Connects, waits until the session knows the controller, and leaves it as it was.
class Inquiry {
 public:
  Inquiry(io::EventLoop& loop, io::MachineUrl url) : loop_(loop), url_(std::move(url)), limit_(loop) {}

  std::optional<Capabilities> run() {
    session::SessionOptions options;
    options.reset_policy = session::ResetPolicy::WhenSilent;  // somebody's modal state must survive a question
    host_ = std::make_unique<io::SessionHost>(
        loop_, url_, options,
        io::SessionHost::Callbacks{
            .event = [this](const session::Event& event) { on_event(event); },
            .lost = [this](const io::TransportError& error) { fail(io::explain(url_, error)); }});
    loop_.run();
    return found_;
  }

 private:
  void on_event(const session::Event& event) {
    if (std::holds_alternative<session::ControllerFound>(event)) {
      found_ = host_->session().capabilities();
      loop_.stop();
    } else if (const auto* failed = std::get_if<session::HandshakeFailed>(&event)) {
      // The link itself says better what became of it.
      if (failed->failure != session::HandshakeFailure::LinkLost) fail(failed->sentence);
    } else if (const auto* busy = std::get_if<session::ControllerBusy>(&event)) {
      limit_.arm(loop_.now() + kBusyLimit,
                 [this, sentence = busy->sentence] { fail(sentence + " Ask again when the machine is idle."); });
    }
  }

  void fail(const std::string& sentence) {
    if (!found_ && !complained_) complain(sentence);
    complained_ = true;
    loop_.stop();
  }

  io::EventLoop& loop_;
  const io::MachineUrl url_;
  io::Timer limit_;
  std::optional<Capabilities> found_;
  bool complained_ = false;
  std::unique_ptr<io::SessionHost> host_;
};

}  // namespace

ExitStatus describe_machine(const DescribeOptions& options) {
  const auto url = io::parse_machine_url(options.machine);
  if (!url) {
    complain(io::explain(url.error()));
    return ExitStatus::Usage;
  }
  io::EventLoop loop;
  bool interrupted = false;
  constexpr std::array<int, 2> kSignals{SIGINT, SIGTERM};
  const io::SignalWatch signals(loop, kSignals, [&](int) {
    interrupted = true;
    loop.stop();
  });
  Inquiry inquiry(loop, *url);
  const auto found = inquiry.run();
  if (interrupted) return ExitStatus::Interrupted;
  if (!found) return ExitStatus::NoConnection;
  if (options.json) {
    put("{}\n", io::print(io::to_json(*found), 2));
  } else {
    print_text(*found);
  }
  return ExitStatus::Done;
}

}  // namespace kerf::apps
