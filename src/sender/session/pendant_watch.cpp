#include "sender/session/pendant_watch.hpp"

#include <chrono>
#include <utility>

namespace kerf::session {
namespace {

/// The report that tells the hand-over comes after 5 ms; a link may be slow.
constexpr Duration kPatience = std::chrono::milliseconds{1500};

}  // namespace

ControlChange PendantWatch::on_report(bool pendant_in_control) {
  if (pendant_in_control == pendant_) return ControlChange::None;
  pendant_ = pendant_in_control;
  give_up_at_ = kNever;
  return pendant_ ? ControlChange::TakenByPendant : ControlChange::GivenBack;
}

void PendantWatch::on_asked_back(Instant now) {
  give_up_at_ = now + kPatience;
}

bool PendantWatch::take_failure(Instant now) {
  if (now < give_up_at_) return false;
  give_up_at_ = kNever;
  return true;
}

void PendantWatch::forget() {
  *this = {};
}

std::string not_given_back_sentence(bool is_network) {
  const std::string sentence = "The controller does not listen to this link while the pendant has it: ";
  return sentence + (is_network ? "release it at the pendant, or disconnect and connect again, as a new network "
                                  "client gets control."
                                : "release it at the pendant.");
}

}  // namespace kerf::session
