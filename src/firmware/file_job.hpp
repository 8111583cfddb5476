#pragma once
// A file on the card that is read in place of the stream (grblHAL fs_stream.c; protocol.md 9.3).

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "firmware/card.hpp"

namespace kerf::firmware {

/// Hands a file out byte by byte, and counts its lines. Knows nothing of what the bytes mean.
class FileJob {
 public:
  /// Starts at the beginning of a file that exists.
  void begin(std::shared_ptr<Card> card, const std::string& path, std::uint64_t bytes);
  /// Forgets everything: the stream is read again.
  void end() { *this = {}; }

  /// A file is run, be it drained or waiting.
  [[nodiscard]] bool is_running() const { return card_ != nullptr; }
  /// Lines come from the file, and what the stream sends is dropped.
  [[nodiscard]] bool is_read() const { return is_running() && !is_suspended_; }
  /// The whole file has been handed out.
  [[nodiscard]] bool is_drained() const { return is_running() && !is_open_; }
  /// During a tool change the stream speaks again.
  void suspend() { is_suspended_ = is_running(); }
  void resume() { is_suspended_ = false; }

  /// The next byte. CR LF and LF CR come as their first half. At the end, or with `may_read` false, the file is closed:
  /// then comes one LF more, unless a line had just ended and the file was not looked at.
  [[nodiscard]] std::optional<char> next(bool may_read);

  /// Where the next byte stands.
  [[nodiscard]] std::uint64_t position() const { return position_; }
  /// Reads on at a place behind the end of `line`.
  void go_to(std::uint64_t position, std::int32_t line);

  /// The line that is being read, counted from 1; an N word that was executed moves it.
  [[nodiscard]] std::int32_t line() const { return line_; }
  void set_line(std::int32_t line) { line_ = line; }
  /// How much has been handed out.
  [[nodiscard]] double percent() const;
  [[nodiscard]] const std::string& name() const { return name_; }

 private:
  [[nodiscard]] std::optional<char> next_raw();
  [[nodiscard]] std::optional<char> next_in_file();

  std::shared_ptr<Card> card_;
  std::string path_;
  std::string name_;
  std::uint64_t bytes_ = 0;
  std::uint64_t position_ = 0;
  /// Bytes that were read ahead, and how many of them have been handed out.
  std::string ahead_;
  std::size_t taken_ = 0;
  std::int32_t line_ = 1;
  char line_end_ = '\0';
  bool is_open_ = false;
  bool is_suspended_ = false;
};

}  // namespace kerf::firmware
