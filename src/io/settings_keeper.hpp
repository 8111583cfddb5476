#pragma once
// Watches a session and keeps every set of settings that its machine had. Belongs to the event loop's thread.

#include <optional>
#include <string>
#include <utility>

#include "io/machine_url.hpp"
#include "io/settings_archive.hpp"
#include "sender/session/session.hpp"

namespace kerf::io {

class SettingsKeeper {
 public:
  explicit SettingsKeeper(MachineUrl url) : url_(std::move(url)) {}

  /// Told of everything that the session tells. Once it has identified the machine, gives the settings of the last
  /// connection to compare with.
  [[nodiscard]] std::optional<session::Command> on_event(const session::Event& event, const session::Session& session);

  /// Why a set could not be kept, in one sentence; once.
  [[nodiscard]] std::optional<std::string> take_fault() { return std::exchange(fault_, std::nullopt); }

 private:
  [[nodiscard]] std::optional<session::Command> on_found(const session::Session& session);
  void keep(const SettingsArchive& archive, const session::Session& session, const std::string& reason);

  const MachineUrl url_;
  std::optional<std::string> fault_;
};

}  // namespace kerf::io
