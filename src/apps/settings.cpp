// `kerf settings`: what the controller is set to, and how that is changed, kept and put back.

#include <algorithm>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "apps/commands.hpp"
#include "apps/inquiry.hpp"
#include "apps/output.hpp"
#include "apps/setting_text.hpp"
#include "common/base/text.hpp"
#include "io/json.hpp"
#include "io/settings_archive.hpp"
#include "preparation/settings_json.hpp"
#include "sender/machine/settings_text.hpp"
#include "sender/machine/startup_line.hpp"

namespace kerf::apps {
namespace {

using machine::Capabilities;
using machine::SettingAssignment;
using machine::SettingFact;
using Status = std::optional<ExitStatus>;

/// A set of settings that somebody named, with the label of its first lines.
struct NamedSet {
  std::string name;
  std::string machine;
  std::vector<SettingAssignment> settings;
};

/// The machine at hand, and what it had.
struct Place {
  const Capabilities& machine;
  io::SettingsArchive archive;
};

std::string machine_of_label(std::string_view text) {
  constexpr std::string_view kLabel = "; machine: ";
  for (const std::string_view line : base::split(text, '\n')) {
    if (line.starts_with(kLabel)) return std::string{base::trim(line.substr(kLabel.size()))};
    if (!line.starts_with(';') && !line.starts_with('#')) break;
  }
  return {};
}

std::optional<NamedSet> version_named(std::string_view name, const Place& place) {
  const auto number = base::parse_int(name.substr(1));
  auto version = number ? place.archive.find(*number) : std::nullopt;
  if (!version) {
    complain(
        fmt::format("There is no version {} of this machine's settings: 'kerf settings history' lists them.", name));
    return std::nullopt;
  }
  return NamedSet{.name = std::string{name}, .machine = version->machine, .settings = std::move(version->settings)};
}

/// A file, `@3` of the history, or `now`; complains where it cannot be used.
std::optional<NamedSet> set_named(const std::string& name, const Place& place) {
  if (name == "now") return NamedSet{.name = name, .machine = {}, .settings = machine::settings_of(place.machine)};
  if (name.starts_with('@')) return version_named(name, place);
  const auto text = io::read_text_file(name);
  if (!text) {
    complain(io::explain(text.error(), name));
    return std::nullopt;
  }
  auto settings = machine::parse_settings_text(*text);
  if (!settings) {
    complain(fmt::format("'{}', line {}: '{}' is no line such as $110=500 and no remark: correct or remove it.", name,
                         settings.error().line, base::escape(settings.error().text)));
    return std::nullopt;
  }
  return NamedSet{.name = name, .machine = machine_of_label(*text), .settings = *std::move(settings)};
}

ExitStatus status_of(session::SettingsOutcome outcome) {
  switch (outcome) {
    case session::SettingsOutcome::Done:
    case session::SettingsOutcome::Unchanged: return ExitStatus::Done;
    case session::SettingsOutcome::Invalid: return ExitStatus::Usage;
    case session::SettingsOutcome::RolledBack:
    case session::SettingsOutcome::RollbackFailed: return ExitStatus::Refused;
    case session::SettingsOutcome::Interrupted:
    case session::SettingsOutcome::Held:
    case session::SettingsOutcome::Unanswered: return ExitStatus::Interrupted;
  }
  return ExitStatus::Interrupted;
}

/// Says something about the machine's settings and goes. With JSON, one value.
class SettingsErrand : public Errand {
 public:
  explicit SettingsErrand(SettingsOptions options) : options_(std::move(options)) {}

  Status begin(io::SessionHost& host, const io::MachineUrl& url) override {
    const Capabilities& machine = host.session().capabilities();
    return look(host, {.machine = machine, .archive = io::settings_archive_of(url, machine)});
  }
  Status on_event(io::SessionHost&, const session::Event&) override { return std::nullopt; }

 protected:
  virtual Status look(io::SessionHost& host, const Place& place) = 0;
  [[nodiscard]] const SettingsOptions& options() const { return options_; }

