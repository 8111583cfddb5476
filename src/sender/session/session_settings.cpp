// Settings: changing them, and comparing them with those of the last connection.

#include <string>
#include <utility>
#include <variant>

#include "common/base/overloaded.hpp"
#include "common/base/text.hpp"
#include "sender/machine/rest.hpp"
#include "sender/machine/startup_line.hpp"
#include "sender/session/session.hpp"

namespace kerf::session {

using streaming::Purpose;

std::vector<std::string> Session::settings_queries() const {
  std::vector<std::string> queries{"$$", "$N"};
  const auto named = handshake_.collector().dialect().named_settings_query;
  if (!named.empty()) queries.emplace_back(named);
  return queries;
}

void Session::obey(Instant now, const ChangeSettings& command) {
  if (const auto reason = why_no_line(now, "")) {
    refuse(*reason);
    return;
  }
  if (!machine::may_store_settings(snapshot())) {
    refuse(Refused::MachineNotIdle);
    return;
  }
  auto plan = machine::plan_settings(capabilities(), command.settings);
  if (!plan) {
    tell(SettingsChanged{invalid_settings(std::move(plan.error()), command.reason)});
    return;
  }
  if (plan->steps.empty()) {
    tell(SettingsChanged{unchanged_settings(command.reason)});
    return;
  }
  settings_change_.emplace(now, capabilities(), *std::move(plan), settings_queries(),
                           handshake_.collector().dialect().reads_single_settings, command.reason);
}

void Session::follow_settings(Instant now) {
  if (!settings_change_) return;
  for (auto& order : settings_change_->take_orders()) {
    std::visit(
        base::Overloaded{
            [&](const AskForReport&) {
              send_byte(vocabulary::Realtime::StatusQuery);
              poller_.on_asked(now);
              gate_.on_asked(now);
            },
            [&](SendSettingLine& line) { streamer_.enqueue(Purpose::Setting, std::move(line.text)); },
            [&](NoteSetting& note) {
              tell(SettingWritten{.setting = std::move(note.difference), .step = note.step, .steps = note.steps});
            },
        },
        order);
  }
  if (!settings_change_->is_over()) return;
  streamer_.drop_queued(Purpose::Setting);
  handshake_.refresh();
  tell(SettingsChanged{settings_change_->result()});
  settings_change_.reset();
}

void Session::obey(Instant, const RecallSettings& command) {
  recalled_ = command;
  if (is_ready()) tell_drift();
}

void Session::obey(Instant, const RecallWords& command) {
  handshake_.recall(command.words);
}

void Session::tell_drift() {
  if (!recalled_ || !capabilities().complete) return;
  const RecallSettings recalled = *std::exchange(recalled_, std::nullopt);
  settings_drift_ = machine::differences(capabilities(), recalled.settings, machine::settings_of(capabilities()));
  // Sets of an older Kerf have no startup lines.
  std::erase_if(settings_drift_, [](const auto& row) { return machine::is_startup_line(row.id) && !row.known_before; });
  if (settings_drift_.empty()) return;
  tell(SettingsDrifted{.differences = settings_drift_, .sentence = drift_sentence(settings_drift_, recalled.since)});
}

/// What Kerf knows follows what was set by hand. Defaults may change everything, units included: all of it is asked for
/// again, with or without the welcome that most firmware sends (protocol.md 7.1).
void Session::on_operator_line_accepted(Instant now, std::string_view text) {
  const std::string_view line = base::trim(text);
  const auto equals = line.find('=');
  if (!is_ready() || !line.starts_with('$') || equals == std::string_view::npos) return;
  const std::string_view name = line.substr(1, equals - 1);
  if (base::iequals(name, "RST")) {
    poller_.stop();
    handshake_.restart(now, false);
  } else if (const auto* setting = capabilities().find_setting(name)) {
    handshake_.learn({.id = setting->id, .value = std::string{line.substr(equals + 1)}});
  }
}

}  // namespace kerf::session
