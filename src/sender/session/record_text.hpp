#pragma once
// Records as lines of JSON, and back (docs/wire_log.md).

#include <expected>
#include <string>
#include <string_view>

#include <boost/describe.hpp>

#include "sender/session/record.hpp"

namespace kerf::session {

/// Why a line is no record.
enum class RecordFault {
  NotJson,      ///< torn, or something else
  NotARecord,   ///< JSON without `at` and `kind`, or with a value that cannot be
  UnknownKind,  ///< a kind or command that this Kerf does not know: a newer one wrote it
};
BOOST_DESCRIBE_ENUM(RecordFault, NotJson, NotARecord, UnknownKind)

/// Appends one line with its end: `{"at":1.250000000,"kind":"received","bytes":"ok\r\n"}`.
void append_line(std::string& out, const Record& record);

/// The record that `line` (without its end) spells. Members that are not known are passed over, absent ones have their
/// defaults.
[[nodiscard]] std::expected<Record, RecordFault> parse_record(std::string_view line);

/// The `kind` of a record as it is written: "header", "opened", "received", "sent", "program", "command", "time",
/// "closed".
[[nodiscard]] std::string_view kind_of(const Record& record);

/// A command's name as it is written: "StartJob".
[[nodiscard]] std::string_view name_of(const Command& command);

}  // namespace kerf::session
