#pragma once
// What a session tells, without passwords: events go to screens, to JSON and to other programs.

#include "common/protocol/secrets.hpp"
#include "sender/session/event.hpp"

namespace kerf::session {

/// Stars in place of every password in the lines that `event` quotes.
void hide_passwords(Event& event, const protocol::Secrets& secrets);

}  // namespace kerf::session
