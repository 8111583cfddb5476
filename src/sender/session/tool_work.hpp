#pragma once
// What an operator does by hand while a job waits for a tool: jogs, touches off, measures; and the way back.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/time.hpp"
#include "sender/machine/snapshot.hpp"

namespace kerf::session {

/// Lives from the beginning of a tool change to its end. The rest of the program counts on the place, in work
/// coordinates, where it waited.
class ToolWork {
 public:
  /// The machine stands and waits for the tool.
  void begin(const machine::Snapshot& snapshot);
  void end() { *this = {}; }
  [[nodiscard]] bool is_open() const { return is_open_; }

  /// Why a line by hand cannot be sent then, one sentence; empty where it can: jogs, offsets, tool length, grblHAL's
  /// own measuring, questions. Whatever else would change how the rest of the program is read, or be refused by a
  /// controller in its Tool state (protocol.md 9.1).
  [[nodiscard]] static std::string why_not(std::string_view text);

  /// A line by hand is to leave. True if 0xA3 has to be sent before: only then a controller in its Tool state reads
  /// lines.
  [[nodiscard]] bool on_line(Instant now, const machine::Snapshot& snapshot);
  /// What is sent before that is put aside unread, with what the buffer held.
  [[nodiscard]] bool must_wait() const { return reads_from_ != kNever; }
  void advance_to(Instant now);
  [[nodiscard]] Instant next_deadline() const { return reads_from_; }
  [[nodiscard]] bool has_worked() const { return has_worked_; }
  void on_answer();
  void on_report();

  /// Jogs that lead back: up, along, and down last. None where the machine stands there; empty while the place is not
  /// known.
  [[nodiscard]] std::optional<std::vector<std::string>> way_back(const machine::Snapshot& snapshot) const;
  /// The way back is under way, and the job goes on behind it.
  void set_returning(bool is_returning) { is_returning_ = is_returning; }
  [[nodiscard]] bool is_returning() const { return is_returning_; }

 private:
  bool is_open_ = false;
  bool is_read_ = false;
  bool has_worked_ = false;
  bool is_returning_ = false;
  int reports_since_answer_ = 0;
  Instant reads_from_ = kNever;
  std::optional<std::vector<double>> work_mm_;
};

}  // namespace kerf::session
