#pragma once
// Passwords that travel as settings or in commands of an ESP32, and where they stand in a line. Firmware prints them in
// plain text on serial and telnet (protocol.md 5.2, type 8), so Kerf hides them wherever people or logs see lines.

#include <cstddef>
#include <map>
#include <string>
#include <string_view>

#include "common/protocol/message.hpp"

namespace kerf::protocol {

/// Knows password settings from the tables of all firmwares and from the `$ES` rows of this controller. A text in a
/// setting that nobody has described counts as a password until its row says that it is none; so does a number while
/// the controller has descriptions that were not asked for.
class Secrets {
 public:
  /// `[SETTING:330|1|Admin Password|…|8|…]`
  void learn(const SettingDefinition& row);
  /// `[NEWOPT:ENUMS,…]`: the controller can describe its settings.
  void learn(const NewOptions& options);
  /// Learns from a line of the controller, if there is something to learn.
  void learn_from(std::string_view line);
  /// The same from a line that it said at another time: there may be settings by now that it did not describe then.
  void recall_from(std::string_view line);

  /// The value of setting `id` ("75") must not be shown.
  [[nodiscard]] bool is_secret(std::string_view id, std::string_view value) const;
  /// What must not be shown of a line without its end, such as `$75=…`, `[echo:$75=…]`, `$N0=$75=…` or
  /// `[ESP101]…`; empty if nothing.
  [[nodiscard]] std::string_view secret_in(std::string_view line) const;
  /// Where a secret may begin in a line of which the end is not known yet; its size when nowhere.
  [[nodiscard]] std::size_t doubtful_from(std::string_view unfinished) const;
  /// `line` with stars in place of the secret: as long as before.
  [[nodiscard]] std::string hidden(std::string_view line) const;
  /// A piece of a conversation, with stars where a secret may be; `before` is its line up to there.
  [[nodiscard]] std::string hidden_part(std::string_view before, std::string_view part) const;

 private:
  enum class Kind { Password, Open, Unknown };
  [[nodiscard]] Kind kind_of(std::string_view id) const;

  /// What the controller told; true for passwords.
  std::map<std::string, bool, std::less<>> told_;
  bool has_descriptions_ = false;
  /// At least one came over this link.
  bool was_described_ = false;
};

}  // namespace kerf::protocol
