#include "common/vocabulary/codes.hpp"

#include <algorithm>

#include "common/vocabulary/alarm_table.hpp"
#include "common/vocabulary/error_table.hpp"
#include "common/vocabulary/firmware_rows.hpp"

namespace kerf::vocabulary {

const CodeRow* find_code(std::span<const CodeRow> rows, int code) {
  const auto at = std::ranges::lower_bound(rows, code, {}, &CodeRow::code);
  return at != rows.end() && at->code == code ? &*at : nullptr;
}

std::span<const CodeRow> error_rows() {
  return tables::kErrorRows;
}

std::span<const CodeRow> error_rows(Firmware firmware) {
  switch (firmware) {
    case Firmware::Rabbit: return tables::kRowsOf<tables::kErrorRows, Firmware::Rabbit>;
    case Firmware::GrblHal: return tables::kRowsOf<tables::kErrorRows, Firmware::GrblHal>;
    case Firmware::Grbl:
    case Firmware::Unknown: break;
  }
  return tables::kRowsOf<tables::kErrorRows, Firmware::Grbl>;
}

std::span<const CodeRow> alarm_rows() {
  return tables::kAlarmRows;
}

std::span<const CodeRow> alarm_rows(Firmware firmware) {
  switch (firmware) {
    case Firmware::Rabbit: return tables::kRowsOf<tables::kAlarmRows, Firmware::Rabbit>;
    case Firmware::GrblHal: return tables::kRowsOf<tables::kAlarmRows, Firmware::GrblHal>;
    case Firmware::Grbl:
    case Firmware::Unknown: break;
  }
  return tables::kRowsOf<tables::kAlarmRows, Firmware::Grbl>;
}

}  // namespace kerf::vocabulary
