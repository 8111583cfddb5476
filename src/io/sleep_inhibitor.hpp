#pragma once
// Keeps this computer awake while a job runs.

#include <functional>
#include <memory>
#include <string>

#include "io/event_loop.hpp"

namespace kerf::io {

/// While it lives, systemd-logind lets nobody suspend this computer, and an idle desktop or a closed lid does not
/// either. Asks in the background; where nobody grants it, `noted` says so once. Loop's thread.
class SleepInhibitor {
 public:
  /// `why` is what logind shows: "A job runs on /dev/ttyUSB0".
  SleepInhibitor(EventLoop& loop, std::string why, std::function<void(const std::string& sentence)> noted);
  ~SleepInhibitor();
  SleepInhibitor(const SleepInhibitor&) = delete;
  SleepInhibitor& operator=(const SleepInhibitor&) = delete;

 private:
  struct Shared;
  std::shared_ptr<Shared> shared_;
};

}  // namespace kerf::io
