#include "apps/transform_steps.hpp"

#include <array>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "common/base/text.hpp"
#include "io/text_file.hpp"
#include "sender/job/program_start.hpp"

namespace kerf::apps {
namespace {

using rehearsal::TransformStep;
using Parsed = std::optional<TransformStep>;

/// `1,2.5`: `least` to `most` numbers.
std::optional<std::vector<double>> numbers(std::string_view text, std::size_t least, std::size_t most) {
  std::vector<double> values;
  for (const std::string_view part : base::split(text, ',')) {
    const auto value = base::parse_decimal(base::trim(part));
    if (!value) return std::nullopt;
    values.push_back(*value);
  }
  if (values.size() < least || values.size() > most) return std::nullopt;
  return values;
}

Parsed parse_translate(std::string_view text) {
  const auto by = numbers(text, 2, 3);
  if (!by) return std::nullopt;
  return rehearsal::Translate{.x_mm = (*by)[0], .y_mm = (*by)[1], .z_mm = by->size() > 2 ? (*by)[2] : 0};
}

Parsed parse_rotate(std::string_view text) {
  const auto parts = base::split_at_most(text, '@', 2);
  const auto angle = numbers(parts[0], 1, 1);
  if (!angle) return std::nullopt;
  rehearsal::Rotate rotate{.angle_deg = angle->front()};
  if (parts.size() < 2) return rotate;
  const auto about = numbers(parts[1], 2, 2);
  if (!about) return std::nullopt;
  rotate.about_x_mm = (*about)[0];
  rotate.about_y_mm = (*about)[1];
  return rotate;
}

Parsed parse_mirror(std::string_view text) {
  constexpr std::string_view kAxes = "XYZ";
  const auto parts = base::split_at_most(text, '@', 2);
  const std::string_view letter = base::trim(parts[0]);
  const auto axis = letter.size() == 1 ? kAxes.find(base::to_upper(letter[0])) : std::string_view::npos;
  if (axis == std::string_view::npos) return std::nullopt;
  const auto at = parts.size() < 2 ? std::vector<double>{0.0} : numbers(parts[1], 1, 1);
  if (!at) return std::nullopt;
  return rehearsal::Mirror{.axis = static_cast<rehearsal::MirrorAxis>(axis), .at_mm = at->front()};
}

Parsed parse_scale(std::string_view text) {
  const auto by = numbers(text, 1, 3);
  if (!by) return std::nullopt;
  if (by->size() == 1) return rehearsal::Scale{.x = (*by)[0], .y = (*by)[0], .z = (*by)[0]};
  return rehearsal::Scale{.x = (*by)[0], .y = (*by)[1], .z = by->size() > 2 ? (*by)[2] : 1};
}

Parsed parse_units(std::string_view text) {
  if (base::iequals(text, "mm")) return rehearsal::ConvertUnits{rehearsal::LengthUnit::Mm};
  if (base::iequals(text, "inch") || base::iequals(text, "in")) {
    return rehearsal::ConvertUnits{rehearsal::LengthUnit::Inch};
  }
  return std::nullopt;
}

Parsed parse_decimals(std::string_view text) {
  const auto decimals = base::parse_int<int>(text);
  if (!decimals) return std::nullopt;
  return rehearsal::TrimDecimals{*decimals};
}

std::optional<double> percent(std::string_view text) {
  if (text.ends_with('%')) text.remove_suffix(1);
  return base::parse_decimal(base::trim(text));
}

Parsed parse_feed(std::string_view text) {
  const auto value = percent(text);
  return value ? Parsed{rehearsal::ScaleFeed{*value}} : std::nullopt;
}

Parsed parse_speed(std::string_view text) {
  const auto value = percent(text);
  return value ? Parsed{rehearsal::ScaleSpeed{*value}} : std::nullopt;
}

Parsed parse_strip(std::string_view) {
  return rehearsal::StripComments{};
}

std::optional<double> tolerance(std::string_view text) {
  return base::parse_decimal(base::trim(text));
}

Parsed parse_arcs_to_lines(std::string_view text) {
  const auto value = tolerance(text);
  return value ? Parsed{rehearsal::ArcsToLines{*value}} : std::nullopt;
}

Parsed parse_lines_to_arcs(std::string_view text) {
  const auto value = tolerance(text);
  return value ? Parsed{rehearsal::LinesToArcs{*value}} : std::nullopt;
}

Parsed parse_passes(std::string_view text) {
  const auto parts = base::split_at_most(text, ',', 2);
  const auto passes = base::parse_int<int>(base::trim(parts[0]));
  const auto step = parts.size() < 2 ? std::optional{0.0} : base::parse_decimal(base::trim(parts[1]));
  if (!passes || !step) return std::nullopt;
  return rehearsal::RepeatDeeper{.passes = *passes, .step_mm = *step};
}

Parsed parse_copies(std::string_view text) {
  rehearsal::CopyToZeros copies;
  for (const std::string_view part : base::split(text, ',')) {
    std::uint8_t zero = 0;
    while (zero < gcode::kMaxWorkOffsets && !base::iequals(base::trim(part), job::work_offset_name(zero))) ++zero;
    if (zero == gcode::kMaxWorkOffsets) return std::nullopt;
    copies.work_offsets.push_back(zero);
  }
  return copies;
}

Parsed parse_from_line(std::string_view text) {
  const auto line = base::parse_int<std::uint32_t>(text);
  return line ? Parsed{rehearsal::RunFromLine{*line}} : std::nullopt;
}

Parsed parse_outline(std::string_view text) {
  const auto parts = base::split_at_most(text, ',', 2);
  rehearsal::Outline outline;
  if (base::iequals(parts[0], "hull")) {
    outline.shape = rehearsal::OutlineShape::Hull;
  } else if (!base::iequals(parts[0], "box")) {
    return std::nullopt;
  }
  if (parts.size() < 2) return outline;
  const auto feed = base::parse_decimal(base::trim(parts[1]));
  if (!feed) return std::nullopt;
  outline.feed_mm_per_min = *feed;
  return outline;
}

/// The only option whose value is the name of a file.
std::expected<TransformStep, std::string> load_heights(const std::string& file) {
  const auto text = io::read_text_file(file);
  if (!text) return std::unexpected{io::explain(text.error(), file)};
  auto map = rehearsal::HeightMap::parse(*text);
  if (!map) return std::unexpected{fmt::format("{}: {}", file, map.error())};
  return rehearsal::FollowHeights{std::make_shared<const rehearsal::HeightMap>(*std::move(map))};
}

struct StepRow {
  std::string_view option;
  Parsed (*parse)(std::string_view text);
  std::string_view form;
};

constexpr std::array kSteps{
    StepRow{"--translate", &parse_translate, "two or three lengths in mm, such as 10,0 or 0,0,-0.5"},
    StepRow{"--rotate", &parse_rotate, "degrees counterclockwise, and a place if it is not the zero: 90 or 15@50,20"},
    StepRow{"--mirror", &parse_mirror, "x, y or z, and where the mirror stands if not at zero: x or x@50"},
    StepRow{"--scale", &parse_scale, "a factor, or one for each axis: 2 or 1.02,1.02 or 1,1,0.5"},
    StepRow{"--units", &parse_units, "mm or inch"},
    StepRow{"--decimals", &parse_decimals, "a whole number, such as 3"},
    StepRow{"--strip-comments", &parse_strip, "nothing"},
    StepRow{"--feed", &parse_feed, "per cent of what the program says, such as 80"},
    StepRow{"--arcs-to-lines", &parse_arcs_to_lines, "a tolerance in mm, such as 0.002"},
    StepRow{"--lines-to-arcs", &parse_lines_to_arcs, "a tolerance in mm, such as 0.002"},
    StepRow{"--passes", &parse_passes, "how many, and how much deeper each, such as 3,0.5"},
    StepRow{"--copies", &parse_copies, "work zeros, such as G54,G55,G56"},
    StepRow{"--from-line", &parse_from_line, "the number of a line, such as 1200"},
    StepRow{"--outline", &parse_outline, "box or hull, and a feed if not 1000 mm/min: box or hull,3000"},
    StepRow{"--speed", &parse_speed, "per cent of what the program says, such as 80"},
};

}  // namespace

namespace {

std::expected<TransformStep, std::string> parse_step(const TransformStepText& text) {
  if (text.option == "--height-map") return load_heights(text.value);
  for (const StepRow& row : kSteps) {
    if (row.option != text.option) continue;
    const Parsed step = row.parse(text.value);
    if (step) return *step;
    return std::unexpected{fmt::format("'{} {}' is not understood: write {}.", row.option, text.value, row.form)};
  }
  return std::unexpected{fmt::format("There is no transform '{}'.", text.option)};
}

}  // namespace

std::expected<std::vector<TransformStep>, std::string> parse_steps(const std::vector<TransformStepText>& texts) {
  std::vector<TransformStep> steps;
  for (const TransformStepText& text : texts) {
    auto step = parse_step(text);
    if (!step) return std::unexpected{std::move(step.error())};
    if (const auto fault = rehearsal::fault_of(*step)) {
      return std::unexpected{fmt::format("'{} {}' cannot be: {}", text.option, text.value, *fault)};
    }
    steps.push_back(*std::move(step));
  }
  return steps;
}

}  // namespace kerf::apps
