// `kerf info`: what a controller is and can do, as it tells itself.

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "apps/commands.hpp"
#include "apps/inquiry.hpp"
#include "apps/output.hpp"
#include "apps/setting_text.hpp"
#include "io/json.hpp"
#include "sender/machine/setting_value.hpp"

namespace kerf::apps {
namespace {

using machine::Capabilities;
using machine::FactSource;

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

std::string feature_text(const machine::FeatureFact& fact) {
  if (!fact.available) return {};
  return fmt::format("{}{}", *fact.available ? "yes" : "no", source_text(fact.source));
}

std::string homing_text(const machine::HomingFact& homing) {
  if (!homing.enabled) return {};
  std::string text = *homing.enabled ? "on" : "off";
  if (homing.required_at_start.value_or(false)) text += ", needed at start";
  if (!homing.phases.empty()) text += fmt::format(", {} in turn", fmt::join(homing.phases, " then "));
  return text;
}

std::string tool_change_text(const machine::ToolChangeFact& change) {
  using machine::ToolChangeKind;
  const std::string mode = change.mode.empty() ? "" : " (" + change.mode + ")";
  switch (change.kind) {
    case ToolChangeKind::Unknown: return {};
    case ToolChangeKind::None: return "M6 is refused" + std::string{source_text(change.source)};
    case ToolChangeKind::Ignored: return "M6 is ignored" + std::string{source_text(change.source)};
    case ToolChangeKind::Manual: return "by hand" + mode;
    case ToolChangeKind::Changer: return "a tool changer" + mode;
  }
  return {};
}

void print_features(const Capabilities& machine) {
  const machine::Features& features = machine.features;
  print_row("Mode", features.mode.word + std::string{source_text(features.mode.source)});
  print_row("Reports in", features.report_units.word + std::string{source_text(features.report_units.source)});
  for (const machine::SpindleFact& spindle : machine.spindles) {
    const std::string range =
        spindle.max_rpm ? fmt::format(", {} to {} rpm", spindle.min_rpm.value_or(0), *spindle.max_rpm) : "";
    print_row("Spindle", fmt::format("{} {}{}", spindle.id, spindle.name, range));
  }
  print_row("Homing", homing_text(features.homing));
  print_row("Soft limits", feature_text(features.soft_limits));
  print_row("Hard limits", feature_text(features.hard_limits));
  print_row("Probe", feature_text(features.probe));
  print_row("Tool change", tool_change_text(features.tool_change));
  print_row("SD card", feature_text(features.sd_card));
  print_row("Pendant", feature_text(features.pendant));
  for (const machine::NetworkPortFact& port : features.network) {
    print_row("Network", fmt::format("{} at port {}{}", port.service, port.port, source_text(port.source)));
  }
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

void print_text(const Capabilities& machine, std::string_view link) {
  print_row("Firmware",
            fmt::format("{} {}{}", machine.firmware, machine.version, source_text(machine.firmware_source)));
  print_row("Link", link);
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
  print_features(machine);
  for (const machine::BuildFact& row : machine.build_rows) print_row(row.key, row.value);
  print_codes("Alarms", machine.alarms);
  print_codes("Errors", machine.errors);
  if (!machine.settings.empty()) put("\nSettings ({})\n", machine.settings.size());
  print_settings(machine, machine.settings, false);
  if (!machine.complete) put("\nThe machine left a question unanswered, so this may not be everything.\n");
}

/// Round trips are counted until there are this many, or for so long.
constexpr std::uint32_t kRoundTripsWanted = 5;
constexpr Duration kRoundTripsPatience = std::chrono::seconds{1};

std::string link_text(const session::LinkHealth& link) {
  if (!link.answer_time_s) return link.automatic ? "reports come unasked" : "no report was answered yet";
  const auto ms = [](double seconds) { return seconds * 1000; };
  std::string text = fmt::format("answers within {:.1f} ms", ms(*link.answer_time_s));
  if (link.round_trips > 1) {
    text += fmt::format(" ({:.1f} to {:.1f} ms in {} round trips)", ms(*link.answer_time_least_s),
                        ms(*link.answer_time_most_s), link.round_trips);
  }
  return text;
}

/// Waits for a few round trips, then says everything.
class Description : public Errand {
 public:
  explicit Description(bool json) : json_(json) {}

  std::optional<ExitStatus> begin(io::SessionHost& host, const io::MachineUrl&) override {
    until_ = host.now() + kRoundTripsPatience;
    return std::nullopt;
  }

  std::optional<ExitStatus> on_event(io::SessionHost& host, const session::Event&) override {
    const session::LinkHealth link = host.session().link_health(host.now());
    if (link.round_trips < kRoundTripsWanted && host.now() < until_) return std::nullopt;
    say(host.session(), link);
    return ExitStatus::Done;
  }

 private:
  void say(const session::Session& session, const session::LinkHealth& link) const {
    const Capabilities found = machine::without_passwords(session.capabilities());
    const auto& drift = session.settings_drift();
    if (json_) {
      io::Json json = io::to_json(found);
      json["settings_drift"] = io::to_json(drift);
      json["link"] = io::to_json(link);
      put("{}\n", io::print(json, 2));
      return;
    }
    print_text(found, link_text(link));
    if (!drift.empty()) put("\n{}\n", session::drift_sentence(drift, {}));
  }

  const bool json_;
  Instant until_{};
};

}  // namespace

ExitStatus describe_machine(const DescribeOptions& options) {
  Description description(options.json);
  return run_errand(options.machine, {.recording = options.recording}, description);
}

}  // namespace kerf::apps
