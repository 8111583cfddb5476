#include "sender/job/program_flow.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kerf::job {
namespace {

using testing::ElementsAre;
using testing::Field;
using testing::IsEmpty;
using testing::Optional;

TEST(FlowWords, AreReadInWireForm) {
  EXPECT_EQ(flow_words_of("G1X1M0"), (FlowWords{.pauses = true}));
  EXPECT_EQ(flow_words_of("M60"), (FlowWords{.pauses = true}));
  EXPECT_EQ(flow_words_of("M01"), (FlowWords{.pauses_optionally = true}));
  EXPECT_EQ(flow_words_of("M30"), (FlowWords{.ends_program = true}));
  EXPECT_EQ(flow_words_of("M2"), (FlowWords{.ends_program = true}));
  EXPECT_EQ(flow_words_of("T12M6"), (FlowWords{.changes_tool = true, .tool = 12}));
  EXPECT_EQ(flow_words_of("G4P1.5"), (FlowWords{.dwell_s = 1.5}));
  EXPECT_EQ(flow_words_of("M3S1000"), FlowWords{});
  EXPECT_EQ(flow_words_of("M62P1"), FlowWords{});
  EXPECT_EQ(flow_words_of("(MSG,M0 T3 M6)"), FlowWords{});
}

TEST(FlowWords, LoseOneWord) {
  EXPECT_EQ(without_word("T1M6G0X1", 'M', 6), "T1G0X1");
  EXPECT_EQ(without_word("T1M06", 'M', 6), "T1");
  EXPECT_EQ(without_word("M62P1", 'M', 6), "M62P1");
}

class Flow : public testing::Test {
 protected:
  Passage admit(std::string_view line) {
    wire_ = line;
    return flow_.admit(++number_, line, wire_);
  }
  ProgramFlow flow_{ToolChanges::ByOperator, true};
  std::string wire_;
  std::uint32_t number_ = 0;
};

TEST_F(Flow, HoldsAToolChangeBackUntilTheOperatorHasChangedIt) {
  EXPECT_EQ(admit("G0X1"), Passage::Send);
  EXPECT_EQ(admit("T2M6"), Passage::Wait);
  EXPECT_EQ(flow_.gate(), (ToolGate{.file_line = 2, .tool = 2, .by_operator = true}));
  flow_.pass_gate();
  --number_;
  EXPECT_EQ(admit("T2M6"), Passage::Send);
  EXPECT_EQ(wire_, "T2");
  EXPECT_FALSE(flow_.gate());
}

TEST_F(Flow, RemembersTheToolOfAnEarlierLine) {
  EXPECT_EQ(admit("T7"), Passage::Send);
  EXPECT_EQ(admit("M6"), Passage::Wait);
  EXPECT_THAT(flow_.gate(), Optional(Field(&ToolGate::tool, Optional(7))));
}

TEST_F(Flow, SendsNothingBehindTheEnd) {
  EXPECT_EQ(admit("M30"), Passage::Send);
  EXPECT_EQ(admit("G0X1"), Passage::End);
  EXPECT_EQ(flow_.end_line(), 1U);
}

TEST_F(Flow, TellsMessagesWhenTheirPlaceIsReached) {
  EXPECT_EQ(admit("G0X1"), Passage::Send);
  wire_.clear();
  EXPECT_EQ(flow_.admit(2, "(MSG,Turn the part)", wire_), Passage::LeaveOut);
  number_ = 2;
  EXPECT_EQ(admit("G0X2"), Passage::Send);
  EXPECT_THAT(flow_.take_messages(0), IsEmpty());
  EXPECT_THAT(flow_.take_messages(1), ElementsAre(Field(&DueMessage::text, "Turn the part")));
  EXPECT_THAT(flow_.take_messages(3), IsEmpty());
}

TEST(FlowByController, LetsTheLineGoAndNothingBehindIt) {
  ProgramFlow flow{ToolChanges::ByController, false};
  std::string wire = "T2M6";
  EXPECT_EQ(flow.admit(1, wire, wire), Passage::Send);
  EXPECT_EQ(wire, "T2M6");
  wire = "G0X1";
  EXPECT_EQ(flow.admit(2, wire, wire), Passage::Wait);
  flow.pass_gate();
  EXPECT_EQ(flow.admit(2, wire, wire), Passage::Send);
}

}  // namespace
}  // namespace kerf::job
