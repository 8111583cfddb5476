// A line becomes bare words: blanks and comments go, letters become capitals, each firmware in its own way
// (protocol.md 6.3).

#include "common/gcode/block.hpp"

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

bool begins_with_msg(std::string_view comment) {
  return comment.size() >= 4 && upper(comment[0]) == 'M' && upper(comment[1]) == 'S' && upper(comment[2]) == 'G' &&
         comment[3] == ',';
}

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

/// The first `(MSG,text)` of a line, without the blanks before the text.
void note_message(std::string_view comment, PreparedText& prepared) {
  if (!prepared.message.empty() || !begins_with_msg(comment)) return;
  comment.remove_prefix(4);
  while (!comment.empty() && comment.front() == ' ') comment.remove_prefix(1);
  prepared.message = comment;
}

PreparedText normalize(std::string_view line, bool jog, const InterpreterSettings& settings, BlockBuffer& buffer) {
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
      if (in_comment && !settings.check_mode) note_message(line.substr(comment_at, at - comment_at), prepared);
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

PreparedText prepare_text(std::string_view line, bool jog, const GcodeRules& rules, const InterpreterSettings& settings,
                          BlockBuffer& buffer) {
  buffer.length = 0;
  PreparedText prepared;
  switch (rules.block_text) {
    case BlockText::AsRead:
      for (const char c : line) buffer.append(c);
      break;
    case BlockText::Collapsed: prepared = collapse(line, buffer); break;
    case BlockText::WithMessages: prepared = normalize(line, jog, settings, buffer); break;
  }
  buffer.text[buffer.length] = '\0';
  return prepared;
}

}  // namespace kerf::gcode
