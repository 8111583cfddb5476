// `kerf transform`: another program out of a program.

#include "rehearsal/transform.hpp"

#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "apps/commands.hpp"
#include "apps/output.hpp"
#include "apps/transform_steps.hpp"
#include "io/file_replacement.hpp"
#include "io/machine_url.hpp"
#include "io/program_file.hpp"
#include "rehearsal/program_measure.hpp"

namespace kerf::apps {
namespace {

using rehearsal::ProgramMeasure;
using rehearsal::ProgramSize;
using rehearsal::SourceLine;
using rehearsal::Transform;
using rehearsal::TransformRefusal;
using rehearsal::TransformStep;

/// What becomes of the lines; counted as they come.
struct Changes {
  std::uint64_t lines = 0;
  std::uint64_t unchanged = 0;
};

/// Where the lines go.
class LineWriter {
 public:
  explicit LineWriter(io::FileReplacement* file) : file_(file) {}

  /// False when the file cannot be written; complain() has said why.
  bool put(const SourceLine& line) {
    rehearsal::append_line(text_, line, has_lines_);
    has_lines_ = true;
    return text_.size() < kPiece || flush();
  }

  bool flush() {
    // The end of the line before tells whether a new one is needed.
    const std::size_t kept = text_.empty() || is_line_end(text_.back()) ? 0 : std::min<std::size_t>(text_.size(), 1);
    const std::string_view out = std::string_view{text_}.substr(0, text_.size() - kept);
    const bool done = write(out);
    text_.erase(0, out.size());
    return done;
  }

  bool finish() {
    const bool done = write(text_);
    text_.clear();
    return done;
  }

 private:
  static constexpr std::size_t kPiece = 1U << 16U;
  static bool is_line_end(char letter) { return letter == '\n' || letter == '\r'; }

  bool write(std::string_view text) {
    if (file_ == nullptr) {
      put_text(text);
      return true;
    }
    return file_->write(text).has_value();
  }

  static void put_text(std::string_view text) { apps::put("{}", text); }

  io::FileReplacement* file_;
  std::string text_;
  bool has_lines_ = false;
};

std::string range_text(const rehearsal::PathBounds& bounds) {
  constexpr std::string_view kLetters = "XYZ";
  std::string text;
  for (std::size_t axis = 0; axis < kLetters.size(); ++axis) {
    if (bounds.least_mm.at(axis) > bounds.most_mm.at(axis)) continue;
    text += fmt::format("{}{} {:.3f} to {:.3f}", text.empty() ? "" : ", ", kLetters[axis], bounds.least_mm.at(axis),
                        bounds.most_mm.at(axis));
  }
  return text.empty() ? "nowhere" : text;
}

std::string refusal_text(const TransformRefusal& refusal, const std::string& file) {
  if (refusal.line == 0) return fmt::format("{}: {}", file, refusal.reason);
  return fmt::format("{}, line {}: {}", file, refusal.line, refusal.reason);
}

void warn(const Transform& transform, const std::string& file) {
  for (const auto& warning : transform.warnings()) {
    complain(warning.line == 0 ? fmt::format("{}: {}", file, warning.text)
                               : fmt::format("{}, line {}: {}", file, warning.line, warning.text));
  }
}

/// The program as it is, or why it cannot be followed.
std::expected<ProgramSize, TransformRefusal> size_of(const job::Program& program, const vocabulary::Dialect& dialect) {
  rehearsal::ProgramSource source(program);
  ProgramMeasure measure(dialect);
  for (auto line = source.next(); line && *line; line = source.next()) {
    if (auto added = measure.add(**line); !added) return std::unexpected{added.error()};
  }
  return measure.size();
}

/// Compares lines with those that they come from.
class ChangeCounter {
 public:
  explicit ChangeCounter(const job::Program& program) : program_(program), line_(program.line_at(0, 1)) {}

  void add(const SourceLine& line) {
    ++changes_.lines;
    if (line_ && line.number < line_->number) line_ = program_.line(line.number);
    while (line_ && line_->number < line.number)
      line_ = program_.line_at(program_.offset_after(*line_), line_->number + 1);
    if (line_ && line_->number == line.number && line_->text == line.text) ++changes_.unchanged;
  }
  [[nodiscard]] const Changes& changes() const { return changes_; }

