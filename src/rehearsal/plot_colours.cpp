#include "rehearsal/plot_colours.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace kerf::rehearsal {
namespace {

/// Told apart by people who see colours differently, too (after Okabe and Ito, darkened for white paper).
constexpr std::array<Rgb, 8> kCategories = {0x1D5FAA, 0xD1541B, 0x0F8A64, 0x8A3FA0,
                                            0xB07A00, 0xC2255C, 0x1389A5, 0x5C4A3D};
/// Viridis without its light end: even steps of lightness, dark is low.
constexpr std::array<Rgb, 7> kScale = {0x440154, 0x453781, 0x33638D, 0x238A8D, 0x29AF7F, 0x5CC863, 0x9BC53D};
constexpr Rgb kOthers = 0x868E96;
constexpr std::size_t kScaleLayers = 12;

double part(Rgb colour, unsigned shift) {
  return static_cast<double>((colour >> shift) & 0xFFU);
}

}  // namespace

Rgb category_colour(std::size_t index) {
  return index < PathColours::kMostLayers - 1 ? kCategories.at(index % kCategories.size()) : kOthers;
}

Rgb scale_colour(double share) {
  const double place = std::clamp(share, 0.0, 1.0) * static_cast<double>(kScale.size() - 1);
  const auto lower = std::min(static_cast<std::size_t>(place), kScale.size() - 2);
  const double rest = place - static_cast<double>(lower);
  Rgb mixed = 0;
  for (const unsigned shift : {16U, 8U, 0U}) {
    const double value = std::lerp(part(kScale.at(lower), shift), part(kScale.at(lower + 1), shift), rest);
    mixed |= static_cast<Rgb>(std::lround(value)) << shift;
  }
  return mixed;
}

PlotColour telling_colour(const PathSummary& path) {
  if (path.operations.size() > 1) return PlotColour::Operation;
  if (path.tools.size() > 1) return PlotColour::Tool;
  const double depth = static_cast<double>(path.cuts.size_mm(2));
  return depth > 0 || path.feed_mm_per_min.size() <= 0 ? PlotColour::Height : PlotColour::Feed;
}

PathColours::PathColours(const PathSummary& path, PlotColour by) : by_(by) {
  const auto add = [this](std::size_t number, std::string name) {
    const std::size_t layer = std::min(legend_.size(), kMostLayers - 1);
    layer_by_number_.resize(std::max(layer_by_number_.size(), number + 1), 0);
    layer_by_number_[number] = layer;
    legend_.push_back({.name = std::move(name), .colour = category_colour(layer)});
    if (colours_.size() <= layer) colours_.push_back(category_colour(layer));
  };
  switch (by) {
    case PlotColour::Operation:
      for (const std::uint16_t operation : path.operations) {
        const std::string& name = path.operation_names.at(operation);
        add(operation, name.empty() ? (path.operations.size() > 1 ? "Before the first" : "Cut") : name);
      }
      break;
    case PlotColour::Tool:
      for (const ToolUse& tool : path.tools) {
        add(tool.number, tool.number == 0 && path.tools.size() == 1 ? "Cut" : "T" + std::to_string(tool.number));
      }
      break;
    case PlotColour::Feed: colour_by_scale(path.feed_mm_per_min); break;
    case PlotColour::Height: {
      Extent heights;
      if (!path.cuts.is_empty()) {
        heights.include(static_cast<double>(path.cuts.least_mm[2]));
        heights.include(static_cast<double>(path.cuts.most_mm[2]));
      }
      colour_by_scale(heights);
      for (std::size_t layer = 1; layer < colours_.size(); ++layer) {
        const double share = static_cast<double>(layer) / static_cast<double>(colours_.size());
        height_steps_mm_.push_back(std::lerp(scale_.least, scale_.most, share));
      }
      break;
    }
  }
  if (colours_.empty()) colours_.push_back(category_colour(0));
}

void PathColours::colour_by_scale(const Extent& extent) {
  scale_ = extent;
  const std::size_t layers = extent.size() > 0 ? kScaleLayers : 1;
  for (std::size_t layer = 0; layer < layers; ++layer) {
    const double share = layers > 1 ? static_cast<double>(layer) / static_cast<double>(layers - 1) : 0.25;
    colours_.push_back(scale_colour(share));
  }
}

std::size_t PathColours::layer_of(const PathVertex& cut, double height_mm) const {
  const auto by_number = [this](std::size_t number) {
    return number < layer_by_number_.size() ? layer_by_number_[number] : 0;
  };
  const auto by_scale = [this](double value) {
    if (scale_.size() <= 0) return std::size_t{0};
    const double share = std::clamp((value - scale_.least) / scale_.size(), 0.0, 1.0);
    return std::min(static_cast<std::size_t>(share * static_cast<double>(layers())), layers() - 1);
  };
  switch (by_) {
    case PlotColour::Operation: return by_number(cut.operation);
    case PlotColour::Tool: return by_number(cut.tool);
    case PlotColour::Feed: return by_scale(static_cast<double>(cut.feed_mm_per_min));
    case PlotColour::Height: break;
  }
  return by_scale(height_mm);
}

std::string PathColours::legend_title() const {
  switch (by_) {
    case PlotColour::Operation: return "Operations";
    case PlotColour::Tool: return "Tools";
    case PlotColour::Feed: return "Feed, mm/min";
    case PlotColour::Height: break;
  }
  return "Height (Z), mm";
}

}  // namespace kerf::rehearsal
