#include "sender/machine/handshake_sentences.hpp"

#include "common/vocabulary/machine_state.hpp"
#include "sender/machine/baud_guess.hpp"
#include "sender/machine/capability_collector.hpp"

namespace kerf::machine {
namespace {

using vocabulary::MachineState;

/// One byte on an opening line is a glitch, not a word.
constexpr std::size_t kFewestBytes = 4;

std::string state_word(const Snapshot& snapshot) {
  std::string word{vocabulary::name_of(snapshot.state)};
  if (snapshot.substate) word += ":" + std::to_string(*snapshot.substate);
  return word;
}

std::string alarm_words(const Snapshot& snapshot, const CodeFact& alarm) {
  // grblHAL shows the input as a pin; no other cause needs a hand first (protocol.md 3.3).
  if (snapshot.pins.contains('E')) return "its E-stop is pressed: release it, then reset";
  const std::string code = snapshot.alarm_code ? " " + std::to_string(*snapshot.alarm_code) : "";
  if (snapshot.reset_required) {
    return "it is in alarm" + code + " (" + alarm.title + "): find the cause, then reset it";
  }
  if (code.empty()) return "it is locked by an alarm: home or unlock it";
  return "it is in alarm" + code + " (" + alarm.title + "): home or unlock it";
}

std::string state_words(const Snapshot& snapshot, const CodeFact& alarm) {
  switch (snapshot.state) {
    case MachineState::Idle: return "it is idle";
    case MachineState::Alarm: return alarm_words(snapshot, alarm);
    case MachineState::Check: return "check mode is on, so nothing will move: $C ends it";
    default: return "its state is " + state_word(snapshot);
  }
}

std::string rate_words(std::optional<int> baud) {
  return baud ? " at " + std::to_string(*baud) + " baud" : "";
}

}  // namespace

std::string busy_sentence(const Snapshot& snapshot) {
  if (!snapshot.controller_file.empty()) {
    return "The controller is running a file of its own (" + snapshot.controller_file +
           "); waiting until it has finished.";
  }
  const std::string state = state_word(snapshot);
  switch (snapshot.state) {
    case MachineState::Door:
      return "The safety door is open or the machine waits behind it (" + state + "); close it and resume, or reset.";
    case MachineState::Hold:
      return "The machine is in feed hold (" + state + "), which Kerf did not start; resume or reset it.";
    case MachineState::Tool:
      return "The controller waits for a tool change that Kerf did not start; finish it or reset.";
    case MachineState::Sleep: return "The controller sleeps; only a reset wakes it.";
    case MachineState::Alarm: return "The machine is in alarm and reads no line; find the cause, then reset it.";
    case MachineState::Unknown:
      return "The controller reports a state that Kerf does not know; waiting until it is one that Kerf knows.";
    default: return "The machine is moving (" + state + ") and Kerf did not start it; waiting until it stands still.";
  }
}

std::string pendant_sentence() {
  return "A pendant has the machine; Kerf only watches until it is released.";
}

std::string found_sentence(const Capabilities& capabilities, const Snapshot& snapshot, const CodeFact& alarm) {
  return summary_of(capabilities) + "; " + state_words(snapshot, alarm) + ".";
}

Verdict verdict_on(const StrangerRow& stranger, std::string_view line) {
  return {.failure = stranger.failure,
          .sentence = "On this link is " + std::string{stranger.who} + "; it said \"" + excerpt_of(line) + "\". " +
                      std::string{stranger.advice}};
}

Verdict verdict_on(const Overheard& overheard, std::string_view sent, std::optional<int> baud) {
  if (overheard.count() < kFewestBytes) {
    return {
        .failure = HandshakeFailure::Silent,
        .sentence =
            "Nothing answers on this link: check that the controller is powered and not waiting for a firmware, and "
            "that port "
            "and baud rate are right; one that homes or that a pendant has answers afterwards, and one in a hard-limit "
            "alarm only after a reset."};
  }
  if (const auto* row = find_stranger(overheard.text())) return verdict_on(*row, overheard.text());
  if (overheard.is_echo_of(sent)) {
    return {.failure = HandshakeFailure::NotGrbl,
            .sentence =
                "This link only sends back what it is sent: a modem, or a cable whose ends are joined. Choose "
                "another port."};
  }
  if (!overheard.is_noise()) {
    return {.failure = HandshakeFailure::NotGrbl,
            .sentence = "What answers on this link is no Grbl controller; it sent \"" + overheard.excerpt() +
                        "\". Choose another port."};
  }
  std::string sentence = "Only noise comes on this link" + rate_words(baud) + " (\"" + overheard.excerpt() + "\"): ";
  if (const auto rate = baud ? guess_baud(overheard.text(), *baud) : std::nullopt) {
    sentence += "it looks like " + std::to_string(*rate) + " baud; open the port with that rate.";
  } else {
    sentence += baud ? "choose another baud rate, or check cable and ground." : "check what is at the other end.";
  }
  return {.failure = HandshakeFailure::Noise, .sentence = std::move(sentence)};
}

Verdict fallen_silent() {
  return {.failure = HandshakeFailure::Silent,
          .sentence = "The controller answered first and has fallen silent: check its cable and power."};
}

Verdict too_old(std::string_view line) {
  return {.failure = HandshakeFailure::NotGrbl,
          .sentence = "This controller speaks an older language than Grbl 1.1; it said \"" + excerpt_of(line) +
                      "\". Put Grbl 1.1, Rabbit GRBL or grblHAL on it."};
}

std::string restarting_sentence() {
  return "The controller restarts again and again: check its power supply, its reset and E-stop inputs.";
}

std::string unanswered_sentence(const Snapshot& snapshot) {
  return "The controller reports its state (" + state_word(snapshot) +
         ") but answers no line: another program or a file may have it; reset it or try again.";
}

}  // namespace kerf::machine
