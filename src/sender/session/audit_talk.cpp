#include "sender/session/audit_talk.hpp"

#include <variant>

#include "common/base/overloaded.hpp"

namespace kerf::session {
namespace {

bool is_written(const SettingsResult& result) {
  return result.outcome == SettingsOutcome::Done || result.outcome == SettingsOutcome::Unchanged;
}

}  // namespace

void tell_audit(job::PositionAudit& audit, Instant now, const Event& event, const machine::Snapshot& snapshot) {
  std::visit(base::Overloaded{
                 [&](const StatusReported&) { audit.on_report(now, snapshot); },
                 [&](const LineReceived& line) {
                   const bool is_ok = std::holds_alternative<protocol::Ok>(line.message);
                   if (is_ok && line.answers && line.answers->purpose == streaming::Purpose::Operator) audit.on_ok();
                 },
                 [&](const LineRefused& refused) {
                   if (refused.purpose == streaming::Purpose::Operator) {
                     audit.on_fault(now, refused.explanation.headline);
                   }
                 },
                 [&](const CommandRefused& refused) { audit.on_fault(now, refused.sentence); },
                 [&](const AlarmRaised& alarm) { audit.on_fault(now, alarm.explanation.headline); },
                 [&](const ControllerRestarted&) {
                   audit.on_fault(now, "The controller restarted in the middle of the audit.");
                 },
                 [&](const PendantTookOver& pendant) { audit.on_fault(now, pendant.sentence); },
                 [&](const SettingsChanged& changed) {
                   audit.on_settings(now, is_written(changed.result), changed.result.sentence);
                 },
                 [](const auto&) {},
             },
             event);
}

std::optional<Command> command_of(const job::AuditOrder& order) {
  using Ordered = std::optional<Command>;
  return std::visit(base::Overloaded{
                        [](const job::AuditJog& jog) -> Ordered { return Jog{jog.words}; },
                        [](const job::AuditCancelJog&) -> Ordered { return CancelJog{}; },
                        [](const job::AuditHome&) -> Ordered { return Home{}; },
                        [](const job::AuditReset&) -> Ordered { return SoftReset{}; },
                        [](const job::AuditChangeSettings& change) -> Ordered {
                          return ChangeSettings{.settings = change.settings, .reason = "audit"};
                        },
                        [](const job::AuditNote&) -> Ordered { return std::nullopt; },
                    },
                    order);
}

}  // namespace kerf::session
