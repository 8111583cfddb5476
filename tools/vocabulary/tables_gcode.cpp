// G and M words, and `$` commands.

#include <map>
#include <string>

#include "common/gcode/commands.hpp"
#include "common/gcode/rules.hpp"
#include "firmware/personality.hpp"
#include "markdown.hpp"
#include "texts.hpp"

namespace kerf::tools {

using vocabulary::Firmware;
using vocabulary::FirmwareSet;

namespace {

std::string_view group_name(gcode::Group group) {
  using gcode::Group;
  switch (group) {
    case Group::None: return "";
    case Group::G0: return "G0 non-modal";
    case Group::G1: return "G1 motion";
    case Group::G2: return "G2 plane";
    case Group::G3: return "G3 distance";
    case Group::G4: return "G4 arc distance";
    case Group::G5: return "G5 feed mode";
    case Group::G6: return "G6 units";
    case Group::G7: return "G7 cutter compensation";
    case Group::G8: return "G8 tool length";
    case Group::G10: return "G10 retract";
    case Group::G11: return "G11 scaling";
    case Group::G12: return "G12 work offset";
    case Group::G13: return "G13 path control";
    case Group::G14: return "G14 spindle speed mode";
    case Group::G15: return "G15 diameter or radius";
    case Group::G16: return "G16 macros";
    case Group::M4: return "M4 program flow";
    case Group::M6: return "M6 tool change";
    case Group::M7: return "M7 spindle";
    case Group::M8: return "M8 coolant";
    case Group::M9: return "M9 overrides";
    case Group::M10: return "M10 pins";
    default: return "other";
  }
}

/// A word, who has it, and the group that it belongs to there.
struct Word {
  gcode::Group group{};
  FirmwareSet known_to = FirmwareSet::None;
};
FirmwareSet set_of(Firmware firmware) {
  switch (firmware) {
    case Firmware::Grbl: return FirmwareSet::Grbl;
    case Firmware::Rabbit: return FirmwareSet::Rabbit;
    case Firmware::GrblHal: return FirmwareSet::GrblHal;
    case Firmware::Unknown: break;
  }
  return FirmwareSet::None;
}

/// By number and hundredths.
using Words = std::map<std::pair<int, int>, Word>;

void add(Words& words, std::span<const gcode::CommandRow> rows, FirmwareSet firmware) {
  for (const gcode::CommandRow& row : rows) {
    Word& word = words[{row.number, row.hundredths}];
    word.group = row.group;
    word.known_to = word.known_to | firmware;
  }
}

std::string spelled(char letter, const std::pair<int, int>& number) {
  std::string text = letter + std::to_string(number.first);
  if (number.second != 0) {
    constexpr int kTen = 10;
    text += "." + std::to_string(number.second / kTen);
    if (number.second % kTen != 0) text += std::to_string(number.second % kTen);
  }
  return text;
}

std::string word_table(char letter, const Words& words) {
  Table table({"word", "group", "Grbl", "Rabbit", "grblHAL", "what it does"});
  for (const auto& [number, word] : words) {
    const std::string name = spelled(letter, number);
    std::vector<std::string> cells = {code(name), std::string{group_name(word.group)}};
    for (std::string& cell : ticks(word.known_to)) cells.push_back(std::move(cell));
    cells.emplace_back(text_of_word(name));
    table.row(cells);
  }
  return table.text();
}

Page words_page() {
  Words g_words;
  Words m_words;
  Table letters({"", "Grbl", "Rabbit", "grblHAL"});
  std::vector<std::string> values = {"letters with values, besides the axes"};
  std::vector<std::string> positive = {"letters that may not be negative"};
  std::vector<std::string> digits = {"digits that count"};
  for (const auto* const personality : firmware::all_personalities()) {
    const gcode::GcodeRules& rules = gcode::rules_for(personality->firmware);
    const FirmwareSet firmware = set_of(personality->firmware);
    constexpr std::uint64_t kNumbers = 1000;
    for (std::uint64_t number = 0; number < kNumbers; ++number) {
      add(g_words, rules.commands->g(number), firmware);
      add(m_words, rules.commands->m(number), firmware);
    }
    values.push_back(code(rules.value_letters));
    positive.push_back(code(rules.non_negative_letters));
    digits.push_back(std::to_string(rules.digits_max));
  }
  letters.row(values);
  letters.row(positive);
  letters.row(digits);
  return {.name = "words.md",
          .text = page_head("G and M words",
                            "Words that a firmware does not have are answered with error:20. Two words of one group in "
                            "a block are error:21. A word listed here may still be refused in the reference build: see "
                            "[../gcode.md](../gcode.md).") +
                  "## G\n\n" + word_table('G', g_words) + "\n## M\n\n" + word_table('M', m_words) + "\n## Letters\n\n" +
                  letters.text()};
}

std::string states_of(const firmware::StateSet& states) {
  using vocabulary::MachineState;
  std::string text;
  int count = 0;
  for (const auto& row : vocabulary::machine_state_rows()) {
    if (!states.contains(row.state)) continue;
    if (!text.empty()) text += ", ";
    text += row.name;
    ++count;
  }
  return count == static_cast<int>(vocabulary::machine_state_rows().size()) ? "any" : text;
}

Page dollar_page() {
  std::string text = page_head(
      "`$` commands",
      "In any other state than those listed the answer is error:8. *critical*: whether grblHAL answers it while only a "
      "reset helps; otherwise error:79. Grbl and Rabbit answer no line then.");
  for (const auto* const personality : firmware::all_personalities()) {
    const bool answers_critically = personality->dialect().critical_alarm_answers_lines;
    Table table({"command", "what it does", "states", "critical"});
    for (const firmware::CommandRow& row : personality->commands) {
      std::string name = "$" + std::string{row.name};
      if (row.needs_value && !name.ends_with('=')) name += "=…";
      if (row.takes_value && !row.needs_value) name += "[=…]";
      std::string effect{text_of_command(row.command)};
      if (!row.long_name.empty()) effect += " (also `$" + std::string{row.long_name} + "`)";
      table.row({code(name), effect, states_of(row.states), tick(answers_critically && row.works_critically)});
    }
    text.append("## ").append(personality->dialect().name).append("\n\n").append(table.text()).append("\n");
  }
  text +=
      "Grbl reads `$J=`, `$N`, `$Nn=`, `$H` and settings by rules of their own (Idle or Alarm; `$J=` Idle or Jog); "
      "settings are read alike on all three: `$n=value`.\n";
  return {.name = "commands.md", .text = std::move(text)};
}

}  // namespace

std::vector<Page> command_pages() {
  return {words_page(), dollar_page()};
}

}  // namespace kerf::tools
