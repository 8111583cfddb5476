#pragma once
// One line of a program as its file has it: where each word stands, and how words are replaced without touching
// anything else.

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace kerf::rehearsal {

/// A letter in upper case and its number, between two places of the line. Blanks within belong to it.
struct PlacedWord {
  char letter = 0;
  std::size_t begin = 0;
  std::size_t end = 0;
  /// Without blanks and `+`; what is no number has none.
  std::string digits{};
  double value = 0;

  /// The value without its fraction, as far as an int reaches.
  [[nodiscard]] int whole() const;
};

/// Edits are collected and take effect together in text(), so that places stay those of the line as it was.
class LineText {
 public:
  explicit LineText(std::string line);

  /// As the line was. Comments have no words; lines of `$` have none either.
  [[nodiscard]] const std::vector<PlacedWord>& words() const { return words_; }
  [[nodiscard]] const std::string& line() const { return line_; }
  /// The first word with this letter.
  [[nodiscard]] const PlacedWord* find(char letter) const;
  [[nodiscard]] bool has(char letter) const { return find(letter) != nullptr; }
  /// The word that says G or M `number`, up to one decimal.
  [[nodiscard]] const PlacedWord* find_command(char letter, double number) const;
  [[nodiscard]] bool has_command(char letter, double number) const { return find_command(letter, number) != nullptr; }
  /// The words and nothing else, without those M words.
  [[nodiscard]] std::string plain_words(std::span<const int> without_m = {}) const;
  /// What stands between its words: a blank or nothing.
  [[nodiscard]] std::string_view gap() const { return is_spaced_ ? " " : ""; }
  /// The line begins with `/`.
  [[nodiscard]] bool may_be_skipped() const;

  /// `text` stands in place of the word: "X10.5".
  void replace(const PlacedWord& word, std::string_view text);
  /// With a blank between them if this line has blanks between words.
  void insert_before(const PlacedWord& word, std::string_view text);
  void insert_after(const PlacedWord& word, std::string_view text);
  /// Behind the last word, or where the first would stand.
  void append(std::string_view text);
  /// With the blanks on one side of it.
  void erase(const PlacedWord& word);

  [[nodiscard]] bool is_edited() const { return !edits_.empty(); }
  /// The line with all edits.
  [[nodiscard]] std::string text() const;

 private:
  struct Edit {
    std::size_t begin = 0;
    std::size_t end = 0;
    std::string text{};
  };

  std::string line_;
  std::vector<PlacedWord> words_;
  std::vector<Edit> edits_;
  bool is_spaced_ = false;
};

}  // namespace kerf::rehearsal
