#include "ideal_controller.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <ctime>

#include <poll.h>
#include <sys/prctl.h>
#include <unistd.h>

namespace kerf::bench {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;
constexpr int kBitsAByte = 10;
constexpr std::string_view kWelcome = "\r\nGrbl 1.1h ['$' for help]\r\n";
constexpr std::string_view kSettings =
    "$0=10\r\n$1=25\r\n$2=0\r\n$3=0\r\n$4=0\r\n$5=0\r\n$6=0\r\n$10=1\r\n$11=0.010\r\n$12=0.002\r\n$13=0\r\n$20=0\r\n"
    "$21=0\r\n$22=0\r\n$23=0\r\n$24=25.000\r\n$25=500.000\r\n$26=250\r\n$27=1.000\r\n$30=1000\r\n$31=0\r\n$32=0\r\n"
    "$100=250.000\r\n$101=250.000\r\n$102=250.000\r\n$110=1000000000.000\r\n$111=1000000000.000\r\n$112=1000000000."
    "000\r\n"
    "$120=10000.000\r\n$121=10000.000\r\n$122=10000.000\r\n$130=2000.000\r\n$131=2000.000\r\n$132=2000.000\r\nok\r\n";
constexpr std::string_view kOffsets =
    "[G54:0.000,0.000,0.000]\r\n[G55:0.000,0.000,0.000]\r\n[G56:0.000,0.000,0.000]\r\n[G57:0.000,0.000,0.000]\r\n"
    "[G58:0.000,0.000,0.000]\r\n[G59:0.000,0.000,0.000]\r\n[G28:0.000,0.000,0.000]\r\n[G30:0.000,0.000,0.000]\r\n"
    "[G92:0.000,0.000,0.000]\r\n[TLO:0.000]\r\n[PRB:0.000,0.000,0.000:0]\r\nok\r\n";
constexpr std::string_view kModes = "[GC:G0 G54 G17 G21 G90 G94 M5 M9 T0 F0 S0]\r\nok\r\n";

bool is_realtime(char byte) {
  return byte == '?' || byte == '!' || byte == '~' || byte == '\x18' || static_cast<unsigned char>(byte) >= 0x80;
}

/// The number behind `letter`; 0 without one.
double word(std::string_view line, char letter) {
  const std::size_t at = line.find(letter);
  return at == std::string_view::npos ? 0.0 : std::strtod(std::string{line.substr(at + 1)}.c_str(), nullptr);
}

bool write_all(int descriptor, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t count = write(descriptor, bytes.data(), bytes.size());
    if (count <= 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(count));
  }
  return true;
}

}  // namespace

std::int64_t steady_now_ns() {
  std::timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return now.tv_sec * kSecond + now.tv_nsec;
}

void IdealController::serve(int descriptor) {
  byte_ns_ = options_.baud ? kBitsAByte * kSecond / *options_.baud : 0;
  if (byte_ns_ == 0) return serve_at_once(descriptor);
  // A wire is punctual; a thread sleeps 50 µs too long unless it asks for better.
  prctl(PR_SET_TIMERSLACK, 1);
  serve_paced(descriptor);
}

void IdealController::serve_at_once(int descriptor) {
  std::array<char, 4096> chunk{};
  for (;;) {
    const ssize_t count = read(descriptor, chunk.data(), chunk.size());
    if (count <= 0) return;
    const std::int64_t now = steady_now_ns();
    take({chunk.data(), static_cast<std::size_t>(count)}, now, now);
    if (!write_all(descriptor, out_)) return;
    out_.clear();
    in_flight_ = line_.size();
  }
}

