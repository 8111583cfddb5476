#include "io/settings_keeper.hpp"

#include <utility>
#include <variant>

namespace kerf::io {
namespace {

/// An answered line such as `$110=600`.
bool is_setting_by_hand(const session::LineReceived& line) {
  if (!line.answers || line.answers->purpose != streaming::Purpose::Operator) return false;
  if (!std::holds_alternative<protocol::Ok>(line.message)) return false;
  const std::string& text = line.answers->text;
  return text.starts_with('$') && text.contains('=') && !text.starts_with("$J") && !text.starts_with("$N");
}

}  // namespace

std::optional<session::Command> SettingsKeeper::on_event(const session::Event& event, const session::Session& session) {
  if (std::holds_alternative<session::ControllerFound>(event)) return on_found(session);
  if (const auto* changed = std::get_if<session::SettingsChanged>(&event)) {
    const auto& result = changed->result;
    if (!result.changed.empty() || !result.also_changed.empty()) keep(session, result.reason);
  } else if (const auto* line = std::get_if<session::LineReceived>(&event); line && is_setting_by_hand(*line)) {
    const std::string& text = line->answers->text;
    keep(session, "by hand: " + text.substr(0, text.find('=')));
  }
  return std::nullopt;
}

std::optional<session::Command> SettingsKeeper::on_found(const session::Session& session) const {
  // Half a list compares as if settings had gone.
  if (!session.capabilities().complete) return std::nullopt;
  const auto archive = settings_archive_of(url_, session.capabilities());
  auto last = archive.latest();
  // A disk that is full must not keep anybody from working: the next connection tries again.
  static_cast<void>(archive.store(session.capabilities(), last ? "found changed at connection" : "first connection",
                                  wall_clock_text()));
  if (!last) return std::nullopt;
  return session::RecallSettings{.settings = std::move(last->settings), .since = std::move(last->taken)};
}

void SettingsKeeper::keep(const session::Session& session, const std::string& reason) const {
  static_cast<void>(
      settings_archive_of(url_, session.capabilities()).store(session.capabilities(), reason, wall_clock_text()));
}

}  // namespace kerf::io
