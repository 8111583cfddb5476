#include "simulation/campaign_case.hpp"

#include <algorithm>
#include <chrono>

#include <boost/describe/enum_to_string.hpp>

#include "common/base/text.hpp"
#include "simulation/dice.hpp"
#include "simulation/milling_job.hpp"

namespace kerf::simulation {
namespace {

using namespace std::chrono_literals;
using vocabulary::Firmware;

constexpr double kSwitchAwayMm = 8;

firmware::StoredState machine_memory(Dice& dice, bool homes) {
  firmware::StoredState stored;
  stored.initialised = true;
  auto& settings = stored.settings;
  for (const std::string axis : {"0", "1", "2"}) {
    settings["10" + axis] = "250.000";
    settings["11" + axis] = "5000.000";
    settings["12" + axis] = dice.one_in(2) ? "500.000" : "200.000";
    settings["13" + axis] = "200.000";
  }
  settings["23"] = "0";
  std::vector<double> zero{30, 20, -15};
  if (homes) {
    settings["22"] = "1";
    settings["24"] = "200.000";
    settings["25"] = "3000.000";
    settings["26"] = "25";
    settings["27"] = "1.000";
    settings["20"] = dice.one_in(2) ? "1" : "0";
    zero = {-80, -70, -40};
  }
  stored.offsets["G54"] = zero;
  stored.offsets["G55"] = {zero[0] + kSecondZeroMm[0], zero[1] + kSecondZeroMm[1], zero[2] + kSecondZeroMm[2]};
  return stored;
}

WorldOptions world_of(Dice& dice, CampaignCase& made_up) {
  const auto firmware = dice.pick({Firmware::Grbl, Firmware::Rabbit, Firmware::GrblHal});
  made_up.link = dice.pick({LinkKind::Serial, LinkKind::Usb, LinkKind::Network});
  WorldOptions options;
  switch (made_up.link) {
    case LinkKind::Serial: options = serial_world(firmware, 115200); break;
    case LinkKind::Usb:
      options = network_world(firmware, 200us);
      options.session.link.network = false;
      break;
    case LinkKind::Network: options = network_world(firmware, dice.pick({1ms, 5ms, 15ms, 60ms})); break;
  }
  options.opening_resets = made_up.link == LinkKind::Serial && firmware == Firmware::Grbl && dice.one_in(2);
  options.head_start = dice.pick<Duration>({0s, 1s, 20s});
  options.keeps_transcript = false;
  options.keeps_wire_log = false;
  return options;
}

std::string bytes_order(Dice& dice, std::string_view kind) {
  std::string order = std::string{kind} + dice.pick({" to", " to", " from"});
  if (dice.one_in(3)) return order + dice.pick({" rate 0.002", " rate 0.01", " rate 0.05"});
  return order + " next " + std::to_string(dice.pick({1, 1, 1, 2, 5, 30}));
}

Fault fault(Dice& dice) {
  Fault made_up{.kind = static_cast<FaultKind>(dice.below(kFaultKinds)),
                .at_share = dice.within(-0.02, 1.1),
                .lasts = dice.one_in(3) ? dice.up_to(8s) : dice.up_to(1s)};
  switch (made_up.kind) {
    case FaultKind::LinkCut: made_up.order = "link cut"; break;
    case FaultKind::LinkSilent: made_up.order = "link silent"; break;
    case FaultKind::Reset: made_up.order = "reset"; break;
    case FaultKind::PowerLoss: made_up.order = "power off"; break;
    case FaultKind::Stall: made_up.order = "stall " + std::to_string(made_up.lasts / 1ms + 1) + "ms"; break;
    case FaultKind::BytesLost: made_up.order = bytes_order(dice, "drop"); break;
    case FaultKind::BytesDoubled: made_up.order = bytes_order(dice, "duplicate"); break;
    case FaultKind::BytesCorrupted: made_up.order = bytes_order(dice, "corrupt"); break;
    case FaultKind::HoldButton: made_up.order = "hold"; break;
    case FaultKind::Door: made_up.order = "door open"; break;
    default: break;
  }
  return made_up;
}

}  // namespace

std::string_view name_of(FaultKind kind) {
  return boost::describe::enum_to_string(kind, "?");
}

CampaignCase campaign_case(std::uint64_t seed) {
  Dice dice{seed};
  CampaignCase made_up{.seed = seed, .homes = !dice.one_in(4)};
  made_up.world = world_of(dice, made_up);
  made_up.world.stored = machine_memory(dice, made_up.homes);
  if (made_up.homes) {
    for (const auto axis : {vocabulary::Axis::X, vocabulary::Axis::Y, vocabulary::Axis::Z}) {
      made_up.workcell.emplace_back(firmware::HomingSwitchMoved{.axis = axis, .distance_mm = kSwitchAwayMm});
    }
  }
  const std::size_t lines = dice.one_in(10) ? 300 : 20 + dice.below(90);
  made_up.program = milling_job(dice, features_of(made_up.world.firmware), lines);
  for (int faults = dice.pick({0, 1, 1, 1, 2, 2, 3, 5}); faults > 0; --faults) made_up.faults.push_back(fault(dice));
  Dice disk{seed ^ 0xD15C0F0FD15C0F0FU};
  if (disk.one_in(8)) {
    made_up.faults.push_back(
        {.kind = FaultKind::DiskFull, .at_share = disk.within(-0.02, 1.0), .lasts = disk.up_to(30s)});
  }
  std::ranges::sort(made_up.faults, {}, &Fault::at_share);
  return made_up;
}

std::string describe(const CampaignCase& made_up) {
  std::string text = "seed " + std::to_string(made_up.seed) + ": " +
                     boost::describe::enum_to_string(made_up.world.firmware, "?") + ", " +
                     boost::describe::enum_to_string(made_up.link, "?") + (made_up.homes ? ", homed" : ", not homed");
  for (const Fault& strikes : made_up.faults) {
    text += "; " + std::string{name_of(strikes.kind)} + " at " + base::to_fixed(strikes.at_share * 100, 1) + " %";
    if (!strikes.order.empty()) text += " (" + strikes.order + ")";
    text += " for " + base::to_fixed(base::to_seconds(strikes.lasts), 2) + " s";
  }
  return text;
}

}  // namespace kerf::simulation
