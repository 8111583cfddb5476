// The command line of `kerf transform`: the order of its options is the order of the transforms.

#include <algorithm>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "apps/command_line.hpp"
#include "apps/commands.hpp"

namespace kerf::apps {
namespace {

struct StepOption {
  const char* name;
  const char* type;
  const char* text;
  const char* group;
};

constexpr const char* kPlace = "Where the job lies";
constexpr const char* kForm = "How it is written";
constexpr const char* kWork = "How it works";

constexpr StepOption kSteps[] = {
    {"--translate", "X,Y[,Z]", "Move the job by so many mm", kPlace},
    {"--rotate", "DEG[@X,Y]", "Turn it counterclockwise about work zero, or about a place", kPlace},
    {"--mirror", "x|y|z[@MM]", "Left becomes right (x), at work zero or at a place", kPlace},
    {"--scale", "F|FX,FY[,FZ]", "Make it larger or smaller; feeds stay", kPlace},
    {"--copies", "G54,G55,...", "The job once at each of these work zeros", kPlace},
    {"--height-map", "GRID", "Follow a measured surface: a file with lines of x,y,z on a grid, in work coordinates",
     kPlace},
    {"--passes", "N[,MM]", "The job N times, each time so much deeper; rapids stay where they are", kWork},
    {"--from-line", "N", "Only the rest from this line on, with modes, spindle and a safe way there in front", kWork},
    {"--outline", "box|hull[,FEED]", "Only a way around the job, above it, with the spindle off", kWork},
    {"--feed", "PERCENT", "Scale all feeds", kWork},
    {"--speed", "PERCENT", "Scale all spindle speeds or laser powers", kWork},
    {"--units", "mm|inch", "Write it in the other unit", kForm},
    {"--arcs-to-lines", "MM", "Chords within this tolerance in place of G2 and G3", kForm},
    {"--lines-to-arcs", "MM", "Arcs within this tolerance in place of runs of short lines", kForm},
    {"--decimals", "N", "At most so many decimals, and no zeros at the end", kForm},
};

/// CLI11 keeps the values by option, and the order apart.
void keep_order(const CLI::App& command, TransformOptions& options) {
  std::map<const CLI::Option*, std::size_t> taken;
  options.steps.clear();
  for (const CLI::Option* option : command.parse_order()) {
    const std::string name = option->get_name();
    const bool is_step = name == "--strip-comments" ||
                         std::ranges::any_of(kSteps, [&](const StepOption& step) { return name == step.name; });
    if (!is_step) continue;
    const std::size_t at = taken[option]++;
    const auto& values = option->results();
    options.steps.push_back({.option = name, .value = at < values.size() ? values[at] : std::string{}});
  }
}

}  // namespace

void add_transform(CLI::App& kerf, Chosen& chosen) {
  auto options = std::make_shared<TransformOptions>();
  CLI::App* command =
      kerf.add_subcommand("transform", "Make another program out of a program: moved, turned, scaled ...");
  command->add_option("FILE", options->file, "The G-code file")->required()->type_name("");
  for (const StepOption& step : kSteps) {
    command->add_option(step.name, step.text)
        ->type_name(step.type)
        ->group(step.group)
        ->take_all()
        ->allow_extra_args(false);
  }
  command->add_flag("--strip-comments")->description("Take comments away, and lines with nothing else")->group(kForm);
  command->add_option("-o,--output", options->output, "Write to this file; else to standard output")->type_name("OUT");
  command->add_flag("--split-tools", options->splits_tools,
                    "A file for each tool: OUT-T1.nc, OUT-T2.nc ... in place of OUT.nc; comes last");
  command->add_flag("--preview", options->previews, "Only say what would change; write nothing");
  command->add_option("-p,--personality", options->personality, "The firmware whose rules the file is read with")
      ->type_name("NAME")
      ->capture_default_str();
  command->footer(
      "\nTransforms are done in the order in which they stand; each may stand more than once.\n"
      "  kerf transform part.nc --rotate 90 --translate 100,0 -o turned.nc\n"
      "Exit status 3: the program cannot be transformed truthfully, and nothing was written.\n");
  command->callback([&chosen, options, command] {
    keep_order(*command, *options);
    chosen = [options] { return transform(*options); };
  });
}

}  // namespace kerf::apps
