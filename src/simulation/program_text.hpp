#pragma once
// The text of a program for the virtual controller, piece by piece: there may be more of it than anybody wants to hold.

#include <cstddef>
#include <string>
#include <string_view>

namespace kerf::simulation {

class ProgramText {
 public:
  ProgramText() = default;
  virtual ~ProgramText() = default;
  ProgramText(const ProgramText&) = delete;
  ProgramText& operator=(const ProgramText&) = delete;

  /// Appends some lines, each ended by LF; false, and nothing appended, when none is left.
  virtual bool read_on(std::string& lines) = 0;
};

/// A text that somebody else holds. Line ends may be LF or CR LF; the last line may lack one.
class HeldText final : public ProgramText {
 public:
  explicit HeldText(std::string_view text) : rest_(text) {}

  bool read_on(std::string& lines) override {
    if (rest_.empty()) return false;
    const std::size_t end = rest_.find('\n');
    std::string_view line = rest_.substr(0, end);
    if (end != std::string_view::npos && line.ends_with('\r')) line.remove_suffix(1);
    (lines += line) += '\n';
    rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
    return true;
  }

 private:
  std::string_view rest_;
};

}  // namespace kerf::simulation
