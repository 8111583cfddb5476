// `kerf plot`: a picture of what a program cuts.

#include "rehearsal/plot.hpp"

#include <cmath>
#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include <fmt/format.h>

#include "apps/case_machine.hpp"
#include "apps/commands.hpp"
#include "apps/drawing_png.hpp"
#include "apps/output.hpp"
#include "common/base/text.hpp"
#include "io/program_file.hpp"

namespace kerf::apps {
namespace {

using rehearsal::PlotOptions;

constexpr int kLeastSide_px = 200;
constexpr int kMostSide_px = 10'000;

struct Size {
  int width_px = 0;
  int height_px = 0;
};

std::optional<Size> parse_size(const std::string& text) {
  const auto parts = base::split(text, 'x');
  const auto side = [](std::string_view part) -> std::optional<int> {
    const auto pixels = base::parse_int<int>(part);
    return pixels && *pixels >= kLeastSide_px && *pixels <= kMostSide_px ? pixels : std::nullopt;
  };
  const auto width = side(parts.front());
  const auto height = side(parts.back());
  if (parts.size() == 2 && width && height) return Size{.width_px = *width, .height_px = *height};
  complain(fmt::format("'{}' is no size of a picture: write width and height in pixels, {} to {}, such as 1200x900.",
                       text, kLeastSide_px, kMostSide_px));
  return std::nullopt;
}

/// The picture's bytes, in the kind that the file's name ends with.
std::optional<std::string> picture_of(const rehearsal::Drawing& drawing, bool is_png) {
  return is_png ? to_png(drawing) : rehearsal::to_svg(drawing);
}

}  // namespace

ExitStatus plot(const PlotCommandOptions& options) {
  std::string extension = std::filesystem::path(options.output).extension().string();
  for (char& letter : extension) letter = base::to_upper(letter);
  const bool is_png = extension == ".PNG";
  if (!is_png && extension != ".SVG") {
    complain(fmt::format("'{}' is no name of a picture: end it with .svg or .png.", options.output));
    return ExitStatus::Usage;
  }
  const auto size = parse_size(options.size);
  if (!size) return ExitStatus::Usage;
  const auto file = io::ProgramFile::load(options.file);
  if (!file) {
    complain(io::explain(file.error(), options.file));
    return ExitStatus::Usage;
  }
  const auto machine = load_case_machine(options.machine);
  if (!machine) return ExitStatus::Usage;
  const std::string_view text = file->program()->text();
  const auto start = rehearsal::path_start_of(*machine);
  const auto path = rehearsal::summarize(text, start);
  if (path.cut_count + path.rapid_count == 0) {
    complain(fmt::format("{} moves nothing that could be drawn{}.", options.file,
                         path.refused_lines > 0 ? ": its lines would be refused, 'kerf estimate' says why" : ""));
    return ExitStatus::Usage;
  }
  const PlotOptions wanted{.view = options.view,
                           .colour = options.colour,
                           .width_px = static_cast<double>(size->width_px),
                           .height_px = static_cast<double>(size->height_px),
                           .title = std::filesystem::path(options.file).filename().string()};
  const auto drawings = rehearsal::plot(text, start, path, std::span{&wanted, 1});
  const auto picture = picture_of(drawings.front(), is_png);
  if (!picture) {
    complain(fmt::format("There is not enough memory for a picture of {}: ask for a smaller one.", options.size));
    return ExitStatus::Usage;
  }
  if (const auto written = io::replace_text_file(options.output, *picture); !written) {
    complain(io::explain(written.error(), options.output));
    return ExitStatus::Usage;
  }
  put("{}: {} x {} pixels, {} cuts and {} rapids of {}.\n", options.output, drawings.front().width_px,
      std::round(drawings.front().height_px), path.cut_count, path.rapid_count, options.file);
  if (path.refused_lines > 0) {
    complain(fmt::format("{} line{} of {} would be refused by this firmware and {} not drawn: see 'kerf estimate {}'.",
                         path.refused_lines, path.refused_lines > 1 ? "s" : "", options.file,
                         path.refused_lines > 1 ? "are" : "is", options.file));
    return ExitStatus::Refused;
  }
  return ExitStatus::Done;
}

}  // namespace kerf::apps
