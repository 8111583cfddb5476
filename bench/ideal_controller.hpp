#pragma once
// The controller that no sender has to wait for: it answers every line at once, or as soon as the line has come in over
// an emulated serial wire. What is left is the sender's own doing.

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <string_view>

namespace kerf::bench {

/// Nanoseconds of the steady clock, which all processes share.
[[nodiscard]] std::int64_t steady_now_ns();

struct IdealOptions {
  /// Told in `[OPT:]`; of Grbl's ring buffer one byte is never used.
  std::size_t rx_bytes = 128;
  /// Without it the wire takes no time.
  std::optional<int> baud{};
};

/// What came in. Lines of the job begin with `X`; the instants are those of their first and last byte.
struct WireAccount {
  std::uint64_t job_lines = 0;
  std::uint64_t job_bytes = 0;
  std::int64_t first_ns = 0;
  std::int64_t last_ns = 0;
  /// Of an emulated wire, between the two instants.
  std::int64_t idle_ns = 0;
  /// Most bytes that were unanswered at once; more than `rx_bytes` - 1 would overrun the real thing.
  std::size_t most_in_flight = 0;

  [[nodiscard]] double seconds() const { return static_cast<double>(last_ns - first_ns) * 1e-9; }
  [[nodiscard]] double lines_per_s() const { return static_cast<double>(job_lines) / seconds(); }
  /// Share of the time in which the wire carried something.
  [[nodiscard]] double utilisation() const { return 1.0 - static_cast<double>(idle_ns) * 1e-9 / seconds(); }
};

/// Answers a sender as Grbl 1.1h does, as far as a handshake and a job ask. It stands where the last line said (words X
/// and Y), Idle or held. One thread calls serve(); the atomics are for others.
class IdealController {
 public:
  explicit IdealController(const IdealOptions& options) : options_(options) {}

  /// Until the other end closes the wire.
  void serve(int descriptor);
  [[nodiscard]] const WireAccount& account() const { return account_; }

  /// Lines of the job so far.
  [[nodiscard]] std::uint64_t lines_so_far() const { return lines_so_far_.load(std::memory_order_relaxed); }
  /// When the last `!` came: read from the port, and through the emulated wire. 0 before the first.
  [[nodiscard]] std::int64_t hold_read_ns() const { return hold_read_ns_.load(); }
  [[nodiscard]] std::int64_t hold_arrived_ns() const { return hold_arrived_ns_.load(); }
  /// A report told of the hold. Somebody presses cycle start at the machine when release() is called.
  [[nodiscard]] bool told_hold() const { return told_hold_.load(); }
  void release() { released_.store(true); }
  /// No hold is in force, and a report said so.
  [[nodiscard]] bool told_idle() const { return told_idle_.load(); }

 private:
  struct Answer {
    std::int64_t at_ns;
    std::size_t line_bytes;
    std::string text;
  };

  void serve_at_once(int descriptor);
  void serve_paced(int descriptor);
  /// Takes in what was read at `read_ns`, the first byte being through the wire at `at_ns`.
  void take(std::string_view bytes, std::int64_t read_ns, std::int64_t at_ns);
  void on_realtime(char byte, std::int64_t read_ns, std::int64_t at_ns);
  void on_line(std::int64_t at_ns);
  void count_job_line(std::int64_t at_ns);
  void answer(std::int64_t at_ns, std::size_t line_bytes, std::string_view text);
  [[nodiscard]] std::string status();

  IdealOptions options_;
  /// Nanoseconds a byte takes; 0 on a wire that takes no time.
  std::int64_t byte_ns_ = 0;
  std::int64_t wire_free_ns_ = 0;
  std::int64_t answered_until_ns_ = 0;
  /// Since the first line of the job.
  std::int64_t idle_ns_ = 0;
  std::string line_;
  std::string position_line_;
  bool is_held_ = false;
  std::size_t in_flight_ = 0;
  /// At once: everything for one write. Paced: what the wire still carries.
  std::string out_;
  std::deque<Answer> due_;
  WireAccount account_;
  std::atomic<std::uint64_t> lines_so_far_{0};
  std::atomic<std::int64_t> hold_read_ns_{0};
  std::atomic<std::int64_t> hold_arrived_ns_{0};
  std::atomic<bool> told_hold_{false};
  std::atomic<bool> told_idle_{false};
  std::atomic<bool> released_{false};
};

}  // namespace kerf::bench
