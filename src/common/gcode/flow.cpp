#include "common/gcode/flow.hpp"

#include "common/gcode/numbers.hpp"

namespace kerf::gcode {

enum class FlowControl::Keyword : std::uint8_t {
  Alarm,
  Break,
  Continue,
  Call,
  Do,
  ElseIf,
  Else,
  EndIf,
  EndWhile,
  EndRepeat,
  EndSub,
  Error,
  If,
  Repeat,
  Return,
  Sub,
  While,
};

std::optional<FlowControl::Keyword> FlowControl::read_keyword(const char* text, std::uint8_t& at) {
  struct Row {
    std::string_view word;
    Keyword keyword;
  };
  static constexpr Row kRows[] = {
      {"ALARM", Keyword::Alarm},
      {"BREAK", Keyword::Break},
      {"CONTINUE", Keyword::Continue},
      {"CALL", Keyword::Call},
      {"DO", Keyword::Do},
      {"ELSEIF", Keyword::ElseIf},
      {"ELSE", Keyword::Else},
      {"ENDIF", Keyword::EndIf},
      {"ENDWHILE", Keyword::EndWhile},
      {"ENDREPEAT", Keyword::EndRepeat},
      {"ENDSUB", Keyword::EndSub},
      {"ERROR", Keyword::Error},
      {"IF", Keyword::If},
      {"REPEAT", Keyword::Repeat},
      {"RETURN", Keyword::Return},
      {"SUB", Keyword::Sub},
      {"WHILE", Keyword::While},
  };
  const std::string_view rest(text + at);
  for (const Row& row : kRows) {
    if (!rest.starts_with(row.word)) continue;
    at = static_cast<std::uint8_t>(at + row.word.size());
    return row.keyword;
  }
  return std::nullopt;
}

void FlowControl::clear() {
  levels_.clear();
  skips_ = false;
}

ErrorCode FlowControl::run(const FlowLabel& label, ExpressionReader& reader, std::uint8_t at, FlowRequest& request) {
  const auto keyword = read_keyword(reader.text(), at);
  // What is no statement leaves everything as it is.
  if (!keyword) return ErrorCode::FlowControlSyntaxError;
  const ErrorCode error = execute(*keyword, label, reader, at, request);
  if (error != ErrorCode::Ok) {
    clear();
  } else {
    skips_ = is_passed_over();
  }
  // `O1 ERROR [254]`: the firmware's own mark of a line that is done.
  constexpr int kHandled = 254;
  return vocabulary::number_of(error) == kHandled ? ErrorCode::Ok : error;
}

ErrorCode FlowControl::execute(Keyword keyword, const FlowLabel& label, ExpressionReader& reader, std::uint8_t& at,
                               FlowRequest& request) {
  switch (keyword) {
    case Keyword::If: return begin_if(label, reader, at);
    case Keyword::ElseIf: return else_if(label, reader, at);
    case Keyword::Else: return otherwise(label);
    case Keyword::EndIf: return end_if(label);
    case Keyword::Alarm: {
      float value = 0.0F;
      if (!is_passed_over() && reader.read_expression(at, value) == ErrorCode::Ok) request.alarm = to_uint8(value);
      return ErrorCode::Ok;
    }
    case Keyword::Error: {
      float value = 0.0F;
      const bool raises = !is_passed_over() && reader.read_expression(at, value) == ErrorCode::Ok;
      return raises ? static_cast<ErrorCode>(to_uint8(value)) : ErrorCode::Ok;
    }
    case Keyword::Call:
      if (!label.names_file()) return ErrorCode::FlowControlNotExecutingMacro;
      if (is_passed_over()) return ErrorCode::Ok;
      return label.name.empty() ? ErrorCode::FlowControlSyntaxError : ErrorCode::FileOpenFailed;
    case Keyword::Break:
    case Keyword::Continue:
    case Keyword::Do:
    case Keyword::EndWhile:
    case Keyword::EndRepeat:
    case Keyword::EndSub:
    case Keyword::Repeat:
    case Keyword::Return:
    case Keyword::Sub:
    case Keyword::While: break;
  }
  return ErrorCode::FlowControlNotExecutingMacro;
}

ErrorCode FlowControl::misplaced() const {
  return is_passed_over() ? ErrorCode::Ok : ErrorCode::FlowControlSyntaxError;
}

ErrorCode FlowControl::begin_if(const FlowLabel& label, ExpressionReader& reader, std::uint8_t& at) {
  if (is_passed_over()) return ErrorCode::Ok;
  float value = 0.0F;
  if (const ErrorCode error = reader.read_expression(at, value); error != ErrorCode::Ok) return error;
  if (levels_.size() == kDeepest) return ErrorCode::FlowControlStackOverflow;
  levels_.push_back({.label = label, .branch = Branch::If, .skips = value == 0.0F, .handled = value != 0.0F});
  return ErrorCode::Ok;
}

// A label that is not the innermost one's is passed over without complaint.
ErrorCode FlowControl::else_if(const FlowLabel& label, ExpressionReader& reader, std::uint8_t& at) {
  if (levels_.empty() || levels_.back().branch == Branch::Else) return misplaced();
  Level& level = levels_.back();
  if (level.label != label) return ErrorCode::Ok;
  level.skips = level.handled;
  if (level.handled) return ErrorCode::Ok;
  float value = 0.0F;
  if (const ErrorCode error = reader.read_expression(at, value); error != ErrorCode::Ok) return error;
  level.skips = value == 0.0F;
  if (!level.skips) {
    level.branch = Branch::ElseIf;
    level.handled = true;
  }
  return ErrorCode::Ok;
}

ErrorCode FlowControl::otherwise(const FlowLabel& label) {
  if (levels_.empty() || levels_.back().branch == Branch::Else) return misplaced();
  Level& level = levels_.back();
  if (level.label != label) return ErrorCode::Ok;
  level.skips = level.handled;
  if (!level.skips) level.branch = Branch::Else;
  return ErrorCode::Ok;
}

ErrorCode FlowControl::end_if(const FlowLabel& label) {
  if (levels_.empty()) return misplaced();
  if (levels_.back().label == label) levels_.pop_back();
  return ErrorCode::Ok;
}

}  // namespace kerf::gcode
