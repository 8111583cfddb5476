#pragma once
// A `.talk`: one small conversation with a controller, as data. The format is described in tests/transcripts/README.md.

#include <cstddef>
#include <expected>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "common/base/time.hpp"
#include "firmware/personality.hpp"
#include "firmware/port.hpp"
#include "firmware/workcell.hpp"

namespace kerf::simulation {

/// A whole line in which `*` stands for any text.
class LinePattern {
 public:
  explicit LinePattern(std::string text) : text_(std::move(text)) {}
  [[nodiscard]] bool matches(std::string_view line) const;
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  std::string text_;
};

struct SendBytes {
  std::string bytes;
  firmware::Port port = firmware::Port::Main;
};
struct ExpectLine {
  LinePattern pattern;
  /// On the pendant lines that do not match are passed over.
  firmware::Port port = firmware::Port::Main;
};
struct AllowLines {
  LinePattern pattern;
};
struct ForbidLines {
  LinePattern pattern;
};
struct LetTimePass {
  Duration time{};
};
/// Ask for status reports until one matches.
struct WaitUntil {
  LinePattern pattern;
};
struct MoveSwitch {
  firmware::WorkcellEvent event;
};

struct TalkStep {
  std::size_t line = 0;  ///< in the file, counted from 1
  std::string text;      ///< as it stands there
  std::variant<SendBytes, ExpectLine, AllowLines, ForbidLines, LetTimePass, WaitUntil, MoveSwitch> action;
};

struct Talk {
  /// Who speaks; null only while the talk is being read.
  const firmware::Personality* personality = nullptr;
  /// What the controller was built with.
  firmware::Hardware hardware{};
  /// Lines such as `$22=1`, sent before the talk begins.
  std::vector<std::string> settings;
  /// The start-up text is part of the talk.
  bool begins_at_power_up = false;
  /// The machine has a card slot with a card in it, and these files on the card.
  bool has_card = false;
  /// It has a second stream with a pendant on it.
  bool has_pendant = false;
  struct CardFile {
    std::string path;
    std::string contents;
  };
  std::vector<CardFile> card_files;
  /// Why real firmware cannot be asked; none if it can.
  std::optional<std::string> virtual_only_because;
  std::vector<TalkStep> steps;

  /// True if somebody would have to press switches while the talk runs.
  [[nodiscard]] bool moves_switches() const;
};

enum class TalkFault {
  UnknownMark,
  UnknownHeader,
  BadCount,
  HeaderAfterStep,
  UnknownPersonality,
  BadEscape,
  BadTime,
  BadSwitch
};

struct TalkSyntaxError {
  TalkFault fault{};
  std::size_t line = 0;
  bool operator==(const TalkSyntaxError&) const = default;
};

/// `folder_personality` is who speaks when no header says so: the key of a personality, as the folder is named.
[[nodiscard]] std::expected<Talk, TalkSyntaxError> parse_talk(std::string_view text,
                                                              std::string_view folder_personality);

/// One sentence for people.
[[nodiscard]] std::string_view explain(TalkFault fault);

}  // namespace kerf::simulation
