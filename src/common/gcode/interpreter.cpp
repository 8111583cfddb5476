#include "common/gcode/interpreter.hpp"

#include "common/gcode/block.hpp"

namespace kerf::gcode {

namespace {

/// The block before its words: the modal state goes on; a jog has its own motion and feed mode. A canned cycle in force
/// is still checked in jogs (grblHAL gcode.c).
void start_block(Block& block, const ParserState& state, bool jog) {
  block.modal = state.modal;
  block.jog = jog;
  if (!jog) return;
  block.modal.motion = MotionMode::Linear;
  block.modal.feed_mode = FeedMode::UnitsPerMinute;
}

template <typename Step>
ErrorCode run(std::span<const Step> steps, Block& block, BlockContext& context) {
  for (const Step step : steps) {
    if (const ErrorCode error = step(block, context); error != ErrorCode::Ok) return error;
    if (block.finished) break;
  }
  return ErrorCode::Ok;
}

/// The last assignment of a block comes first: of two to the same parameter the first one stays.
void assign(const Block& block, Parameters& parameters) {
  for (auto at = block.assignments.rbegin(); at != block.assignments.rend(); ++at)
    parameters.set(at->parameter, at->value);
}

ErrorCode read_block(std::string_view line, Block& block, BlockContext& context) {
  BlockBuffer buffer;
  PreparedText prepared = prepare_text(line, block.jog, context, buffer);
  if (prepared.error != ErrorCode::Ok) return prepared.error;
  block.message = std::move(prepared.message);
  if (prepared.demarcates) context.out.push_back(ProgramDemarcation{});
  if (buffer.length == 0 && !context.rules.runs_empty_blocks) {
    if (!block.message.empty()) context.out.push_back(OperatorMessage{.text = std::move(block.message)});
    block.finished = true;
    return ErrorCode::Ok;
  }
  if (const ErrorCode error = collect_words(buffer.text.data(), block, context); error != ErrorCode::Ok) return error;
  return block.finished ? ErrorCode::Ok : run(context.rules.checks, block, context);
}

}  // namespace

Interpreter::Interpreter(const GcodeRules& rules, InterpreterSettings settings) : rules_(&rules), settings_(settings) {}

std::expected<void, ErrorCode> Interpreter::interpret(std::string_view line, std::vector<Action>& out) {
  BlockContext context = context_for(out);
  Block block;
  start_block(block, state_, false);
  ErrorCode error = read_block(line, block, context);
  if (error == ErrorCode::Ok && !block.finished) error = run(rules_->acts, block, context);
  if (error == ErrorCode::Ok) {
    if (!block.finished) assign(block, parameters_);
    return {};
  }
  fail();
  return std::unexpected(error);
}

BlockContext Interpreter::context_for(std::vector<Action>& out) {
  return {.rules = *rules_,
          .settings = settings_,
          .state = state_,
          .offsets = offsets_,
          .out = out,
          .parameters = parameters_,
          .flow = flow_,
          .machine = machine_};
}

std::optional<float> Interpreter::parameter(std::uint16_t id) {
  std::vector<Action> none;
  return context_for(none).values().get(id);
}

std::optional<float> Interpreter::parameter(std::string_view name) {
  std::vector<Action> none;
  return context_for(none).values().get(name);
}

std::expected<JogMove, ErrorCode> Interpreter::interpret_jog(std::string_view after_dollar_j) {
  std::vector<Action> said;
  BlockContext context = context_for(said);
  Block block;
  start_block(block, state_, true);
  BlockBuffer buffer;
  ErrorCode error = prepare_text(after_dollar_j, true, context, buffer).error;
  if (error == ErrorCode::Ok) error = collect_words(buffer.text.data(), block, context);
  if (error == ErrorCode::Ok && !block.finished) error = run(rules_->checks, block, context);
  if (error != ErrorCode::Ok) {
    fail();
    return std::unexpected(error);
  }
  // G66 ends a line before it becomes a motion.
  return JogMove{.target_mm = block.finished ? state_.position_mm : block.xyz,
                 .feed = {.rate_mm_per_min = block.f,
                          .no_override = true,
                          .spindle_rpm = state_.spindle_rpm,
                          .spindle = state_.modal.spindle,
                          .line_number = block.n}};
}

void Interpreter::reset() {
  const ParserState old = state_;
  state_ = {};
  state_.position_mm = old.position_mm;
  if (!rules_->reset_clears_tool) state_.tool = state_.tool_pending = old.tool;
  if (rules_->reset_clears_g92) offsets_.g92 = {};
  if (rules_->reset_clears_tool_length) offsets_.tool_length = {};
  flow_.clear(parameters_);
  reload_offsets();
}

void Interpreter::stop_spindle() {
  state_.modal.spindle = SpindleDirection::Off;
  state_.spindle_rpm = 0.0F;
}

void Interpreter::stop() {
  const ModalState old = state_.modal;
  reset();
  state_.modal.work_offset = old.work_offset;
  state_.modal.tool_length = old.tool_length;
  reload_offsets();
}

void Interpreter::sync_position(const AxisValues& mm) {
  state_.position_mm = mm;
}

void Interpreter::complete_tool_change() {
  if (state_.arriving_tool) state_.tool = *state_.arriving_tool;
  if (state_.arriving_length) {
    state_.modal.tool_length = ToolLengthMode::FromTable;
    offsets_.tool_length = offsets_.tools.at(*state_.arriving_length).length_mm;
  }
  abort_tool_change();
}

void Interpreter::abort_tool_change() {
  state_.arriving_tool.reset();
  state_.arriving_length.reset();
  state_.tool_change_pending = false;
}

void Interpreter::set_tool_length(std::size_t axis, float mm) {
  state_.modal.tool_length = ToolLengthMode::Dynamic;
  offsets_.tool_length.at(axis) = mm;
}

AxisValues Interpreter::work_coordinate_offset() const {
  AxisValues sum{};
  for (std::size_t axis = 0; axis < sum.size(); ++axis)
    sum[axis] = state_.work_offset_mm[axis] + offsets_.g92[axis] + offsets_.tool_length[axis];
  return sum;
}

void Interpreter::reload_offsets() {
  state_.work_offset_mm = offsets_.work[state_.modal.work_offset];
}

void Interpreter::fail() {
  if (!rules_->failure_drops_pending_work) return;
  state_.arriving_tool.reset();
  state_.modal_macro.reset();
}

}  // namespace kerf::gcode
