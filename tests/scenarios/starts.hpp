#pragma once
// What the scenarios of connecting share: machines found in every condition, and what the handshake made of them.

#include <string>
#include <string_view>
#include <vector>

#include "scenario.hpp"

namespace kerf::scenarios {

inline bool is_waiting(const simulation::World& world) {
  return world.session().phase() == session::SessionPhase::Waiting;
}

inline bool has_failed(const simulation::World& world) {
  return world.session().phase() == session::SessionPhase::Failed;
}

inline std::size_t resets_sent(const simulation::World& world) {
  std::size_t resets = 0;
  for (const auto& entry : world.transcript()) {
    if (entry.direction == Direction::ToController) {
      resets += static_cast<std::size_t>(std::ranges::count(entry.bytes, '\x18'));
    }
  }
  return resets;
}

/// The stages that the handshake went through, in order.
inline std::vector<machine::HandshakeStage> path(const simulation::World& world) {
  std::vector<machine::HandshakeStage> stages;
  for (const auto& moved : told<session::HandshakeMoved>(world)) stages.push_back(moved.change.to);
  return stages;
}

/// The sentence in which a start ended: what was found, what it waits for, or why it failed.
inline std::string outcome(const simulation::World& world) {
  std::string sentence;
  for (const auto& event : world.events()) {
    if (const auto* found = std::get_if<session::ControllerFound>(&event)) sentence = found->sentence;
    if (const auto* busy = std::get_if<session::ControllerBusy>(&event)) sentence = busy->sentence;
    if (const auto* failed = std::get_if<session::HandshakeFailed>(&event)) sentence = failed->sentence;
  }
  return sentence;
}

/// What another sender did before Kerf came: its lines, and some time for them.
inline void before_kerf(World& world, std::string_view bytes, Duration time = std::chrono::seconds{1}) {
  world.inject_to_controller(bytes);
  world.run_for(time);
}

}  // namespace kerf::scenarios
