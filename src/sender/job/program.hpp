#pragma once
// The G-code text of a job: immutable after load, shared and never copied.

#include <cstddef>
#include <cstdint>
#include <expected>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <boost/describe.hpp>

namespace kerf::job {

/// Why a text is no program.
enum class ProgramError {
  Empty,         ///< no line that a controller would execute
  Binary,        ///< NUL or control characters: not a text
  RealtimeByte,  ///< `?`, `!`, `~` or a byte above 0x7F outside a comment: a controller would act on it at once
};
BOOST_DESCRIBE_ENUM(ProgramError, Empty, Binary, RealtimeByte)

/// Where a text stops being a program. `line` counts from 1; 0 when the whole text is meant.
struct ProgramFault {
  ProgramError error{};
  std::uint32_t line = 0;
  std::string excerpt{};
  bool operator==(const ProgramFault&) const = default;
};
BOOST_DESCRIBE_STRUCT(ProgramFault, (), (error, line, excerpt))

/// One clear sentence about `fault` in the program called `name`: what, where, what to do.
[[nodiscard]] std::string describe(const ProgramFault& fault, std::string_view name);

/// One line of the file: number from 1, where it starts, and its text without the line end.
struct ProgramLine {
  std::uint32_t number = 0;
  std::size_t offset_bytes = 0;
  std::string_view text;
};

/// The longest line after WireForm has taken out what no controller needs.
struct LongestLine {
  std::size_t length = 0;
  std::uint32_t number = 0;
};

/// A text that may be sent to a controller. Any line ends; comments may hold UTF-8 or Latin-1, which never reaches the
/// wire.
class Program {
 public:
  /// Checks and indexes `text`. The file's bytes are moved in, not copied.
  [[nodiscard]] static std::expected<std::shared_ptr<const Program>, ProgramFault> load(std::string name,
                                                                                        std::string text);
  /// The same for text that lives elsewhere (a mapped file): `owner` keeps it alive.
  [[nodiscard]] static std::expected<std::shared_ptr<const Program>, ProgramFault> load(
      std::string name, std::shared_ptr<const void> owner, std::string_view text);

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] std::string_view text() const { return text_; }
  [[nodiscard]] std::size_t size_bytes() const { return text_.size(); }
  /// base::content_hash() of the file, every byte of it: what recognises it later.
  [[nodiscard]] const std::string& hash() const { return hash_; }
  [[nodiscard]] std::uint32_t line_count() const { return line_count_; }

  /// The line that begins at `offset_bytes`, numbered `number`; empty at the end of the text.
  [[nodiscard]] std::optional<ProgramLine> line_at(std::size_t offset_bytes, std::uint32_t number) const;
  /// Line `number` (from 1); empty when there is none. Costs a walk over at most kIndexStep lines.
  [[nodiscard]] std::optional<ProgramLine> line(std::uint32_t number) const;
  /// Offset of the line after `line`.
  [[nodiscard]] std::size_t offset_after(const ProgramLine& line) const;

  /// Longest line as sent with (`true`) or without `(MSG,…)` comments.
  [[nodiscard]] LongestLine longest_line(bool with_messages) const { return with_messages ? longest_ : longest_bare_; }

  static constexpr std::uint32_t kIndexStep = 256;

 private:
  Program() = default;
  [[nodiscard]] std::optional<ProgramFault> scan();
  [[nodiscard]] std::optional<ProgramFault> scan_line(const ProgramLine& line, bool& executable);

  std::string name_;
  std::shared_ptr<const void> owner_;
  std::string_view text_;
  std::string hash_;
  std::uint32_t line_count_ = 0;
  /// Offset of every kIndexStep-th line: a file of a gigabyte must not cost an index of its own size.
  std::vector<std::size_t> index_;
  LongestLine longest_;
  LongestLine longest_bare_;
};

}  // namespace kerf::job
