#include "common/gcode/line_reader.hpp"

#include "common/gcode/plain_text.hpp"

namespace kerf::gcode {

namespace {

constexpr char kBackspace = '\b';
constexpr char kDelete = '\x7f';

/// Grbl's and grblHAL's `c <= ' '` on unsigned bytes.
constexpr bool is_blank_or_control(char c) {
  return static_cast<unsigned char>(c) <= ' ';
}

constexpr char upper(char c) {
  return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
}

}  // namespace

std::optional<ReadLine> LineReader::push(char byte) {
  const bool edits = (byte == kBackspace && rules_.edits) || (byte == kDelete && rules_.delete_edits);
  if (delivered_) start_line();
  if (edits) {
    erase_last();
    return std::nullopt;
  }
  if (rules_.overlong_at_once && length_ == rules_.length_max + 1) {
    delivered_ = true;
    return ReadLine{.text = {}, .overlong = true};
  }
  if (byte == '\n' || byte == '\r') return end_line(byte);

  switch (rules_.filter) {
    case LineRules::Filter::StripWhileReading: take_stripped(byte); break;
    case LineRules::Filter::KeepRaw: take_raw(byte); break;
    case LineRules::Filter::TrimLeading: take_trimmed(byte); break;
  }
  return std::nullopt;
}

std::optional<ReadLine> LineReader::push_line(std::string_view line) {
  if (!is_mid_line() && !line.empty() && line.size() <= rules_.length_max && is_plain(line)) {
    start_line();
    delivered_ = true;
    last_end_ = '\n';
    return ReadLine{.text = line};
  }
  for (const char byte : line) static_cast<void>(push(byte));
  return push('\n');
}

void LineReader::block_failed() {
  if (rules_.pairing == LineRules::Pairing::Either) last_end_ = '\0';
}

void LineReader::clear() {
  start_line();
  last_end_ = '\0';
}

std::optional<ReadLine> LineReader::end_line(char byte) {
  const bool second_half = length_ == 0 && !overlong_ &&
                           ((rules_.pairing == LineRules::Pairing::Either && last_end_ != '\0' && last_end_ != byte) ||
                            (rules_.pairing == LineRules::Pairing::LineFeedLast && last_end_ == '\r' && byte == '\n'));
  if (second_half) {
    last_end_ = '\0';
    start_line();
    return std::nullopt;
  }
  last_end_ = byte;
  delivered_ = true;
  return ReadLine{.text = {text_.data(), overlong_ ? 0 : length_}, .overlong = overlong_};
}

void LineReader::take_stripped(char byte) {
  if (overlong_ || in_comment_ || to_end_comment_) {
    if (byte == ')') in_comment_ = false;
    return;
  }
  if (is_blank_or_control(byte) || byte == '/') return;
  if (byte == '(') {
    in_comment_ = true;
  } else if (byte == ';') {
    to_end_comment_ = true;
  } else if (length_ >= rules_.length_max) {
    overlong_ = true;
  } else {
    text_[length_++] = upper(byte);
  }
}

void LineReader::take_raw(char byte) {
  last_end_ = '\0';
  text_[length_++] = byte;
}

void LineReader::take_trimmed(char byte) {
  const auto code = static_cast<unsigned char>(byte);
  if (length_ > 0 ? code < ' ' : code <= ' ') return;
  note_trimmed(byte);
  overlong_ = length_ >= rules_.length_max;
  if (!overlong_) text_[length_++] = byte;
}

void LineReader::note_trimmed(char byte) {
  switch (byte) {
    case '$':
    case '[':
      if (length_ == 0) keeps_realtime_ = true;
      break;
    case '(':
      if (!keeps_realtime_) {
        in_comment_ = !to_end_comment_;
        keeps_realtime_ = in_comment_;
      }
      break;
    case ')':
      if (!to_end_comment_) in_comment_ = keeps_realtime_ = false;
      break;
    case ';':
      if (!in_comment_) {
        keeps_realtime_ = false;
        to_end_comment_ = true;
      }
      break;
    default: break;
  }
}

void LineReader::erase_last() {
  if (length_ == 0) return;
  const std::size_t kept = --length_;
  in_comment_ = to_end_comment_ = keeps_realtime_ = false;
  for (length_ = 0; length_ < kept; ++length_) note_trimmed(text_[length_]);
}

void LineReader::start_line() {
  length_ = 0;
  overlong_ = in_comment_ = to_end_comment_ = keeps_realtime_ = delivered_ = false;
}

}  // namespace kerf::gcode
