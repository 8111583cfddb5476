#pragma once
// How a PositionAudit and a session talk: what is told becomes what the audit has to know, and its orders become
// commands.

#include <optional>

#include "sender/job/position_audit.hpp"
#include "sender/machine/snapshot.hpp"
#include "sender/session/command.hpp"
#include "sender/session/event.hpp"

namespace kerf::session {

/// `snapshot` is the session's own.
void tell_audit(job::PositionAudit& audit, Instant now, const Event& event, const machine::Snapshot& snapshot);

/// Empty for what is only to be said.
[[nodiscard]] std::optional<Command> command_of(const job::AuditOrder& order);

}  // namespace kerf::session
