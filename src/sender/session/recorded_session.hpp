#pragma once
// A session that writes down what goes into it and what comes out: the flight recorder. And what happens to its jobs:
// the journal.

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sender/session/job_recorder.hpp"
#include "sender/session/password_mask.hpp"
#include "sender/session/record.hpp"
#include "sender/session/session.hpp"

namespace kerf::session {

/// Has the shape of a Session, and its inputs hide a Session's: whoever drives it calls these. Passwords do not get
/// into the records. The log begins with a LogHeader that the owner writes.
class RecordedSession : public Session {
 public:
  explicit RecordedSession(const SessionOptions& options = {}) : Session(options) {}

  void on_open(Instant now, const machine::LinkOpening& opening = {});
  void on_bytes(Instant now, std::string_view bytes);
  [[nodiscard]] std::string feed_ahead(Instant now, std::string_view bytes);
  void on_closed(Instant now, LinkLoss loss);
  void submit(Instant now, const Command& command);
  void advance_to(Instant now);
  [[nodiscard]] Instant next_deadline() const;
  /// With the records of the journal.
  [[nodiscard]] Outbox take_outbox();

  /// What happened since the last call.
  [[nodiscard]] std::vector<Record> take_records();

 private:
  template <typename What>
  void note(Instant now, What what) {
    records_.push_back({.at = now, .what = std::move(what)});
  }
  void catch_up();
  void note_program(Instant now, const StartJob& start);
  /// Takes what the input led to, and writes the bytes down behind it; `ahead` went before the others.
  void settle(Instant now, std::string ahead = {});

  /// Bytes that are not written down yet, and the lines that they made room for.
  struct Heard {
    Instant at{};
    std::string bytes;
    std::string lines;
  };

  std::optional<Heard> heard_;
  Outbox waiting_;
  PasswordMask mask_;
  StreamMask received_mask_;
  /// The program in the log; another one is written down before its StartJob.
  std::shared_ptr<const job::Program> program_;
  std::vector<Record> records_;
  JobRecorder journal_;
};

}  // namespace kerf::session
