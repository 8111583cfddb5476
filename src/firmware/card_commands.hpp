#pragma once
// `$F...`, `$CWD`, `$PWD`: what a build with a card understands beyond the rest (grblHAL sdcard.c, fs_stream.c).

#include <expected>
#include <optional>
#include <string_view>

#include "firmware/board.hpp"
#include "firmware/step.hpp"

namespace kerf::firmware {

/// Handles the commands of the card slot. Without a card none of them exists.
class CardCommands {
 public:
  using Result = std::expected<void, ErrorCode>;

  explicit CardCommands(Board& board) : board_(board) {}

  /// `line` without its `$`. Nothing if this is none of these commands.
  [[nodiscard]] std::optional<Result> execute(std::string_view line, Steps& steps);

 private:
  struct Row;

  Result mount();
  Result unmount();
  std::optional<Result> run(std::optional<std::string_view> name, bool filtered, Steps& steps);
  Result start(std::string_view name, Steps& steps);
  Result list(bool filtered);
  [[nodiscard]] bool list_folder(const std::string& folder, int depth, bool filtered);
  Result print_file(std::string_view name);
  Result remove(std::string_view name);
  Result change_folder(std::string_view name);
  void say_folder();
  void say_drives();
  /// What forbids to touch a file now.
  [[nodiscard]] std::optional<ErrorCode> refusal() const;

  Board& board_;
};

}  // namespace kerf::firmware
