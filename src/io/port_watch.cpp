#include "io/port_watch.hpp"

#include <optional>
#include <utility>

#include "io/udev_objects.hpp"

namespace kerf::io {

struct PortWatch::State {
  explicit State(std::function<void()> on_change) : changed(std::move(on_change)) {}

  void read() {
    bool has_changed = false;
    // The socket does not block: it gives nothing when everything was read.
    while (const UdevDevice device{udev_monitor_receive_device(monitor.get())}) has_changed = true;
    if (!has_changed) return;
    const auto running = changed;  // the owner may end the watch in there
    running();
  }

  std::function<void()> changed;
  Udev context;
  UdevMonitor monitor;
  std::optional<ReadableWatch> readable;
};

PortWatch::PortWatch(EventLoop& loop, std::function<void()> changed)
    : state_(std::make_unique<State>(std::move(changed))) {
  State& state = *state_;
  state.context.reset(udev_new());
  if (!state.context) return;
  state.monitor.reset(udev_monitor_new_from_netlink(state.context.get(), "udev"));
  if (!state.monitor) return;
  if (udev_monitor_filter_add_match_subsystem_devtype(state.monitor.get(), "tty", nullptr) < 0) return;
  if (udev_monitor_enable_receiving(state.monitor.get()) < 0) return;
  state.readable.emplace(loop, udev_monitor_get_fd(state.monitor.get()), [&state] { state.read(); });
}

PortWatch::~PortWatch() = default;

}  // namespace kerf::io
