#include "sender/job/link_doubt.hpp"

#include <gtest/gtest.h>

namespace kerf::job {
namespace {

constexpr ExecutingLines kFurtherOn{.from = 40, .to = 44, .known_by = ExecutingKnownBy::Position};

TEST(LinkDoubt, BeginsWithASilenceAndEndsWhenEverythingIsAnswered) {
  LinkDoubt doubt;
  EXPECT_EQ(doubt.widened(kFurtherOn), kFurtherOn);
  doubt.on_silence(20);
  EXPECT_TRUE(doubt.is_question_due());
  doubt.on_asked();
  EXPECT_FALSE(doubt.is_question_due());
  EXPECT_EQ(doubt.widened(kFurtherOn), (ExecutingLines{.from = 20, .to = 44, .known_by = ExecutingKnownBy::Silence}));
  doubt.on_account_settled();
  EXPECT_EQ(doubt.widened(kFurtherOn), kFurtherOn);
}

TEST(LinkDoubt, OfTwoSilencesTheFirstOneCounts) {
  LinkDoubt doubt;
  doubt.on_silence(20);
  doubt.on_asked();
  doubt.on_silence(30);
  EXPECT_TRUE(doubt.is_question_due());
  EXPECT_EQ(doubt.from_line(), 20U);
}

TEST(LinkDoubt, StaysWhereLinesWereLost) {
  LinkDoubt doubt;
  doubt.on_silence(20);
  doubt.on_lines_lost();
  doubt.on_account_settled();
  EXPECT_EQ(doubt.from_line(), 20U);
  // What is executing lies before it.
  const ExecutingLines before{.from = 10, .to = 12, .known_by = ExecutingKnownBy::Position};
  EXPECT_EQ(doubt.widened(before), before);
}

}  // namespace
}  // namespace kerf::job
