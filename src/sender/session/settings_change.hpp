#pragma once
// Changes settings of a machine at rest: one line at a time, each acknowledged and read back, and everything undone if
// one is refused. Sans I/O: told of reports, answers and values, it says what to send.

#include <cstddef>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <boost/describe.hpp>

#include "common/base/time.hpp"
#include "sender/machine/capabilities.hpp"
#include "sender/machine/settings_plan.hpp"
#include "sender/machine/snapshot.hpp"

namespace kerf::session {

/// How a change ended.
enum class SettingsOutcome {
  Done,            ///< all values are set and were read back
  Unchanged,       ///< all values were set already; nothing was sent
  Invalid,         ///< not sent: at least one value would not be taken
  RolledBack,      ///< the controller refused or altered one; the values from before are back
  RollbackFailed,  ///< as before, but not all values from before are back
  Interrupted,     ///< the machine was not at rest any more, restarted or went away
  Unanswered,      ///< a line stayed without an answer
  Held,            ///< the same, because the machine was held meanwhile: it answers when it goes on
};
BOOST_DESCRIBE_ENUM(SettingsOutcome, Done, Unchanged, Invalid, RolledBack, RollbackFailed, Interrupted, Unanswered,
                    Held)

/// What became of a change. `changed` is what the controller has now, as it was read back.
struct SettingsResult {
  SettingsOutcome outcome{};
  std::string reason{};
  std::string sentence{};
  std::vector<machine::SettingDifference> changed;
  /// Changed by the controller itself as a consequence.
  std::vector<machine::SettingDifference> also_changed;
  std::vector<machine::SettingRefusal> refused;
  /// Ids of what acts only after the controller was switched off and on.
  std::vector<std::string> reboot_required;
};
BOOST_DESCRIBE_STRUCT(SettingsResult, (), (outcome, reason, sentence, changed, also_changed, refused, reboot_required))

/// A `?`: the report that follows shows whether the machine is at rest.
struct AskForReport {};
/// One line, alone, of which the answer comes back through on_answer().
struct SendSettingLine {
  std::string text;
};
/// A value was written and read back, `step` of `steps`.
struct NoteSetting {
  machine::SettingDifference difference;
  std::size_t step = 0;
  std::size_t steps = 0;
};
using SettingsOrder = std::variant<AskForReport, SendSettingLine, NoteSetting>;

/// One change, from the plan to the result.
class SettingsChange {
 public:
  /// `machine` is what is known now; `plan` was made for it. `queries` list all settings ("$$", and "$+" of Rabbit).
  SettingsChange(Instant now, machine::Capabilities machine, machine::SettingsPlan plan,
                 std::vector<std::string> queries, bool reads_single_settings, std::string reason);

  void on_report(Instant now, const machine::Snapshot& snapshot);
  /// The answer to the line sent last; `meaning` explains an error.
  void on_answer(Instant now, int error_code, std::string_view meaning);
  /// `$110=500.000`; `id` as Capabilities has it.
  void on_value(std::string_view id, std::string_view value);
  /// A welcome, or the link is gone: no answer will come.
  void interrupt(std::string why);
  void advance_to(Instant now);

  [[nodiscard]] Instant next_deadline() const { return deadline_; }
  [[nodiscard]] std::vector<SettingsOrder> take_orders();
  [[nodiscard]] bool is_over() const { return phase_ == Phase::Over; }
  /// A line is out that makes the controller store something: nothing else may be sent (protocol.md 6.5).
  [[nodiscard]] bool is_storing() const { return phase_ == Phase::Writing; }
  [[nodiscard]] const SettingsResult& result() const { return result_; }

 private:
  enum class Phase { AwaitingRest, Writing, ReadingOne, ReadingAll, Over };

  void ask_for_rest(Instant now);
  void write(Instant now);
  void send(Instant now, Phase phase, std::string line);
  void go_on(Instant now);
  void next_step(Instant now);
  void read_all(Instant now);
  void judge(Instant now);
  void fail(Instant now, const machine::SettingDifference& step, std::string sentence);
  void end_forward(Instant now);
  void end_rollback(Instant now);
  void end_unanswered(const machine::Snapshot& snapshot);
  void finish(SettingsOutcome outcome, std::string sentence);
  [[nodiscard]] std::vector<machine::SettingDifference> changed_so_far() const;
  [[nodiscard]] std::vector<machine::SettingDifference> left_to_undo() const;
  [[nodiscard]] bool is_secret(std::string_view id) const;
  [[nodiscard]] machine::SettingDifference without_secret(machine::SettingDifference step) const;
  [[nodiscard]] std::string what_it_has(const machine::SettingDifference& step) const;
  [[nodiscard]] bool is_set(const machine::SettingDifference& step) const;
  [[nodiscard]] std::string value_of(std::string_view id) const;

  /// With the values as last read.
  machine::Capabilities machine_;
  std::vector<machine::SettingAssignment> initial_;
  std::vector<machine::SettingDifference> asked_;
  std::vector<machine::SettingDifference> steps_;
  std::size_t at_ = 0;
  std::vector<std::string> queries_;
  std::size_t query_ = 0;
  bool reads_single_;
  bool rolling_back_ = false;
  /// Firmware runs a startup line when it is written: what moves then has to end first.
  bool may_move_ = false;
  /// An answer is missing, and a report is to say why.
  bool asks_why_ = false;
  /// Values that another one pushed aside are written once more.
  bool second_pass_ = false;
  Phase phase_ = Phase::AwaitingRest;
  Instant deadline_ = kNever;
  std::vector<SettingsOrder> orders_;
  SettingsResult result_;
};

/// What a change that was not even begun has to say.
[[nodiscard]] SettingsResult invalid_settings(std::vector<machine::SettingRefusal> refusals, std::string reason);
[[nodiscard]] SettingsResult unchanged_settings(std::string reason);

/// "3 settings are not as they were on 2026-11-20 14:03: $110 (X-axis maximum rate): 500 -> 600 mm/min; …"
[[nodiscard]] std::string drift_sentence(const std::vector<machine::SettingDifference>& differences,
                                         std::string_view since);

}  // namespace kerf::session
