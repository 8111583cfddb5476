// What a line of a job costs Kerf itself: a session that streams to a controller which answers at once, without any
// operating system between them. Processor time, so that other users of the machine disturb little.

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string>
#include <string_view>

#include "measure.hpp"
#include "sender/session/record_text.hpp"
#include "sender/session/recorded_session.hpp"

namespace kerf::bench {
namespace {

/// The least that a handshake and a job need to hear.
std::string reply_to(std::string_view line) {
  if (line == "$I") return "[VER:1.1h.20190830:ideal]\r\n[OPT:V,15,128]\r\nok\r\n";
  if (line == "$G") return "[GC:G0 G54 G17 G21 G90 G94 M5 M9 T0 F0 S0]\r\nok\r\n";
  if (line == "$$") return "$0=10\r\n$10=1\r\n$13=0\r\n$32=0\r\n$100=250.000\r\n$101=250.000\r\n$102=250.000\r\nok\r\n";
  return "ok\r\n";
}

/// Session and controller, until the job has ended.
class Run {
 public:
  Run(std::string text, bool writes_log)
      : writes_log_(writes_log), program_(*job::Program::load("cost.nc", std::move(text))) {}

  /// Lines of the job that were answered.
  std::uint64_t operator()() {
    session_.on_open(now_);
    exchange();
    while (!ended_) {
      now_ = std::max(now_, session_.next_deadline());
      session_.advance_to(now_);
      exchange();
    }
    return answered_;
  }
  [[nodiscard]] std::size_t log_bytes() const { return log_bytes_; }

 private:
  void exchange() {
    for (auto out = session_.take_outbox(); !out.empty(); out = session_.take_outbox()) {
      now_ += std::chrono::microseconds{10};
      for (const session::Event& event : out.events) observe(event);
      write_down();
      heard_.clear();
      for (const char byte : out.realtime) hear_byte(byte);
      for (std::string_view rest = out.lines; !rest.empty();) {
        const std::size_t end = rest.find('\n');
        heard_ += reply_to(rest.substr(0, end));
        rest.remove_prefix(end + 1);
        ++answered_;
      }
      if (!heard_.empty()) session_.on_bytes(now_, heard_);
    }
    write_down();
  }
  void hear_byte(char byte) {
    if (byte == '?') heard_ += "<Idle|MPos:0.000,0.000,0.000|FS:0,0|WCO:0.000,0.000,0.000>\r\n";
    if (byte == '\x18') heard_ += "\r\nGrbl 1.1h ['$' for help]\r\n";
  }
  void observe(const session::Event& event) {
    if (std::holds_alternative<session::ControllerFound>(event)) session_.submit(now_, session::StartJob{program_});
    if (std::holds_alternative<session::JobEnded>(event)) ended_ = true;
  }
  void write_down() {
    for (const session::Record& record : session_.take_records()) {
      if (writes_log_) session::append_line(log_, record);
    }
    log_bytes_ += log_.size();
    log_.clear();
  }

  bool writes_log_;
  std::shared_ptr<const job::Program> program_;
  session::RecordedSession session_;
  Instant now_{};
  std::string heard_;
  std::string log_;
  std::size_t log_bytes_ = 0;
  std::uint64_t answered_ = 0;
  bool ended_ = false;
};

std::string job_of(int lines) {
  std::string text = "G1F50000\n";
  for (int line = 0; line < lines; ++line) {
    char word[32];
    std::snprintf(word, sizeof word, "X%02d.%02dY%02d.%d\n", 10 + line / 80 % 80, 11 + line % 80 - line % 10,
                  10 + line / 80 % 80, 1 + line % 9);
    text += word;
  }
  return text;
}

void measure(const char* name, int lines, bool writes_log) {
  std::uint64_t answered = 0;
  std::size_t log_bytes = 0;
  const Took took = time([&] {
    Run run(job_of(lines), writes_log);
    answered = run();
    log_bytes = run.log_bytes();
  });
  std::printf("%-36s %5.0f ns a line, %4.1f bytes of log a line\n", name,
              took.cpu_s * 1e9 / static_cast<double>(answered),
              static_cast<double>(log_bytes) / static_cast<double>(answered));
}

}  // namespace
}  // namespace kerf::bench

int main(int argc, char** argv) {
  const int lines = argc > 1 ? std::atoi(argv[1]) : 500'000;
  kerf::bench::measure("session", lines, false);
  kerf::bench::measure("session, and the text of its log", lines, true);
}
