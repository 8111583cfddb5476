// `kerf transform`: another program out of a program.

#include "rehearsal/transform.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

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
using rehearsal::ProgramPart;
using rehearsal::ProgramSize;
using rehearsal::SourceLine;
using rehearsal::Transform;
using rehearsal::TransformRefusal;
using rehearsal::TransformStep;

/// What is done to which program.
struct Work {
  const job::Program& program;
  const std::vector<TransformStep>& steps;
  const vocabulary::Dialect& dialect;
  const std::string& file;
};

/// What becomes of the lines; counted as they come.
struct Changes {
  std::uint64_t lines = 0;
  std::uint64_t unchanged = 0;
};

/// Where the lines go.
class LineWriter {
 public:
  explicit LineWriter(io::FileReplacement* file) : file_(file) {}

  /// False when the file cannot be written.
  bool put(const SourceLine& line) {
    // What ends the line stays behind until it is known whether another one follows.
    if (text_.size() >= kPiece && !flush()) return false;
    rehearsal::append_line(text_, line, has_lines_);
    has_lines_ = true;
    return true;
  }

  bool flush() {
    const std::size_t kept = std::min<std::size_t>(text_.size(), 1);
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

  bool write(std::string_view text) {
    if (file_ != nullptr) return file_->write(text).has_value();
    apps::put("{}", text);
    return true;
  }

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

ExitStatus preview(const Work& work) {
  Transform transform(work.program, work.steps, work.dialect);
  ProgramMeasure measure(work.dialect);
  ChangeCounter counter(work.program);
  std::optional<TransformRefusal> lost;
  auto line = transform.next();
  for (; line && *line; line = transform.next()) {
    counter.add(**line);
    if (lost) continue;
    if (auto added = measure.add(**line); !added) lost = added.error();
  }
  if (!line) {
    complain(refusal_text(line.error(), work.file));
    return ExitStatus::Refused;
  }
  if (const auto before = size_of(work.program, work.dialect)) tell_size("Before", *before);
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

/// Every line through `writer`; null: everything is only tried.
std::expected<Changes, ExitStatus> carry_out(const Work& work, const std::optional<ProgramPart>& part,
                                             LineWriter* writer) {
  Transform transform(work.program, work.steps, work.dialect, part);
  ChangeCounter counter(work.program);
  auto line = transform.next();
  bool is_written = true;
  for (; line && *line && is_written; line = transform.next()) {
    counter.add(**line);
    if (writer != nullptr) is_written = writer->put(**line);
  }
  if (!line) {
    complain(refusal_text(line.error(), work.file));
    return std::unexpected{ExitStatus::Refused};
  }
  if (writer == nullptr) return counter.changes();
  if (!is_written || !writer->finish()) {
    complain("The new program cannot be written: is the disk full?");
    return std::unexpected{ExitStatus::Usage};
  }
  warn(transform, work.file);
  return counter.changes();
}

ExitStatus write_file(const Work& work, const std::optional<ProgramPart>& part, const std::string& output) {
  auto file = io::FileReplacement::begin(output);
  if (!file) {
    complain(io::explain(file.error(), output));
    return ExitStatus::Usage;
  }
  LineWriter writer(&*file);
  const auto changes = carry_out(work, part, &writer);
  if (!changes) return changes.error();
  if (const auto committed = file->commit(); !committed) {
    complain(io::explain(committed.error(), output));
    return ExitStatus::Usage;
  }
  put("{}: {} lines, {} of them new or changed.\n", output, changes->lines, changes->lines - changes->unchanged);
  return ExitStatus::Done;
}

ExitStatus write_to_standard_output(const Work& work) {
  // Half a program must not get out: first everything is tried.
  if (const auto tried = carry_out(work, std::nullopt, nullptr); !tried) return tried.error();
  LineWriter writer(nullptr);
  const auto changes = carry_out(work, std::nullopt, &writer);
  return changes ? ExitStatus::Done : changes.error();
}

/// `part.nc` becomes `part-T1.nc`.
std::string name_of_part(const std::string& output, int tool, std::size_t again) {
  const std::string tag = again == 0 ? fmt::format("-T{}", tool) : fmt::format("-T{}-{}", tool, again + 1);
  const std::size_t folder = output.find_last_of('/');
  const std::size_t dot = output.find_last_of('.');
  const bool has_ending = dot != std::string::npos && (folder == std::string::npos || dot > folder + 1) && dot > 0;
  return has_ending ? output.substr(0, dot) + tag + output.substr(dot) : output + tag;
}

ExitStatus split_tools(const Work& work, const TransformOptions& options) {
  const auto parts = rehearsal::tool_parts(work.program, work.dialect);
  if (!parts) {
    complain(refusal_text(parts.error(), work.file));
    return ExitStatus::Refused;
  }
  // All of them or none.
  for (const auto& part : *parts) {
    if (const auto tried = carry_out(work, part.part, nullptr); !tried) return tried.error();
  }
  std::map<int, std::size_t> seen;
  for (const auto& part : *parts) {
    const std::string name = name_of_part(options.output, part.tool, seen[part.tool]++);
    if (options.previews) {
      const auto last = std::min(part.part.last_line, work.program.line_count());
      put("{}: lines {} to {}\n", name, part.part.first_line, last);
      continue;
    }
    if (const auto status = write_file(work, part.part, name); status != ExitStatus::Done) return status;
  }
  return ExitStatus::Done;
}

/// A sentence about options that do not go together.
std::optional<std::string> conflict_of(const TransformOptions& options) {
  if (options.steps.empty() && !options.splits_tools) {
    return "Say what to do: 'kerf transform --help' lists the transforms.";
  }
  if (!options.splits_tools) return std::nullopt;
  if (options.output.empty() || options.output == "-") {
    return "--split-tools writes several files: name them with -o, such as -o part.nc for part-T1.nc and so on.";
  }
  for (const TransformStepText& step : options.steps) {
    for (const std::string_view other : {"--passes", "--copies", "--from-line", "--outline"}) {
      if (step.option == other)
        return fmt::format("--split-tools and {} do not go together: use one after the other.", other);
    }
  }
  return std::nullopt;
}

}  // namespace

ExitStatus transform(const TransformOptions& options) {
  if (const auto conflict = conflict_of(options)) {
    complain(*conflict);
    return ExitStatus::Usage;
  }
  const auto steps = parse_steps(options.steps);
  if (!steps) {
    complain(steps.error());
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
  const Work work{
      .program = *file->program(), .steps = *steps, .dialect = (*personality)->dialect(), .file = options.file};
  if (options.splits_tools) return split_tools(work, options);
  if (options.previews) return preview(work);
  if (options.output.empty() || options.output == "-") return write_to_standard_output(work);
  return write_file(work, std::nullopt, options.output);
}

}  // namespace kerf::apps
