// What the API tells of programs.

#include <algorithm>
#include <optional>
#include <utility>

#include "common/base/text.hpp"
#include "daemon/api.hpp"
#include "daemon/api_replies.hpp"
#include "preparation/check_text.hpp"
#include "preparation/estimate_grades.hpp"
#include "preparation/rehearsal.hpp"
#include "rehearsal/check.hpp"
#include "rehearsal/toolpath_stream.hpp"
#include "simulation/machine_like.hpp"

namespace kerf::daemon {
namespace {

using io::web::Answer;
using io::web::HttpReply;
using io::web::HttpRequest;

constexpr std::uint32_t kMostTextLines = 5000;
constexpr std::size_t kMostMarks = 5000;

HttpReply not_found(std::string sentence) {
  return error_reply(404, "NotFound", std::move(sentence));
}

std::optional<std::uint32_t> number_in(const HttpRequest& request, const std::string& name, std::uint32_t otherwise) {
  const auto text = request.parameter(name);
  if (!text) return otherwise;
  return base::parse_int<std::uint32_t>(*text);
}

/// What a program is measured by: a machine that is known, or a stock one.
simulation::CaseMachine machine_for(const session::Session* session) {
  if (session != nullptr && session->capabilities().family != vocabulary::Firmware::Unknown) {
    return simulation::machine_like(session->capabilities());
  }
  return {.personality = firmware::personality_of(vocabulary::Firmware::GrblHal)};
}

class ToolpathSource final : public io::web::BodySource {
 public:
  ToolpathSource(SharedProgram program, const simulation::CaseMachine& machine)
      : program_(std::move(program)),
        stream_(program_->file.program()->text(), rehearsal::path_start_of(machine), program_->id) {}
  [[nodiscard]] std::optional<std::string> next() override { return stream_.next(); }

 private:
  const SharedProgram program_;
  rehearsal::ToolpathStream stream_;
};

Json thinned_timeline(const job::Timeline& timeline) {
  Json lines = Json::array();
  Json ends = Json::array();
  const std::size_t count = timeline.end_s.size();
  const std::size_t step = std::max<std::size_t>(1, count / kMostMarks);
  for (std::size_t at = 0; at < count; at += step) {
    lines.push_back(at + 1);
    ends.push_back(timeline.end_s[at]);
  }
  if (count > 0 && lines.back() != count) {
    lines.push_back(count);
    ends.push_back(timeline.end_s.back());
  }
  return {{"lines", std::move(lines)}, {"end_s", std::move(ends)}};
}

}  // namespace

void Api::get_text(const ApiCall& call, const Answer& answer) {
  const auto first = number_in(call.request, "first", 1);
  const auto count = number_in(call.request, "count", 500);
  if (!first || !count || *first == 0 || *count > kMostTextLines) {
    return answer(error_reply(400, "BadRequest", "`first` counts from 1, and `count` is at most 5000."));
  }
  library_.open_program(call.places.front(),
                        [answer, first = *first, count = *count](const ProgramLibrary::Opened& opened) {
                          if (!opened) return answer(not_found(opened.error()));
                          const job::Program& program = *(*opened)->file.program();
                          ProgramText reply{.first = first, .total = program.line_count(), .lines = {}};
                          for (auto line = program.line(first); line && reply.lines.size() < count;
                               line = program.line_at(program.offset_after(*line), line->number + 1)) {
                            reply.lines.emplace_back(line->text);
                          }
                          answer(json_reply(io::to_json(reply)));
                        });
}

void Api::get_toolpath(const ApiCall& call, const Answer& answer) {
  const auto machine = call.request.parameter("machine");
  const Station* const station = machine ? park_.find(*machine) : nullptr;
  library_.open_program(call.places.front(),
                        [answer, on = machine_for(station == nullptr ? nullptr : station->session())](
                            const ProgramLibrary::Opened& opened) {
                          if (!opened) return answer(not_found(opened.error()));
                          answer({.content_type = "application/octet-stream",
                                  .headers = {{"Cache-Control", "no-store"}},
                                  .body = std::make_shared<ToolpathSource>(*opened, on)});
                        });
}

void Api::get_check(const ApiCall& call, const Answer& answer) {
  const auto machine = call.request.parameter("machine");
  const Station* const station = machine ? park_.find(*machine) : nullptr;
  const session::Session* const session = station == nullptr ? nullptr : station->session();
  const bool is_known = session != nullptr && session->capabilities().family != vocabulary::Firmware::Unknown;
  auto on = is_known ? rehearsal::check_machine_of(session->capabilities(), session->snapshot())
                     : rehearsal::check_machine_of(machine_for(nullptr));
  const std::string firmware = is_known ? session->capabilities().firmware : "grblHAL";
  library_.open_program(
      call.places.front(), [this, answer, on = std::move(on), firmware](const ProgramLibrary::Opened& opened) {
        if (!opened) return answer(not_found(opened.error()));
        pool_.run([answer, on, firmware, program = *opened]() -> std::function<void()> {
          const auto result = rehearsal::check_program(*program->file.program(), on);
          return [answer, reply = json_reply(preparation::check_json(result, firmware))] { answer(reply); };
        });
      });
}

void Api::get_estimate(const ApiCall& call, const Answer& answer) {
  const auto machine = call.request.parameter("machine");
  const Station* const station = machine ? park_.find(*machine) : nullptr;
  const session::Session* const session = station == nullptr ? nullptr : station->session();
  auto known = std::make_shared<const machine::Capabilities>(session == nullptr ? machine::Capabilities{}
                                                                                : session->capabilities());
  library_.open_program(
      call.places.front(), [this, answer, known, on = machine_for(session)](const ProgramLibrary::Opened& opened) {
        if (!opened) return answer(not_found(opened.error()));
        pool_.run([answer, known, on, program = *opened]() -> std::function<void()> {
          Json estimate = preparation::estimate_json(preparation::grades_of(*program->file.program(), on));
          const auto timeline = preparation::rehearse(*program->file.program(), *known, 1.0);
          if (timeline != nullptr) estimate["timeline"] = thinned_timeline(*timeline);
          return [answer, reply = json_reply(estimate)] { answer(reply); };
        });
      });
}

void Api::delete_program(const ApiCall& call, const Answer& answer) {
  const std::string& id = call.places.front();
  for (const auto& [name, station] : park_.stations()) {
    if (station->has_loaded(id)) {
      return answer(error_reply(409, "InUse", "The program is loaded on " + station->row().name + "."));
    }
  }
  const auto removed = library_.remove(id);
  answer(removed ? json_reply(Json::object()) : not_found(removed.error()));
}

}  // namespace kerf::daemon
