#include "sender/session/override_pursuit.hpp"

#include <cstdlib>

namespace kerf::session {
namespace {

using vocabulary::Realtime;

/// A change is told within so many reports (Grbl: with the next one that has no `WCO:`).
constexpr int kPatience = 3;
/// A controller that does not follow is left alone.
constexpr int kMostVainSteps = 8;
constexpr int kCoarse = 10;
constexpr int kLeast = 10;
constexpr int kMost = 200;

struct StepBytes {
  Realtime reset, coarse_plus, coarse_minus, fine_plus, fine_minus;
};
constexpr StepBytes kFeed{Realtime::FeedOverrideReset, Realtime::FeedOverrideCoarsePlus,
                          Realtime::FeedOverrideCoarseMinus, Realtime::FeedOverrideFinePlus,
                          Realtime::FeedOverrideFineMinus};
constexpr StepBytes kSpindle{Realtime::SpindleOverrideReset, Realtime::SpindleOverrideCoarsePlus,
                             Realtime::SpindleOverrideCoarseMinus, Realtime::SpindleOverrideFinePlus,
                             Realtime::SpindleOverrideFineMinus};

void append(std::string& bytes, Realtime byte) {
  bytes += static_cast<char>(byte);
}

void append_step(std::string& bytes, const StepBytes& kind, int is, int wanted) {
  if (is == wanted) return;
  if (wanted == 100) return append(bytes, kind.reset);
  const int by = wanted - is;
  if (std::abs(by) >= kCoarse) append(bytes, by > 0 ? kind.coarse_plus : kind.coarse_minus);
  if (by % kCoarse != 0) append(bytes, by > 0 ? kind.fine_plus : kind.fine_minus);
}

void append_rapid(std::string& bytes, int is, int wanted) {
  if (is == wanted) return;
  append(bytes, wanted == 100  ? Realtime::RapidOverrideReset
                : wanted == 50 ? Realtime::RapidOverrideMedium
                               : Realtime::RapidOverrideLow);
}

bool is_out_of_range(std::optional<int> percent) {
  return percent && (*percent < kLeast || *percent > kMost);
}

}  // namespace

std::string OverridePursuit::why_not(const OverrideWish& wish) {
  if (is_out_of_range(wish.feed) || is_out_of_range(wish.spindle)) {
    return "Feed and spindle can be overridden from 10 to 200 %.";
  }
  if (wish.rapid && *wish.rapid != 100 && *wish.rapid != 50 && *wish.rapid != 25) {
    return "Rapids can be overridden to 100, 50 or 25 %.";
  }
  return {};
}

void OverridePursuit::aim_at(const OverrideWish& wish) {
  if (wish.feed) wish_.feed = wish.feed;
  if (wish.rapid) wish_.rapid = wish.rapid;
  if (wish.spindle) wish_.spindle = wish.spindle;
  reports_waited_ = kPatience;
  steps_without_effect_ = 0;
}

std::string OverridePursuit::on_report(const machine::Snapshot& snapshot) {
  if (is_over()) return {};
  const machine::OverridePercentages is = snapshot.overrides.value_or(machine::OverridePercentages{});
  if (is == told_ && ++reports_waited_ < kPatience) return {};
  steps_without_effect_ = is == told_ ? steps_without_effect_ + 1 : 0;
  told_ = is;
  reports_waited_ = 0;
  if (wish_.feed == is.feed) wish_.feed.reset();
  if (wish_.rapid == is.rapid) wish_.rapid.reset();
  if (wish_.spindle == is.spindle) wish_.spindle.reset();
  if (steps_without_effect_ > kMostVainSteps) wish_ = {};
  std::string bytes;
  if (wish_.feed) append_step(bytes, kFeed, is.feed, *wish_.feed);
  if (wish_.rapid) append_rapid(bytes, is.rapid, *wish_.rapid);
  if (wish_.spindle) append_step(bytes, kSpindle, is.spindle, *wish_.spindle);
  return bytes;
}

}  // namespace kerf::session
