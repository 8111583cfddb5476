// The command line of `kerf plot` and `kerf report`, and the machine that programs are rehearsed on.

#include <map>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>

#include "apps/command_line.hpp"
#include "apps/commands.hpp"
#include "firmware/personality.hpp"

namespace kerf::apps {

void add_virtual_machine(CLI::App& command, CaseMachineOptions& machine) {
  command
      .add_option("-p,--personality", machine.personality,
                  "Which firmware the machine runs: " + firmware::personality_names())
      ->type_name("NAME")
      ->capture_default_str();
  command.add_option("--settings", machine.settings_file, "The machine has the $n=value lines of this file")
      ->type_name("FILE");
}

void add_plot(CLI::App& kerf, Chosen& chosen) {
  using rehearsal::PlotColour;
  using rehearsal::PlotView;
  static const std::map<std::string, PlotView> kViews{
      {"top", PlotView::Top}, {"front", PlotView::Front}, {"side", PlotView::Side}, {"isometric", PlotView::Isometric}};
  static const std::map<std::string, PlotColour> kColours{{"operation", PlotColour::Operation},
                                                          {"tool", PlotColour::Tool},
                                                          {"feed", PlotColour::Feed},
                                                          {"height", PlotColour::Height}};
  auto options = std::make_shared<PlotCommandOptions>();
  CLI::App* command = kerf.add_subcommand("plot", "Draw what a program cuts, for the screen or for print");
  command->add_option("FILE", options->file, "The G-code file")->required()->type_name("");
  command->add_option("-o,--output", options->output, "The picture: a name that ends with .svg or .png")
      ->required()
      ->type_name("PICTURE");
  command->add_option("--view", options->view, "From where: isometric unless told otherwise")
      ->transform(CLI::CheckedTransformer(kViews).description(""))
      ->type_name("top|front|side|isometric");
  command
      ->add_option("--colour,--color", options->colour,
                   "What colours tell: by default operations, or tools, or heights, whichever tells more")
      ->transform(CLI::CheckedTransformer(kColours).description(""))
      ->type_name("operation|tool|feed|height");
  command->add_option("--size", options->size, "Pixels")->type_name("WxH")->capture_default_str();
  add_virtual_machine(*command, options->machine);
  command->footer(
      "\nRapids are dashed. Places are measured from work zero. Exit status 3: lines that this firmware refuses are "
      "not "
      "drawn.\n");
  command->callback([&chosen, options] { chosen = [options] { return plot(*options); }; });
}

void add_report(CLI::App& kerf, Chosen& chosen) {
  auto options = std::make_shared<ReportOptions>();
  CLI::App* command =
      kerf.add_subcommand("report", "Write a page about a job: pictures, times, findings, tools, limits");
  command->add_option("FILE", options->file, "The G-code file")->required()->type_name("");
  command->add_option("-o,--output", options->output, "The page, such as report.html")->required()->type_name("PAGE");
  add_virtual_machine(*command, options->virtual_machine);
  command->add_option("-m,--machine", options->machine, "Ask this machine for its firmware and settings; nothing moves")
      ->type_name("URL")
      ->excludes("--personality")
      ->excludes("--settings");
  add_recording(*command, options->recording);
  command->footer(
      "\nThe page needs neither network nor scripts, and is laid out for A4. Exit status as of 'kerf check': 0 nothing "
      "to "
      "worry about, 6 warnings, 3 errors.\n");
  command->callback([&chosen, options] { chosen = [options] { return report(*options); }; });
}

}  // namespace kerf::apps
