#include "io/link_recorder.hpp"

namespace kerf::io {

session::LinkLoss loss_of(TransportFault fault) {
  switch (fault) {
    case TransportFault::ClosedByPeer: return session::LinkLoss::Closed;
    case TransportFault::Unplugged: return session::LinkLoss::Unplugged;
    case TransportFault::TimedOut: return session::LinkLoss::TimedOut;
    default: return session::LinkLoss::Error;
  }
}

LinkRecorder::LinkRecorder(EventLoop& loop, const RecordingOptions& options, session::LogHeader header,
                           Callbacks callbacks)
    : loop_(loop), log_(loop, options, std::move(header)), callbacks_(std::move(callbacks)) {}

LinkRecorder::~LinkRecorder() {
  callbacks_ = {};  // whoever listened may be half gone
  gone(session::LinkLoss::HungUp);
}

template <typename What>
void LinkRecorder::write(What what) {
  const session::Record record{.at = loop_.now(), .what = std::move(what)};
  log_.append(record);
  if (callbacks_.recorded) callbacks_.recorded(record);
  const auto fault = log_.take_fault();
  if (fault && callbacks_.noted) callbacks_.noted(*fault);
}

void LinkRecorder::opened() {
  is_open_ = true;
  write(session::LinkOpened{});
}

void LinkRecorder::received(std::string_view bytes) {
  write(session::BytesReceived{received_.push(bytes, mask_)});
}

void LinkRecorder::sent(std::string_view bytes) {
  write(session::BytesSent{.realtime = {}, .lines = sent_.push(bytes, mask_)});
}

void LinkRecorder::gone(session::LinkLoss loss) {
  if (!std::exchange(is_open_, false)) return;
  if (auto held = sent_.finish(); !held.empty()) {
    write(session::BytesSent{.realtime = {}, .lines = std::move(held)});
  }
  if (auto held = received_.finish(); !held.empty()) write(session::BytesReceived{std::move(held)});
  write(session::LinkGone{loss});
}

}  // namespace kerf::io
