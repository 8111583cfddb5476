// Lines from a file on the card instead of the stream (grblHAL fs_stream.c; protocol.md 9.3).

#include "firmware/foreground.hpp"

namespace kerf::firmware {

std::optional<char> Foreground::next_byte() {
  if (board_.job.is_read()) return next_file_byte();
  if (receiver_.empty()) return std::nullopt;
  return receiver_.pop();
}

std::optional<char> Foreground::next_file_byte() {
  const MachineState state = board_.state;
  const bool ends = board_.job.is_drained() && (state == MachineState::Idle || state == MachineState::Check);
  if (ends) {
    // The end of the file counts as M30 once the machine rests.
    end_file_job();
    board_.say(vocabulary::FeedbackText::ProgramEnd);
    return std::nullopt;
  }
  constexpr StateSet kReading = {MachineState::Idle, MachineState::Run, MachineState::Hold, MachineState::Check,
                                 MachineState::Tool};
  return board_.job.next(kReading.contains(state));
}

void Foreground::end_file_job() {
  board_.job.end();
  receiver_.clear();
}

std::string Foreground::file_interruption() const {
  return "Reset during streaming of file at line: " + std::to_string(board_.job.line());
}

Steps Foreground::interrupted_file() const {
  if (!board_.job.is_running()) return {};
  return {Say{.message = protocol::Feedback{.text = file_interruption()}}, EndFileJob{}};
}

bool Foreground::operator()(BeginFileJob& step) {
  last_error_ = ErrorCode::Ok;
  board_.job.begin(board_.slot.card, step.path, step.bytes);
  return true;
}

bool Foreground::operator()(EndFileJob& /*step*/) {
  end_file_job();
  return true;
}

}  // namespace kerf::firmware
