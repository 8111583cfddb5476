// The three firmwares as values: which words they know, in what order they check, what they let slip.

#include "common/gcode/rules.hpp"

#include "common/gcode/acts.hpp"
#include "common/gcode/checks.hpp"
#include "common/gcode/commands.hpp"

namespace kerf::gcode {

using vocabulary::Firmware;

namespace {

// gnea/grbl gcode.c, step 3.
constexpr CheckStep kGrblChecks[] = {
    check_implicit_motion, check_line_number,  check_feed,    check_spindle_speed, check_dwell,        convert_units,
    check_tool_length,     select_work_offset, check_targets, check_motion,        check_unused_words, check_jog_words,
};

// gnea/grbl gcode.c, step 4.
constexpr ActStep kGrblActs[] = {
    act_laser, act_feed,        act_spindle_speed, act_tool_number, act_spindle, act_coolant,      act_dwell,
    act_modes, act_tool_length, act_work_offset,   act_non_modal,   act_motion,  act_program_flow,
};

// RabbitGRBL GCode.cpp.
constexpr CheckStep kRabbitChecks[] = {
    check_implicit_motion, check_line_number, check_feed,         check_spindle_speed, check_dwell,  check_pins,
    convert_units,         check_tool_length, select_work_offset, check_targets,       check_motion, check_unused_words,
    check_jog_words,
};
constexpr ActStep kRabbitActs[] = {
    act_laser, act_feed,        act_spindle_speed, act_spindle,   act_coolant, act_pins,         act_dwell,
    act_modes, act_tool_length, act_work_offset,   act_non_modal, act_motion,  act_program_flow,
};

// grblHAL core gcode.c.
constexpr CheckStep kGrblHalChecks[] = {
    check_macro_words,
    check_implicit_motion,
    check_tool_change_pending,
    check_line_number,
    check_tool_and_length_numbers,
    check_feed_grblhal,
    check_spindle_grblhal,
    check_tool_set,
    check_ports,
    check_overrides,
    check_dwell,
    convert_units,
    check_scaling,
    check_tool_length_grblhal,
    select_work_offset,
    check_targets_grblhal,
    check_motion_grblhal,
    forget_unchanged_modes,
    check_unused_words,
    check_jog_words,
};
constexpr ActStep kGrblHalActs[] = {
    act_macro,     act_laser,       act_feed,    act_spindle_speed,       act_tool_select,
    act_ports,     act_tool_change, act_spindle, act_saved_state,         act_coolant,
    act_overrides, act_dwell,       act_modes,   act_tool_length_grblhal, act_work_offset,
    act_non_modal, act_message,     act_motion,  act_modal_macro,         act_program_flow,
};

GcodeRules make_grbl() {
  return {.firmware = Firmware::Grbl,
          .commands = &grbl_commands(),
          .value_letters = "FIJKLNPRST",
          .non_negative_letters = "FNPST",
          .checks = kGrblChecks,
          .acts = kGrblActs};
}

GcodeRules make_rabbit() {
  return {.firmware = Firmware::Rabbit,
          .line = {.filter = LineRules::Filter::KeepRaw,
                   .pairing = LineRules::Pairing::LineFeedLast,
                   .length_max = 254,
                   .overlong_at_once = true,
                   .edits = true},
          .block_text = BlockText::Collapsed,
          .floats = FloatRule::PromotedLiterals,
          .commands = &rabbit_commands(),
          .value_letters = "EFIJKLNPQRST",
          .non_negative_letters = "FNPST",
          .checks = kRabbitChecks,
          .acts = kRabbitActs,
          .tool_word_acts_at_once = true,
          .runs_empty_blocks = true,
          .rapid_wants_inverse_feed = true,
          .g10_checks_l_first = true,
          .coolant_word_always_acts = true,
          .report = ReportedGroups::Rabbit,
          .printer = NumberPrinter::Printf};
}

GcodeRules make_grblhal() {
  return {.firmware = Firmware::GrblHal,
          .line = {.filter = LineRules::Filter::TrimLeading,
                   .pairing = LineRules::Pairing::Either,
                   .length_max = 256,
                   .edits = true,
                   .delete_edits = true},
          .block_text = BlockText::WithMessages,
          .digits_max = 9,
          .counts_leading_zeros = false,
          .byte_commands = false,
          .commands = &grblhal_commands(),
          .value_letters = "$ABCDEFHIJKLNOPQRSTUVW",
          .non_negative_letters = "LNO",
          .tool_max_at_once = 0.0F,
          .work_offsets = 9,
          .checks = kGrblHalChecks,
          .acts = kGrblHalActs,
          .failure_drops_pending_work = true,
          .program_end_restores_overrides = false,
          .stores_g92 = true,
          .report = ReportedGroups::All,
          .printer = NumberPrinter::RoundThenSplit,
          .reset_clears_tool = false,
          .reset_clears_g92 = false,
          .reset_clears_tool_length = false};
}

GcodeRules make_grblhal_expressions() {
  GcodeRules rules = make_grblhal();
  rules.reads_expressions = true;
  return rules;
}

}  // namespace

const GcodeRules& rules_for(Firmware firmware) {
  static const GcodeRules grbl = make_grbl();
  static const GcodeRules rabbit = make_rabbit();
  static const GcodeRules grblhal = make_grblhal();
  switch (firmware) {
    case Firmware::Rabbit: return rabbit;
    case Firmware::GrblHal: return grblhal;
    case Firmware::Grbl:
    case Firmware::Unknown: break;
  }
  return grbl;
}

const GcodeRules& rules_for(const vocabulary::Dialect& dialect) {
  static const GcodeRules expressions = make_grblhal_expressions();
  return dialect.builds.contains(vocabulary::BuildOption::Expressions) ? expressions : rules_for(dialect.firmware);
}

}  // namespace kerf::gcode
