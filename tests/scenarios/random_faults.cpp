// Seeded chaos: bytes that are lost, doubled, changed and late, stalls, reboots, cable pulls, pendants and other
// senders that take over, in any combination, with a job and without. Whatever happens, no line goes to a machine in
// motion that Kerf did not start; the watch of the world looks at the machine itself.

#include <chrono>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "starts.hpp"

namespace kerf::scenarios {
namespace {

using namespace std::chrono_literals;
using session::SessionPhase;
using vocabulary::Firmware;

constexpr unsigned kSeeds = 30;

class Chaos {
 public:
  Chaos(Firmware firmware, unsigned seed) : random_(seed), world_(options(firmware)) {
    must("seed " + std::to_string(seed));
  }

  std::string run() {
    world_.run_for(pick({0ms, 300ms, 2000ms}));
    if (chance(3)) world_.inject_to_controller("G21G91G1X60F1500\n");
    world_.open();
    for (int deed = 0; deed < 40; ++deed) {
      act();
      world_.run_for(std::chrono::milliseconds{random_() % 2500});
      const auto& ledger = world_.session().ledger();
      EXPECT_EQ(ledger.lines_entered(), ledger.lines_settled() + ledger.lines_struck_out() + ledger.size());
    }
    foreign_moves_ += world_.line_watch().foreign_stretches();
    return world_.transcript_text();
  }
  [[nodiscard]] std::size_t foreign_moves() const { return foreign_moves_; }

 private:
  WorldOptions options(Firmware firmware) {
    auto options = chance(2) ? quick_serial(firmware) : quick_network(firmware);
    options.equipment.pendant = firmware == Firmware::GrblHal;
    options.opening_resets = firmware == Firmware::Grbl && chance(2);
    options.head_start = pick({0s, 1s, 20s});
    options.session.reset_policy = chance(3) ? session::ResetPolicy::Never : session::ResetPolicy::WhenAtRest;
    return options;
  }

  void act() {
    switch (random_() % 26) {
      case 0: must("drop " + direction() + " rate 0.02"); break;
      case 1: must("duplicate " + direction() + " rate 0.02"); break;
      case 2: must("corrupt " + direction() + " rate 0.02"); break;
      case 3: must("delay " + direction() + " " + std::to_string(random_() % 250) + "ms"); break;
      case 4: must("drop " + direction() + " next " + std::to_string(1 + random_() % 60)); break;
      case 5:
      case 6: must("faults off"); break;
      case 7: must("stall " + std::to_string(random_() % 1500) + "ms"); break;
      case 8: must("reboot"); break;
      case 9: must("link silent"); break;
      case 10: must("link restore"); break;
      case 11: must("link cut"); break;
      case 12: take_over(); break;
      case 13: must("pendant return"); break;
      case 14: must(pick({"door open", "door close"})); break;
      case 15: must(pick({"hold", "start"})); break;
      case 16:
        world_.inject_to_controller(pick({"G91G1X-30F1500\n", "$J=G91Y20F1000\n", "G91G0X", "!", "~", "\x18"}));
        break;
      case 17:
        world_.inject_to_session(pick({"\xFFnoise\r\n", "ok\r\n", "<Idl", "rst:0x1 (POWERON_RESET)\r\n"}));
        break;
      case 18: command(); break;
      case 19: command(); break;
      case 20:
      case 21:
        must("faults off");
        must("link restore");
        break;
      case 22:
      case 23: somebody_else_moves_it(); break;
      case 24: insist(); break;
      default: world_.submit(session::StartJob{program(zigzag(6))}); break;
    }
    if (world_.session().phase() == SessionPhase::Closed && chance(2)) {
      must("link restore");
      world_.open();
    }
  }

  void command() {
    switch (random_() % 9) {
      case 0: world_.submit(session::HoldJob{}); break;
      case 1: world_.submit(session::ResumeJob{}); break;
      case 2: world_.submit(session::StopJob{}); break;
      case 3: world_.submit(session::SoftReset{}); break;
      case 4: world_.submit(session::Unlock{}); break;
      case 5: world_.submit(session::Jog{"G91X25F1500"}); break;
      case 6: world_.submit(session::CancelJog{}); break;
      default: world_.submit(session::SendLine{pick({"G91G1X10F1000", "$G", "G4P1", "M3S500"})}); break;
    }
  }

  void somebody_else_moves_it() {
    world_.inject_to_controller("$X\n");
    world_.inject_to_controller(pick({"G91G1X40F1200\n", "$J=G91Y-30F1000\n", "G91G1X20F900\nG4P1\nX-20\n"}));
  }

  /// The operator does not give up, whatever the machine does.
  void insist() {
    world_.run_for(2s);
    if (chance(2)) somebody_else_moves_it();
    for (int times = 0; times < 12; ++times) {
      world_.run_for(300ms);
      command();
    }
  }

  void take_over() {
    must("pendant take");
    must("pendant say $J=G91X40F1000\\n");
  }

  void must(const std::string& line) { EXPECT_TRUE(world_.order(line)) << line; }
  bool chance(unsigned one_in) { return random_() % one_in == 0; }
  template <class Value>
  Value pick(std::initializer_list<Value> values) {
    return *(values.begin() + random_() % values.size());
  }
  std::string direction() { return pick({"to", "from", "both"}); }

  std::mt19937 random_;
  World world_;
  std::size_t foreign_moves_ = 0;
};

class RandomFaults : public testing::TestWithParam<Firmware> {};
INSTANTIATE_TEST_SUITE_P(Firmwares, RandomFaults, testing::ValuesIn(kFirmwares),
                         [](const auto& param) { return word_for(param.param); });

TEST_P(RandomFaults, NoLineGoesToAMachineInForeignMotion) {
  std::size_t foreign_moves = 0;
  for (unsigned seed = 1; seed <= kSeeds; ++seed) {
    SCOPED_TRACE(seed);
    Chaos chaos{GetParam(), seed};
    chaos.run();
    foreign_moves += chaos.foreign_moves();
  }
  // Else the promise would be cheap.
  EXPECT_GT(foreign_moves, kSeeds);
}

TEST_P(RandomFaults, TheSameSeedGivesTheSameBytes) {
  for (unsigned seed = 101; seed <= 104; ++seed)
    EXPECT_EQ(Chaos(GetParam(), seed).run(), Chaos(GetParam(), seed).run());
}

}  // namespace
}  // namespace kerf::scenarios
