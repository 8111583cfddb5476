// What a job wants done, and how it learns that its lines are answered.

#include <string>
#include <string_view>
#include <utility>

#include "sender/session/session.hpp"

namespace kerf::session {
namespace {

using streaming::Purpose;
using vocabulary::Realtime;

/// Its answer proves that all motion has ended, because a dwell waits for the planner (protocol.md 6.5).
constexpr std::string_view kSyncLine = "G4P0";

}  // namespace

void Session::follow_job(Instant now) {
  if (!job_) return;
  // Before anybody looks whether there is a line left: it may just have been told to feed again.
  obey_job(now);
  if (has_job() && streamer_.source_exhausted() && streamer_.done_with(Purpose::JobLine)) {
    job_->on_lines_answered(now);
    obey_job(now);
  }
  const bool was_final = job_state_ && job::is_final(job_state_->phase);
  const bool phase_changed = job_state_ && job_state_->phase != job_->state().phase;
  job_state_ = job_->state();
  if (was_final || !phase_changed) return;
  if (has_job())
    tell(JobProgressed{*job_state_});
  else
    tell(JobEnded{*job_state_});
}

void Session::obey_job(Instant now) {
  for (const job::JobOrder order : job_->take_orders()) obey_job(now, order);
}

void Session::obey_job(Instant now, job::JobOrder order) {
  switch (order) {
    case job::JobOrder::StopFeeding:
      streamer_.stop_feeding();
      streamer_.drop_queued(Purpose::JobSync);
      return;
    case job::JobOrder::HoldFeeding: streamer_.hold_feeding(true); return;
    case job::JobOrder::FeedAgain: streamer_.feed_from(feed_->lines_from(job_->goes_on_at())); return;
    case job::JobOrder::SendSync: streamer_.enqueue(Purpose::JobSync, std::string{kSyncLine}); return;
    case job::JobOrder::ClearLatch: streamer_.enqueue(Purpose::ClearLatch, ""); return;
    case job::JobOrder::FeedHold: send_byte(Realtime::FeedHold); return;
    case job::JobOrder::CycleStart: send_byte(Realtime::CycleStart); return;
    case job::JobOrder::SoftReset: reset_controller(now); return;
    case job::JobOrder::AnnounceReset:
      tell(ControllerReset{"Line " + std::to_string(job_->state().refusal->file_line) +
                           " was refused: the machine is held and then reset, so that nothing behind it is cut."});
      return;
  }
}

void Session::tell_program_messages(std::uint32_t acknowledged_line) {
  for (auto& message : feed_->flow()->take_messages(acknowledged_line)) {
    tell(ProgramSpoke{.file_line = message.file_line, .text = std::move(message.text)});
  }
}

}  // namespace kerf::session
