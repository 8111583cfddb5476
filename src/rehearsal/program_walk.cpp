#include "rehearsal/program_walk.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "common/base/text.hpp"
#include "common/motion/rules.hpp"
#include "firmware/settings_store.hpp"
#include "rehearsal/words_seen.hpp"

namespace kerf::rehearsal {
namespace {

using gcode::Action;

constexpr int kToolChange = 6;

job::WireForm form_of(const vocabulary::Dialect& dialect) {
  job::WireForm form = job::wire_form_of(dialect);
  form.keeps_messages = false;
  return form;
}

vocabulary::AxisValues axis_values(const std::vector<double>& values) {
  vocabulary::AxisValues result{};
  for (std::size_t axis = 0; axis < std::min(values.size(), result.size()); ++axis) {
    result.at(axis) = static_cast<float>(values[axis]);
  }
  return result;
}

gcode::Offsets stored_offsets(const firmware::StoredState& stored, int tools) {
  struct Slot {
    std::string_view name;
    vocabulary::AxisValues* values;
  };
  gcode::Offsets offsets;
  auto& work = offsets.work;
  const Slot slots[] = {{"G54", &work[0]},   {"G55", &work[1]},     {"G56", &work[2]},    {"G57", &work[3]},
                        {"G58", &work[4]},   {"G59", &work[5]},     {"G59.1", &work[6]},  {"G59.2", &work[7]},
                        {"G59.3", &work[8]}, {"G28", &offsets.g28}, {"G30", &offsets.g30}};
  for (const Slot& slot : slots) {
    const auto found = stored.offsets.find(slot.name);
    if (found != stored.offsets.end()) *slot.values = axis_values(found->second);
  }
  offsets.tools.resize(static_cast<std::size_t>(tools) + 1);
  for (const auto& [number, tool] : stored.tools) {
    if (number < 1 || number > tools) continue;
    offsets.tools.at(static_cast<std::size_t>(number)) = {.length_mm = axis_values(tool.length_mm),
                                                          .radius_mm = static_cast<float>(tool.radius_mm)};
  }
  return offsets;
}

}  // namespace

void ToolInUse::on_words(const job::FlowWords& words) {
  if (words.tool) selected_ = words.tool;
  has_changes_ = has_changes_ || words.changes_tool;
  if (words.changes_tool || (words.tool && !has_changes_)) number_ = selected_.value_or(0);
}

gcode::Interpreter interpreter_of(const simulation::CaseMachine& machine) {
  firmware::SettingsStore store(machine.personality, firmware::axes_of(machine.personality, machine.stored));
  static_cast<void>(store.load(machine.stored));
  gcode::InterpreterSettings settings;
  store.configure(settings);
  gcode::Interpreter reader(gcode::rules_for(machine.personality.dialect()), settings);
  reader.offsets() = stored_offsets(machine.stored, settings.tools);
  reader.reload_offsets();
  return reader;
}

ProgramWalk::ProgramWalk(std::string_view text, gcode::Interpreter reader, const vocabulary::Dialect& dialect)
    : text_(text),
      reader_(std::move(reader)),
      dialect_(&dialect),
      lines_(reader_.rules().line),
      form_(form_of(dialect)) {}

const WalkedLine* ProgramWalk::next() {
  if (is_over_ || !take_text()) return nullptr;
  actions_.clear();
  start_mm_ = reader_.state().position_mm;
  note_operation();
  prepare();
  if (line_.wire.starts_with('$')) {
    execute_system();
  } else if (!line_.wire.empty()) {
    execute();
  }
  return &line_;
}

bool ProgramWalk::take_text() {
  if (offset_ >= text_.size()) return false;
  std::size_t end = offset_;
  while (end < text_.size() && text_[end] != '\n' && text_[end] != '\r') ++end;
  line_ = {.number = line_.number + 1, .text = text_.substr(offset_, end - offset_)};
  const bool is_pair = end + 1 < text_.size() && text_[end] == '\r' && text_[end + 1] == '\n';
  offset_ = std::min(end + (is_pair ? 2 : 1), text_.size());
  return true;
}

void ProgramWalk::note_operation() {
  auto name = finder_.on_line(line_.text);
  if (!name) return;
  const auto found = operation_numbers_.find(*name);
  if (found != operation_numbers_.end()) {
    operation_ = found->second;
  } else if (operations_.size() <= std::numeric_limits<std::uint16_t>::max()) {
    operation_ = static_cast<std::uint16_t>(operations_.size());
    operation_numbers_.emplace(*name, operation_);
    operations_.push_back(*std::move(name));
  }
}

void ProgramWalk::prepare() {
  if (base::trim(line_.text) == "%") {
    is_over_ = std::exchange(has_percent_, true);
    return;
  }
  wire_.clear();
  job::append_wire_form(wire_, line_.text, form_);
  if (wire_.empty()) return;
  const WordsSeen words_seen = words_seen_in(wire_);
  line_.axes = words_seen.axes();
  line_.in_machine_coordinates = words_seen.machine_place;
  const bool has_flow = words_seen.has('M') || words_seen.has('T');
  if (has_flow && !wire_.starts_with('$')) {
    const job::FlowWords words = job::flow_words_of(wire_);
    tool_.on_words(words);
    is_over_ = words.ends_program;
    // Where the firmware refuses it, the operator changes the tool and Kerf takes the word out.
    if (words.changes_tool && dialect_->tool_change == vocabulary::ToolChangeRule::Refused) {
      wire_ = job::without_word(wire_, 'M', kToolChange);
    }
  }
  line_.wire = as_read(wire_);
}

std::string_view ProgramWalk::as_read(std::string_view wire) {
  // The wire form has neither blanks nor comments, so only a reader that strips more than these changes it.
  const gcode::LineRules& rules = reader_.rules().line;
  if (rules.filter != gcode::LineRules::Filter::StripWhileReading && wire.size() <= rules.length_max) return wire;
  lines_.clear();
  std::optional<gcode::ReadLine> read;
  for (std::size_t at = 0; at < wire.size() && !read; ++at) read = lines_.push(wire[at]);
  if (!read) read = lines_.push('\n');
  if (read && read->overlong) {
    line_.refused = gcode::ErrorCode::LineTooLong;
    ++refused_lines_;
  }
  return read ? read->text : std::string_view{};
}

void ProgramWalk::execute() {
  if (const auto read = reader_.interpret(line_.wire, actions_); !read) {
    line_.refused = read.error();
    ++refused_lines_;
    actions_.clear();
  }
  settle();
}

void ProgramWalk::settle() {
  for (const Action& action : actions_) {
    if (const auto* const probe = std::get_if<gcode::ProbeMove>(&action)) reader_.sync_position(probe->target_mm);
    if (std::holds_alternative<gcode::ToolChange>(action)) reader_.complete_tool_change();
  }
}

void ProgramWalk::execute_system() {
  constexpr std::string_view kJog = "$J=";
  if (base::starts_with_ignoring_case(line_.wire, kJog)) {
    const auto jog = reader_.interpret_jog(line_.wire.substr(kJog.size()));
    if (!jog) {
      line_.refused = jog.error();
      ++refused_lines_;
      return;
    }
    actions_.emplace_back(gcode::LinearMove{.target_mm = jog->target_mm, .feed = jog->feed});
    reader_.sync_position(jog->target_mm);
    return;
  }
  line_.ends_elsewhere = base::starts_with_ignoring_case(line_.wire, "$H");
}

}  // namespace kerf::rehearsal
