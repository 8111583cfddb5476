#include "programs.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "common/base/text.hpp"

namespace kerf::bench {
namespace {

constexpr std::string_view kRouter =
    "$1=255\n$11=0.02\n$12=0.002\n$32=0\n$100=80\n$101=80\n$102=400\n$110=5000\n$111=5000\n$112=1500\n"
    "$120=310\n$121=290\n$122=110\n";
constexpr std::string_view kLaser =
    "$1=255\n$11=0.03\n$12=0.002\n$30=1000\n$31=0\n$32=1\n$100=100\n$101=100\n$102=250\n$110=12000\n$111=12000\n"
    "$112=1500\n$120=1530\n$121=1470\n$122=110\n";
constexpr double kPi = 3.14159265358979323846;

/// Numbers that look random and are the same everywhere (a linear congruential generator).
class Dice {
 public:
  /// From `low` on, below `high`.
  double between(double low, double high) {
    state_ = state_ * 6364136223846793005U + 1442695040888963407U;
    constexpr double kSteps = 1U << 31U;
    return low + (high - low) * static_cast<double>(state_ >> 33U) / kSteps;
  }

 private:
  std::uint64_t state_ = 20'261'122;
};

/// Appends words and counts lines.
class Writer {
 public:
  explicit Writer(std::string_view head) : text_(head), lines_(std::ranges::count(head, '\n')) {}

  Writer& word(std::string_view letter, double value, int decimals) {
    text_ += letter;
    base::append_fixed(text_, value, decimals);
    return *this;
  }
  void end_line() {
    text_ += '\n';
    ++lines_;
  }
  [[nodiscard]] std::ptrdiff_t lines() const { return lines_; }
  [[nodiscard]] std::string finish(std::string_view tail) { return text_ + std::string{tail}; }

 private:
  std::string text_;
  std::ptrdiff_t lines_;
};

}  // namespace

BenchProgram finishing(int lines) {
  constexpr double kWidth_mm = 120.0;
  constexpr double kStepover_mm = 0.4;
  Dice dice;
  Writer out("G21 G90 G94 G17\nM3 S12000\nG0 X0 Y0 Z5\nG1 Z0 F600\nF3000\n");
  double x = 0;
  double y = 0;
  double heading = 1;
  while (out.lines() + 2 < lines) {
    x += heading * dice.between(0.1, 0.8);
    if (x < 0 || x > kWidth_mm) {
      x = std::clamp(x, 0.0, kWidth_mm);
      y += kStepover_mm;
      heading = -heading;
    }
    const double z = 2.0 * std::sin(x / 7.0) * std::cos(y / 9.0) + 0.5 * std::sin((x + y) / 2.5) - 3.0;
    out.word("X", x, 3).word("Y", y, 3).word("Z", z, 3).end_line();
  }
  return {.name = "finishing", .text = out.finish("M5\nM30\n"), .settings = kRouter};
}

BenchProgram raster(int lines) {
  constexpr int kPixels = 800;
  constexpr double kPixel_mm = 0.1;
  Dice dice;
  Writer out("G21 G90 G94 G17\nM4 S0\nG0 X0 Y0\nG1 F4000\n");
  for (int row = 0; out.lines() + 2 < lines; ++row) {
    out.word("Y", row * kPixel_mm, 1).word("S", 0, 0).end_line();
    const bool out_bound = row % 2 == 0;
    for (int pixel = 1; pixel <= kPixels && out.lines() + 2 < lines; ++pixel) {
      const double x = (out_bound ? pixel : kPixels - pixel) * kPixel_mm;
      out.word("X", x, 1).word("S", std::floor(dice.between(0, 1000)), 0).end_line();
    }
  }
  return {.name = "raster", .text = out.finish("M5\nM30\n"), .settings = kLaser};
}

BenchProgram arcs(int lines) {
  Dice dice;
  Writer out("G21 G90 G94 G17 G91.1\nM3 S12000\nG0 X0 Y0 Z5\nG1 Z-1 F600\nF2000\nG91\n");
  while (out.lines() + 3 < lines) {
    const double radius = dice.between(1.0, 10.0);
    const double from = dice.between(0.0, 2 * kPi);
    const bool clockwise = dice.between(0.0, 1.0) < 0.5;
    const double sweep = dice.between(kPi / 6, 1.5 * kPi);
    const double to = clockwise ? from - sweep : from + sweep;
    out.word(clockwise ? "G2X" : "G3X", radius * (std::cos(to) - std::cos(from)), 4)
        .word("Y", radius * (std::sin(to) - std::sin(from)), 4)
        .word("I", -radius * std::cos(from), 4)
        .word("J", -radius * std::sin(from), 4)
        .end_line();
    out.word("G1X", dice.between(-2.0, 2.0), 3).word("Y", dice.between(-2.0, 2.0), 3).end_line();
  }
  return {.name = "arcs", .text = out.finish("M5\nM30\n"), .settings = kRouter};
}

std::vector<BenchProgram> all_programs(int lines) {
  return {finishing(lines), raster(lines), arcs(lines)};
}

}  // namespace kerf::bench
