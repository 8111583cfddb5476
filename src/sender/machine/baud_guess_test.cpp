#include "sender/machine/baud_guess.hpp"

#include <random>

#include <gtest/gtest.h>

namespace kerf::machine {
namespace {

constexpr std::string_view kWelcome = "\r\nGrbl 1.1h ['$' for help]\r\n";
constexpr std::string_view kTalk =
    "<Idle|MPos:12.340,-7.125,3.000|FS:0,0|WCO:0.000,0.000,0.000>\r\n<Idle|MPos:12.340,-7.125,3.000|FS:0,0>\r\n";

TEST(BaudGuess, TheRightRateIsHeardAsItIs) {
  EXPECT_EQ(heard_at(kWelcome, 115200, 115200, BadFrames::Kept), kWelcome);
  EXPECT_EQ(heard_at(kTalk, 250000, 250000, BadFrames::Dropped), kTalk);
}

TEST(BaudGuess, TheUsualMistakesAreNamed) {
  for (const int sent : {9600, 19200, 38400, 57600, 230400}) {
    EXPECT_EQ(guess_baud(heard_at(kWelcome, sent, 115200, BadFrames::Kept), 115200), sent);
    EXPECT_EQ(guess_baud(heard_at(kTalk, sent, 115200, BadFrames::Kept), 115200), sent);
  }
}

TEST(BaudGuess, NoRateIsNamedWrongly) {
  for (const int read : {9600, 57600, 115200, 250000}) {
    for (const int sent : {9600, 19200, 38400, 57600, 115200, 230400, 250000}) {
      if (sent == read) continue;
      for (const auto bad : {BadFrames::Kept, BadFrames::Dropped}) {
        const std::string heard = heard_at(kWelcome, sent, read, bad) + heard_at(kTalk, sent, read, bad);
        // A port that is much slower hears a byte or two of all that; then no rate is named, but never a wrong one.
        EXPECT_EQ(guess_baud(heard, read).value_or(sent), sent) << sent << " read at " << read;
      }
    }
  }
}

TEST(BaudGuess, MereNoiseIsNoRate) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    std::mt19937 random{seed};
    std::string noise;
    for (int count = 0; count < 200; ++count) noise += static_cast<char>(random() % 256);
    EXPECT_EQ(guess_baud(noise, 115200), std::nullopt);
  }
  EXPECT_EQ(guess_baud("", 115200), std::nullopt);
}

}  // namespace
}  // namespace kerf::machine
