// `kerf conform`: interpreter cases in, one record of answers a case out, both as JSON lines.

#include <expected>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "apps/case_machine.hpp"
#include "apps/commands.hpp"
#include "apps/output.hpp"
#include "common/base/text.hpp"
#include "io/json.hpp"
#include "io/text_file.hpp"
#include "simulation/case_runner.hpp"

namespace kerf::apps {
namespace {

using io::Json;
using simulation::InterpreterCase;

/// Characters up to U+00FF as one byte each, as the recordings hold them; what lies beyond is sent as it stands.
std::string as_latin1(std::string_view utf8) {
  constexpr unsigned kTwoByteLead = 0xC0;
  constexpr unsigned kLastLatin1Lead = 0xC3;
  std::string bytes;
  for (std::size_t i = 0; i < utf8.size(); ++i) {
    const auto lead = static_cast<unsigned char>(utf8[i]);
    if (lead >= kTwoByteLead && lead <= kLastLatin1Lead && i + 1 < utf8.size()) {
      const auto rest = static_cast<unsigned char>(utf8[++i]);
      bytes += static_cast<char>(((lead & 3U) << 6U) | (rest & 0x3FU));
    } else {
      bytes += static_cast<char>(lead);
    }
  }
  return bytes;
}

std::string as_utf8(std::string_view latin1) {
  constexpr unsigned kAsciiEnd = 0x80;
  std::string text;
  for (const char letter : latin1) {
    const auto byte = static_cast<unsigned char>(letter);
    if (byte < kAsciiEnd) {
      text += letter;
    } else {
      text += static_cast<char>(0xC0U | (byte >> 6U));
      text += static_cast<char>(kAsciiEnd | (byte & 0x3FU));
    }
  }
  return text;
}

/// The strings of `json[key]`; false if something else stands there.
bool read_strings(const Json& json, const char* key, std::vector<std::string>& into) {
  const auto found = json.find(key);
  if (found == json.end()) return true;
  if (!found->is_array()) return false;
  for (const Json& item : *found) {
    if (!item.is_string()) return false;
    into.push_back(item.get<std::string>());
  }
  return true;
}

/// What is wrong, or the case.
std::expected<InterpreterCase, std::string> parse_case(std::string_view line) {
  const Json json = Json::parse(line, nullptr, false);
  if (!json.is_object()) return std::unexpected("this is no JSON object");
  const auto id = json.find("id");
  if (id == json.end() || !id->is_string()) return std::unexpected("\"id\" is missing; give each case a name");
  InterpreterCase parsed{.id = id->get<std::string>(), .lines = {}};
  std::vector<std::string> injections;
  if (!json.contains("lines") || !read_strings(json, "lines", parsed.lines)) {
    return std::unexpected("\"lines\" is no list of texts");
  }
  if (!read_strings(json, "setup", parsed.setup)) return std::unexpected("\"setup\" is no list of texts");
  if (!read_strings(json, "inject", injections)) return std::unexpected("\"inject\" is no list of texts");
  for (std::string& text : parsed.lines) text = as_latin1(text);
  for (std::string& text : parsed.setup) text = as_latin1(text);
  auto bytes = parse_injections(injections);
  if (!bytes) return std::unexpected("\"inject\" cannot be read");
  parsed.inject = *std::move(bytes);
  return parsed;
}

Json texts(const std::vector<std::string>& values) {
  Json array = Json::array();
  for (const std::string& value : values) array.push_back(as_utf8(value));
  return array;
}

Json as_json(const simulation::CaseRecord& record) {
  Json offsets = Json::object();
  for (const auto& [name, value] : record.offsets) offsets[as_utf8(name)] = as_utf8(value);
  Json json = Json::object();
  json["id"] = record.id;
  json["resp"] = texts(record.answers);
  json["alarms"] = texts(record.alarms);
  json["gc"] = record.parser_state.empty() ? Json(nullptr) : Json(as_utf8(record.parser_state));
  json["offsets"] = std::move(offsets);
  json["mpos_steps"] = record.position_steps;
  json["mpos"] = record.position_mm;
  json["msgs"] = texts(record.messages);
  return json;
}

}  // namespace

ExitStatus conform(const ConformOptions& options) {
  const auto machine = load_case_machine(options.machine);
  if (!machine) return ExitStatus::Usage;
  const auto text = io::read_text_file(options.file);
  if (!text) {
    complain(io::explain(text.error(), options.file));
    return ExitStatus::Usage;
  }
  std::size_t number = 0;
  for (const std::string_view line : base::split(*text, '\n')) {
    ++number;
    if (base::trim(line).empty()) continue;
    const auto asked = parse_case(line);
    if (!asked) {
      complain(fmt::format("{}, line {}: {}.", options.file, number, asked.error()));
      return ExitStatus::Usage;
    }
    put("{}\n", io::print(as_json(simulation::run_case(*asked, *machine))));
  }
  return ExitStatus::Done;
}

}  // namespace kerf::apps
