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
// The operator of a campaign puts right what is broken, connects anew, homes where the machine can, confirms the
// position where it cannot and the machine really is where it says, and takes every plan to resume as it is. Where
// bytes on the way to the controller were lost, doubled or changed, the machine may have been told another program:
// there (d) and (e) are not asserted, only counted as `unjudged`.

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
