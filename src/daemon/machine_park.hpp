#pragma once
// The machines of a daemon and the state that its clients see of them: one document, published at most twenty times a
// second. Loop's thread only.

#include <cstdint>
#include <expected>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "daemon/state_feed.hpp"
#include "daemon/station.hpp"

namespace kerf::daemon {

class MachinePark {
 public:
  struct Callbacks {
    /// A patch is there for everybody.
    std::function<void(const Frame&)> published;
    /// Lines went to or from this machine since the last time.
    std::function<void(const std::string& machine)> traffic;
  };

  MachinePark(const StationServices& services, Callbacks callbacks);

  /// A machine of the configuration: there from the beginning, and not to be removed.
  [[nodiscard]] std::expected<std::string, std::string> add_fixed(const MachineRow& row);
  /// Machines that were added earlier.
  void add_remembered();
  /// Its id, or one sentence why it cannot be.
  [[nodiscard]] std::expected<std::string, std::string> add(const MachineRow& row);
  [[nodiscard]] std::expected<void, std::string> remove(const std::string& id);

  /// Null where there is none.
  [[nodiscard]] Station* find(const std::string& id) const;
  [[nodiscard]] const std::map<std::string, std::unique_ptr<Station>>& stations() const { return stations_; }
  /// The machine that has this address; empty if none.
  [[nodiscard]] std::string owner_of(const std::string& url) const;

  /// While nobody looks, nothing is published.
  void set_watched(bool is_watched);
  /// The state of this moment, published.
  [[nodiscard]] const StateFeed& feed();
  [[nodiscard]] double clock_s() const { return base::to_seconds(services_.loop->now()); }
  void on_programs_changed();
  [[nodiscard]] const io::JournalOptions& journal() const { return services_.recording.journal; }

 private:
  std::expected<std::string, std::string> open(const std::string& id, const MachineRow& row);
  [[nodiscard]] std::string new_id(const std::string& name) const;
  void on_changed(const std::string& id);
  void on_traffic(const std::string& id);
  void schedule();
  void publish();

  const StationServices services_;
  const Callbacks callbacks_;
  io::Timer timer_;
  StateFeed feed_;
  std::map<std::string, bool> is_fixed_;
  std::map<std::string, bool> is_stale_;
  std::set<std::string> has_traffic_;
  bool programs_are_stale_ = true;
  bool is_watched_ = false;
  bool is_scheduled_ = false;
  Instant published_at_{};
  std::map<std::string, std::unique_ptr<Station>> stations_;
};

}  // namespace kerf::daemon
