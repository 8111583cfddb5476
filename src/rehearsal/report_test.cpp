#include "rehearsal/report.hpp"

#include <array>

#include <gmock/gmock.h>

#include "rehearsal/plot.hpp"

namespace kerf::rehearsal {
namespace {

using testing::HasSubstr;
using testing::Not;
using vocabulary::Firmware;

std::string report_of(std::string name, std::string text, Firmware firmware = Firmware::GrblHal) {
  simulation::CaseMachine machine{.personality = firmware::personality_of(firmware)};
  machine.stored.initialised = true;
  const auto program = *job::Program::load(name, std::move(text));
  const auto start = path_start_of(machine);
  const auto facts = check_machine_of(machine);
  Report report{.file = {.name = name,
                         .hash = program->hash(),
                         .size_bytes = program->size_bytes(),
                         .lines = program->line_count()},
                .firmware = "grblHAL",
                .settings = "default settings",
                .made_at = "today",
                .made_by = "Kerf",
                .machine = facts,
                .path = summarize(program->text(), start),
                .estimate = estimate_job(*program, machine),
                .check = check_program(*program, facts),
                .pictures = {}};
  const std::array wanted{PlotOptions{.title = name, .is_sheet = false},
                          PlotOptions{.view = PlotView::Top, .title = name, .is_sheet = false}};
  for (auto& drawing : plot(program->text(), start, report.path, wanted)) {
    report.pictures.push_back({.caption = "caption", .drawing = std::move(drawing)});
  }
  return to_html(report);
}

TEST(Report, TellsAllOfAJob) {
  const std::string page = report_of("part.nc",
                                     "G21 G90\n(Toolpath:- Slot)\nT1 M6\nM3 S500\nG0 X0 Y0 Z5\nG1 Z-1 F100\nX20 F300\n"
                                     "(Toolpath:- Round)\nT2 M6\nG0 Z5\nG1 Z-1\nX50\nM0\nG0 Z5\nM30\n");
  for (const auto* words :
       {"<h1>part.nc</h1>", "Findings", "Time", "Operations", "Slot", "Round", "Tools", "T2", "Limits", "XXH3-128",
        "millimetres (G21)", "waits for the operator 3 times", "Programmed feed", "<svg", "Work zero", "size: A4"}) {
    EXPECT_THAT(page, HasSubstr(words));
  }
  EXPECT_THAT(page, Not(HasSubstr("nan")));
  EXPECT_THAT(page, Not(HasSubstr("<script")));
  EXPECT_THAT(page, Not(HasSubstr("src=")));
}

TEST(Report, WhatTheFileSaysStaysText) {
  const std::string evil = "<img src=x onerror=alert(1)>";
  const std::string page =
      report_of(evil + "\"'&.nc", "G21 G90\n(Toolpath:- " + evil + ")\nG1 X1 F100\n(Toolpath:- b" + evil +
                                      ")\nG1 X2\n(MSG," + evil + ")\nG99.7 (" + evil + ")\nM6 T4\n");
  EXPECT_THAT(page, Not(HasSubstr("<img")));
  EXPECT_THAT(page, HasSubstr("&lt;img"));
}

TEST(Report, ErrorsAreOnTop) {
  const std::string page = report_of("bad.nc", "G21 G90\nG1 X1\nG99.7\n");
  EXPECT_THAT(page, HasSubstr("verdict error"));
  EXPECT_THAT(page, HasSubstr("finding is-error"));
}

TEST(Report, AProgramWithoutMotionHasOneToo) {
  EXPECT_THAT(report_of("still.nc", "M3 S100\nG4 P1\nM5\n"), HasSubstr("still.nc"));
}

}  // namespace
}  // namespace kerf::rehearsal
