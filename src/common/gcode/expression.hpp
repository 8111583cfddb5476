#pragma once
// Values as grblHAL's expression build reads them: numbers, parameters, functions and bracketed expressions.

#include <cstdint>
#include <string>

#include "common/gcode/parameter_values.hpp"
#include "common/gcode/rules.hpp"

namespace kerf::gcode {

using vocabulary::ErrorCode;

/// Reads a NUL-terminated text in capitals; positions wrap at 256 like the firmware's 8-bit counter. After an error the
/// position is where the firmware stopped, and the value is what it left there (grblHAL core ngc_expr.c).
class ExpressionReader {
 public:
  ExpressionReader(const GcodeRules& rules, const ParameterValues& values, const char* text)
      : rules_(rules), values_(values), text_(text) {}

  /// `5`, `-[1+2]`, `#1`, `SIN[30]`: what may follow a letter.
  ErrorCode read_value(std::uint8_t& at, float& value);
  /// `[ ... ]`.
  ErrorCode read_expression(std::uint8_t& at, float& value);
  /// The same in another text, from its beginning.
  [[nodiscard]] ErrorCode read_again(const std::string& text, float& value) const;
  /// A value that is close to a whole number.
  ErrorCode read_whole_value(std::uint8_t& at, std::int32_t& value);
  /// `#5`, `#<name>`. Comments ask for `known` numbers.
  ErrorCode read_parameter(std::uint8_t& at, float& value, bool known);
  /// `<name>`, in small letters.
  ErrorCode read_name(std::uint8_t& at, std::string& name) const;

  [[nodiscard]] const char* text() const { return text_; }

 private:
  struct Operation;
  ErrorCode read_operator(std::uint8_t& at, const Operation*& operation) const;
  ErrorCode read_function(std::uint8_t& at, float& value);
  ErrorCode read_exists(std::uint8_t& at, float& value) const;
  ErrorCode read_setting(std::uint8_t& at, float& value);
  ErrorCode read_arctangent(std::uint8_t& at, float& value);
  /// A long line without end would be read for ever once the counter has wrapped.
  [[nodiscard]] bool is_lost() { return ++values_read_ > kMostValues; }

  static constexpr int kMostValues = 512;

  const GcodeRules& rules_;
  const ParameterValues& values_;
  const char* text_;
  int values_read_ = 0;
};

}  // namespace kerf::gcode
