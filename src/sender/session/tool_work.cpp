#include "sender/session/tool_work.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <utility>

#include "common/base/text.hpp"
#include "common/vocabulary/axis.hpp"

namespace kerf::session {
namespace {

using vocabulary::MachineState;

constexpr std::size_t kZ = 2;
/// Rounding of reports, and a step.
constexpr double kSamePlaceMm = 0.05;
constexpr int kWayBackFeed = 1000;
constexpr int kDecimals = 3;
/// 0xA3 empties the receive buffer between two passes of the main loop.
constexpr Duration kUntilRead = std::chrono::milliseconds{300};
/// A new offset comes with the report behind it; the first one may have been on its way.
constexpr int kReportsOfNewOffset = 2;

std::string compact(std::string_view text) {
  std::string result;
  for (const char letter : text) {
    if (letter != ' ' && letter != '\t') result += base::to_upper(letter);
  }
  return result;
}

/// Only axis words and numbers, and letters of `also`.
bool holds_only_axes(std::string_view words, std::string_view also) {
  return std::ranges::all_of(words, [also](char letter) {
    return base::is_digit(letter) || letter == '.' || letter == '-' || letter == '+' || also.contains(letter) ||
           vocabulary::kAxisLetters.contains(letter);
  });
}

std::string jog(std::string_view words) {
  return "$J=G21G90G53" + std::string{words} + "F" + std::to_string(kWayBackFeed);
}

std::string word(std::size_t axis, double mm) {
  return vocabulary::kAxisLetters[axis] + base::to_fixed(mm, kDecimals);
}

}  // namespace

void ToolWork::begin(const machine::Snapshot& snapshot) {
  *this = {};
  is_open_ = true;
  work_mm_ = snapshot.work_position_mm;
}

std::string ToolWork::why_not(std::string_view text) {
  static constexpr std::array<std::string_view, 6> kWhole{"$TPW", "$TLR", "$#", "$G", "$I", "G49"};
  const std::string line = compact(text);
  if (line.starts_with("$J=")) return {};
  if (line.starts_with("G10L") && holds_only_axes(line.substr(4), "P")) return {};
  if (line.starts_with("G43.1") && holds_only_axes(line.substr(5), "")) return {};
  if (std::ranges::find(kWhole, line) != kWhole.end()) return {};
  return "The job waits for a tool: until it goes on, only jogs ($J=), G10, G43.1, G49, $TPW, $TLR and questions can "
         "be "
         "sent, which leave the modes of the program as they are.";
}

bool ToolWork::on_line(Instant now, const machine::Snapshot& snapshot) {
  has_worked_ = true;
  reports_since_answer_ = 0;
  if (snapshot.state != MachineState::Tool || std::exchange(is_read_, true)) return false;
  reads_from_ = now + kUntilRead;
  return true;
}

void ToolWork::advance_to(Instant now) {
  if (now >= reads_from_) reads_from_ = kNever;
}

void ToolWork::on_answer() {
  reports_since_answer_ = 0;
}

void ToolWork::on_report() {
  reports_since_answer_ = std::min(reports_since_answer_ + 1, kReportsOfNewOffset);
}

std::optional<std::vector<std::string>> ToolWork::way_back(const machine::Snapshot& snapshot) const {
  std::vector<std::string> lines;
  if (!has_worked_) return lines;
  const auto& now = snapshot.machine_position_mm;
  const auto& offset = snapshot.work_offset_mm;
  const bool is_known = work_mm_ && now && offset && now->size() > kZ && now->size() == work_mm_->size() &&
                        offset->size() >= now->size() && reports_since_answer_ >= kReportsOfNewOffset;
  if (!is_known) return std::nullopt;
  std::vector<double> target;
  for (std::size_t axis = 0; axis < now->size(); ++axis) target.push_back((*work_mm_)[axis] + (*offset)[axis]);
  const auto differs = [&](std::size_t axis, double from) { return std::abs(target[axis] - from) > kSamePlaceMm; };

  std::string along;
  for (std::size_t axis = 0; axis < now->size(); ++axis) {
    if (axis != kZ && differs(axis, (*now)[axis])) along += word(axis, target[axis]);
  }
  double height = (*now)[kZ];
  if (target[kZ] > height && differs(kZ, height)) {
    lines.push_back(jog(word(kZ, target[kZ])));
    height = target[kZ];
  }
  if (!along.empty()) lines.push_back(jog(along));
  if (differs(kZ, height)) lines.push_back(jog(word(kZ, target[kZ])));
  return lines;
}

}  // namespace kerf::session
