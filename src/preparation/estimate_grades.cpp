#include "preparation/estimate_grades.hpp"

#include <cmath>
#include <utility>

namespace kerf::preparation {
namespace {

using io::Json;
using rehearsal::JobEstimate;

/// Microseconds and micrometres are more than anybody needs.
double rounded(double value) {
  constexpr double kMillion = 1e6;
  return std::round(value * kMillion) / kMillion;
}

Json refused_json(const JobEstimate& estimate) {
  Json refused = Json::array();
  for (const auto& error : estimate.errors) refused.push_back({{"line", error.line}, {"code", error.code}});
  return refused;
}

}  // namespace

Grades grades_of(const job::Program& program, const simulation::CaseMachine& machine, simulation::ProgramLink link) {
  Grades grades{.planner = rehearsal::estimate_job(program, machine)};
  if (link.baud) {
    grades.world = rehearsal::estimate_job(program, machine, link);
    grades.losses = rehearsal::lost_on_the_link(grades.planner, *grades.world);
  }
  return grades;
}

io::Json estimate_json(const Grades& grades) {
  const JobEstimate& planner = grades.planner;
  Json json = Json::object();
  json["total_s"] = rounded(planner.total_s);
  json["grade"] = "planner";
  if (grades.world) {
    Json world = Json::object();
    world["total_s"] = rounded(grades.world->total_s);
    world["lost"] = io::to_json(grades.losses);
    json["world"] = std::move(world);
  }
  json["use"] = io::to_json(planner.use);
  json["cutting_mm"] = rounded(planner.cutting_mm);
  json["rapid_mm"] = rounded(planner.rapid_mm);
  json["tools"] = io::to_json(planner.tools);
  json["operations"] = io::to_json(planner.operations);
  json["feeds"] = io::to_json(planner.feeds);
  json["stops"] = planner.stops;
  json["refused"] = refused_json(planner);
  json["alarms"] = planner.alarms;
  json["blocks"] = planner.blocks;
  json["lines"] = planner.lines;
  json["lines_answered"] = planner.lines_answered;
  return json;
}

}  // namespace kerf::preparation
