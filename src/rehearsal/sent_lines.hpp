#pragma once
// The lines of a program as Kerf would send them, for whoever wants to know what becomes of them.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "common/vocabulary/dialect.hpp"
#include "sender/job/program.hpp"
#include "sender/job/program_flow.hpp"
#include "sender/job/wire_form.hpp"
#include "simulation/program_text.hpp"

namespace kerf::rehearsal {

/// A line of the file, and what of it goes to the wire.
struct SentLine {
  std::uint32_t number = 0;
  std::string_view text;
  /// Without a line end; empty where nothing is sent. Valid until the next line is read.
  std::string_view wire;
  /// The program waits here until the tool is changed.
  std::optional<job::ToolGate> tool_change{};
};

/// Who changes tools on a controller of which only the firmware is known.
[[nodiscard]] job::ToolChanges tool_changes_on(const vocabulary::Dialect& dialect);

/// Reads a program from its first line to its last: changes of tools that a controller refuses are the operator's, and
/// nothing comes behind the end of the program.
class SentLines {
 public:
  /// Both must outlive it.
  SentLines(const job::Program& program, const vocabulary::Dialect& dialect);
  SentLines(const job::Program& program, job::WireForm form, job::ToolChanges changes);

  /// Nothing behind the last line, and behind the end of the program.
  [[nodiscard]] std::optional<SentLine> next();
  /// How much of the file was read.
  [[nodiscard]] std::size_t bytes_read() const { return offset_bytes_; }
  /// The line that ended the program before the file did; 0 where there is none.
  [[nodiscard]] std::uint32_t end_line() const { return flow_.end_line(); }

 private:
  const job::Program* program_;
  job::WireForm form_;
  job::ProgramFlow flow_;
  std::size_t offset_bytes_ = 0;
  std::uint32_t next_number_ = 1;
  std::string wire_;
};

/// The same for a virtual controller, each line at its own place: what is not sent is a blank line.
class SentText final : public simulation::ProgramText {
 public:
  explicit SentText(SentLines lines) : lines_(std::move(lines)) {}
  bool read_on(std::string& lines) override;

 private:
  SentLines lines_;
};

}  // namespace kerf::rehearsal
