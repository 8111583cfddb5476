#pragma once
// A small JSON: enough to write down values and read them back without a library, a locale or an exception. Strings
// hold bytes, not characters: byte 0xE9 is written as \u00E9, so that any bytes survive and the text stays ASCII.

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace kerf::base {

/// A parsed value. Numbers keep their digits, because what they mean (nanoseconds, a code) is the reader's affair.
struct JsonValue {
  enum class Kind { Null, Bool, Number, String, Array, Object };
  Kind kind = Kind::Null;
  bool truth = false;
  /// The digits of a number, or the bytes of a string.
  std::string text;
  /// Of an array, or of an object: there `names` has the name of each.
  std::vector<JsonValue> elements;
  std::vector<std::string> names;

  /// The member called `name`; null when there is none.
  [[nodiscard]] const JsonValue* find(std::string_view name) const;
};

/// The value that `text` spells from its first to its last character (blanks around it are allowed). Nothing when it is
/// not JSON, or nested deeper than anybody writes.
[[nodiscard]] std::optional<JsonValue> parse_json(std::string_view text);

/// Appends `bytes` as a JSON string with its quotes.
void append_json_string(std::string& out, std::string_view bytes);

}  // namespace kerf::base
