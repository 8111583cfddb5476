#pragma once
// The state document with its number: every change makes the next patch, and whoever knows an older number gets the
// patches since, or all of it. Pure.

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "io/json.hpp"

namespace kerf::daemon {

using io::Json;

/// The merge patch (RFC 7396) that makes `after` of `before`; both are objects without null members.
[[nodiscard]] Json merge_difference(const Json& before, const Json& after);

/// A frame as it goes to clients, shared by all of them.
using Frame = std::shared_ptr<const std::string>;

[[nodiscard]] Frame frame_of(const Json& json);

class StateFeed {
 public:
  /// A part of the document, which is an object by names: "machines", "programs". A null removes.
  void set(const std::string& part, const std::string& name, Json value);
  void set(const std::string& part, Json value) { state_[part] = std::move(value); }

  /// What has changed since the last time, as a patch with the next number; null when nothing has.
  [[nodiscard]] Frame publish(double clock_s);

  /// Of the last patch.
  [[nodiscard]] std::uint64_t number() const { return number_; }
  /// As it was at that number.
  [[nodiscard]] const Json& state() const { return published_; }
  [[nodiscard]] Frame snapshot(double clock_s) const;
  /// The patches behind `number`; nothing where they are not all known any more.
  [[nodiscard]] std::optional<std::vector<Frame>> since(std::uint64_t number) const;

 private:
  Json state_ = Json::object();
  Json published_ = Json::object();
  std::uint64_t number_ = 0;
  /// The last one led to `number_`.
  std::deque<Frame> recent_;
};

}  // namespace kerf::daemon
