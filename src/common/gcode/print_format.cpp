#include "common/gcode/print_format.hpp"

#include <array>

#include "common/gcode/expression.hpp"
#include "common/gcode/print_number.hpp"

namespace kerf::gcode {

namespace {

/// Goes through a text letter by letter. grblHAL does so twice, the first time to count, and the format found last in
/// that pass, finished or not, is in force at the beginning of the second.
class Substitution {
 public:
  Substitution(const std::string& text, const GcodeRules& rules, const ParameterValues& values)
      : text_(text), rules_(rules), values_(values), decimals_(parameter_decimals(values.settings)) {}

  std::string pass() {
    out_.clear();
    format_ = {};
    std::uint8_t at = 0;
    // A `#` that ends the text leaves the reader one letter behind the end.
    while (at < text_.size()) {
      const char c = text_[at];
      if (format_length_ > 0) {
        take_format(c);
        ++at;
      } else if (c == '%') {
        format_.front() = c;
        format_length_ = 1;
        ++at;
      } else if (c == '#') {
        append_value(at);
      } else {
        out_ += c;
        ++at;
      }
      if (at == 0) break;
    }
    return out_;
  }

 private:
  /// One letter more of a format. A bad one is printed, with what an earlier, longer one left behind it.
  void take_format(char c) {
    format_.at(format_length_) = c;
    const bool is_digit = c >= '0' && c <= '9';
    if (format_length_ == 1 && (c == 'd' || c == 'f')) {
      decimals_ = c == 'd' ? 0 : parameter_decimals(values_.settings);
      format_length_ = 0;
    } else if (format_length_ == 1 && c == '.') {
      format_length_ = 2;
    } else if (format_length_ == 2 && is_digit) {
      digits_ = c - '0';
      format_length_ = 3;
    } else if (format_length_ == 3 && c == 'f') {
      decimals_ = digits_;
      format_length_ = 0;
    } else {
      out_ += format_.data();
      format_length_ = 0;
    }
  }

  void append_value(std::uint8_t& at) {
    ExpressionReader reader(rules_, values_, text_.c_str());
    float value = 0.0F;
    if (reader.read_parameter(at, value, true) != ErrorCode::Ok) {
      out_ += "N/A";
    } else if (decimals_ == 0) {
      out_ += trimmed_number(value, 0);
    } else {
      append_number(NumberPrinter::RoundThenSplit, value, decimals_, out_);
    }
  }

  const std::string& text_;
  const GcodeRules& rules_;
  const ParameterValues& values_;
  std::string out_;
  std::array<char, 5> format_{};
  std::size_t format_length_ = 0;
  int decimals_;
  int digits_ = 0;
};

}  // namespace

int parameter_decimals(const InterpreterSettings& settings) {
  constexpr int kInches = 4;
  constexpr int kMillimetres = 3;
  return settings.report_inches ? kInches : kMillimetres;
}

std::string trimmed_number(float value, int decimals) {
  std::string text;
  append_number(NumberPrinter::RoundThenSplit, value, decimals, text);
  while (text.ends_with('0')) text.pop_back();
  if (text.ends_with('.')) text.pop_back();
  return text;
}

std::string substitute_parameters(std::string_view text, const GcodeRules& rules, const ParameterValues& values) {
  while (text.starts_with(' ')) text.remove_prefix(1);
  const std::string copy(text);
  Substitution substitution(copy, rules, values);
  static_cast<void>(substitution.pass());
  return substitution.pass();
}

}  // namespace kerf::gcode
