#pragma once
// Hold, standstill, reset: the one way to stop a machine on every firmware and keep its position.

#include <vector>

#include <boost/describe.hpp>

#include "common/base/time.hpp"
#include "sender/machine/snapshot.hpp"

namespace kerf::job {

enum class StopOrder { FeedHold, SoftReset };
BOOST_DESCRIBE_ENUM(StopOrder, FeedHold, SoftReset)

/// Stops what moves. A hold that shows no effect is repeated; a machine that does not come to rest, or does not report,
/// is reset all the same, and its position is suspect then. A reset in motion would raise ALARM:3 and lose the position
/// (protocol.md 10, row 15); grblHAL's 0x19 would do the three steps in one, but only there.
class StopSequence {
 public:
  /// `deaf_until`: reports before that may be about a hold that has ended since.
  void begin(Instant now, bool rests, Instant deaf_until = {});
  /// Reset at once, whatever moves.
  void reset_now(Instant now);
  void on_snapshot(Instant now, const machine::Snapshot& snapshot);
  /// The reset has been confirmed, or nobody can confirm it any more.
  void end() { *this = {}; }
  void advance_to(Instant now);
  [[nodiscard]] Instant next_deadline() const { return deadline_; }
  [[nodiscard]] std::vector<StopOrder> take_orders();

  [[nodiscard]] bool is_under_way() const { return stage_ != Stage::None; }
  /// The reset went out and no welcome came.
  [[nodiscard]] bool is_unconfirmed() const { return stage_ == Stage::Unconfirmed; }
  /// It was reset before it was seen at rest.
  [[nodiscard]] bool position_suspect() const { return position_suspect_; }

 private:
  enum class Stage { None, Braking, Resetting, Unconfirmed };

  void order_hold(Instant now);
  void reset(Instant now);

  Stage stage_ = Stage::None;
  bool position_suspect_ = false;
  Instant asked_at_{};
  Instant reported_at_{};
  Instant deaf_until_{};
  Instant deadline_ = kNever;
  std::vector<StopOrder> orders_;
};

}  // namespace kerf::job
