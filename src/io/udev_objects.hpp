#pragma once
// libudev's reference-counted objects as owning pointers. Included only by the files that ask udev.

#include <memory>
#include <string>

#include <libudev.h>

namespace kerf::io {

template <auto Release>
struct UdevReleaser {
  template <typename Object>
  void operator()(Object* object) const {
    Release(object);
  }
};
using Udev = std::unique_ptr<udev, UdevReleaser<udev_unref>>;
using UdevEnumeration = std::unique_ptr<udev_enumerate, UdevReleaser<udev_enumerate_unref>>;
using UdevDevice = std::unique_ptr<udev_device, UdevReleaser<udev_device_unref>>;
using UdevMonitor = std::unique_ptr<udev_monitor, UdevReleaser<udev_monitor_unref>>;

}  // namespace kerf::io
