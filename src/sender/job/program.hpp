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

#include "common/base/content_hash.hpp"
#include "common/base/text_masks.hpp"

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
  /// Line `number` (from 1); empty when there is none. Costs a walk over the lines between two entries of the index.
  [[nodiscard]] std::optional<ProgramLine> line(std::uint32_t number) const;
  /// Offset of the line after `line`.
  [[nodiscard]] std::size_t offset_after(const ProgramLine& line) const;

  /// Longest line as sent with (`true`) or without `(MSG,…)` comments.
  [[nodiscard]] LongestLine longest_line(bool with_messages) const { return with_messages ? longest_ : longest_bare_; }

  /// The index begins with an entry for every so many lines…
  static constexpr std::uint32_t kFirstIndexStep = 256;
  /// …and has no more entries than this: memory must not grow with the file, so entries of a long one lie further
  /// apart.
  static constexpr std::size_t kMostIndexEntries = 16'384;

 private:
  friend class ProgramReader;
  Program() = default;
  void add_to_index(std::uint32_t number, std::size_t offset_bytes);

  std::string name_;
  std::shared_ptr<const void> owner_;
  std::string_view text_;
  std::string hash_;
  std::uint32_t line_count_ = 0;
  /// Offset of every index_step_-th line.
  std::vector<std::size_t> index_;
  std::uint32_t index_step_ = kFirstIndexStep;
  /// Number of the line that the index has to hold next.
  std::uint32_t next_indexed_ = 1;
  LongestLine longest_;
  LongestLine longest_bare_;
};

/// Reads a text into a Program piece by piece, so that whoever owns a long one can show how far it is, and give back
/// the memory of what was read.
class ProgramReader {
 public:
  /// `owner` keeps `text` alive.
  ProgramReader(std::string name, std::shared_ptr<const void> owner, std::string_view text);

  /// Reads `most_bytes` more; false when nothing is left to read, or a fault was found.
  bool read_on(std::size_t most_bytes);
  /// The whole program, once read_on() gave false.
  [[nodiscard]] std::expected<std::shared_ptr<const Program>, ProgramFault> finish();

 private:
  void read_masked(const base::TextMasks& masks, std::size_t length);
  void end_line(std::size_t end, bool is_special);
  [[nodiscard]] std::optional<ProgramFault> look_at(const ProgramLine& line) const;
  void measure(const ProgramLine& line);
  void hash_until(std::size_t bytes_of_whole);

  std::shared_ptr<Program> program_;
  /// With what does not count as program: byte order mark and end mark.
  std::string_view whole_;
  std::size_t hashed_bytes_ = 0;
  base::ContentHash hash_;
  /// How far the text is read, and where the line begins that is being read.
  std::size_t read_bytes_ = 0;
  std::size_t line_start_bytes_ = 0;
  bool line_is_special_ = false;
  /// The last byte was a CR: a line feed behind it belongs to the same end.
  bool after_return_ = false;
  bool is_executable_ = false;
  std::optional<ProgramFault> fault_;
  std::string form_;
};

}  // namespace kerf::job
