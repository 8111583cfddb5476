#include "io/audit_history.hpp"

#include <filesystem>

#include <gtest/gtest.h>
#include <unistd.h>

namespace kerf::io {
namespace {

class AuditHistoryTest : public testing::Test {
 protected:
  AuditHistoryTest() {
    folder_ = std::filesystem::temp_directory_path() / ("kerf-audits-" + std::to_string(::getpid()));
    std::filesystem::remove_all(folder_);
  }
  ~AuditHistoryTest() override { std::filesystem::remove_all(folder_); }

  [[nodiscard]] AuditHistory open() const { return *AuditHistory::open((folder_ / "journal.db").string()); }

  std::filesystem::path folder_;
};

TEST_F(AuditHistoryTest, KeepsWhatWasFoundAndWhatWasLeftOff) {
  std::int64_t number = 0;
  {
    auto history = open();
    const auto begun = history.begin("tcp://here:1", {.left_off = {{.id = "21", .value = "1"}}});
    ASSERT_TRUE(begun);
    number = *begun;
    ASSERT_TRUE(history.begin("tcp://there:2", {}));
  }
  auto history = open();
  auto audits = history.audits("tcp://here:1");
  ASSERT_TRUE(audits);
  ASSERT_EQ(audits->size(), 1U);
  EXPECT_EQ(audits->front().result.outcome, job::AuditOutcome::Unfinished);
  ASSERT_EQ(audits->front().result.left_off.size(), 1U);
  EXPECT_EQ(audits->front().result.left_off[0].id, "21");

  const job::AuditResult result{.outcome = job::AuditOutcome::Shifted,
                                .sentence = "Lost.",
                                .axes = {{.axis = "X",
                                          .verdict = job::AxisVerdict::Shifted,
                                          .difference_mm = -0.16,
                                          .difference_steps = -40,
                                          .before_mm = 0.16,
                                          .after_mm = 0.0,
                                          .step_mm = 0.004}},
                                .tolerance_mm = 0.05,
                                .is_homed = true};
  ASSERT_TRUE(history.update(number, result));
  audits = history.audits();
  ASSERT_TRUE(audits);
  ASSERT_EQ(audits->size(), 2U);
  const job::AuditResult& kept = audits->back().result;
  EXPECT_EQ(kept.outcome, job::AuditOutcome::Shifted);
  EXPECT_TRUE(kept.is_homed);
  EXPECT_TRUE(kept.left_off.empty());
  ASSERT_EQ(kept.axes.size(), 1U);
  EXPECT_EQ(kept.axes[0].difference_steps, -40);
  EXPECT_EQ(kept.axes[0].difference_mm, -0.16);
  EXPECT_EQ(kept.axes[0].verdict, job::AxisVerdict::Shifted);
}

}  // namespace
}  // namespace kerf::io
