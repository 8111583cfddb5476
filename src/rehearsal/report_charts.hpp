#pragma once
// Small pictures of a report's numbers.

#include <vector>

#include "rehearsal/drawing.hpp"
#include "rehearsal/job_estimate.hpp"
#include "rehearsal/plot_colours.hpp"

namespace kerf::rehearsal {

/// A part of a whole, with its colour.
struct Share {
  std::string name;
  double seconds = 0;
  Rgb colour = 0;
};

/// What the time is spent on; what takes no time is left out.
[[nodiscard]] std::vector<Share> shares_of(const UseOfTime& use);

/// One bar, divided.
[[nodiscard]] Drawing draw_shares(const std::vector<Share>& shares, double width_px);

/// A bar for each range of feeds, as high as the time that is spent in it.
[[nodiscard]] Drawing draw_feeds(const std::vector<FeedBin>& feeds, double width_px);

/// The scale of a picture's colours with its ends.
[[nodiscard]] Drawing draw_scale(const PathColours& colours, double width_px);

/// A bar in a row of a table: `share` of its width is filled.
[[nodiscard]] Drawing draw_bar(double share, Rgb colour);

}  // namespace kerf::rehearsal
