#pragma once
// Journal records as they are written down: a kind and a line of JSON.

#include <expected>
#include <string>
#include <string_view>

#include <boost/describe.hpp>

#include "sender/job/journal.hpp"

namespace kerf::job {

/// Why a text is no record.
enum class JournalFault {
  NotJson,      ///< torn, or something else
  NotARecord,   ///< JSON with a value that cannot be
  UnknownKind,  ///< a newer Kerf wrote it
};
BOOST_DESCRIBE_ENUM(JournalFault, NotJson, NotARecord, UnknownKind)

/// "begun", "advanced", "noted" or "closed".
[[nodiscard]] std::string_view kind_of(const JournalRecord& record);

/// `{"kind":"LineRefused","line":7,"text":"…"}`
[[nodiscard]] std::string body_of(const JournalRecord& record);

/// What `kind` and `body` spell. Members that are not known are passed over, absent ones have their defaults.
[[nodiscard]] std::expected<JournalRecord::What, JournalFault> parse_body(std::string_view kind, std::string_view body);

}  // namespace kerf::job
