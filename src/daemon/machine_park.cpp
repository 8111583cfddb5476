#include "daemon/machine_park.hpp"

#include <algorithm>
#include <cctype>
#include <chrono>
#include <utility>

#include "io/wall_clock.hpp"

namespace kerf::daemon {
namespace {

using namespace std::chrono_literals;

constexpr Duration kBetweenPatches = 50ms;
constexpr std::size_t kMostMachines = 100;
constexpr std::size_t kLongestName = 60;

}  // namespace

MachinePark::MachinePark(const StationServices& services, Callbacks callbacks)
    : services_(services), callbacks_(std::move(callbacks)), timer_(*services.loop) {
  feed_.set("server",
            io::to_json(ServerView{.version = KERF_VERSION, .started_at = io::to_string(io::wall_clock_now())}));
  feed_.set("machines", Json::object());
  feed_.set("programs", Json::object());
}

std::string MachinePark::new_id(const std::string& name) const {
  std::string slug;
  for (const char letter : name) {
    const auto byte = static_cast<unsigned char>(letter);
    if (std::isalnum(byte) != 0 && byte < 0x80) {
      slug += static_cast<char>(std::tolower(byte));
    } else if (!slug.empty() && slug.back() != '-') {
      slug += '-';
    }
  }
  while (slug.ends_with('-')) slug.pop_back();
  if (slug.empty()) slug = "machine";
  std::string id = slug;
  for (int number = 2; stations_.contains(id); ++number) id = slug + "-" + std::to_string(number);
  return id;
}

std::expected<std::string, std::string> MachinePark::open(const std::string& id, const MachineRow& row) {
  auto url = io::parse_machine_url(row.url);
  if (!url) return std::unexpected(io::explain(url.error()));
  if (row.name.empty() || row.name.size() > kLongestName)
    return std::unexpected("A machine's name has 1 to 60 letters.");
  if (stations_.size() >= kMostMachines) return std::unexpected("There are too many machines already.");
  if (const std::string owner = owner_of(row.url); !owner.empty()) {
    return std::unexpected("That address belongs to the machine '" + find(owner)->row().name + "'.");
  }
  stations_[id] = std::make_unique<Station>(
      services_, row, *url,
      Station::Callbacks{.changed = [this, id] { on_changed(id); }, .traffic = [this, id] { on_traffic(id); }});
  on_changed(id);
  return id;
}

std::expected<std::string, std::string> MachinePark::add_fixed(const MachineRow& row) {
  auto id = open(new_id(row.name), row);
  if (id) is_fixed_[*id] = true;
  return id;
}

void MachinePark::add_remembered() {
  for (const auto& [id, row] : services_.store->machines()) {
    if (!stations_.contains(id)) static_cast<void>(open(id, row));
  }
}

std::expected<std::string, std::string> MachinePark::add(const MachineRow& row) {
  auto id = open(new_id(row.name), row);
  if (!id) return id;
  if (auto kept = services_.store->put_machine(*id, row); !kept) return std::unexpected(kept.error());
  return id;
}

std::expected<void, std::string> MachinePark::remove(const std::string& id) {
  const auto found = stations_.find(id);
  if (found == stations_.end()) return std::unexpected("There is no such machine.");
  if (is_fixed_.contains(id)) return std::unexpected("This machine is in the configuration: remove it there.");
  if (found->second->is_busy()) return std::unexpected("A job is under way; stop it first.");
  if (auto forgotten = services_.store->remove_machine(id); !forgotten) return forgotten;
  stations_.erase(found);
  is_stale_.erase(id);
  feed_.set("machines", id, nullptr);
  schedule();
  return {};
}

Station* MachinePark::find(const std::string& id) const {
  const auto found = stations_.find(id);
  return found == stations_.end() ? nullptr : found->second.get();
}

std::string MachinePark::owner_of(const std::string& url) const {
  const auto wanted = io::parse_machine_url(url);
  if (!wanted || std::holds_alternative<io::VirtualAddress>(*wanted)) return {};
  const auto found =
      std::ranges::find_if(stations_, [&](const auto& station) { return station.second->url() == *wanted; });
  return found == stations_.end() ? std::string{} : found->first;
}

void MachinePark::set_watched(bool is_watched) {
  is_watched_ = is_watched;
  if (is_watched_) schedule();
}

void MachinePark::on_changed(const std::string& id) {
  is_stale_[id] = true;
  schedule();
}

void MachinePark::on_traffic(const std::string& id) {
  has_traffic_.insert(id);
  schedule();
}

void MachinePark::on_programs_changed() {
  programs_are_stale_ = true;
  schedule();
}

void MachinePark::schedule() {
  if (!is_watched_ || std::exchange(is_scheduled_, true)) return;
  timer_.arm(std::max(services_.loop->now(), published_at_ + kBetweenPatches), [this] { publish(); });
}

void MachinePark::publish() {
  is_scheduled_ = false;
  published_at_ = services_.loop->now();
  for (auto& [id, is_stale] : is_stale_) {
    const Station* const station = find(id);
    if (std::exchange(is_stale, false) && station != nullptr) feed_.set("machines", id, io::to_json(station->view()));
  }
  if (std::exchange(programs_are_stale_, false)) feed_.set("programs", io::to_json(services_.library->programs()));
  const Frame patch = feed_.publish(clock_s());
  if (patch != nullptr) callbacks_.published(patch);
  for (const std::string& id : std::exchange(has_traffic_, {})) callbacks_.traffic(id);
}

const StateFeed& MachinePark::feed() {
  publish();
  return feed_;
}

}  // namespace kerf::daemon
