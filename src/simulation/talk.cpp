#include "simulation/talk.hpp"

#include <algorithm>
#include <utility>

#include "common/base/duration_text.hpp"
#include "common/base/text.hpp"
#include "firmware/workcell_script.hpp"

namespace kerf::simulation {
namespace {

std::string_view without_trailing_blanks(std::string_view line) {
  while (!line.empty() && base::is_blank(line.back())) line.remove_suffix(1);
  return line;
}

/// Text that is nothing but `\xNN` escapes is sent raw.
bool is_only_hex_escapes(std::string_view text) {
  constexpr std::size_t kEscape = 4;
  if (text.empty() || text.size() % kEscape != 0) return false;
  for (std::size_t at = 0; at < text.size(); at += kEscape) {
    const std::string_view escape = text.substr(at, kEscape);
    if (!escape.starts_with("\\x") || !base::parse_int(escape.substr(2), 16)) return false;
  }
  return true;
}

using ParsedAction = std::expected<decltype(TalkStep::action), TalkFault>;

ParsedAction send_text(std::string_view text) {
  if (text == "?" || text == "!" || text == "~") return SendBytes{.bytes = std::string(text)};
  if (is_only_hex_escapes(text)) return SendBytes{.bytes = base::unescape(text).value_or("")};
  return SendBytes{.bytes = std::string(text) + "\n"};
}

ParsedAction send_raw(std::string_view text) {
  auto bytes = base::unescape(text);
  if (!bytes) return std::unexpected(TalkFault::BadEscape);
  return SendBytes{.bytes = *std::move(bytes)};
}

ParsedAction to_pendant(ParsedAction action) {
  if (action) std::get<SendBytes>(*action).port = firmware::Port::Pendant;
  return action;
}

ParsedAction at(std::string_view text) {
  constexpr std::string_view kUntil = "until ";
  if (text.starts_with(kUntil)) return WaitUntil{LinePattern(std::string(text.substr(kUntil.size())))};
  if (text.starts_with('+')) {
    const auto time = base::parse_duration(text.substr(1));
    if (!time) return std::unexpected(TalkFault::BadTime);
    return LetTimePass{*time};
  }
  const auto event = firmware::parse_workcell_event(text);
  if (!event) return std::unexpected(TalkFault::BadSwitch);
  return MoveSwitch{*event};
}

ParsedAction parse_step(std::string_view line) {
  if (line.starts_with("@ ")) return at(line.substr(2));
  const std::string_view mark = line.substr(0, 2);
  if (line.size() > 2 && line[2] != ' ') return std::unexpected(TalkFault::UnknownMark);
  const std::string_view text = line.size() > 2 ? line.substr(3) : std::string_view{};
  if (mark == "->") return send_text(text);
  if (mark == "=>") return send_raw(text);
  if (mark == "P>") return to_pendant(send_text(text));
  if (mark == "<P") return ExpectLine{.pattern = LinePattern(std::string(text)), .port = firmware::Port::Pendant};
  if (mark == "<-") return ExpectLine{.pattern = LinePattern(std::string(text))};
  if (mark == "<~") return AllowLines{LinePattern(std::string(text))};
  if (mark == "<!") return ForbidLines{LinePattern(std::string(text))};
  return std::unexpected(TalkFault::UnknownMark);
}

std::expected<void, TalkFault> read_header(Talk& talk, std::string_view text) {
  const auto parts = base::split_at_most(base::trim(text), ' ', 2);
  const std::string_view value = parts.size() > 1 ? base::trim(parts[1]) : std::string_view{};
  if (parts[0] == "personality") {
    talk.personality = firmware::personality_named(value);
    if (talk.personality == nullptr) return std::unexpected(TalkFault::UnknownPersonality);
  } else if (parts[0] == "axes" || parts[0] == "tools") {
    const auto count = base::parse_int<int>(value);
    if (!count || *count < 0) return std::unexpected(TalkFault::BadCount);
    (parts[0] == "axes" ? talk.hardware.axes : talk.hardware.tools) = *count;
  } else if (parts[0] == "ports") {
    const auto ports = firmware::parse_port_counts(value);
    if (!ports) return std::unexpected(TalkFault::BadCount);
    talk.hardware.ports = *ports;
  } else if (parts[0] == "spindle-encoder") {
    talk.hardware.spindle_encoder = true;
  } else if (parts[0] == "slow-memory") {
    talk.hardware.slow_memory = true;
  } else if (parts[0] == "setting") {
    talk.settings.emplace_back(value);
  } else if (parts[0] == "power-up") {
    talk.begins_at_power_up = true;
  } else if (parts[0] == "pendant") {
    talk.has_pendant = true;
  } else if (parts[0] == "card") {
    talk.has_card = true;
  } else if (parts[0] == "file") {
    const auto file = base::split_at_most(value, ' ', 2);
    const auto contents = base::unescape(file.size() > 1 ? file[1] : std::string_view{});
    if (!contents || file[0].empty()) return std::unexpected(TalkFault::BadEscape);
    talk.has_card = true;
    talk.card_files.push_back({.path = std::string{file[0]}, .contents = *contents});
  } else if (parts[0] == "virtual-only") {
    talk.virtual_only_because = std::string(value);
  } else {
    return std::unexpected(TalkFault::UnknownHeader);
  }
  return {};
}

}  // namespace

bool LinePattern::matches(std::string_view line) const {
  // Two-finger matching: on a mismatch the last star takes one more character.
  std::size_t in_line = 0;
  std::size_t in_pattern = 0;
  std::size_t after_star = std::string::npos;
  std::size_t star_ends = 0;
  while (in_line < line.size()) {
    if (in_pattern < text_.size() && text_[in_pattern] == '*') {
      after_star = ++in_pattern;
      star_ends = in_line;
    } else if (in_pattern < text_.size() && text_[in_pattern] == line[in_line]) {
      ++in_pattern;
      ++in_line;
    } else if (after_star != std::string::npos) {
      in_pattern = after_star;
      in_line = ++star_ends;
    } else {
      return false;
    }
  }
  return text_.find_first_not_of('*', in_pattern) == std::string::npos;
}

bool Talk::moves_switches() const {
  return std::ranges::any_of(steps,
                             [](const TalkStep& step) { return std::holds_alternative<MoveSwitch>(step.action); });
}

std::expected<Talk, TalkSyntaxError> parse_talk(std::string_view text, std::string_view folder_personality) {
  Talk talk;
  talk.personality = firmware::personality_named(folder_personality);
  std::size_t number = 0;
  for (const std::string_view row : base::split(text, '\n')) {
    ++number;
    const std::string_view line = without_trailing_blanks(row);
    if (line.empty() || line.starts_with('#')) continue;
    if (line.starts_with('%')) {
      if (!talk.steps.empty()) return std::unexpected(TalkSyntaxError{TalkFault::HeaderAfterStep, number});
      const auto header = read_header(talk, line.substr(1));
      if (!header) return std::unexpected(TalkSyntaxError{header.error(), number});
      continue;
    }
    auto action = parse_step(line);
    if (!action) return std::unexpected(TalkSyntaxError{action.error(), number});
    talk.steps.push_back({.line = number, .text = std::string(line), .action = *std::move(action)});
  }
  if (talk.personality == nullptr) return std::unexpected(TalkSyntaxError{TalkFault::UnknownPersonality, 1});
  return talk;
}

std::string_view explain(TalkFault fault) {
  switch (fault) {
    case TalkFault::UnknownMark:
      return "a line begins with '->', '=>', '<-', '<~', '<!', 'P>', '<P', '@', '%' or '#', then one space";
    case TalkFault::BadCount: return "this header wants whole numbers";
    case TalkFault::UnknownHeader:
      return "this header is none of personality, axes, tools, ports, slow-memory, spindle-encoder, setting, power-up, "
             "card, file, "
             "pendant and virtual-only";
    case TalkFault::HeaderAfterStep: return "headers stand before the first step";
    case TalkFault::UnknownPersonality:
      return "nobody knows who speaks: add '% personality grbl', 'rabbit', 'grblhal' or 'grblhal-expr'";
    case TalkFault::BadEscape: return "an escape is one of \\r \\n \\t \\\\ and \\xNN";
    case TalkFault::BadTime: return "time is written like '@ +1s' or '@ +200ms'";
    case TalkFault::BadSwitch: return "this is no switch: write for example '@ limit X on' or '@ door open'";
  }
  return {};
}

}  // namespace kerf::simulation
