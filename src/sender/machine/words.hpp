#pragma once
// What a controller says about itself that stays the same while its firmware does: 25 kB on grblHAL, two seconds at
// 115200 baud. Kept by the host, it need not be asked for again.

#include <string>
#include <vector>

#include <boost/describe.hpp>

namespace kerf::machine {

/// One question, such as `$ES`, and the lines of its answer without the ok.
struct KeptAnswer {
  std::string question;
  std::vector<std::string> lines;
  friend bool operator==(const KeptAnswer&, const KeptAnswer&) = default;
};
BOOST_DESCRIBE_STRUCT(KeptAnswer, (), (question, lines))

/// All answers of one firmware. `identity` is CapabilityCollector::identity() of whoever gave them.
struct Words {
  std::string identity{};
  std::vector<KeptAnswer> answers{};
  friend bool operator==(const Words&, const Words&) = default;
};
BOOST_DESCRIBE_STRUCT(Words, (), (identity, answers))

}  // namespace kerf::machine
