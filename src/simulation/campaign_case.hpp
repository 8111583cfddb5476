#pragma once
// One run of a campaign as the dice made it up: a machine, a link, a milling job, and what strikes it when.

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <boost/describe.hpp>

#include "common/base/time.hpp"
#include "firmware/workcell.hpp"
#include "simulation/world.hpp"

namespace kerf::simulation {

/// What may happen to a job.
enum class FaultKind : std::uint8_t {
  Kill,            ///< Kerf is killed; the journal loses what was not yet written
  LinkCut,         ///< the cable is pulled, and both ends know
  LinkSilent,      ///< the cable is pulled, and nobody is told
  Reset,           ///< somebody presses the reset button of the controller
  PowerLoss,       ///< the controller loses power
  Stall,           ///< the controller's main loop stands still
  BytesLost,       ///< bytes vanish
  BytesDoubled,    ///< bytes arrive twice
  BytesCorrupted,  ///< one bit of a byte flips
  Hold,            ///< the operator holds and resumes
  HoldButton,      ///< somebody presses the hold button of the controller
  Override,        ///< the operator turns feed and rapid overrides
  Door,            ///< the door opens and closes
  Stop,            ///< the operator stops the job, position kept
  Abort,           ///< the operator aborts it
  DiskFull,        ///< the disk of the journal has no room; beside the others, so that their dice stay the same
};
/// Those that the dice of a fault choose among.
inline constexpr std::size_t kFaultKinds = 15;
BOOST_DESCRIBE_ENUM(FaultKind, Kill, LinkCut, LinkSilent, Reset, PowerLoss, Stall, BytesLost, BytesDoubled,
                    BytesCorrupted, Hold, HoldButton, Override, Door, Stop, Abort, DiskFull)

[[nodiscard]] std::string_view name_of(FaultKind kind);
[[nodiscard]] constexpr bool changes_bytes(FaultKind kind) {
  return kind == FaultKind::BytesLost || kind == FaultKind::BytesDoubled || kind == FaultKind::BytesCorrupted;
}

/// Something happens to a job.
struct Fault {
  FaultKind kind{};
  /// When: as a share of the time that the undisturbed job takes, counted from its start.
  double at_share = 0;
  /// How long it lasts, or how long until somebody puts it right.
  Duration lasts{};
  /// What the rig is ordered to do; empty where it has no part in it.
  std::string order{};
};

enum class LinkKind : std::uint8_t { Serial, Usb, Network };
BOOST_DESCRIBE_ENUM(LinkKind, Serial, Usb, Network)

/// Everything about a run follows from its seed.
struct CampaignCase {
  std::uint64_t seed = 0;
  LinkKind link{};
  bool homes = false;
  WorldOptions world{};
  std::vector<firmware::WorkcellEvent> workcell{};
  std::string program{};
  /// In the order in which they strike.
  std::vector<Fault> faults{};
};

inline constexpr double kCampaignStepsPerMm = 250;

[[nodiscard]] CampaignCase campaign_case(std::uint64_t seed);
/// A few lines for people.
[[nodiscard]] std::string describe(const CampaignCase& made_up);

}  // namespace kerf::simulation
