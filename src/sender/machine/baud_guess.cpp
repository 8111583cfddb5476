#include "sender/machine/baud_guess.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <set>
#include <vector>

#include "common/vocabulary/dialect.hpp"

namespace kerf::machine {
namespace {

constexpr int kBitsPerByte = 10;
/// What boards are set to: Grbl 0.8 used 9600, 0.9 and later 115200; the rest is offered by driver builds.
constexpr std::array kRates{9600, 19200, 38400, 57600, 115200, 230400, 250000, 460800, 500000, 921600, 1000000};
/// Short pieces occur by chance, long ones are spoilt by a single number that is not known.
constexpr std::array<std::size_t, 3> kPieces{3, 6, 12};
constexpr std::size_t kFewestBytes = 6;
constexpr double kLeastShare = 0.2;
/// The best guess must explain that much more than the second.
constexpr double kClearlyBetter = 1.1;

/// The line's level over time; idle (high) before and after.
class Waveform {
 public:
  Waveform(std::string_view text, int baud) : text_(text), baud_(baud) {}

  [[nodiscard]] bool level_at(double time_s) const {
    const double bits = time_s * baud_;
    if (bits < 0 || bits >= static_cast<double>(text_.size() * kBitsPerByte)) return true;
    const auto bit = static_cast<std::size_t>(bits);
    const auto place = bit % kBitsPerByte;
    if (place == 0) return false;
    if (place == kBitsPerByte - 1) return true;
    return ((static_cast<unsigned char>(text_[bit / kBitsPerByte]) >> (place - 1)) & 1U) != 0;
  }
  [[nodiscard]] double length_s() const { return static_cast<double>(text_.size() * kBitsPerByte) / baud_; }

 private:
  std::string_view text_;
  int baud_;
};

/// A receiver looks at the line so often in each of its bits.
constexpr int kLooksPerBit = 16;

using Pieces = std::set<std::string, std::less<>>;

void add_pieces(Pieces& pieces, const std::string& bytes) {
  for (const std::size_t length : kPieces) {
    for (std::size_t at = 0; at + length <= bytes.size(); ++at) pieces.insert(bytes.substr(at, length));
  }
}

/// What every one of them says sooner or later.
Pieces pieces_at(int sent_baud, int read_baud) {
  Pieces pieces;
  const auto add = [&](std::string_view words) {
    add_pieces(pieces, heard_at(words, sent_baud, read_baud, BadFrames::Kept));
    add_pieces(pieces, heard_at(words, sent_baud, read_baud, BadFrames::Dropped));
  };
  for (const auto* dialect : vocabulary::all_dialects()) add("\r\n" + std::string{dialect->welcome} + "\r\n");
  for (const std::string_view words :
       {"ok\r\n", "error:1\r\n", "error:2\r\n", "[MSG:'$H'|'$X' to unlock]\r\n",
        "<Idle|MPos:0.000,0.000,0.000|FS:0,0>\r\n", "<Alarm|MPos:0.000,0.000,0.000|FS:0,0>\r\n",
        "<Idle|MPos:0.000,0.000,0.000|FS:0,0|WCO:0.000,0.000,0.000>\r\n",
        "<Idle|MPos:0.000,0.000,0.000|Bf:15,128|FS:0,0|Ov:100,100,100>\r\n",
        "<Idle|WPos:0.000,0.000,0.000|Bf:100,1023|FS:0,0|Ov:100,100,100|A:|TLR:0>\r\n"}) {
    add(words);
  }
  return pieces;
}

double share_explained(std::string_view heard, const Pieces& pieces) {
  std::size_t explained = 0;
  std::size_t count = 0;
  for (const std::size_t length : kPieces) {
    for (std::size_t at = 0; at + length <= heard.size(); ++at, ++count) {
      explained += pieces.contains(heard.substr(at, length)) ? 1U : 0U;
    }
  }
  return static_cast<double>(explained) / static_cast<double>(count);
}

}  // namespace

std::string heard_at(std::string_view text, int sent_baud, int read_baud, BadFrames bad) {
  const Waveform line(text, sent_baud);
  const double bit_s = 1.0 / read_baud;
  const double look_s = bit_s / kLooksPerBit;
  std::string heard;
  bool was_high = true;
  for (double now_s = 0; now_s < line.length_s(); now_s += look_s) {
    const bool high = line.level_at(now_s);
    const bool falls = was_high && !high;
    was_high = high;
    if (!falls || line.level_at(now_s + (bit_s / 2))) continue;
    std::uint8_t byte = 0;
    for (int bit = 0; bit < 8; ++bit) {
      if (line.level_at(now_s + ((1.5 + bit) * bit_s))) byte = static_cast<std::uint8_t>(byte | (1U << bit));
    }
    now_s += 9.5 * bit_s;
    was_high = line.level_at(now_s);
    if (was_high || bad == BadFrames::Kept) heard += static_cast<char>(byte);
  }
  return heard;
}

std::optional<int> guess_baud(std::string_view heard, int read_baud) {
  if (heard.size() < kFewestBytes) return std::nullopt;
  std::optional<int> best;
  double best_share = kLeastShare;
  double second_share = 0;
  for (const int rate : kRates) {
    if (rate == read_baud) continue;
    const double share = share_explained(heard, pieces_at(rate, read_baud));
    if (share > best_share) {
      second_share = best ? best_share : second_share;
      best_share = share;
      best = rate;
    } else {
      second_share = std::max(second_share, share);
    }
  }
  return best && best_share >= second_share * kClearlyBetter ? best : std::nullopt;
}

}  // namespace kerf::machine