 private:
  const SettingsOptions options_;
};

class List : public SettingsErrand {
 public:
  using SettingsErrand::SettingsErrand;
  Status look(io::SessionHost& host, const Place& place) override {
    std::vector<SettingFact> chosen;
    for (const SettingFact& setting : place.machine.settings) {
      if (options().group.empty() || is_in_group(place.machine, setting, options().group)) chosen.push_back(setting);
    }
    if (chosen.empty() && !options().group.empty()) {
      complain(fmt::format("No settings are in a group '{}': 'kerf settings list' shows the groups.", options().group));
      return ExitStatus::Usage;
    }
    if (options().json) {
      put("{}\n", io::print(preparation::settings_json(place.machine, chosen), 2));
      return ExitStatus::Done;
    }
    print_settings(place.machine, std::move(chosen), options().verbose);
    if (const auto& drift = host.session().settings_drift(); !drift.empty()) {
      put("\n{}\n", session::drift_sentence(drift, {}));
    }
    return ExitStatus::Done;
  }
};

class Get : public SettingsErrand {
 public:
  using SettingsErrand::SettingsErrand;
  Status look(io::SessionHost&, const Place& place) override {
    std::vector<SettingFact> chosen;
    for (const std::string& item : options().items) {
      const SettingFact* setting = place.machine.find_setting(machine::setting_id_of(item));
      if (setting == nullptr) {
        complain(fmt::format("This machine has no setting '{}': 'kerf settings list' shows those that it has.", item));
        return ExitStatus::Usage;
      }
      chosen.push_back(*setting);
    }
    if (options().json) {
      put("{}\n", io::print(preparation::settings_json(place.machine, chosen), 2));
    } else {
      for (const SettingFact& setting : chosen) print_setting(place.machine, setting);
    }
    return ExitStatus::Done;
  }
};

class Diff : public SettingsErrand {
 public:
  using SettingsErrand::SettingsErrand;
  Status look(io::SessionHost&, const Place& place) override {
    const auto before = set_named(options().sets.front(), place);
    const auto after = set_named(options().sets.size() > 1 ? options().sets[1] : "now", place);
    if (!before || !after) return ExitStatus::Usage;
    const auto found = machine::differences(place.machine, before->settings, after->settings);
    if (options().json) {
      put("{}\n", io::print(io::to_json(found), 2));
      return ExitStatus::Done;
    }
    for (const auto& difference : found) put("{}\n", machine::sentence_of(difference));
    if (found.empty()) put("No difference between {} and {}.\n", before->name, after->name);
    return ExitStatus::Done;
  }
};

class Save : public SettingsErrand {
 public:
  using SettingsErrand::SettingsErrand;
  Status look(io::SessionHost&, const Place& place) override {
    const std::vector<std::string> label{"Settings, to be put back with 'kerf settings restore'.",
                                         "taken: " + io::wall_clock_text(),
                                         "machine: " + machine::summary_of(place.machine)};
    const std::string text = machine::print_settings_text(place.machine, machine::settings_of(place.machine), label);
    const std::string& file = options().sets.front();
    if (file == "-") {
      put("{}", text);
      return ExitStatus::Done;
    }
    if (const auto written = io::replace_text_file(file, text); !written) {
      complain(io::explain(written.error(), file));
      return ExitStatus::Usage;
    }
    put("Saved {} settings in {}.\n", place.machine.settings.size(), file);
    return ExitStatus::Done;
  }
};

class History : public SettingsErrand {
 public:
  using SettingsErrand::SettingsErrand;
  Status look(io::SessionHost&, const Place& place) override {
    const auto versions = place.archive.versions();
    if (options().json) {
      put("{}\n", io::print(io::to_json(versions), 2));
      return ExitStatus::Done;
    }
    if (place.archive.folder().empty()) put("No history is kept of this machine: it forgets everything at its end.\n");
    const std::vector<SettingAssignment>* before = nullptr;
    for (const io::SettingsVersion& version : versions) {
      put("@{:<4} {}  {}\n", version.number, version.taken, version.reason);
      if (before != nullptr) print_changes(place.machine, *before, version.settings);
      before = &version.settings;
    }
    return ExitStatus::Done;
  }

 private:
  static void print_changes(const Capabilities& machine, const std::vector<SettingAssignment>& before,
                            const std::vector<SettingAssignment>& after) {
    constexpr std::size_t kMost = 5;
    const auto found = machine::differences(machine, before, after);
    for (std::size_t index = 0; index < found.size() && index < kMost; ++index) {
      put("        {}\n", machine::sentence_of(found[index]));
    }
    if (found.size() > kMost) put("        and {} more\n", found.size() - kMost);
  }
};

/// Writes settings, and waits until they are written, read back or put back.
class Change : public SettingsErrand {
 public:
  using SettingsErrand::SettingsErrand;

  Status on_event(io::SessionHost&, const session::Event& event) override {
    if (const auto* refused = std::get_if<session::CommandRefused>(&event)) {
      complain(refused->sentence);
      return ExitStatus::Refused;
    }
    if (const auto* written = std::get_if<session::SettingWritten>(&event); written != nullptr && !options().json) {
      put("{:>3}/{} {}\n", written->step, written->steps, machine::sentence_of(written->setting));
      return std::nullopt;
    }
    if (const auto* changed = std::get_if<session::SettingsChanged>(&event)) return tell(changed->result);
    return std::nullopt;
  }

