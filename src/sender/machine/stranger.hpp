#pragma once
// What is on the link when it is not Grbl: told by its words, or by the noise it makes.

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "sender/machine/handshake_orders.hpp"

namespace kerf::machine {

/// How sure a phrase makes us.
enum class Certainty {
  Boot,     ///< ordinary boot text: the firmware that follows may well be Grbl
  Alone,    ///< means something only if nothing of Grbl's comes
  Certain,  ///< no Grbl ever says that
};

/// A phrase and who says it.
struct StrangerRow {
  std::string_view phrase;  ///< found anywhere in a line
  Certainty certainty{};
  HandshakeFailure failure{};
  std::string_view who;     ///< "Marlin, a firmware of 3D printers"
  std::string_view advice;  ///< what to do about it, a sentence of its own
};

[[nodiscard]] std::span<const StrangerRow> stranger_rows();
/// The row of the first phrase found in `text`.
[[nodiscard]] const StrangerRow* find_stranger(std::string_view text);

/// Everything heard since the link was opened, as far as it helps to say who it was.
class Overheard {
 public:
  void hear(std::string_view bytes);
  void forget() { *this = {}; }

  [[nodiscard]] bool empty() const { return count_ == 0; }
  [[nodiscard]] std::size_t count() const { return count_; }
  [[nodiscard]] std::string_view text() const { return text_; }
  /// More bytes that no text has than noise on a good line would explain.
  [[nodiscard]] bool is_noise() const;
  /// Nothing but what Kerf has sent itself.
  [[nodiscard]] bool is_echo_of(std::string_view sent) const;
  /// The beginning, escaped.
  [[nodiscard]] std::string excerpt() const;

 private:
  static constexpr std::size_t kKept = 1024;

  std::string text_;
  std::size_t count_ = 0;
};

/// `line`, escaped and cut to what fits into a sentence.
[[nodiscard]] std::string excerpt_of(std::string_view line);

}  // namespace kerf::machine
