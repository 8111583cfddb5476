#pragma once
// Markdown tables from rows of the code.

#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include "common/vocabulary/firmware.hpp"

namespace kerf::tools {

/// One file below docs/protocol/tables.
struct Page {
  std::string_view name;
  std::string text;
};

/// Collects rows; cells are escaped when they are added.
class Table {
 public:
  explicit Table(std::initializer_list<std::string_view> head);

  void row(const std::vector<std::string>& cells);
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  std::string text_;
};

/// A page's first lines: its title, and that nobody should edit it.
[[nodiscard]] std::string page_head(std::string_view title, std::string_view introduction);

/// `text` in back quotes; empty if it is empty.
[[nodiscard]] std::string code(std::string_view text);

/// "yes" or "–".
[[nodiscard]] std::string tick(bool value);
/// Three cells: Grbl, Rabbit, grblHAL.
[[nodiscard]] std::vector<std::string> ticks(vocabulary::FirmwareSet known_to);

/// "all", or the names.
[[nodiscard]] std::string names(vocabulary::FirmwareSet known_to);

// tables_words.cpp: what both ends of the wire share.
[[nodiscard]] std::vector<Page> vocabulary_pages();
// tables_settings.cpp.
[[nodiscard]] std::vector<Page> settings_pages();
// tables_gcode.cpp: G and M words, `$` commands.
[[nodiscard]] std::vector<Page> command_pages();
// tables_figures.cpp: sizes, policies and motion rules.
[[nodiscard]] std::vector<Page> figure_pages();

}  // namespace kerf::tools
