// What clients ask of a machine, and what becomes of it.

#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "common/base/text.hpp"
#include "daemon/station.hpp"
#include "io/journal_database.hpp"
#include "io/journal_store.hpp"
#include "io/settings_archive.hpp"
#include "preparation/checked_job.hpp"
#include "preparation/resume_preparation.hpp"
#include "sender/session/refusals.hpp"

namespace kerf::daemon {
namespace {

/// Without limits that the machine tells, a pace that no machine minds.
constexpr double kCarefulFeed = 500;
/// Above the work zero, where nobody knows where the top is.
constexpr double kClearanceMm = 5;

CommandAnswer refused(std::string reason, std::string sentence) {
  return {.outcome = Outcome::Refused, .reason = std::move(reason), .sentence = std::move(sentence)};
}
CommandAnswer invalid(std::string reason, std::string sentence) {
  return {.outcome = Outcome::Invalid, .reason = std::move(reason), .sentence = std::move(sentence)};
}
CommandAnswer not_connected() {
  return refused("NotConnected", "The machine is not connected.");
}

bool is_feed(double feed) {
  return std::isfinite(feed) && feed > 0;
}

/// "X10.000Y-5.000"; empty where an axis is not of `axes`, or a number is none.
std::string words_of(const std::map<std::string, double>& by_axis, std::string_view axes) {
  constexpr double kFarther = 1e5;
  std::string words;
  for (const auto& [letter, value] : by_axis) {
    if (letter.size() != 1 || !axes.contains(letter.front()) || !(std::abs(value) < kFarther)) return {};
    words += letter + base::to_fixed(value, 3);
  }
  return words;
}

std::string feed_word(double feed) {
  return "F" + base::to_fixed(feed, 0);
}

bool is_system(std::string_view name) {
  constexpr std::array<std::string_view, 9> kSystems{"G54", "G55",   "G56",   "G57",  "G58",
                                                     "G59", "G59.1", "G59.2", "G59.3"};
  return std::ranges::find(kSystems, name) != kSystems.end();
}

/// P of G10: 1 for G54.
int number_of_system(std::string_view name) {
  if (name.size() > 3) return 6 + (name.back() - '0');
  return name[2] - '3';
}

}  // namespace

CommandAnswer Station::obey(const Command& command) {
  CommandAnswer answer = std::visit([this](const auto& known) { return do_it(known); }, command);
  callbacks_.changed();
  return answer;
}

CommandAnswer Station::submit(const session::Command& command) {
  if (!host_) return not_connected();
  refusal_.reset();
  host_->submit(command);
  const auto refusal = std::exchange(refusal_, std::nullopt);
  if (!refusal) return {};
  return refused(boost::describe::enum_to_string(refusal->reason, "?"), refusal->sentence);
}

CommandAnswer Station::do_it(const Connect&) {
  if (phase_ == LinkPhase::Opening || is_ready()) return {};
  attempt_ = 0;
  connect();
  return {};
}

CommandAnswer Station::do_it(const Disconnect&) {
  if (has_job()) return refused("JobUnderWay", "A job is under way; stop it first.");
  disconnect();
  return {};
}

CommandAnswer Station::do_it(const Hold&) {
  end_jog();
  return submit(session::HoldJob{});
}

CommandAnswer Station::do_it(const Resume&) {
  return submit(session::ResumeJob{});
}

CommandAnswer Station::do_it(const Stop&) {
  const bool was_starting = starter_.is_busy();
  starter_.end();
  const bool was_jogging = jog_.is_held();
  end_jog();
  CommandAnswer answer = submit(session::StopJob{});
  // There was something to stop, and it is stopped.
  if ((was_starting || was_jogging) && answer.reason == "NoJob") return {};
  return answer;
}

CommandAnswer Station::do_it(const Abort&) {
  starter_.end();
  jog_.end();
  return submit(session::AbortJob{});
}

CommandAnswer Station::do_it(const SoftReset&) {
  starter_.end();
  jog_.end();
  return submit(session::SoftReset{});
}

CommandAnswer Station::do_it(const Unlock&) {
  return submit(session::Unlock{});
}

CommandAnswer Station::do_it(const Home&) {
  if (starter_.is_busy()) return refused("JobUnderWay", "A job is about to begin; stop it first.");
  return submit(session::Home{});
}

CommandAnswer Station::do_it(const CancelJog&) {
  const bool was_held = jog_.is_held();
  end_jog();
  return was_held ? CommandAnswer{} : submit(session::CancelJog{});
}

CommandAnswer Station::do_it(const TakeControl&) {
  return submit(session::TakeControl{});
}

CommandAnswer Station::do_it(const Load& command) {
  if (is_busy()) return refused("JobUnderWay", "A job is under way; stop it before another program is loaded.");
  if (!services_.library->programs().contains(command.program)) {
    return invalid("NoSuchProgram", "There is no such program in the library.");
  }
  services_.library->open_program(command.program,
                                  [this, alive = std::weak_ptr(alive_)](const ProgramLibrary::Opened& opened) {
                                    if (alive.expired()) return;
                                    if (!opened) {
                                      notes_.add(NoteLevel::Trouble, opened.error());
                                    } else if (!is_busy()) {
                                      program_ = *opened;
                                    }
                                    callbacks_.changed();
                                  });
  return {};
}

CommandAnswer Station::do_it(const Start& command) {
  if (!program_) return refused("NoProgram", "No program is loaded on this machine.");
  if (starter_.is_busy()) return refused("JobUnderWay", "A job is about to begin already.");
  if (!host_) return not_connected();
  if (const auto why = host_->session().why_no_job(services_.loop->now())) {
    return refused(boost::describe::enum_to_string(*why, "?"), session::sentence_of(*why));
  }
  const session::JobOptions options{.optional_stop = command.optional_stop, .block_delete = command.block_delete};
  using Made = std::unique_ptr<preparation::JobPreparation>;
  if (command.from_line && *command.from_line > 1) {
    if (*command.from_line > program_->file.program()->line_count()) {
      return invalid("NoSuchLine",
                     fmt::format("{} has {} lines.", program_->name, program_->file.program()->line_count()));
    }
    starter_.begin(
        "Planning how to begin at line " + std::to_string(*command.from_line) + ".",
        [program = program_, line = *command.from_line]() -> JobStarter::Prepared {
          return preparation::prepare_resume(
              {.file = program->file, .path = program->path, .choice = {.from_line = line}});
        },
        options);
    return {};
  }
  starter_.begin(
      "The program is checked first.",
      [program = program_, options, despite = command.despite_errors]() -> JobStarter::Prepared {
        return Made(preparation::prepare_checked_job({.program = program->file.program(),
                                                      .origin = {.path = program->path},
                                                      .options = options,
                                                      .despite_errors = despite}));
      },
      options);
  return {};
}

CommandAnswer Station::do_it(const Agree&) {
  if (!starter_.asks()) return refused("NoQuestion", "Nothing was asked.");
  starter_.agree();
  return {};
}

CommandAnswer Station::do_it(const Decline&) {
  if (!starter_.view()) return refused("NoQuestion", "Nothing was asked.");
  starter_.end();
  return {};
}

CommandAnswer Station::do_it(const ResumeJob& command) {
  if (is_busy()) return refused("JobUnderWay", "A job is under way; stop it first.");
  if (!host_) return not_connected();
  if (const auto why = host_->session().why_no_job(services_.loop->now());
      why && why != session::Refused::MachineInAlarm) {
    return refused(boost::describe::enum_to_string(*why, "?"), session::sentence_of(*why));
  }
  starter_.begin(
      "Reading what the journal knows of the job.",
      [number = command.job, path = io::journal_path(services_.recording.journal)]() -> JobStarter::Prepared {
        const auto journal = io::JournalDatabase::open_to_read(path);
        if (!journal) return std::unexpected("The journal of jobs cannot be read: " + journal.error().sentence + ".");
        auto work = preparation::find_interrupted_work(*journal, number);
        if (!work) return std::unexpected(work.error());
        const std::string file = work->history.begun.origin.path;
        auto program = io::ProgramFile::load(file, work->history.begun.program);
        if (!program) return std::unexpected(io::explain(program.error(), file));
        const job::JobBegun& begun = work->history.begun;
        const std::string& then = begun.origin.file_hash.empty() ? begun.hash : begun.origin.file_hash;
        if (program->program()->hash() != then) {
          return std::unexpected(begun.program + " is not the file that the job cut: its content has changed since.");
        }
        return preparation::prepare_resume(
            {.file = *std::move(program), .path = file, .work = *std::move(work), .choice = {}});
      },
      {});
  return {};
}

CommandAnswer Station::do_it(const DismissJob& command) {
  if (auto kept = services_.store->dismiss_job(command.job); !kept) return refused("NotKept", kept.error());
  std::erase_if(interrupted_, [&](const auto& row) { return row.number == command.job; });
  return {};
}

CommandAnswer Station::do_it(const JogStep& command) {
  const std::string words = words_of(command.distance, limits_.axes);
  if (words.empty() || !is_feed(command.feed_mm_per_min)) {
    return invalid("BadJog", "A jog needs distances of axes that this machine has, and a feed above 0.");
  }
  return submit(session::Jog{"G91G21" + words + feed_word(command.feed_mm_per_min)});
}

CommandAnswer Station::jog_to(const std::string& words) {
  return submit(session::Jog{words});
}

CommandAnswer Station::do_it(const GoTo& command) {
  if (!host_) return not_connected();
  const machine::Snapshot& now = host_->session().snapshot();
  std::map<std::string, double> along = command.position;
  along.erase("Z");
  if (command.position.empty() || (along.empty() != words_of(along, limits_.axes).empty()) ||
      words_of(command.position, limits_.axes).empty() ||
      (command.feed_mm_per_min && !is_feed(*command.feed_mm_per_min))) {
    return invalid("BadPlace", "A place has positions of axes that this machine has.");
  }
  const std::size_t z = limits_.axes.find('Z');
  const auto feed_of = [&](std::size_t axis) {
    if (command.feed_mm_per_min) return *command.feed_mm_per_min;
    if (!limits_.max_feed_mm_per_min || axis >= limits_.max_feed_mm_per_min->size()) return kCarefulFeed;
    return (*limits_.max_feed_mm_per_min)[axis];
  };
  const std::string frame = command.system == PositionSystem::Machine ? "G90G21G53" : "G90G21";
  std::vector<std::string> moves;
  if (!along.empty() && z != std::string::npos) {
    const bool knows_top = now.homing.all.value_or(false) && limits_.max_mm && z < limits_.max_mm->size();
    const auto& work = now.work_position_mm;
    if (knows_top) {
      // A little below the switch.
      constexpr double kBelowTop = 1;
      const double top = (*limits_.max_mm)[z] - kBelowTop;
      if (now.machine_position_mm && (*now.machine_position_mm)[z] < top) {
        moves.push_back("G90G21G53Z" + base::to_fixed(top, 3) + feed_word(feed_of(z)));
      }
    } else if (work && z < work->size() && (*work)[z] < kClearanceMm) {
      moves.push_back("G90G21Z" + base::to_fixed(kClearanceMm, 3) + feed_word(feed_of(z)));
    }
  }
  if (!along.empty()) {
    double feed = feed_of(limits_.axes.find(along.begin()->first.front()));
    for (const auto& [letter, place] : along) feed = std::min(feed, feed_of(limits_.axes.find(letter.front())));
    moves.push_back(frame + words_of(along, limits_.axes) + feed_word(feed));
  }
  if (const auto down = command.position.find("Z"); down != command.position.end() && z != std::string::npos) {
    moves.push_back(frame + "Z" + base::to_fixed(down->second, 3) + feed_word(feed_of(z)));
  }
  for (const std::string& words : moves) {
    if (CommandAnswer answer = jog_to(words); answer.outcome != Outcome::Accepted) return answer;
  }
  return {};
}

CommandAnswer Station::do_it(const SetZero& command) {
  std::string line = "G10L20P" + std::to_string(command.system ? number_of_system(*command.system) : 0);
  if (command.axes.empty() || (command.system && !is_system(*command.system))) {
    return invalid("BadZero", "Name the axes, such as XY, and a work system from G54 to G59.3.");
  }
  for (const char axis : command.axes) {
    if (!limits_.axes.contains(axis)) return invalid("NoSuchAxis", "This machine does not have all of these axes.");
    line += std::string(1, axis) + "0";
  }
  return send_line(line);
}

CommandAnswer Station::do_it(const SelectSystem& command) {
  if (!is_system(command.system)) return invalid("NoSuchSystem", "Work systems are G54 to G59.3.");
  return send_line(command.system);
}

CommandAnswer Station::do_it(const SendLine& command) {
  if (starter_.is_busy()) return refused("JobUnderWay", "A job is about to begin; stop it first.");
  return send_line(command.text);
}

CommandAnswer Station::do_it(const SetOverride& command) {
  const session::OverrideWish wish{.feed = command.feed, .rapid = command.rapid, .spindle = command.spindle};
  if (std::string why = session::OverridePursuit::why_not(wish); !why.empty()) {
    return invalid("OutOfRange", std::move(why));
  }
  if (!is_ready()) return not_connected();
  overrides_.aim_at(wish);
  return {};
}

CommandAnswer Station::do_it(const Spindle& command) {
  if (command.rpm && !(*command.rpm >= 0 && *command.rpm < 1e6)) {
    return invalid("OutOfRange", "A speed is 0 or more revolutions a minute.");
  }
  if (command.turn == machine::SpindleTurn::Off) return send_line("M5");
  const std::string turn = command.turn == machine::SpindleTurn::Clockwise ? "M3" : "M4";
  return send_line(turn + (command.rpm ? "S" + base::to_fixed(*command.rpm, 0) : ""));
}

CommandAnswer Station::do_it(const Coolant& command) {
  if (!host_) return not_connected();
  const auto on = host_->session().snapshot().accessories.value_or(machine::Accessories{});
  const bool flood = command.flood.value_or(on.flood);
  const bool mist = command.mist.value_or(on.mist);
  // M9 switches both off.
  CommandAnswer answer = (!flood || !mist) ? send_line("M9") : CommandAnswer{};
  if (flood && answer.outcome == Outcome::Accepted) answer = send_line("M8");
  if (mist && answer.outcome == Outcome::Accepted) answer = send_line("M7");
  return answer;
}

CommandAnswer Station::do_it(const ChangeSettings& command) {
  if (command.settings.empty()) return invalid("NoSettings", "Name settings and their values.");
  return submit(session::ChangeSettings{.settings = command.settings,
                                        .reason = command.reason.empty() ? "set in the browser" : command.reason});
}

CommandAnswer Station::do_it(const RollbackSettings& command) {
  if (!is_ready()) return not_connected();
  const auto version = io::settings_archive_of(url_, host_->session().capabilities()).find(command.version);
  if (!version) return invalid("NoSuchVersion", "There is no such version of this machine's settings.");
  return submit(session::ChangeSettings{.settings = version->settings,
                                        .reason = fmt::format("back to version {}", command.version)});
}

}  // namespace kerf::daemon
