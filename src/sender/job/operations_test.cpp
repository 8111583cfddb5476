#include "sender/job/operations.hpp"

#include <vector>

#include <gmock/gmock.h>

#include "common/base/text.hpp"

namespace kerf::job {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

std::vector<std::string> operations_of(std::string_view text) {
  OperationFinder finder;
  std::vector<std::string> names;
  for (const std::string_view line : base::split(text, '\n')) {
    if (auto name = finder.on_line(line)) names.push_back(*std::move(name));
  }
  return names;
}

TEST(Operations, AreNamedByTheMarksOfCamPrograms) {
  EXPECT_THAT(operations_of("(begin operation: Profile)\nG1X1\n(finish operation: Profile)\n"
                            "(Begin operation: Pocket)\nG1X2\n"),
              ElementsAre("Profile", "Pocket"));
  EXPECT_THAT(operations_of("(Toolpath:- Pocket 1)\nG1X1\n; Operation: Engrave\nG1X2\n"),
              ElementsAre("Pocket 1", "Engrave"));
}

TEST(Operations, ANameAloneBehindABlankLineIsOne) {
  EXPECT_THAT(operations_of("(1001)\n(T1 D=6.)\n\nG90 G94\nG21\n\n(2D Adaptive1)\nT1\nG1X1\n\n(2D Contour2)\nG1X2\n"),
              ElementsAre("2D Adaptive1", "2D Contour2"));
}

TEST(Operations, OtherCommentsAreNone) {
  EXPECT_THAT(operations_of("(made by hand)\nG1X1 (a move)\n(and another)\nG1X2\n"), IsEmpty());
}

}  // namespace
}  // namespace kerf::job
