#include "common/vocabulary/dialect.hpp"

#include <algorithm>
#include <array>

#include "common/base/text.hpp"
#include "common/vocabulary/dialects/grbl.hpp"
#include "common/vocabulary/dialects/grblhal.hpp"
#include "common/vocabulary/dialects/rabbit.hpp"

namespace kerf::vocabulary {
namespace {

// What is safe with all three: the smallest buffers, the strictest line rules, and nothing that one of them lacks.
constexpr Dialect kUnknown = [] {
  Dialect dialect = dialects::kGrbl;
  dialect.firmware = Firmware::Unknown;
  dialect.name = "unknown firmware";
  dialect.key = "unknown";
  dialect.version = {};
  dialect.build = {};
  dialect.welcome = {};
  dialect.welcome_start = {};
  dialect.options = {};
  dialect.rx_bytes = {.usable = 127, .printed = 0};
  dialect.planner_blocks = {.usable = 14, .printed = 0};
  dialect.line_length = 70;
  dialect.opening_port_resets = false;
  dialect.settings = {};
  return dialect;
}();

constexpr std::array<const Dialect*, 3> kAll{&dialects::kGrbl, &dialects::kRabbit, &dialects::kGrblHal};
constexpr std::array<const Dialect*, 4> kAllBuilds{&dialects::kGrbl, &dialects::kRabbit, &dialects::kGrblHal,
                                                   &dialects::kGrblHalExpressions};

}  // namespace

const Dialect& dialect_of(Firmware firmware) {
  const auto at = std::ranges::find(kAll, firmware, [](const Dialect* dialect) { return dialect->firmware; });
  return at == kAll.end() ? kUnknown : **at;
}

std::span<const Dialect* const> all_dialects() {
  return kAll;
}

const Dialect* find_dialect(std::string_view key) {
  const auto at =
      std::ranges::find_if(kAllBuilds, [&](const Dialect* dialect) { return base::iequals(dialect->key, key); });
  return at == kAllBuilds.end() ? nullptr : *at;
}

}  // namespace kerf::vocabulary
