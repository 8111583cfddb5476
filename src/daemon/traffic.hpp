#pragma once
// The last lines that went over a link, decoded, for whoever watches a console.

#include <cstdint>
#include <deque>
#include <string>
#include <utility>

#include <boost/describe.hpp>

#include "sender/session/event.hpp"

namespace kerf::daemon {

enum class TrafficDirection { Sent, Received };
BOOST_DESCRIBE_ENUM(TrafficDirection, Sent, Received)

/// `meaning` is what Kerf understood, in words, where there is more to say than the line itself.
struct TrafficLine {
  std::uint64_t number = 0;
  double at_s = 0;
  TrafficDirection direction{};
  std::string text{};
  std::string purpose{};
  std::string meaning{};
};
BOOST_DESCRIBE_STRUCT(TrafficLine, (), (number, at_s, direction, text, purpose, meaning))

class Traffic {
 public:
  void add(Instant at, const session::LineSent& line);
  void add(Instant at, const session::LineReceived& line);

  [[nodiscard]] const std::deque<TrafficLine>& lines() const { return lines_; }
  /// Of the newest.
  [[nodiscard]] std::uint64_t number() const { return number_; }

 private:
  void add(TrafficLine line);

  std::uint64_t number_ = 0;
  std::deque<TrafficLine> lines_;
};

}  // namespace kerf::daemon
