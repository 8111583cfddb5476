#include "sender/job/wire_form.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>

#include "common/base/text.hpp"
#include "sender/job/program_flow.hpp"

namespace kerf::job {
namespace {

constexpr bool is_plain(char letter) {
  const bool printable = letter >= ' ' && letter <= '~';
  return printable && letter != '?' && letter != '!' && letter != '~';
}

bool is_mark(char letter) {
  return letter == '?' || letter == '!' || letter == '~';
}

bool is_for_the_operator(std::string_view comment) {
  constexpr std::array<std::string_view, 3> kStarts{"MSG,", "PRINT,", "DEBUG,"};
  return std::ranges::any_of(kStarts,
                             [comment](auto start) { return base::starts_with_ignoring_case(comment, start); });
}

/// Takes the comment that starts at `at`; gives where the line goes on.
std::size_t append_comment(std::string& out, std::string_view line, std::size_t at, WireForm form) {
  const std::size_t close = line.find(')', at);
  // An unclosed comment prints nothing and hides the rest of the line.
  if (close == std::string_view::npos) return line.size();
  const std::string_view comment = line.substr(at + 1, close - at - 1);
  if (form.keeps_messages && is_for_the_operator(base::trim(comment))) {
    out += '(';
    for (const char letter : base::trim(comment)) {
      if (is_plain(letter) || (form.keeps_marks && is_mark(letter))) out += letter;
    }
    out += ')';
  }
  return close + 1;
}

/// What a character adds to the words of a line: itself or nothing.
constexpr auto kAdds = [] {
  std::array<bool, 256> adds{};
  for (std::size_t byte = 0; byte < adds.size(); ++byte) {
    const char letter = static_cast<char>(byte);
    adds.at(byte) = letter != ' ' && is_plain(letter);
  }
  return adds;
}();

/// The words up to the next comment, without a branch for what is left out; gives where they end.
std::size_t append_until_comment(std::string& out, std::string_view line, std::size_t at) {
  const std::size_t before = out.size();
  out.resize(before + line.size() - at);
  char* to = out.data() + before;
  for (; at < line.size() && line[at] != ';' && line[at] != '('; ++at) {
    *to = line[at];
    to += kAdds[static_cast<unsigned char>(line[at])] ? 1 : 0;
  }
  out.resize(static_cast<std::size_t>(to - out.data()));
  return at;
}

void append_words(std::string& out, std::string_view line, WireForm form) {
  for (std::size_t at = 0; at < line.size();) {
    at = append_until_comment(out, line, at);
    if (at == line.size() || line[at] == ';') return;
    at = append_comment(out, line, at, form);
  }
}

void replace_optional_stop(std::string& out, std::size_t from, ProgramSwitch optional_stop) {
  const std::string_view text = std::string_view{out}.substr(from);
  if (!flow_words_of(text).pauses_optionally) return;
  std::string rest = without_word(text, 'M', 1);
  if (optional_stop == ProgramSwitch::On) rest.insert(rest.starts_with('/') ? 1 : 0, "M0");
  out.replace(from, std::string::npos, rest);
}

}  // namespace

WireForm wire_form_of(const vocabulary::Dialect& dialect) {
  return {.keeps_messages = dialect.comment_rule == vocabulary::CommentRule::ParsedForMessages,
          .keeps_percent = dialect.percent_rule != vocabulary::PercentRule::Error,
          .keeps_slash = dialect.block_delete_rule == vocabulary::BlockDeleteRule::SkippedIfOn};
}

void append_wire_form(std::string& out, std::string_view line, WireForm form) {
  const std::string_view trimmed = base::trim(line);
  if (trimmed.starts_with('$')) {
    std::ranges::copy_if(trimmed, std::back_inserter(out), is_plain);
    return;
  }
  const bool may_be_deleted = trimmed.starts_with('/');
  if (may_be_deleted && form.block_delete == ProgramSwitch::On) return;
  const bool keeps_slash = form.keeps_slash && form.block_delete == ProgramSwitch::AsMachine;
  const std::size_t before = out.size();
  append_words(out, may_be_deleted && !keeps_slash ? trimmed.substr(1) : trimmed, form);
  if (form.optional_stop != ProgramSwitch::AsMachine) replace_optional_stop(out, before, form.optional_stop);
  if (!form.keeps_percent && std::string_view{out}.substr(before) == "%") out.resize(before);
}

}  // namespace kerf::job
