#include "simulation/talk_runner.hpp"

#include <algorithm>
#include <memory>

#include "firmware/personality.hpp"
#include "firmware/virtual_controller.hpp"

namespace kerf::simulation {
namespace {

/// More turns than any controller needs at one instant.
constexpr int kMostTurnsAtOnce = 100'000;

/// Carries bytes and events both ways until neither side has more to say now.
bool deliver(Instant now, TalkConversation& conversation, firmware::VirtualController& controller) {
  const std::string heard = controller.take_outbox();
  if (!heard.empty()) conversation.on_bytes(now, heard);
  const std::string heard_on_pendant = controller.take_pendant_outbox();
  if (!heard_on_pendant.empty()) conversation.on_pendant_bytes(now, heard_on_pendant);
  conversation.advance_to(now);
  const TalkOutbox said = conversation.take_outbox();
  for (const auto& event : said.events) controller.submit(now, event);
  if (!said.bytes.empty()) controller.on_bytes(now, said.bytes);
  if (!said.pendant_bytes.empty()) controller.on_pendant_bytes(now, said.pendant_bytes);
  return !heard.empty() || !heard_on_pendant.empty() || !said.is_empty();
}

firmware::Equipment equipment_of(const Talk& talk) {
  firmware::Equipment equipment = {.pendant = talk.has_pendant};
  if (!talk.has_card) return equipment;
  const auto card = std::make_shared<firmware::MemoryCard>();
  for (const auto& file : talk.card_files) card->put(file.path, file.contents);
  equipment.card = card;
  return equipment;
}

}  // namespace

TalkOutcome run_talk(const Talk& talk) {
  const Instant began{};
  Instant now = began;
  const firmware::Personality built = firmware::built_with(*talk.personality, talk.hardware);
  firmware::VirtualController controller(built, {}, equipment_of(talk));
  TalkConversation conversation(talk, now);
  // A talk begins with all switches off and places the homing switches that it needs.
  for (std::size_t axis = 0; axis < vocabulary::kMaxAxes; ++axis) {
    controller.submit(
        now, firmware::HomingSwitchMoved{.axis = static_cast<vocabulary::Axis>(axis), .distance_mm = std::nullopt});
  }
  controller.power_on(now);
  int turns = 0;
  while (!conversation.is_finished()) {
    if (!deliver(now, conversation, controller)) {
      const Instant next = std::max(now, std::min(controller.next_deadline(), conversation.next_deadline()));
      if (next == kNever) break;
      if (next > now) turns = 0;
      now = next;
      controller.advance_to(now);
    }
    if (++turns > kMostTurnsAtOnce) break;
  }
  TalkOutcome outcome{
      .failure = conversation.failure(), .record = conversation.record(), .virtual_s = base::to_seconds(now - began)};
  if (!conversation.is_finished()) outcome.failure = TalkFailure{.line = 0, .step = "", .what = "time stands still"};
  return outcome;
}

}  // namespace kerf::simulation