 protected:
  Status write(io::SessionHost& host, const Place& place, std::vector<SettingAssignment> settings,
               const std::string& usual_reason) {
    for (const SettingAssignment& setting : settings) {
      const SettingFact* known = place.machine.find_setting(setting.id);
      if (known != nullptr && machine::is_password(*known) && setting.value == machine::kStars) {
        complain(fmt::format("{} is a password that is not known here, only stars: give it, or leave it out.",
                             machine::label_of(*known)));
        return ExitStatus::Usage;
      }
    }
    if (options().dry_run) return rehearse(place, settings);
    if (const std::string danger = danger_of(place, settings); !danger.empty() && !options().allows_motion) {
      complain(danger + " Look at it, then give --allow-motion.");
      return ExitStatus::Usage;
    }
    host.submit(session::ChangeSettings{.settings = std::move(settings),
                                        .reason = options().reason.empty() ? usual_reason : options().reason});
    return std::nullopt;
  }

 private:
  /// A startup line that does more than set modes; Grbl runs it when it is written, and the old one when that is put
  /// back.
  static std::string danger_of(const Place& place, const std::vector<SettingAssignment>& settings) {
    const auto plan = machine::plan_settings(place.machine, settings);
    if (!plan) return {};
    for (const machine::SettingDifference& step : plan->steps) {
      if (!machine::is_startup_line(step.id)) continue;
      const std::string deed = machine::deed_of_startup_line(step.after);
      if (!deed.empty()) {
        return fmt::format("${} would be '{}', which {} at every start and reset, and once when it is written.",
                           step.id, step.after, deed);
      }
      const std::string old_deed = machine::deed_of_startup_line(step.before);
      if (!old_deed.empty() && plan->steps.size() > 1) {
        return fmt::format("${} is '{}', which {} if it has to be put back because another value is not taken.",
                           step.id, step.before, old_deed);
      }
    }
    return {};
  }

  Status rehearse(const Place& place, const std::vector<SettingAssignment>& settings) {
    const auto plan = machine::plan_settings(place.machine, settings);
    if (!plan) return tell(session::invalid_settings(plan.error(), options().reason));
    if (options().json) {
      put("{}\n", io::print(io::to_json(plan->steps), 2));
    } else {
      for (const auto& step : plan->steps) put("{}\n", machine::sentence_of(step));
      put("{} would be changed; nothing was sent.\n", plan->steps.size());
      if (const std::string danger = danger_of(place, settings); !danger.empty()) put("{}\n", danger);
    }
    return ExitStatus::Done;
  }

  Status tell(const session::SettingsResult& result) {
    const ExitStatus status = status_of(result.outcome);
    if (options().json) {
      put("{}\n", io::print(io::to_json(result), 2));
    } else if (status == ExitStatus::Done) {
      put("{}\n", result.sentence);
    } else {
      complain(result.sentence);
    }
    return status;
  }
};

class Set : public Change {
 public:
  using Change::Change;
  Status look(io::SessionHost& host, const Place& place) override {
    std::vector<SettingAssignment> settings;
    std::string reason = "set";
    for (const std::string& item : options().items) {
      const auto equals = item.find('=');
      const std::string id = machine::setting_id_of(std::string_view{item}.substr(0, equals));
      if (equals == std::string::npos || id.empty()) {
        complain(fmt::format("'{}' is no setting: write it as 110=500 or as '$110=500'.", item));
        return ExitStatus::Usage;
      }
      settings.push_back({.id = id, .value = item.substr(equals + 1)});
      reason += " $" + id;
    }
    return write(host, place, std::move(settings), reason);
  }
};

class Restore : public Change {
 public:
  using Change::Change;
  Status look(io::SessionHost& host, const Place& place) override {
    auto chosen = set_named(options().sets.front(), place);
    if (!chosen) return ExitStatus::Usage;
    const bool is_foreign = !chosen->machine.empty() && !chosen->machine.starts_with(place.machine.firmware + " ");
    if (is_foreign && !options().force) {
      complain(
          fmt::format("That set is of another firmware ({}), and this is {}: the same numbers mean other things. "
                      "Compare first with 'kerf settings diff'; --force restores it all the same.",
                      chosen->machine, place.machine.firmware));
      return ExitStatus::Usage;
    }
    return write(host, place, std::move(chosen->settings), "restored " + chosen->name);
  }
};

template <typename Kind>
ExitStatus run(const SettingsOptions& options) {
  Kind errand(options);
  return run_errand(options.machine, {.recording = options.recording}, errand);
}

}  // namespace

ExitStatus list_settings(const SettingsOptions& options) {
  return run<List>(options);
}
ExitStatus get_settings(const SettingsOptions& options) {
  return run<Get>(options);
}
ExitStatus set_settings(const SettingsOptions& options) {
  return run<Set>(options);
}
ExitStatus diff_settings(const SettingsOptions& options) {
  return run<Diff>(options);
}
ExitStatus save_settings(const SettingsOptions& options) {
  return run<Save>(options);
}
ExitStatus restore_settings(const SettingsOptions& options) {
  return run<Restore>(options);
}
ExitStatus list_settings_history(const SettingsOptions& options) {
  return run<History>(options);
}

}  // namespace kerf::apps
