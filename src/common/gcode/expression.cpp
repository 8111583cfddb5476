#include "common/gcode/expression.hpp"

#include <array>
#include <cmath>

#include "common/gcode/numbers.hpp"

namespace kerf::gcode {

namespace {

constexpr float kDegreesPerRadian = 57.29577951308232087680F;
constexpr float kRadiansPerDegree = 0.01745329251994329577F;
/// Closer than this counts as equal.
constexpr float kEqual = 0.0001F;

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

/// Does `word` stand at `text[at]`? Moves `at` behind it.
bool take(const char* text, std::uint8_t& at, std::string_view word) {
  std::uint8_t next = at;
  for (const char letter : word)
    if (text[next++] != letter) return false;
  at = next;
  return true;
}

float truth(bool is_true) {
  return is_true ? 1.0F : 0.0F;
}

ErrorCode divide(float& left, float right) {
  if (right == 0.0F) return ErrorCode::ExpressionDivideByZero;
  left = left / right;
  return ErrorCode::Ok;
}

/// Never negative.
ErrorCode modulo(float& left, float right) {
  left = std::fmod(left, right);
  if (left < 0.0F) left = left + std::fabs(right);
  return ErrorCode::Ok;
}

ErrorCode power(float& left, float right) {
  if (left < 0.0F && std::floor(right) != right) return ErrorCode::ExpressionInvalidArgument;
  left = std::pow(left, right);
  return ErrorCode::Ok;
}

/// The operators that cannot fail, by what they compute.
template <auto Compute>
ErrorCode always(float& left, float right) {
  left = Compute(left, right);
  return ErrorCode::Ok;
}

constexpr auto kTimes = [](float a, float b) { return a * b; };
constexpr auto kPlus = [](float a, float b) { return a + b; };
constexpr auto kMinus = [](float a, float b) { return a - b; };
constexpr auto kAnd = [](float a, float b) { return truth(a != 0.0F && b != 0.0F); };
constexpr auto kOr = [](float a, float b) { return truth(a != 0.0F || b != 0.0F); };
constexpr auto kExclusiveOr = [](float a, float b) { return truth((a == 0.0F) != (b == 0.0F)); };
constexpr auto kLess = [](float a, float b) { return truth(a < b); };
constexpr auto kLessOrEqual = [](float a, float b) { return truth(a <= b); };
constexpr auto kGreater = [](float a, float b) { return truth(a > b); };
constexpr auto kGreaterOrEqual = [](float a, float b) { return truth(a >= b); };
constexpr auto kEquals = [](float a, float b) { return truth(std::fabs(a - b) < kEqual); };
constexpr auto kDiffers = [](float a, float b) { return truth(std::fabs(a - b) >= kEqual); };

using Function = ErrorCode (*)(float& value);

template <auto Compute>
ErrorCode plain(float& value) {
  value = Compute(value);
  return ErrorCode::Ok;
}

ErrorCode arc_function(float& value, float (*compute)(float)) {
  if (value < -1.0F || value > 1.0F) return ErrorCode::ExpressionArgumentOutOfRange;
  value = compute(value) * kDegreesPerRadian;
  return ErrorCode::Ok;
}
ErrorCode arc_cosine(float& value) {
  return arc_function(value, [](float x) { return std::acos(x); });
}
ErrorCode arc_sine(float& value) {
  return arc_function(value, [](float x) { return std::asin(x); });
}
ErrorCode logarithm(float& value) {
  if (value <= 0.0F) return ErrorCode::ExpressionArgumentOutOfRange;
  value = std::log(value);
  return ErrorCode::Ok;
}
ErrorCode square_root(float& value) {
  if (value < 0.0F) return ErrorCode::ExpressionArgumentOutOfRange;
  value = std::sqrt(value);
  return ErrorCode::Ok;
}

constexpr auto kAbsolute = [](float x) { return x < 0.0F ? -1.0F * x : x; };
constexpr auto kCosine = [](float x) { return std::cos(x * kRadiansPerDegree); };
constexpr auto kSine = [](float x) { return std::sin(x * kRadiansPerDegree); };
constexpr auto kTangent = [](float x) { return std::tan(x * kRadiansPerDegree); };
constexpr auto kExponential = [](float x) { return std::exp(x); };
constexpr auto kFloor = [](float x) { return std::floor(x); };
constexpr auto kCeiling = [](float x) { return std::ceil(x); };
constexpr auto kRound = [](float x) { return static_cast<float>(to_int32(x + (x < 0.0F ? -0.5F : 0.5F))); };

struct FunctionRow {
  std::string_view name;
  Function compute;
};

// EXISTS, PRM and ATAN read their arguments themselves.
constexpr FunctionRow kFunctions[] = {
    {"ABS", plain<kAbsolute>},    {"ACOS", arc_cosine},   {"ASIN", arc_sine},       {"COS", plain<kCosine>},
    {"EXP", plain<kExponential>}, {"FIX", plain<kFloor>}, {"FUP", plain<kCeiling>}, {"LN", logarithm},
    {"ROUND", plain<kRound>},     {"SIN", plain<kSine>},  {"SQRT", square_root},    {"TAN", plain<kTangent>},
};

}  // namespace

/// An operator; `]` is the weakest.
struct ExpressionReader::Operation {
  std::string_view name;
  int precedence;
  ErrorCode (*compute)(float& left, float right);
};

ErrorCode ExpressionReader::read_operator(std::uint8_t& at, const Operation*& operation) const {
  constexpr int kLogic = 2;
  constexpr int kRelation = 3;
  constexpr int kSum = 4;
  constexpr int kProduct = 5;
  constexpr int kPower = 6;
  static constexpr Operation kOperations[] = {
      {"]", 1, nullptr},
      {"+", kSum, always<kPlus>},
      {"-", kSum, always<kMinus>},
      {"/", kProduct, divide},
      {"**", kPower, power},
      {"*", kProduct, always<kTimes>},
      {"AND", kLogic, always<kAnd>},
      {"MOD", kProduct, modulo},
      {"OR", kLogic, always<kOr>},
      {"XOR", kLogic, always<kExclusiveOr>},
      {"EQ", kRelation, always<kEquals>},
      {"NE", kRelation, always<kDiffers>},
      {"GE", kRelation, always<kGreaterOrEqual>},
      {"GT", kRelation, always<kGreater>},
      {"LE", kRelation, always<kLessOrEqual>},
      {"LT", kRelation, always<kLess>},
  };
  for (const Operation& row : kOperations) {
    if (!take(text_, at, row.name)) continue;
    operation = &row;
    return ErrorCode::Ok;
  }
  ++at;
  return ErrorCode::ExpressionUnknownOperation;
}

ErrorCode ExpressionReader::read_again(const std::string& text, float& value) const {
  std::uint8_t at = 0;
  return ExpressionReader(rules_, values_, text.c_str()).read_expression(at, value);
}

ErrorCode ExpressionReader::read_expression(std::uint8_t& at, float& value) {
  if (text_[at] != '[') return ErrorCode::UnsupportedCommand;
  ++at;
  // One waiting operator a precedence is the most there can be.
  std::array<float, 8> values{};
  std::array<const Operation*, 8> waiting{};
  std::size_t depth = 0;
  for (;;) {
    if (const ErrorCode error = read_value(at, values.at(depth)); error != ErrorCode::Ok) return error;
    const Operation* next = nullptr;
    if (const ErrorCode error = read_operator(at, next); error != ErrorCode::Ok) return error;
    for (; depth > 0 && next->precedence <= waiting.at(depth - 1)->precedence; --depth) {
      const ErrorCode error = waiting.at(depth - 1)->compute(values.at(depth - 1), values.at(depth));
      if (error != ErrorCode::Ok) return error;
    }
    if (next->compute == nullptr) break;
    waiting.at(depth++) = next;
  }
  value = values.front();
  return ErrorCode::Ok;
}

ErrorCode ExpressionReader::read_value(std::uint8_t& at, float& value) {
  const char c = text_[at];
  if (c == '\0' || is_lost()) return ErrorCode::ExpressionSyntaxError;
  const char after = text_[static_cast<std::uint8_t>(at + 1)];
  const bool is_sign = (c == '+' || c == '-') && after != '\0' && !is_digit(after) && after != '.';

  ErrorCode error = ErrorCode::Ok;
  if (c == '[') {
    error = read_expression(at, value);
  } else if (c == '#') {
    error = read_parameter(at, value, false);
  } else if (is_sign) {
    ++at;
    error = read_value(at, value);
    if (c == '-') value = -value;
  } else if (c >= 'A' && c <= 'Z') {
    error = read_function(at, value);
  } else if (!read_float(rules_, text_, at, value)) {
    error = ErrorCode::BadNumberFormat;
  }
  return std::isfinite(value) ? error : ErrorCode::ExpressionInvalidResult;
}

ErrorCode ExpressionReader::read_whole_value(std::uint8_t& at, std::int32_t& value) {
  constexpr float kAlmostNext = 0.9999F;
  constexpr float kAlmostThis = 0.0001F;
  float number = 0.0F;
  if (const ErrorCode error = read_value(at, number); error != ErrorCode::Ok) return error;
  value = to_int32(std::floor(number));
  const float rest = number - static_cast<float>(value);
  if (rest > kAlmostNext) {
    value = static_cast<std::int32_t>(to_uint32(std::ceil(number)));
  } else if (rest > kAlmostThis) {
    return ErrorCode::CommandValueNotInteger;
  }
  return ErrorCode::Ok;
}

ErrorCode ExpressionReader::read_name(std::uint8_t& at, std::string& name) const {
  name.clear();
  if (text_[at++] != '<') return ErrorCode::BadNumberFormat;
  std::uint8_t next = at;
  char c = '\0';
  while ((c = text_[next++]) != '\0' && c != '>' && name.size() < Parameters::kLongestName) {
    name += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    ++at;
  }
  if (c != '>') return ErrorCode::FlowControlSyntaxError;
  ++at;
  return ErrorCode::Ok;
}

ErrorCode ExpressionReader::read_parameter(std::uint8_t& at, float& value, bool known) {
  constexpr int kLastKnown = 5599;
  if (text_[at] != '#') return ErrorCode::BadNumberFormat;
  ++at;
  if (text_[at] == '<') {
    std::string name;
    if (const ErrorCode error = read_name(at, name); error != ErrorCode::Ok) return error;
    const auto found = values_.get(name);
    if (!found) {
      // Looking for a name clears the value before it fails.
      if (clean_name(name)) value = 0.0F;
      return ErrorCode::BadNumberFormat;
    }
    value = *found;
    return ErrorCode::Ok;
  }
  std::int32_t number = 0;
  if (const ErrorCode error = read_whole_value(at, number); error != ErrorCode::Ok) return error;
  const auto id = static_cast<std::uint16_t>(number);
  if (number < 0 || (known && (id == 0 || id > kLastKnown))) return ErrorCode::ValueOutOfRange;
  const auto found = values_.get(id);
  value = found.value_or(0.0F);
  return found ? ErrorCode::Ok : ErrorCode::ValueOutOfRange;
}

ErrorCode ExpressionReader::read_function(std::uint8_t& at, float& value) {
  constexpr std::string_view kArctangent = "ATAN";
  constexpr std::string_view kExists = "EXISTS";
  constexpr std::string_view kSetting = "PRM";
  const FunctionRow* function = nullptr;
  std::string_view special;
  for (const std::string_view name : {kArctangent, kExists, kSetting}) {
    if (special.empty() && take(text_, at, name)) special = name;
  }
  for (const FunctionRow& row : kFunctions) {
    if (special.empty() && function == nullptr && take(text_, at, row.name)) function = &row;
  }
  if (special.empty() && function == nullptr) {
    ++at;
    return ErrorCode::ExpressionUnknownOperation;
  }
  if (text_[at] != '[') return ErrorCode::ExpressionSyntaxError;
  if (special == kExists) return read_exists(at, value);
  if (special == kSetting) return read_setting(at, value);
  if (const ErrorCode error = read_expression(at, value); error != ErrorCode::Ok) return error;
  return function != nullptr ? function->compute(value) : read_arctangent(at, value);
}

ErrorCode ExpressionReader::read_arctangent(std::uint8_t& at, float& value) {
  if (text_[at] != '/') return ErrorCode::ExpressionSyntaxError;
  ++at;
  if (text_[at] != '[') return ErrorCode::ExpressionSyntaxError;
  float divisor = 0.0F;
  if (const ErrorCode error = read_expression(at, divisor); error != ErrorCode::Ok) return error;
  value = std::atan2(value, divisor) * kDegreesPerRadian;
  return ErrorCode::Ok;
}

ErrorCode ExpressionReader::read_exists(std::uint8_t& at, float& value) const {
  ++at;
  if (text_[at] != '#' || text_[static_cast<std::uint8_t>(at + 1)] != '<') return ErrorCode::ExpressionSyntaxError;
  const std::string_view rest(text_ + at + 2);
  const auto end = rest.find(']');
  if (end == std::string_view::npos || end == 0 || rest[end - 1] != '>') return ErrorCode::ExpressionSyntaxError;
  value = truth(values_.get(rest.substr(0, end - 1)).has_value());
  at = static_cast<std::uint8_t>(at + end + 3);
  return ErrorCode::Ok;
}

ErrorCode ExpressionReader::read_setting(std::uint8_t& at, float& value) {
  constexpr std::int32_t kLastBit = 31;
  ++at;
  std::int32_t id = 0;
  if (const ErrorCode error = read_whole_value(at, id); error != ErrorCode::Ok) return error;
  std::int32_t bit = -1;
  if (text_[at] == ',') {
    ++at;
    if (const ErrorCode error = read_whole_value(at, bit); error != ErrorCode::Ok) return error;
    if (bit < 0 || bit > kLastBit) return ErrorCode::ExpressionArgumentOutOfRange;
  }
  if (text_[at] != ']') return ErrorCode::ExpressionSyntaxError;
  ++at;
  const auto setting = values_.machine != nullptr ? values_.machine->setting(id) : std::nullopt;
  if (!setting || setting->kind == SettingNumber::Kind::NotNumber) return ErrorCode::ExpressionArgumentOutOfRange;
  value = setting->value;
  const bool asks_bit = bit >= 0 && setting->kind == SettingNumber::Kind::Whole;
  if (asks_bit) value = static_cast<float>((to_uint32(value) >> static_cast<unsigned>(bit)) & 1U);
  return ErrorCode::Ok;
}

}  // namespace kerf::gcode
