#include "daemon/state_feed.hpp"

#include <utility>

namespace kerf::daemon {
namespace {

/// Half a minute of a busy machine.
constexpr std::size_t kPatchesKept = 600;

}  // namespace

Json merge_difference(const Json& before, const Json& after) {
  Json patch = Json::object();
  for (const auto& [name, value] : before.items()) {
    if (!after.contains(name)) patch[name] = nullptr;
  }
  for (const auto& [name, value] : after.items()) {
    const auto known = before.find(name);
    if (known != before.end() && known->is_object() && value.is_object()) {
      Json inner = merge_difference(*known, value);
      if (!inner.empty()) patch[name] = std::move(inner);
    } else if (known == before.end() || *known != value) {
      patch[name] = value;
    }
  }
  return patch;
}

Frame frame_of(const Json& json) {
  return std::make_shared<const std::string>(io::print(json));
}

void StateFeed::set(const std::string& part, const std::string& name, Json value) {
  Json& owner = state_[part];
  if (owner.is_null()) owner = Json::object();
  if (value.is_null()) {
    owner.erase(name);
  } else {
    owner[name] = std::move(value);
  }
}

Frame StateFeed::publish(double clock_s) {
  Json patch = merge_difference(published_, state_);
  if (patch.empty()) return nullptr;
  published_.merge_patch(patch);
  ++number_;
  recent_.push_back(
      frame_of({{"type", "patch"}, {"number", number_}, {"clock_s", clock_s}, {"patch", std::move(patch)}}));
  if (recent_.size() > kPatchesKept) recent_.pop_front();
  return recent_.back();
}

Frame StateFeed::snapshot(double clock_s) const {
  return frame_of({{"type", "snapshot"}, {"number", number_}, {"clock_s", clock_s}, {"state", published_}});
}

std::optional<std::vector<Frame>> StateFeed::since(std::uint64_t number) const {
  if (number > number_ || number_ - number > recent_.size()) return std::nullopt;
  return std::vector<Frame>(recent_.end() - static_cast<std::ptrdiff_t>(number_ - number), recent_.end());
}

}  // namespace kerf::daemon
