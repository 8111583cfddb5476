#pragma once
// Lines of a program on their way through transforms, one at a time: each transform is a source of lines that takes
// them from the source before it.

#include <cstddef>
#include <cstdint>
#include <deque>
#include <expected>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "rehearsal/program_reading.hpp"
#include "sender/job/program.hpp"

namespace kerf::rehearsal {

/// A line, the line of the file that it comes from, and how it ends there: "\n", "\r\n", "\r" or "".
struct SourceLine {
  std::string text{};
  std::uint32_t number = 0;
  std::string_view end = "\n";
};

/// What a transform says besides its lines.
struct TransformWarning {
  std::uint32_t line = 0;
  std::string text{};
  bool operator==(const TransformWarning&) const = default;
};
BOOST_DESCRIBE_STRUCT(TransformWarning, (), (line, text))

/// Lines that wait to be taken, and what was noticed. The same warning is kept once, with its first line.
class LineQueue {
 public:
  void put(SourceLine line) { lines_.push_back(std::move(line)); }
  /// A new line that stands for line `like`.
  void put_new(std::string text, const SourceLine& like) {
    put({.text = std::move(text), .number = like.number, .end = like.end.empty() ? "\n" : like.end});
  }
  void warn(std::uint32_t line, std::string text);
  [[nodiscard]] bool is_empty() const { return lines_.empty(); }
  SourceLine take();
  void clear() { lines_.clear(); }
  [[nodiscard]] const std::deque<TransformWarning>& warnings() const { return warnings_; }

 private:
  std::deque<SourceLine> lines_;
  std::deque<TransformWarning> warnings_;
};

/// Gives lines until there are no more, or one that cannot be transformed.
class LineSource {
 public:
  LineSource() = default;
  LineSource(const LineSource&) = delete;
  LineSource& operator=(const LineSource&) = delete;
  virtual ~LineSource() = default;
  /// Nothing at the end.
  virtual std::expected<std::optional<SourceLine>, TransformRefusal> next() = 0;
  /// From the first line again.
  virtual void rewind() = 0;
  virtual void collect_warnings(std::deque<TransformWarning>& out) const = 0;
};

/// The program itself, which must outlive it.
class ProgramSource : public LineSource {
 public:
  explicit ProgramSource(const job::Program& program) : program_(program) { rewind(); }
  std::expected<std::optional<SourceLine>, TransformRefusal> next() override;
  void rewind() override { next_ = program_.line_at(0, 1); }
  void collect_warnings(std::deque<TransformWarning>&) const override {}

 private:
  const job::Program& program_;
  std::optional<job::ProgramLine> next_;
};

/// A transform that makes lines out of each line as it comes.
class LineRewriter {
 public:
  LineRewriter() = default;
  LineRewriter(const LineRewriter&) = delete;
  LineRewriter& operator=(const LineRewriter&) = delete;
  virtual ~LineRewriter() = default;
  virtual std::expected<void, TransformRefusal> on_line(SourceLine line, LineQueue& out) = 0;
  /// Behind the last line.
  virtual std::expected<void, TransformRefusal> on_end(LineQueue& out);
  /// As it was made.
  virtual void restart() = 0;
};

/// Puts a rewriter behind a source.
class RewritingSource : public LineSource {
 public:
  RewritingSource(std::unique_ptr<LineSource> before, std::unique_ptr<LineRewriter> rewriter)
      : before_(std::move(before)), rewriter_(std::move(rewriter)) {}
  std::expected<std::optional<SourceLine>, TransformRefusal> next() override;
  void rewind() override;
  void collect_warnings(std::deque<TransformWarning>& out) const override;

 private:
  std::unique_ptr<LineSource> before_;
  std::unique_ptr<LineRewriter> rewriter_;
  LineQueue queue_;
  bool ended_ = false;
};

}  // namespace kerf::rehearsal
