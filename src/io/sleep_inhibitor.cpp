#include "io/sleep_inhibitor.hpp"

#include <array>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <system_error>
#include <thread>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <systemd/sd-bus.h>
#include <unistd.h>

namespace kerf::io {
namespace {

constexpr std::uint64_t kPatienceUs = 5'000'000;

/// Only the owner of the screen may decide about its lid: without that, the rest is asked for alone.
constexpr std::array<const char*, 2> kWhat{"sleep:idle:handle-lid-switch", "sleep:idle"};

struct Grant {
  int descriptor = -1;
  std::string fault;
};

/// org.freedesktop.login1.Manager.Inhibit(): the lock holds as long as the descriptor is open.
Grant ask(sd_bus* bus, const char* what, const std::string& why) {
  sd_bus_error error{};
  sd_bus_message* reply = nullptr;
  Grant grant;
  int descriptor = -1;
  const int called =
      sd_bus_call_method(bus, "org.freedesktop.login1", "/org/freedesktop/login1", "org.freedesktop.login1.Manager",
                         "Inhibit", &error, &reply, "ssss", what, "Kerf", why.c_str(), "block");
  if (called < 0) {
    grant.fault = error.message != nullptr ? error.message : std::generic_category().message(-called);
  } else if (const int read = sd_bus_message_read(reply, "h", &descriptor); read < 0) {
    grant.fault = std::generic_category().message(-read);
  } else {
    // The message owns its own.
    grant.descriptor = ::fcntl(descriptor, F_DUPFD_CLOEXEC, 3);
  }
  sd_bus_error_free(&error);
  sd_bus_message_unref(reply);
  return grant;
}

Grant ask_logind(const std::string& why) {
  sd_bus* bus = nullptr;
  if (const int opened = sd_bus_open_system(&bus); opened < 0) {
    return {.fault = "there is no system bus: " + std::generic_category().message(-opened)};
  }
  sd_bus_set_method_call_timeout(bus, kPatienceUs);
  Grant grant;
  for (const char* what : kWhat) {
    grant = ask(bus, what, why);
    if (grant.descriptor >= 0) break;
  }
  sd_bus_flush_close_unref(bus);
  return grant;
}

}  // namespace

/// What the asking thread and the owner share; the bus may answer after the job has ended.
struct SleepInhibitor::Shared {
  std::mutex mutex;
  int descriptor = -1;
  bool is_over = false;

  ~Shared() {
    if (descriptor >= 0) ::close(descriptor);
  }
};

SleepInhibitor::SleepInhibitor(EventLoop& loop, std::string why, std::function<void(const std::string&)> noted)
    : shared_(std::make_shared<Shared>()) {
  std::thread([shared = std::weak_ptr<Shared>(shared_), &loop, why = std::move(why), noted = std::move(noted)] {
    const Grant grant = ask_logind(why);
    const auto owner = shared.lock();
    if (!owner) {
      if (grant.descriptor >= 0) ::close(grant.descriptor);
      return;
    }
    const std::lock_guard lock(owner->mutex);
    owner->descriptor = grant.descriptor;
    if (grant.descriptor >= 0 || owner->is_over) return;
    loop.post([noted, fault = grant.fault] {
      noted(fmt::format("This computer may fall asleep during the job: switch that off ({}).", fault));
    });
  }).detach();
}

SleepInhibitor::~SleepInhibitor() {
  const std::lock_guard lock(shared_->mutex);
  shared_->is_over = true;
  if (shared_->descriptor >= 0) ::close(std::exchange(shared_->descriptor, -1));
}

}  // namespace kerf::io
