#pragma once
// Which line goes next, and whether there is room for it.

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/base/time.hpp"
#include "sender/streaming/flow_policy.hpp"
#include "sender/streaming/ledger.hpp"
#include "sender/streaming/line_source.hpp"
#include "sender/streaming/solo_lines.hpp"

namespace kerf::streaming {

/// Feeds one controller by character counting: the bytes of all unanswered lines never exceed the window, except for
/// one line that is longer than the window and travels alone. Lines of a source (the job) and single lines (by hand,
/// questions) share the ledger; single lines go first. It decides nothing else: errors, holds and resets are told to
/// it.
class Streamer {
 public:
  /// Bytes that may be unanswered, and which lines travel alone.
  void configure(std::size_t window_bytes, SoloPolicy policy);
  [[nodiscard]] std::size_t window() const { return window_; }

  /// Puts one line into the queue.
  void enqueue(Purpose purpose, std::string text);
  /// Starts to feed from `source`, and keeps it until it is exhausted or the feeding is stopped.
  void feed_from(std::unique_ptr<LineSource> source);
  /// No more lines from the source.
  void stop_feeding();
  /// While held the source keeps its next line.
  void hold_feeding(bool held) { feeding_held_ = held; }
  /// While waiting the source gives no line, and is not exhausted either.
  void let_source_wait(bool waits) { source_waits_ = waits; }
  /// How the source is fed; single lines are not meant.
  void feed_by(FlowPolicy flow) { flow_ = flow; }
  /// Forgets single lines that have not been sent.
  void drop_queued(Purpose purpose);
  /// While paused no line leaves at all.
  void pause(bool paused) { paused_ = paused; }

  /// Appends to `out` everything there is room for; gives the lines that went.
  std::vector<OwedLine> pump(Instant now, std::string& out);
  /// Sends one line past the queue and beside the window: only to a controller that has read everything before.
  OwedLine interject(Instant now, std::string& out, Purpose purpose, std::string text);
  /// The answer to the oldest line has come.
  [[nodiscard]] std::optional<OwedLine> settle();
  /// No answers will come for what is on its way (protocol.md 4.4). Lines in the queue stay there.
  [[nodiscard]] std::vector<OwedLine> strike_out();
  [[nodiscard]] std::vector<OwedLine> strike_out_before(Purpose purpose) { return ledger_.strike_out_before(purpose); }

  [[nodiscard]] const Ledger& ledger() const { return ledger_; }
  /// The source has no line to give, now or at all.
  [[nodiscard]] bool source_exhausted();
  /// Nothing is queued, fed or unanswered.
  [[nodiscard]] bool is_idle() const { return queue_.empty() && !source_ && ledger_.empty(); }
  /// Nothing of `purpose` is queued or unanswered.
  [[nodiscard]] bool done_with(Purpose purpose) const;

 private:
  struct Queued {
    Purpose purpose;
    std::string text;
  };

  [[nodiscard]] bool has_room_for(std::string_view text) const;
  OwedLine send(Instant now, std::string& out, OwedLine line);

  Ledger ledger_;
  std::size_t window_ = 1;
  SoloPolicy policy_ = SoloPolicy::EveryLine;
  std::deque<Queued> queue_;
  std::unique_ptr<LineSource> source_;
  bool solo_under_way_ = false;
  bool paused_ = false;
  bool feeding_held_ = false;
  bool source_waits_ = false;
  FlowPolicy flow_ = FlowPolicy::CharacterCounting;
};

}  // namespace kerf::streaming
