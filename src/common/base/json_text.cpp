#include "common/base/json_text.hpp"

#include <algorithm>
#include <cstdint>

#include "common/base/text.hpp"

namespace kerf::base {
namespace {

constexpr int kDeepest = 16;

void append_utf8(std::string& out, std::uint32_t code) {
  const auto put = [&out](std::uint32_t byte) { out += static_cast<char>(byte); };
  if (code < 0x800) {
    put(0xC0U | code >> 6U);
  } else {
    put(0xE0U | code >> 12U);
    put(0x80U | (code >> 6U & 0x3FU));
  }
  put(0x80U | (code & 0x3FU));
}

/// Recursive descent over a text; every function is false at the first thing that is not JSON.
class Parser {
 public:
  explicit Parser(std::string_view text) : rest_(text) {}

  bool read_all(JsonValue& value) {
    if (!read_value(value, 0)) return false;
    skip_blanks();
    return rest_.empty();
  }

 private:
  void skip_blanks() {
    while (!rest_.empty() && is_blank(rest_.front())) rest_.remove_prefix(1);
  }

  bool take(char letter) {
    skip_blanks();
    if (!rest_.starts_with(letter)) return false;
    rest_.remove_prefix(1);
    return true;
  }

  bool take_word(std::string_view word) {
    if (!rest_.starts_with(word)) return false;
    rest_.remove_prefix(word.size());
    return true;
  }

  bool read_value(JsonValue& value, int depth) {
    if (depth > kDeepest) return false;
    skip_blanks();
    if (rest_.empty()) return false;
    switch (rest_.front()) {
      case '{': return read_object(value, depth);
      case '[': return read_array(value, depth);
      case '"': value.kind = JsonValue::Kind::String; return read_string(value.text);
      case 't': value.truth = true; [[fallthrough]];
      case 'f': value.kind = JsonValue::Kind::Bool; return take_word(value.truth ? "true" : "false");
      case 'n': return take_word("null");
      default: return read_number(value);
    }
  }

  bool read_object(JsonValue& value, int depth) {
    value.kind = JsonValue::Kind::Object;
    if (!take('{')) return false;
    if (take('}')) return true;
    do {
      skip_blanks();
      if (!read_string(value.names.emplace_back()) || !take(':')) return false;
      if (!read_value(value.elements.emplace_back(), depth + 1)) return false;
    } while (take(','));
    return take('}');
  }

  bool read_array(JsonValue& value, int depth) {
    value.kind = JsonValue::Kind::Array;
    if (!take('[')) return false;
    if (take(']')) return true;
    do {
      if (!read_value(value.elements.emplace_back(), depth + 1)) return false;
    } while (take(','));
    return take(']');
  }

  bool read_number(JsonValue& value) {
    value.kind = JsonValue::Kind::Number;
    const std::size_t size = std::min(rest_.find_first_not_of("+-.0123456789eE"), rest_.size());
    value.text = rest_.substr(0, size);
    rest_.remove_prefix(size);
    return size > 0;
  }

  bool read_string(std::string& out) {
    if (!take('"')) return false;
    while (!rest_.empty()) {
      const std::size_t plain = std::min(rest_.find_first_of("\"\\"), rest_.size());
      out.append(rest_.substr(0, plain));
      rest_.remove_prefix(plain);
      if (take_word("\"")) return true;
      if (!read_escape(out)) return false;
    }
    return false;
  }

  bool read_escape(std::string& out) {
    if (rest_.size() < 2) return false;
    const char letter = rest_[1];
    rest_.remove_prefix(2);
    switch (letter) {
      case '"':
      case '\\':
      case '/': out += letter; return true;
      case 'b': out += '\b'; return true;
      case 'f': out += '\f'; return true;
      case 'n': out += '\n'; return true;
      case 'r': out += '\r'; return true;
      case 't': out += '\t'; return true;
      case 'u': break;
      default: return false;
    }
    const auto code = rest_.size() < 4 ? std::nullopt : parse_int<std::uint16_t>(rest_.substr(0, 4), 16);
    if (!code) return false;
    rest_.remove_prefix(4);
    if (*code <= 0xFF) {
      out += static_cast<char>(*code);
    } else {
      append_utf8(out, *code);
    }
    return true;
  }

  std::string_view rest_;
};

}  // namespace

const JsonValue* JsonValue::find(std::string_view name) const {
  const auto found = std::ranges::find(names, name);
  return found == names.end() ? nullptr : &elements[static_cast<std::size_t>(found - names.begin())];
}

std::optional<JsonValue> parse_json(std::string_view text) {
  JsonValue value;
  if (!Parser(text).read_all(value)) return std::nullopt;
  return value;
}

void append_json_string(std::string& out, std::string_view bytes) {
  constexpr EscapeStyle kJson{.code_prefix = "\\u00", .hex_digits = "0123456789abcdef", .in_quotes = true};
  out += '"';
  append_escaped(out, bytes, kJson);
  out += '"';
}

}  // namespace kerf::base
