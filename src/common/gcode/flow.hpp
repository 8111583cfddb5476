#pragma once
// O words: which lines of a program are executed (grblHAL core ngc_flowctrl.c).

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/gcode/expression.hpp"

namespace kerf::gcode {

/// `O100` or `O<name>`.
struct FlowLabel {
  std::uint32_t number = 0;
  std::string name{};
  bool operator==(const FlowLabel&) const = default;

  /// Calls of such labels look for a file of that name.
  [[nodiscard]] bool names_file() const { return !name.empty() || number > kLastLocal; }
  static constexpr std::uint32_t kLastLocal = 65535;
};

/// What an O word asks for besides its answer.
struct FlowRequest {
  std::optional<int> alarm{};
};

/// Branches work anywhere. Loops, subroutines and calls go back in their file, so that they answer error:80 in a
/// stream.
class FlowControl {
 public:
  /// Lines are read and not executed.
  [[nodiscard]] bool skips() const { return skips_; }
  void clear();

  /// The statement at `at`, behind its label. An error forgets all open branches.
  ErrorCode run(const FlowLabel& label, ExpressionReader& reader, std::uint8_t at, FlowRequest& request);

 private:
  enum class Keyword : std::uint8_t;
  enum class Branch : std::uint8_t { If, ElseIf, Else };
  struct Level {
    FlowLabel label;
    Branch branch = Branch::If;
    /// Its lines are passed over now.
    bool skips = false;
    /// One of its branches was taken.
    bool handled = false;
  };

  static std::optional<Keyword> read_keyword(const char* text, std::uint8_t& at);
  ErrorCode execute(Keyword keyword, const FlowLabel& label, ExpressionReader& reader, std::uint8_t& at,
                    FlowRequest& request);
  ErrorCode begin_if(const FlowLabel& label, ExpressionReader& reader, std::uint8_t& at);
  ErrorCode else_if(const FlowLabel& label, ExpressionReader& reader, std::uint8_t& at);
  ErrorCode otherwise(const FlowLabel& label);
  ErrorCode end_if(const FlowLabel& label);
  [[nodiscard]] ErrorCode misplaced() const;
  [[nodiscard]] bool is_passed_over() const { return !levels_.empty() && levels_.back().skips; }

  static constexpr std::size_t kDeepest = 20;

  std::vector<Level> levels_;
  bool skips_ = false;
};

}  // namespace kerf::gcode
