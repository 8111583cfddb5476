#pragma once
// What about this computer's power may interrupt a job.

#include <string>
#include <vector>

#include "io/machine_url.hpp"

namespace kerf::io {

/// What may interrupt a job on that machine, one sentence each: a battery instead of mains, a USB device that the
/// kernel may suspend. `sysfs` is a folder like /sys. Any thread.
[[nodiscard]] std::vector<std::string> power_warnings(const MachineUrl& url, const std::string& sysfs = "/sys");

}  // namespace kerf::io
