#pragma once
// One run of a campaign, judged by observers at the motors and at the wire.
//
// What is asserted in every run, whatever strikes it:
//   (a) bytes in flight, counted at the wire, never exceed the window (WireWatch);
//   (b) no line is answered twice or out of order, and no more lines are answered than answers came (WireWatch);
//       and the ledger adds up: entered = answered + struck out + owed;
//   (c) nothing that may start motion leaves before a command is given to a new connection or a new start of the
//       controller (WireWatch), no motor turns after a start before such a thing has left (CutterWatch), and no line
//       goes to a machine in motion that Kerf did not start (LineWatch);
//   (d) no rapid goes through uncut stock, and no tool that does not turn is fed into it (CutterWatch);
//   (e) a job that is said to be finished, in one piece or resumed from the journal as often as it was interrupted, has
//       cut what the undisturbed job cuts, nothing is missing and nothing is in excess (Stock); one that ended
//       otherwise has cut nothing that the undisturbed job does not cut;
//   (f) every job comes to an end.
//   (g) the machine keeps to the path of the job unless bytes on their way to it were lost, doubled or changed, or the
//       link was silent for a while; then a machine that is off its path is held within one report (DepartureWatch);
//   (h) a full disk of the journal changes nothing for the job.
// The operator of a campaign puts right what is broken, connects anew, homes where the machine can, confirms the
// position where it cannot and the machine really is where it says, and takes every plan to resume as it is. He stops a
// job that is held off its path, and goes on after lost answers only where Kerf says that it is safe. What a machine
// that was told another program has cut until it was held is bounded by (g): (e) is not asserted there; such runs
// are counted as `unjudged`. Where bytes were changed and the machine keeps to its path all the same, excess is judged;
// (d) and what is missing are only counted (`cut_amiss`).

#include <cstdint>
#include <string>
#include <vector>

#include <boost/describe.hpp>

#include "common/base/time.hpp"
#include "simulation/campaign_case.hpp"

namespace kerf::simulation {

/// How a run ended.
enum class CampaignEnding : std::uint8_t {
  NeverStarted,  ///< the machine was never ready
  Finished,      ///< in one piece
  Resumed,       ///< finished after one interruption or more
  Refused,       ///< there was no plan to resume, with a reason
  NotReady,      ///< the machine was not ready to be resumed
  NotInJournal,  ///< Kerf was killed before the job stood in the journal
  TooOften,      ///< interrupted more often than an operator bears
};
BOOST_DESCRIBE_ENUM(CampaignEnding, NeverStarted, Finished, Resumed, Refused, NotReady, NotInJournal, TooOften)

struct CampaignVerdict {
  CampaignEnding ending{};
  /// Those of the faults that struck before the end.
  std::vector<FaultKind> struck;
  /// Why there was no plan to resume.
  std::string refusal;
  int resumes = 0;
  /// The cut was not judged.
  bool unjudged = false;
  /// Changed bytes, on the path of the job: a rapid through uncut stock, a tool that stands still was fed into it, or
  /// something was left uncut.
  bool cut_amiss = false;
  /// The machine was off its path while the job ran.
  bool left_path = false;
  /// On the machine's clock.
  Duration took{};
  /// What must not be; empty for a good run.
  std::vector<std::string> complaints;
  /// What was said and done, if it was asked for.
  std::string transcript;
};

/// `most_resumes`: the operator gives up after so many.
[[nodiscard]] CampaignVerdict judge(CampaignCase made_up, int most_resumes, bool keep_transcript = false);

}  // namespace kerf::simulation
