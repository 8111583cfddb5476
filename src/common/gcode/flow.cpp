#include "common/gcode/flow.hpp"

#include <algorithm>
#include <array>
#include <cmath>

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

struct FlowControl::Statement {
  const FlowLabel& label;
  ExpressionReader& reader;
  std::uint8_t at;
  Parameters& parameters;
  const std::optional<FilePlace>& here;
  FlowRequest& request;
  std::optional<FilePlace>& next;

  ErrorCode read(float& value) { return reader.read_expression(at, value); }
  [[nodiscard]] bool ends() const { return reader.text()[at] == '\0'; }
  void jump(const FilePlace& place) const { next = place; }
  /// What a subroutine gives back.
  void read_result() {
    float value = 0.0F;
    const bool returns = read(value) == ErrorCode::Ok;
    if (returns) parameters.set("_value", value);
    parameters.set("_value_returned", returns ? 1.0F : 0.0F);
  }
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

void FlowControl::clear(Parameters& parameters) {
  while (!levels_.empty()) close(parameters);
  subroutines_.clear();
  skips_subroutine_ = in_subroutine_ = skips_ = false;
  jump_.reset();
}

ErrorCode FlowControl::run(const FlowLabel& label, ExpressionReader& reader, std::uint8_t at, Parameters& parameters,
                           const std::optional<FilePlace>& here, FlowRequest& request) {
  const auto keyword = read_keyword(reader.text(), at);
  // What is no statement leaves everything as it is.
  if (!keyword) return ErrorCode::FlowControlSyntaxError;
  Statement statement{.label = label,
                      .reader = reader,
                      .at = at,
                      .parameters = parameters,
                      .here = here,
                      .request = request,
                      .next = jump_};
  const ErrorCode error = execute(*keyword, statement);
  if (error != ErrorCode::Ok) {
    clear(parameters);
  } else {
    skips_ = is_passed_over();
  }
  return error;
}

ErrorCode FlowControl::execute(Keyword keyword, Statement& statement) {
  switch (keyword) {
    case Keyword::If: return begin_if(statement);
    case Keyword::ElseIf: return else_if(statement);
    case Keyword::Else: return otherwise(statement.label);
    case Keyword::EndIf: return end_if(statement.label);
    case Keyword::Alarm: {
      float value = 0.0F;
      if (!is_passed_over() && statement.read(value) == ErrorCode::Ok) statement.request.alarm = to_uint8(value);
      return ErrorCode::Ok;
    }
    case Keyword::Error: {
      float value = 0.0F;
      const bool raises = !is_passed_over() && statement.read(value) == ErrorCode::Ok;
      return raises ? static_cast<ErrorCode>(to_uint8(value)) : ErrorCode::Ok;
    }
    case Keyword::Call:
      if (!statement.here && !statement.label.names_file()) return ErrorCode::FlowControlNotExecutingMacro;
      return is_passed_over() ? ErrorCode::Ok : call(statement);
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
  return statement.here ? execute_in_file(keyword, statement) : ErrorCode::FlowControlNotExecutingMacro;
}

ErrorCode FlowControl::execute_in_file(Keyword keyword, Statement& statement) {
  switch (keyword) {
    case Keyword::Break: return is_passed_over() ? ErrorCode::Ok : leave_loop(statement);
    case Keyword::Continue: return is_passed_over() ? ErrorCode::Ok : next_round(statement);
    case Keyword::Do:
      if (is_passed_over()) return ErrorCode::Ok;
      return open({.label = statement.label, .by = Opened::Do, .place = *statement.here});
    case Keyword::While: return begin_while(statement);
    case Keyword::EndWhile: return end_while(statement);
    case Keyword::Repeat: return is_passed_over() ? ErrorCode::Ok : begin_repeat(statement);
    case Keyword::EndRepeat: return end_repeat(statement);
    case Keyword::Sub: return begin_subroutine(statement);
    case Keyword::EndSub:
      if (!skips_subroutine_) {
        end_call(statement);
        statement.read_result();
      }
      skips_subroutine_ = false;
      return ErrorCode::Ok;
    case Keyword::Return:
      if (is_passed_over()) return ErrorCode::Ok;
      if (in_subroutine_) end_call(statement);
      statement.read_result();
      return ErrorCode::Ok;
    default: return ErrorCode::FlowControlSyntaxError;
  }
}

ErrorCode FlowControl::misplaced() const {
  return is_passed_over() ? ErrorCode::Ok : ErrorCode::FlowControlSyntaxError;
}

ErrorCode FlowControl::open(Level level) {
  if (levels_.size() == kDeepest) return ErrorCode::FlowControlStackOverflow;
  level.in_subroutine = level.by == Opened::Call || in_subroutine_;
  levels_.push_back(std::move(level));
  return ErrorCode::Ok;
}

void FlowControl::close(Parameters& parameters) {
  if (levels_.back().by == Opened::Call) parameters.end_call();
  levels_.pop_back();
}

ErrorCode FlowControl::begin_if(Statement& statement) {
  if (is_passed_over()) return ErrorCode::Ok;
  float value = 0.0F;
  if (const ErrorCode error = statement.read(value); error != ErrorCode::Ok) return error;
  return open({.label = statement.label, .skips = value == 0.0F, .handled = value != 0.0F});
}

// A label that is not the innermost one's is passed over without complaint.
ErrorCode FlowControl::else_if(Statement& statement) {
  if (!is_branch() || is_open(Opened::Else)) return misplaced();
  Level& level = levels_.back();
  if (level.label != statement.label) return ErrorCode::Ok;
  level.skips = level.handled;
  if (level.handled) return ErrorCode::Ok;
  float value = 0.0F;
  if (const ErrorCode error = statement.read(value); error != ErrorCode::Ok) return error;
  level.skips = value == 0.0F;
  if (!level.skips) {
    level.by = Opened::ElseIf;
    level.handled = true;
  }
  return ErrorCode::Ok;
}

ErrorCode FlowControl::otherwise(const FlowLabel& label) {
  if (!is_branch() || is_open(Opened::Else)) return misplaced();
  Level& level = levels_.back();
  if (level.label != label) return ErrorCode::Ok;
  level.skips = level.handled;
  if (!level.skips) level.by = Opened::Else;
  return ErrorCode::Ok;
}

ErrorCode FlowControl::end_if(const FlowLabel& label) {
  if (!is_branch()) return misplaced();
  if (levels_.back().label == label) levels_.pop_back();
  return ErrorCode::Ok;
}

// The same word begins one loop and ends the other.
ErrorCode FlowControl::begin_while(Statement& statement) {
  const bool ends_do = is_open(Opened::Do) && levels_.back().label == statement.label;
  if (!levels_.empty() && levels_.back().left) {
    if (ends_do) levels_.pop_back();
    return ErrorCode::Ok;
  }
  if (is_passed_over()) return ErrorCode::Ok;
  const char* const condition = statement.reader.text() + statement.at;
  float value = 0.0F;
  if (const ErrorCode error = statement.read(value); error != ErrorCode::Ok) return error;
  if (!ends_do) {
    return open({.label = statement.label,
                 .by = Opened::While,
                 .place = *statement.here,
                 .condition = condition,
                 .skips = value == 0.0F});
  }
  if (value != 0.0F) {
    statement.jump(levels_.back().place);
  } else {
    levels_.pop_back();
  }
  return ErrorCode::Ok;
}

ErrorCode FlowControl::repeat_while(Level& level, Statement& statement) {
  if (level.skips) return ErrorCode::Ok;
  float value = 0.0F;
  if (const ErrorCode error = statement.reader.read_again(level.condition, value); error != ErrorCode::Ok) return error;
  level.skips = value == 0.0F;
  if (!level.skips) statement.jump(level.place);
  return ErrorCode::Ok;
}

ErrorCode FlowControl::end_while(Statement& statement) {
  if (!is_open(Opened::While)) return misplaced();
  Level& level = levels_.back();
  if (level.label != statement.label) return ErrorCode::Ok;
  if (!is_passed_over()) {
    if (const ErrorCode error = repeat_while(level, statement); error != ErrorCode::Ok) return error;
  }
  if (level.skips) levels_.pop_back();
  return ErrorCode::Ok;
}

ErrorCode FlowControl::begin_repeat(Statement& statement) {
  float value = 0.0F;
  if (const ErrorCode error = statement.read(value); error != ErrorCode::Ok) return error;
  const float rounds = std::nearbyint(value);
  return open({.label = statement.label,
               .by = Opened::Repeat,
               .place = *statement.here,
               .repeats = rounds > 0.0F ? to_uint32(rounds) : 0U,
               .skips = rounds <= 0.0F});
}

ErrorCode FlowControl::end_repeat(Statement& statement) {
  if (!is_open(Opened::Repeat)) return misplaced();
  Level& level = levels_.back();
  if (level.label != statement.label) return ErrorCode::Ok;
  if (!is_passed_over() && level.repeats != 0 && --level.repeats != 0) {
    statement.jump(level.place);
  } else {
    levels_.pop_back();
  }
  return ErrorCode::Ok;
}

ErrorCode FlowControl::leave_loop(Statement& statement) {
  while (!levels_.empty() && levels_.back().label != statement.label) close(statement.parameters);
  const bool is_loop = is_open(Opened::Do) || is_open(Opened::While) || is_open(Opened::Repeat);
  if (!is_loop) return ErrorCode::FlowControlSyntaxError;
  Level& level = levels_.back();
  level.repeats = 0;
  level.left = level.skips = level.handled = true;
  return ErrorCode::Ok;
}

ErrorCode FlowControl::next_round(Statement& statement) {
  while (!levels_.empty() && levels_.back().label != statement.label) close(statement.parameters);
  if (levels_.empty()) return ErrorCode::FlowControlSyntaxError;
  Level& level = levels_.back();
  switch (level.by) {
    case Opened::Do: statement.jump(level.place); return ErrorCode::Ok;
    case Opened::Repeat:
      if (level.repeats != 0 && --level.repeats != 0) {
        statement.jump(level.place);
      } else {
        level.skips = true;
      }
      return ErrorCode::Ok;
    case Opened::While: {
      const ErrorCode error = repeat_while(level, statement);
      // Its end, still to come, finds no loop any more.
      if (error == ErrorCode::Ok && level.skips) levels_.pop_back();
      return error;
    }
    default: return ErrorCode::FlowControlSyntaxError;
  }
}

// A name belongs to a file of its own, which nobody has called here.
ErrorCode FlowControl::begin_subroutine(Statement& statement) {
  if (statement.label.names_file()) return ErrorCode::FlowControlSyntaxError;
  subroutines_.push_back({.label = statement.label, .place = *statement.here});
  skips_subroutine_ = true;
  return ErrorCode::Ok;
}

ErrorCode FlowControl::call(Statement& statement) {
  if (statement.label.names_file()) {
    return statement.label.name.empty() ? ErrorCode::FlowControlSyntaxError : ErrorCode::FileOpenFailed;
  }
  const auto found = std::ranges::find(subroutines_, statement.label, &Subroutine::label);
  if (found == subroutines_.end()) return ErrorCode::FlowControlSyntaxError;

  // What is not given is handed on from the caller.
  constexpr std::uint16_t kMost = 30;
  std::array<float, kMost> values{};
  std::uint16_t given = 0;
  while (!statement.ends() && given < kMost) {
    if (const ErrorCode error = statement.read(values.at(given)); error != ErrorCode::Ok) return error;
    ++given;
  }
  for (std::uint16_t at = given; at < kMost; ++at)
    values.at(at) = statement.parameters.get(static_cast<std::uint16_t>(at + 1));
  if (levels_.size() == kDeepest) return ErrorCode::FlowControlStackOverflow;
  if (!statement.parameters.begin_call(1 + static_cast<int>(statement.parameters.call_level())))
    return ErrorCode::FlowControlStackOverflow;
  in_subroutine_ = true;
  static_cast<void>(open({.label = statement.label, .by = Opened::Call, .place = *statement.here, .repeats = 1}));
  for (std::uint16_t at = 0; at < kMost; ++at)
    if (values.at(at) != 0.0F) statement.parameters.set(static_cast<std::uint16_t>(at + 1), values.at(at));
  statement.parameters.set("_value", 0.0F);
  statement.parameters.set("_value_returned", 0.0F);
  statement.jump(found->place);
  return ErrorCode::Ok;
}

// Its value is read after this: with the caller's parameters.
void FlowControl::end_call(Statement& statement) {
  while (!levels_.empty() && levels_.back().label != statement.label) close(statement.parameters);
  if (!levels_.empty()) {
    statement.jump(levels_.back().place);
    close(statement.parameters);
  }
  in_subroutine_ = !levels_.empty() && levels_.back().in_subroutine;
}

}  // namespace kerf::gcode
