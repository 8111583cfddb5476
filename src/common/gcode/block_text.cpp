// A line becomes bare words: blanks and comments go, letters become capitals, each firmware in its own way
// (protocol.md 6.3).

#include <algorithm>

#include "common/base/text.hpp"
#include "common/gcode/block.hpp"
#include "common/gcode/plain_text.hpp"
#include "common/gcode/print_format.hpp"

namespace kerf::gcode {

namespace {

/// grblHAL and Rabbit compare signed characters: bytes from 0x80 count as control characters on grblHAL.
bool is_printable(char c) {
  return static_cast<signed char>(c) > ' ';
}

bool is_space(char c) {
  return c == ' ' || (c >= '\t' && c <= '\r');
}

char upper(char c) {
  return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
}

constexpr std::string_view kMessage = "MSG,";
constexpr std::string_view kDebug = "DEBUG,";
constexpr std::string_view kPrint = "PRINT,";
constexpr std::string_view kAbort = "ABORT,";

/// Rabbit shows what follows the fourth character of a comment that has MSG somewhere.
void note_comment(std::string_view comment, PreparedText& prepared) {
  if (comment.find("MSG") == std::string_view::npos) return;
  prepared.message = "GCode Comment..." + std::string(comment.size() > 4 ? comment.substr(4) : std::string_view());
}

PreparedText collapse(std::string_view line, BlockBuffer& buffer) {
  PreparedText prepared;
  std::size_t comment_at = std::string_view::npos;
  for (std::size_t at = 0; at < line.size(); ++at) {
    const char c = line[at];
    if (is_space(c)) continue;
    if (c == ')') {
      if (comment_at != std::string_view::npos) note_comment(line.substr(comment_at, at - comment_at), prepared);
      comment_at = std::string_view::npos;
    } else if (c == '(') {
      comment_at = at + 1;
    } else if (c == ';') {
      return prepared;
    } else if (c != '%' && comment_at == std::string_view::npos) {
      buffer.append(upper(c));
    }
  }
  if (comment_at != std::string_view::npos) note_comment(line.substr(comment_at), prepared);
  return prepared;
}

/// The first message of a line: `(MSG,text)` as it stands, and in builds with expressions `(PRINT,...)` and
/// `(DEBUG,...)` with values put in. A comment that is none may end the program with `(ABORT,text)`.
void hear_comment(std::string_view comment, BlockContext& context, PreparedText& prepared) {
  const bool has_expressions = context.rules.reads_expressions;
  const bool is_debug = has_expressions && base::starts_with_ignoring_case(comment, kDebug);
  const bool is_print = has_expressions && base::starts_with_ignoring_case(comment, kPrint);
  if (!prepared.has_message) {
    if (is_print || (is_debug && context.settings.prints_debug)) {
      prepared.message = substitute_parameters(comment.substr(kPrint.size()), context.rules, context.values());
      prepared.has_message = true;
    } else if (base::starts_with_ignoring_case(comment, kMessage)) {
      comment.remove_prefix(kMessage.size());
      while (comment.starts_with(' ')) comment.remove_prefix(1);
      prepared.message = comment;
      prepared.has_message = true;
    }
  }
  if (!has_expressions || prepared.has_message || is_debug || comment.empty()) return;
  const bool aborts = base::starts_with_ignoring_case(comment, kAbort);
  prepared.error = aborts ? ErrorCode::UserDefined : ErrorCode::Ok;
  if (!aborts) return;
  const std::string text = substitute_parameters(comment.substr(kAbort.size()), context.rules, context.values());
  context.out.push_back(OperatorMessage{.text = "Error: " + text});
}

PreparedText normalize(std::string_view line, bool jog, BlockContext& context, BlockBuffer& buffer) {
  const InterpreterSettings& settings = context.settings;
  const bool speaks = !settings.check_mode && !context.flow.skips();
  PreparedText prepared;
  while (!line.empty() && !is_printable(line.front())) line.remove_prefix(1);
  if (line.empty() || line.front() == ';') return prepared;
  if (line.front() == '/' && !jog) {
    if (settings.block_delete) return prepared;
    line.remove_prefix(1);
  }
  std::size_t comment_at = std::string_view::npos;
  for (std::size_t at = 0; at < line.size(); ++at) {
    const char c = line[at];
    if (!is_printable(c)) continue;
    const bool in_comment = comment_at != std::string_view::npos;
    if (c == ';' && !in_comment) break;
    if (c == '(') {
      comment_at = at + 1;
    } else if (c == ')') {
      if (in_comment && speaks) hear_comment(line.substr(comment_at, at - comment_at), context, prepared);
      comment_at = std::string_view::npos;
    } else if (!in_comment) {
      buffer.append(upper(c));
    }
  }
  prepared.demarcates = buffer.length == 1 && buffer.text[0] == '%';
  if (prepared.demarcates) buffer.length = 0;
  return prepared;
}

}  // namespace

PreparedText prepare_text(std::string_view line, bool jog, BlockContext& context, BlockBuffer& buffer) {
  buffer.length = 0;
  PreparedText prepared;
  if (line.size() < BlockBuffer::kCapacity && is_plain(line)) {
    std::ranges::copy(line, buffer.text.begin());
    buffer.length = line.size();
    buffer.text[buffer.length] = '\0';
    return prepared;
  }
  switch (context.rules.block_text) {
    case BlockText::AsRead:
      for (const char c : line) buffer.append(c);
      break;
    case BlockText::Collapsed: prepared = collapse(line, buffer); break;
    case BlockText::WithMessages: prepared = normalize(line, jog, context, buffer); break;
  }
  buffer.text[buffer.length] = '\0';
  return prepared;
}

}  // namespace kerf::gcode
