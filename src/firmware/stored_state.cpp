#include "firmware/stored_state.hpp"

#include <algorithm>

#include "common/base/text.hpp"

namespace kerf::firmware {

namespace {

constexpr std::string_view kHeader = "# kerf state 1";
constexpr std::array<std::string_view, 12> kOffsetNames = {"G54",   "G55",   "G56",   "G57", "G58", "G59",
                                                           "G59.1", "G59.2", "G59.3", "G28", "G30", "G92"};
/// Digits that give every float back exactly enough: steps are never finer than a tenth of a micrometre.
constexpr int kOffsetDecimals = 6;

using Result = std::expected<void, StoredStateError::Reason>;

bool is_setting_id(std::string_view id) {
  if (id.empty()) return false;
  if (std::ranges::all_of(id, base::is_digit)) return true;
  return id.find('/') != std::string_view::npos;
}

// $110=500.000
Result read_dollar_line(StoredState& state, std::string_view line) {
  const auto equals = line.find('=');
  if (equals == std::string_view::npos) return std::unexpected(StoredStateError::Reason::UnknownLine);
  const std::string_view id = line.substr(1, equals - 1);
  const std::string_view value = line.substr(equals + 1);
  if (id == "I") {
    state.user_text = value;
  } else if (id == "N0" || id == "N1") {
    state.startup_lines.at(id == "N1" ? 1 : 0) = value;
  } else if (is_setting_id(id)) {
    state.settings.insert_or_assign(std::string{id}, std::string{value});
  } else {
    return std::unexpected(StoredStateError::Reason::UnknownLine);
  }
  return {};
}

std::expected<std::vector<double>, StoredStateError::Reason> read_numbers(std::string_view text) {
  std::vector<double> values;
  for (const std::string_view word : base::split(text, ',')) {
    const auto value = base::parse_decimal(word);
    if (!value) return std::unexpected(StoredStateError::Reason::BadNumber);
    values.push_back(*value);
  }
  return values;
}

void append_numbers(std::string& text, const std::vector<double>& values) {
  std::string_view separator;
  for (const double value : values) {
    text += separator;
    base::append_fixed(text, value, kOffsetDecimals);
    separator = ",";
  }
}

// [T:3|0.000000,0.000000,12.500000|0.500000]
Result read_tool(StoredState& state, std::string_view fields) {
  const auto parts = base::split(fields, '|');
  if (parts.size() != 3) return std::unexpected(StoredStateError::Reason::UnknownLine);
  const auto number = base::parse_int<int>(parts[0]);
  const auto radius = base::parse_decimal(parts[2]);
  auto length = read_numbers(parts[1]);
  if (!number || !radius || !length) return std::unexpected(StoredStateError::Reason::BadNumber);
  state.tools.insert_or_assign(*number, StoredTool{.length_mm = *std::move(length), .radius_mm = *radius});
  return {};
}

// [G54:1.000000,2.000000,3.000000]
Result read_offset_line(StoredState& state, std::string_view line) {
  const auto colon = line.find(':');
  if (colon == std::string_view::npos || line.back() != ']') {
    return std::unexpected(StoredStateError::Reason::UnknownLine);
  }
  const std::string_view name = line.substr(1, colon - 1);
  const std::string_view fields = line.substr(colon + 1, line.size() - colon - 2);
  if (name == "T") return read_tool(state, fields);
  if (std::ranges::find(kOffsetNames, name) == kOffsetNames.end())
    return std::unexpected(StoredStateError::Reason::UnknownLine);
  auto values = read_numbers(fields);
  if (!values) return std::unexpected(values.error());
  state.offsets.insert_or_assign(std::string{name}, *std::move(values));
  return {};
}

Result read_state_line(StoredState& state, std::string_view line) {
  if (line.empty() || line.starts_with('#')) return {};
  if (line.starts_with('$')) return read_dollar_line(state, line);
  if (line.starts_with('[')) return read_offset_line(state, line);
  return std::unexpected(StoredStateError::Reason::UnknownLine);
}

bool is_kept_with_settings(std::string_view id) {
  return is_setting_id(id) || id == "N0" || id == "N1";
}

// $110=500, $N0=G54   or a remark
Result read_settings_line(StoredState& state, std::string_view line) {
  line = base::trim(line);
  if (line.empty() || line.starts_with('#') || line.starts_with(';')) return {};
  const auto equals = line.find('=');
  if (!line.starts_with('$') || equals == std::string_view::npos ||
      !is_kept_with_settings(line.substr(1, equals - 1))) {
    return std::unexpected(StoredStateError::Reason::NotASetting);
  }
  return read_dollar_line(state, line);
}

template <typename ReadLine>
std::expected<StoredState, StoredStateError> read_lines(StoredState state, std::string_view text, ReadLine read_line) {
  std::size_t number = 0;
  for (std::string_view line : base::split(text, '\n')) {
    ++number;
    if (line.ends_with('\r')) line.remove_suffix(1);
    if (const Result result = read_line(state, line); !result) {
      return std::unexpected(StoredStateError{.reason = result.error(), .line = number});
    }
  }
  state.initialised = true;
  return state;
}

}  // namespace

std::string print(const StoredState& state) {
  if (!state.initialised) return {};
  std::string text{kHeader};
  text += '\n';
  for (const auto& [id, value] : state.settings) text.append("$").append(id).append("=").append(value).append("\n");
  for (std::size_t index = 0; index < state.startup_lines.size(); ++index) {
    if (state.startup_lines.at(index).empty()) continue;
    text.append("$N").append(std::to_string(index)).append("=").append(state.startup_lines.at(index)).append("\n");
  }
  if (!state.user_text.empty()) text.append("$I=").append(state.user_text).append("\n");
  for (const auto& [name, values] : state.offsets) {
    text.append("[").append(name);
    text += ':';
    append_numbers(text, values);
    text += "]\n";
  }
  for (const auto& [number, tool] : state.tools) {
    text.append("[T:").append(std::to_string(number)).append("|");
    append_numbers(text, tool.length_mm);
    text += '|';
    append_numbers(text, {tool.radius_mm});
    text += "]\n";
  }
  return text;
}

std::expected<StoredState, StoredStateError> parse_stored_state(std::string_view text) {
  if (base::trim(text).empty()) return StoredState{};
  if (!text.starts_with(kHeader)) {
    return std::unexpected(StoredStateError{.reason = StoredStateError::Reason::NotAState, .line = 1});
  }
  return read_lines({}, text, read_state_line);
}

std::expected<void, StoredStateError> apply_settings_text(StoredState& state, std::string_view text) {
  auto changed = read_lines(state, text, read_settings_line);
  if (!changed) return std::unexpected(changed.error());
  state = std::move(*changed);
  return {};
}

}  // namespace kerf::firmware
