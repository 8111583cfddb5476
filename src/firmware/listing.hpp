#pragma once
// What `$` queries list: settings, codes, build information, help (protocol.md 4.5, 4.6, 5).

#include <cstdint>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "firmware/board.hpp"

namespace kerf::firmware {

/// Prints lists about the controller. Changes nothing.
class Listing {
 public:
  explicit Listing(Board& board) : board_(board) {}

  void help();
  /// `$HELP` and `$HELP topic`, the topic in capitals.
  void help_on(std::string_view topic);
  void settings();
  void changed_settings();
  void named_settings();
  void setting_names();
  void commands();
  void one_setting(const SettingsStore::Slot& slot);
  /// As Rabbit prints it by name: `$Homing/Enable=On`.
  void one_named_setting(const SettingsStore::Slot& slot);
  void one_named(std::string_view name, std::string_view value);
  /// Name and value of each setting that has a name.
  [[nodiscard]] std::vector<std::pair<std::string, std::string>> named() const;
  /// `$N0` alone, under the name it was asked for.
  void one_startup_line(std::string_view index, std::string_view name);
  void state();
  void memory_use();
  void describe_setting(const SettingsStore::Slot& slot);
  void setting_description(std::string_view key);
  void startup_lines();
  void build_information(bool extended);
  void alarms();
  void errors();
  void setting_groups();
  void setting_definitions();
  /// The forms for spreadsheets: `$EAG`, `$EEG`, `$ESG`, `$ESH`.
  void alarms_as_csv();
  void errors_as_csv();
  void settings_as_csv();
  void settings_as_tabs();
  void limits();
  void home_switches();
  void last_events();
  void spindles(bool for_machines);
  /// One alarm or error by number (Rabbit `$EA=n`); false if there is none.
  bool one_alarm(int code);
  bool one_error(int code);

 private:
  void help_topics();
  void line(std::string text);
  void codes_as_csv(std::span<const vocabulary::CodeRow> rows);
  [[nodiscard]] std::set<int> groups_in_use() const;
  [[nodiscard]] std::string option_letters() const;
  [[nodiscard]] std::vector<std::string> new_options() const;
  [[nodiscard]] std::string unit_of(const SettingsStore::Slot& slot) const {
    return vocabulary::unit_of(slot.match, board_.settings.rotary_axes());
  }
  [[nodiscard]] bool titles() const { return board_.personality.codes_have_titles; }

  Board& board_;
};

/// The description with what the firmware adds to it.
[[nodiscard]] std::string description_of(const vocabulary::SettingRow& row);
/// A setting's number, or its name where it has no number.
[[nodiscard]] std::string key_of(const SettingsStore::Slot& slot);

}  // namespace kerf::firmware
