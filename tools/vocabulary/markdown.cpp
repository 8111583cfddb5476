#include "markdown.hpp"

#include <array>

namespace kerf::tools {

using vocabulary::Firmware;
using vocabulary::FirmwareSet;

namespace {

constexpr std::array kFirmwares = {Firmware::Grbl, Firmware::Rabbit, Firmware::GrblHal};

std::string escaped(std::string_view cell) {
  std::string text;
  for (const char letter : cell) {
    if (letter == '|') text += '\\';
    text += letter;
  }
  return text;
}

}  // namespace

Table::Table(std::initializer_list<std::string_view> head) {
  std::string rule;
  for (const std::string_view cell : head) {
    text_.append("| ").append(cell).append(" ");
    rule += "|---";
  }
  text_ += "|\n" + rule + "|\n";
}

void Table::row(const std::vector<std::string>& cells) {
  for (const std::string& cell : cells) text_.append("| ").append(escaped(cell)).append(cell.empty() ? "" : " ");
  text_ += "|\n";
}

std::string page_head(std::string_view title, std::string_view introduction) {
  std::string text = "<!-- Generated from the code by `make docs`. Do not edit. -->\n\n# ";
  text.append(title).append("\n\n").append(introduction).append("\n\n");
  return text;
}

std::string code(std::string_view text) {
  return text.empty() ? "" : "`" + std::string{text} + "`";
}

std::string tick(bool value) {
  return value ? "yes" : "–";
}

std::vector<std::string> ticks(FirmwareSet known_to) {
  std::vector<std::string> cells;
  for (const Firmware firmware : kFirmwares) cells.push_back(tick(contains(known_to, firmware)));
  return cells;
}

std::string names(FirmwareSet known_to) {
  if (known_to == FirmwareSet::All) return "all";
  std::string text;
  for (const Firmware firmware : kFirmwares) {
    if (!contains(known_to, firmware)) continue;
    if (!text.empty()) text += ", ";
    text += name_of(firmware);
  }
  return text;
}

}  // namespace kerf::tools
