#include "io/sleep_inhibitor.hpp"

#include <array>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/wait.h>
#include <systemd/sd-bus.h>
#include <unistd.h>

namespace kerf::io {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

/// From now on the system's bus is at `address`. Not put back: a thread that asks may still read it.
void use_bus(const std::string& address) {
  ::setenv("DBUS_SYSTEM_BUS_ADDRESS", address.c_str(), 1);
}

/// A bus of the test's own; the program that keeps it may be missing.
class Daemon {
 public:
  Daemon() {
    std::array<int, 2> pipe{};
    if (::pipe(pipe.data()) != 0) return;
    process_ = ::fork();
    if (process_ == 0) {
      ::dup2(pipe[1], STDOUT_FILENO);
      ::execlp("dbus-daemon", "dbus-daemon", "--session", "--nofork", "--print-address=1", nullptr);
      ::_exit(127);
    }
    ::close(pipe[1]);
    for (char letter = 0; ::read(pipe[0], &letter, 1) == 1 && letter != '\n';) address_ += letter;
    ::close(pipe[0]);
  }
  ~Daemon() {
    ::kill(process_, SIGTERM);
    ::waitpid(process_, nullptr, 0);
  }
  Daemon(const Daemon&) = delete;
  Daemon& operator=(const Daemon&) = delete;
  [[nodiscard]] const std::string& address() const { return address_; }

 private:
  pid_t process_ = -1;
  std::string address_;
};

/// What logind does: gives away one end of a pipe, and knows from the other whether it is still held.
class FakeLogind {
 public:
  explicit FakeLogind(const std::string& address, bool refuses_lids = false) : refuses_lids_(refuses_lids) {
    sd_bus_new(&bus_);
    sd_bus_set_address(bus_, address.c_str());
    sd_bus_set_bus_client(bus_, 1);
    sd_bus_start(bus_);
    sd_bus_add_object(bus_, nullptr, "/org/freedesktop/login1", &FakeLogind::answer, this);
    sd_bus_request_name(bus_, "org.freedesktop.login1", 0);
    serving_ = std::thread([this] {
      while (!is_over_) {
        if (sd_bus_process(bus_, nullptr) == 0) sd_bus_wait(bus_, 20'000);
      }
    });
  }
  ~FakeLogind() {
    is_over_ = true;
    serving_.join();
    sd_bus_flush_close_unref(bus_);
    if (watched_ >= 0) ::close(watched_);
  }
  FakeLogind(const FakeLogind&) = delete;
  FakeLogind& operator=(const FakeLogind&) = delete;

  /// A lock was given within 5 s.
  [[nodiscard]] bool gave_a_lock() const {
    for (int round = 0; round < 500 && watched_ < 0; ++round) ::poll(nullptr, 0, 10);
    return watched_ >= 0;
  }
  /// The lock that was given is held no more, at once or within `patience`.
  [[nodiscard]] bool is_released(std::chrono::milliseconds patience) const {
    pollfd watched{.fd = watched_, .events = 0, .revents = 0};
    return ::poll(&watched, 1, static_cast<int>(patience.count())) == 1 && (watched.revents & POLLHUP) != 0;
  }
  /// What was asked for last.
  [[nodiscard]] std::string what() const { return what_; }
  [[nodiscard]] std::string why() const { return why_; }

 private:
  static int answer(sd_bus_message* message, void* self, sd_bus_error*) {
    if (sd_bus_message_is_method_call(message, "org.freedesktop.login1.Manager", "Inhibit") <= 0) return 0;
    return static_cast<FakeLogind*>(self)->inhibit(message);
  }
  int inhibit(sd_bus_message* message) {
    std::array<const char*, 4> arguments{};
    sd_bus_message_read(message, "ssss", &arguments[0], &arguments[1], &arguments[2], &arguments[3]);
    what_ = arguments[0];
    why_ = arguments[2];
    if (refuses_lids_ && what_.find("lid") != std::string::npos) {
      return sd_bus_reply_method_errorf(message, SD_BUS_ERROR_ACCESS_DENIED, "not yours");
    }
    std::array<int, 2> pipe{};
    if (::pipe(pipe.data()) != 0) return -1;
    const int replied = sd_bus_reply_method_return(message, "h", pipe[1]);
    ::close(pipe[1]);
    watched_ = pipe[0];
    return replied;
  }

  const bool refuses_lids_;
  sd_bus* bus_ = nullptr;
  std::thread serving_;
  std::atomic<bool> is_over_ = false;
  std::atomic<int> watched_ = -1;
  std::string what_;
  std::string why_;
};

TEST(SleepInhibitor, HoldsALockOfLogindWhileItLives) {
  for (const bool refuses_lids : {false, true}) {
    const Daemon daemon;
    if (daemon.address().empty()) GTEST_SKIP() << "there is no dbus-daemon here";
    use_bus(daemon.address());
    const FakeLogind logind(daemon.address(), refuses_lids);
    EventLoop loop;
    std::vector<std::string> said;
    {
      const SleepInhibitor inhibitor(loop, "A job runs on /dev/ttyACM0",
                                     [&](const std::string& sentence) { said.push_back(sentence); });
      ASSERT_TRUE(logind.gave_a_lock());
      EXPECT_EQ(logind.what(), refuses_lids ? "sleep:idle" : "sleep:idle:handle-lid-switch");
      EXPECT_EQ(logind.why(), "A job runs on /dev/ttyACM0");
      EXPECT_FALSE(logind.is_released(100ms));
    }
    EXPECT_TRUE(logind.is_released(5s));
    loop.post([&loop] { loop.stop(); });
    loop.run();
    EXPECT_THAT(said, IsEmpty());
  }
}

TEST(SleepInhibitor, SaysOnceThatNobodyGrantsIt) {
  use_bus("unix:path=/nonexistent/bus");
  EventLoop loop;
  std::vector<std::string> said;
  const SleepInhibitor inhibitor(loop, "A job runs", [&](const std::string& sentence) {
    said.push_back(sentence);
    loop.stop();
  });
  loop.run();
  ASSERT_THAT(said, SizeIs(1));
  EXPECT_THAT(said[0], HasSubstr("This computer may fall asleep"));
}

TEST(SleepInhibitor, MayEndBeforeItIsAnswered) {
  use_bus("unix:path=/nonexistent/bus");
  for (int round = 0; round < 50; ++round) {
    EventLoop loop;
    const SleepInhibitor inhibitor(loop, "A job runs", [](const std::string&) {});
  }
}

}  // namespace
}  // namespace kerf::io
