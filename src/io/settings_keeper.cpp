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
  return text.starts_with('$') && text.contains('=') && !text.starts_with("$J");
}

}  // namespace

std::optional<session::Command> SettingsKeeper::on_event(const session::Event& event, const session::Session& session) {
  if (std::holds_alternative<session::ControllerFound>(event)) return on_found(session);
  if (const auto* changed = std::get_if<session::SettingsChanged>(&event)) {
    const auto& result = changed->result;
    if (!result.changed.empty() || !result.also_changed.empty())
      keep(settings_archive_of(url_, session.capabilities()), session, result.reason);
  } else if (const auto* line = std::get_if<session::LineReceived>(&event); line && is_setting_by_hand(*line)) {
    const std::string& text = line->answers->text;
    keep(settings_archive_of(url_, session.capabilities()), session, "by hand: " + text.substr(0, text.find('=')));
  }
  return std::nullopt;
}

std::optional<session::Command> SettingsKeeper::on_found(const session::Session& session) {
  // Half a list compares as if settings had gone.
  if (!session.capabilities().complete) return std::nullopt;
  const auto archive = settings_archive_of(url_, session.capabilities());
  auto last = archive.latest();
  keep(archive, session, last ? "found changed at connection" : "first connection");
  if (!last) return std::nullopt;
  return session::RecallSettings{.settings = std::move(last->settings), .since = std::move(last->taken)};
}

void SettingsKeeper::keep(const SettingsArchive& archive, const session::Session& session, const std::string& reason) {
  const auto stored = archive.store(session.capabilities(), reason, wall_clock_text());
  if (stored) return;
  // A disk that is full must not keep anybody from working: the next connection tries again.
  fault_ = "This set of settings is not in the history: " + explain(stored.error(), archive.folder());
}

}  // namespace kerf::io