void IdealController::serve_paced(int descriptor) {
  std::array<char, 4096> chunk{};
  for (;;) {
    for (const std::int64_t now = steady_now_ns(); !due_.empty() && due_.front().at_ns <= now; due_.pop_front()) {
      in_flight_ -= due_.front().line_bytes;
      out_ += due_.front().text;
    }
    if (!write_all(descriptor, out_)) return;
    out_.clear();
    const std::int64_t wait_ns =
        due_.empty() ? kSecond : std::max<std::int64_t>(due_.front().at_ns - steady_now_ns(), 0);
    const std::timespec wait{.tv_sec = wait_ns / kSecond, .tv_nsec = wait_ns % kSecond};
    pollfd readable{.fd = descriptor, .events = POLLIN, .revents = 0};
    if (ppoll(&readable, 1, &wait, nullptr) <= 0) continue;
    const ssize_t count = read(descriptor, chunk.data(), chunk.size());
    if (count <= 0) return;
    const std::int64_t now = steady_now_ns();
    const std::int64_t starts_ns = std::max(now, wire_free_ns_);
    if (account_.job_lines > 0) idle_ns_ += starts_ns - wire_free_ns_;
    take({chunk.data(), static_cast<std::size_t>(count)}, now, starts_ns + byte_ns_);
    wire_free_ns_ = starts_ns + count * byte_ns_;
  }
}

void IdealController::take(std::string_view bytes, std::int64_t read_ns, std::int64_t at_ns) {
  for (const char byte : bytes) {
    if (is_realtime(byte)) {
      on_realtime(byte, read_ns, at_ns);
    } else {
      ++in_flight_;
      account_.most_in_flight = std::max(account_.most_in_flight, in_flight_);
      if (byte == '\n') {
        on_line(at_ns);
      } else {
        line_ += byte;
      }
    }
    at_ns += byte_ns_;
  }
  lines_so_far_.store(account_.job_lines, std::memory_order_relaxed);
}

void IdealController::on_realtime(char byte, std::int64_t read_ns, std::int64_t at_ns) {
  if (byte == '?') answer(at_ns, 0, status());
  if (byte == '\x18') {
    line_.clear();
    is_held_ = false;
    answer(at_ns, 0, kWelcome);
  }
  if (byte == '~') is_held_ = false;
  if (byte != '!') return;
  is_held_ = true;
  told_hold_ = false;
  told_idle_ = false;
  released_ = false;
  hold_arrived_ns_ = at_ns;
  hold_read_ns_ = read_ns;
}

void IdealController::on_line(std::int64_t at_ns) {
  const std::size_t line_bytes = line_.size() + 1;
  if (line_.starts_with('X')) {
    count_job_line(at_ns);
    answer(at_ns, line_bytes, "ok\r\n");
  } else if (line_ == "$I") {
    answer(at_ns, line_bytes,
           "[VER:1.1h.20190830:ideal]\r\n[OPT:V,15," + std::to_string(options_.rx_bytes) + "]\r\nok\r\n");
  } else if (line_ == "$$") {
    answer(at_ns, line_bytes, kSettings);
  } else if (line_ == "$#") {
    answer(at_ns, line_bytes, kOffsets);
  } else if (line_ == "$G") {
    answer(at_ns, line_bytes, kModes);
  } else {
    answer(at_ns, line_bytes, "ok\r\n");
  }
  line_.clear();
}

void IdealController::count_job_line(std::int64_t at_ns) {
  const std::size_t line_bytes = line_.size() + 1;
  if (account_.job_lines++ == 0) account_.first_ns = at_ns - static_cast<std::int64_t>(line_bytes) * byte_ns_;
  account_.job_bytes += line_bytes;
  account_.last_ns = at_ns;
  account_.idle_ns = idle_ns_;
  if (!is_held_) position_line_.assign(line_);
}

void IdealController::answer(std::int64_t at_ns, std::size_t line_bytes, std::string_view text) {
  if (byte_ns_ == 0) {
    out_ += text;
    return;
  }
  answered_until_ns_ = std::max(answered_until_ns_, at_ns) + static_cast<std::int64_t>(text.size()) * byte_ns_;
  due_.push_back({.at_ns = answered_until_ns_, .line_bytes = line_bytes, .text = std::string{text}});
}

std::string IdealController::status() {
  if (is_held_ && released_.exchange(false)) is_held_ = false;
  (is_held_ ? told_hold_ : told_idle_) = true;
  char text[128];
  std::snprintf(text, sizeof text, "<%s|MPos:%.3f,%.3f,0.000|FS:0,0|WCO:0.000,0.000,0.000>\r\n",
                is_held_ ? "Hold:0" : "Idle", word(position_line_, 'X'), word(position_line_, 'Y'));
  return text;
}

}  // namespace kerf::bench