 private:
  const job::Program& program_;
  std::optional<job::ProgramLine> line_;
  Changes changes_;
};

void tell_size(std::string_view name, const ProgramSize& size) {
  put("{}\n  {} lines, {:.0f} mm cut, {:.0f} mm rapid\n  cuts {}\n  goes {}\n", name, size.lines, size.cutting_mm,
      size.rapid_mm, range_text(size.cutting), range_text(size.all));
}

ExitStatus preview(const job::Program& program, const std::vector<TransformStep>& steps,
                   const vocabulary::Dialect& dialect, const TransformOptions& options) {
  Transform transform(program, steps, dialect);
  ProgramMeasure measure(dialect);
  ChangeCounter counter(program);
  std::optional<TransformRefusal> lost;
  auto line = transform.next();
  for (; line && *line; line = transform.next()) {
    counter.add(**line);
    if (lost) continue;
    if (auto added = measure.add(**line); !added) lost = added.error();
  }
  if (!line) {
    complain(refusal_text(line.error(), options.file));
    return ExitStatus::Refused;
  }
  if (const auto before = size_of(program, dialect)) tell_size("Before", *before);
  if (lost) {
    put("After: from line {} on it cannot be measured: {}\n", lost->line, lost->reason);
  } else {
    tell_size("After", measure.size());
  }
  put("{} of {} lines are new or changed.\n", counter.changes().lines - counter.changes().unchanged,
      counter.changes().lines);
  for (const auto& warning : transform.warnings()) {
    put("{}\n", warning.line == 0 ? warning.text : fmt::format("Line {}: {}", warning.line, warning.text));
  }
  return ExitStatus::Done;
}

/// Every line through `writer`, or nowhere.
ExitStatus carry_out(const job::Program& program, const std::vector<TransformStep>& steps,
                     const vocabulary::Dialect& dialect, const TransformOptions& options, LineWriter* writer,
                     Changes* changes) {
  Transform transform(program, steps, dialect);
  ChangeCounter counter(program);
  auto line = transform.next();
  bool is_written = true;
  for (; line && *line && is_written; line = transform.next()) {
    counter.add(**line);
    if (writer != nullptr) is_written = writer->put(**line);
  }
  if (!line) {
    complain(refusal_text(line.error(), options.file));
    return ExitStatus::Refused;
  }
  if (writer == nullptr) return ExitStatus::Done;
  if (!is_written || !writer->finish()) {
    complain(fmt::format("'{}' cannot be written: is the disk full?", options.output));
    return ExitStatus::Usage;
  }
  warn(transform, options.file);
  *changes = counter.changes();
  return ExitStatus::Done;
}

ExitStatus write_file(const job::Program& program, const std::vector<TransformStep>& steps,
                      const vocabulary::Dialect& dialect, const TransformOptions& options) {
  auto file = io::FileReplacement::begin(options.output);
  if (!file) {
    complain(io::explain(file.error(), options.output));
    return ExitStatus::Usage;
  }
  LineWriter writer(&*file);
  Changes changes;
  if (const auto status = carry_out(program, steps, dialect, options, &writer, &changes); status != ExitStatus::Done) {
    return status;
  }
  if (const auto committed = file->commit(); !committed) {
    complain(io::explain(committed.error(), options.output));
    return ExitStatus::Usage;
  }
  put("{}: {} lines, {} of them new or changed.\n", options.output, changes.lines, changes.lines - changes.unchanged);
  return ExitStatus::Done;
}

}  // namespace

ExitStatus transform(const TransformOptions& options) {
  const auto steps = parse_steps(options.steps);
  if (!steps) {
    complain(steps.error());
    return ExitStatus::Usage;
  }
  if (steps->empty()) {
    complain("Say what to do: 'kerf transform --help' lists the transforms.");
    return ExitStatus::Usage;
  }
  const auto personality = io::parse_personality(options.personality);
  if (!personality) {
    complain(io::explain(personality.error()));
    return ExitStatus::Usage;
  }
  const auto file = io::ProgramFile::load(options.file);
  if (!file) {
    complain(io::explain(file.error(), options.file));
    return ExitStatus::Usage;
  }
  const job::Program& program = *file->program();
  const vocabulary::Dialect& dialect = (*personality)->dialect();
  if (options.previews) return preview(program, *steps, dialect, options);
  if (!options.output.empty() && options.output != "-") return write_file(program, *steps, dialect, options);
  // Half a program must not get out: first everything is tried.
  if (const auto status = carry_out(program, *steps, dialect, options, nullptr, nullptr); status != ExitStatus::Done) {
    return status;
  }
  LineWriter writer(nullptr);
  Changes changes;
  return carry_out(program, *steps, dialect, options, &writer, &changes);
}

}  // namespace kerf::apps
