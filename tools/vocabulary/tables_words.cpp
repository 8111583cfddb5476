// Realtime bytes, states, status fields, alarms and errors, messages, build options.

#include <algorithm>
#include <cstdio>

#include "common/vocabulary/accessories.hpp"
#include "common/vocabulary/alarms.hpp"
#include "common/vocabulary/dialect.hpp"
#include "common/vocabulary/machine_state.hpp"
#include "common/vocabulary/messages.hpp"
#include "common/vocabulary/options.hpp"
#include "common/vocabulary/pins.hpp"
#include "common/vocabulary/realtime.hpp"
#include "common/vocabulary/report_mask.hpp"
#include "common/vocabulary/status_fields.hpp"
#include "markdown.hpp"

namespace kerf::tools {

using vocabulary::Firmware;
using vocabulary::FirmwareSet;

namespace {

std::string byte_name(std::uint8_t byte) {
  char text[16];
  if (byte > ' ' && byte < 0x7F) {
    std::snprintf(text, sizeof text, "`%c` 0x%02X", byte, byte);
  } else {
    std::snprintf(text, sizeof text, "0x%02X", byte);
  }
  return text;
}

/// How one firmware treats a realtime byte.
std::string treatment(const vocabulary::RealtimeRow& row, Firmware firmware) {
  if (contains(row.optional_in, firmware)) return "build option";
  if (contains(row.known_to, firmware)) return "acts";
  return is_realtime(vocabulary::dialect_of(firmware), static_cast<std::uint8_t>(row.byte)) ? "dropped" : "text";
}

Page realtime_page() {
  Table table({"byte", "name", "Grbl", "Rabbit", "grblHAL", "effect, and when it is legal"});
  for (const auto& row : vocabulary::realtime_rows()) {
    table.row({byte_name(static_cast<std::uint8_t>(row.byte)), std::string{row.name}, treatment(row, Firmware::Grbl),
               treatment(row, Firmware::Rabbit), treatment(row, Firmware::GrblHal), std::string{row.text}});
  }
  return {.name = "realtime.md",
          .text = page_head("Realtime bytes",
                            "*acts*: has an effect; *build option*: has one if the driver, a plugin or a build option "
                            "says so; *dropped*: taken out of the stream without effect; *text*: becomes part of the "
                            "line.") +
                  table.text()};
}

Page states_page() {
  Table states({"state", "meaning", "known to", "lines are read by", "what happens, and the way out"});
  for (const auto& row : vocabulary::machine_state_rows()) {
    states.row(
        {code(row.name), std::string{row.title}, names(row.known_to), names(row.reads_lines), std::string{row.text}});
  }
  Table substates({"state", "meaning", "known to", "what happens"});
  for (const auto& row : vocabulary::substate_rows()) {
    const std::string name = std::string{name_of(row.state)} + ":" + std::to_string(row.substate);
    substates.row({code(name), std::string{row.title}, names(row.known_to), std::string{row.text}});
  }
  return {.name = "states.md",
          .text = page_head("Machine states", "The first word of a status report.") + states.text() +
                  "\n## Substates\n\nThe number behind the colon. In `Alarm` it is the alarm's code (grblHAL, `$10` "
                  "bit 10).\n\n" +
                  substates.text()};
}

Page status_page() {
  Table fields({"field", "value", "known to", "`$10` bit", "what it tells, and when it is sent"});
  for (const auto& row : vocabulary::status_field_rows()) {
    fields.row({row.name.empty() ? "*plugins*" : code(row.name), code(row.syntax), names(row.known_to),
                row.needs ? std::to_string(static_cast<int>(*row.needs)) : "", std::string{row.text}});
  }
  std::string orders;
  for (const auto* const dialect : vocabulary::all_dialects()) {
    orders.append("- ").append(dialect->name).append(": ");
    bool first = true;
    for (const auto field : dialect->field_order) {
      if (!first) orders += ", ";
      first = false;
      const std::string_view name = vocabulary::row_of(field).name;
      orders += name.empty() ? "*plugins*" : code(name);
    }
    orders += "\n";
  }
  Table plugins({"field", "what it tells"});
  for (const auto& row : vocabulary::plugin_field_rows()) plugins.row({code(row.name), std::string{row.text}});
  Table bits({"bit", "name", "known to", "what it switches on"});
  for (const auto& row : vocabulary::report_bit_rows()) {
    bits.row(
        {std::to_string(static_cast<int>(row.bit)), std::string{row.name}, names(row.known_to), std::string{row.text}});
  }
  Table pins({"letter", "input", "known to", "active when"});
  for (const auto& row : vocabulary::pin_rows()) {
    pins.row({code({&row.letter, 1}), std::string{row.name}, names(row.known_to), std::string{row.text}});
  }
  Table accessories({"letter", "output", "known to", "meaning"});
  for (const auto& row : vocabulary::accessory_rows()) {
    accessories.row({code({&row.letter, 1}), std::string{row.name}, names(row.known_to), std::string{row.text}});
  }
  return {.name = "status.md",
          .text = page_head("Status report fields",
                            "What may stand behind the state. The order differs: go by the names.") +
                  fields.text() + "\n## Order in the report\n\n" + orders + "\n## Fields of plugins\n\n" +
                  plugins.text() + "\n## Bits of `$10`\n\n" + bits.text() + "\n## Letters of `Pn:`\n\n" + pins.text() +
                  "\n## Letters of `A:`\n\n" + accessories.text()};
}

std::string_view build_name(vocabulary::BuildOption build) {
  switch (build) {
    case vocabulary::BuildOption::Usual: return "";
    case vocabulary::BuildOption::Expressions: return "expressions";
    case vocabulary::BuildOption::CutterCompensation: return "cutter compensation";
    case vocabulary::BuildOption::FileSystem: return "file system";
    case vocabulary::BuildOption::Bluetooth: return "Bluetooth";
    case vocabulary::BuildOption::Driver: return "driver or plugin";
    default: return "more axes";
  }
}

/// All firmwares' codes by number; a row that several share stands once.
std::string code_table(std::span<const vocabulary::CodeRow> vocabulary::Dialect::* rows) {
  Table table({"code", "known to", "meaning", "remarks", "cause, and what to do"});
  int highest = 0;
  for (const auto* const dialect : vocabulary::all_dialects()) {
    for (const auto& row : dialect->*rows) highest = std::max(highest, row.code);
  }
  for (int number = 0; number <= highest; ++number) {
    std::vector<vocabulary::CodeRow> found;
    for (const auto* const dialect : vocabulary::all_dialects()) {
      const auto* const row = vocabulary::find_code(dialect->*rows, number);
      if (row != nullptr && std::ranges::find(found, *row) == found.end()) found.push_back(*row);
    }
    for (const auto& row : found) {
      std::string remarks{build_name(row.build)};
      if (row.critical) remarks += remarks.empty() ? "only a reset helps" : ", only a reset helps";
      table.row({std::to_string(number), names(row.known_to), std::string{row.title}, remarks, std::string{row.text}});
    }
  }
  return table.text();
}

Page codes_page(std::string_view name, std::string_view title, std::string_view introduction,
                std::span<const vocabulary::CodeRow> vocabulary::Dialect::* rows) {
  return {.name = name, .text = page_head(title, introduction) + code_table(rows)};
}

Page messages_page() {
  Table brackets({"line", "known to", "what it tells"});
  for (const auto& row : vocabulary::bracket_rows()) {
    brackets.row({code("[" + std::string{row.name} + ":" + std::string{row.syntax} + "]"), names(row.known_to),
                  std::string{row.text}});
  }
  Table texts({"Grbl", "Rabbit", "grblHAL", "when"});
  for (const auto& row : vocabulary::feedback_rows()) {
    texts.row({code(row.grbl), code(row.rabbit), code(row.grblhal), std::string{row.text}});
  }
  return {.name = "messages.md",
          .text = page_head("Lines in brackets", "Everything that a controller says besides answers and reports.") +
                  brackets.text() + "\n## Texts of `[MSG:]`\n\n" + texts.text()};
}

Page options_page() {
  Table letters({"letter", "name", "known to", "meaning"});
  for (const auto& row : vocabulary::option_rows()) {
    letters.row({code({&row.letter, 1}), std::string{row.name}, names(row.known_to), std::string{row.text}});
  }
  Table tokens({"token", "name", "from", "meaning"});
  for (const auto& row : vocabulary::new_option_rows()) {
    tokens.row({code(std::string{row.token} + (row.takes_value ? "=n" : "")), std::string{row.name},
                row.plugin ? "driver or plugin" : "core", std::string{row.text}});
  }
  return {.name = "options.md",
          .text = page_head("Build options", "What `$I` says about a build.") + "## Letters of `[OPT:]`\n\n" +
                  letters.text() + "\n## Tokens of grblHAL's `[NEWOPT:]`\n\n" + tokens.text()};
}

}  // namespace

std::vector<Page> vocabulary_pages() {
  return {
      realtime_page(),
      states_page(),
      status_page(),
      codes_page("errors.md", "Errors", "The number behind `error:`, in our own words.", &vocabulary::Dialect::errors),
      codes_page("alarms.md", "Alarms", "The number behind `ALARM:`, in our own words.", &vocabulary::Dialect::alarms),
      messages_page(),
      options_page()};
}

}  // namespace kerf::tools
