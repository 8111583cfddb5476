// Any text as a wire log: it is read or refused, what was read is written as it was, and a replay neither crashes nor
// says anything else the second time.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <string>
#include <string_view>

#include "sender/session/record_text.hpp"
#include "sender/session/replay.hpp"

using namespace kerf::session;

namespace {

void require(bool holds) {
  if (!holds) std::abort();
}

/// Writing what was read, and reading that, comes to an end at once.
void check_line(std::string_view line) {
  const auto record = parse_record(line);
  if (!record) return;
  std::string once;
  append_line(once, *record);
  require(once.ends_with('\n') && std::ranges::count(once, '\n') == 1);
  const auto again = parse_record(std::string_view(once).substr(0, once.size() - 1));
  require(again.has_value());
  std::string twice;
  append_line(twice, *again);
  require(once == twice);
}

bool same(const std::optional<ReplayStop>& left, const std::optional<ReplayStop>& right) {
  if (!left || !right) return left.has_value() == right.has_value();
  return left->end == right->end && left->record == right->record && left->at == right->at &&
         left->replayed == right->replayed && sentence_of(*left) == sentence_of(*right);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  const std::string_view log{reinterpret_cast<const char*>(bytes), size};
  for (std::size_t at = 0; at < log.size();) {
    const std::size_t end = std::min(log.find('\n', at), log.size());
    check_line(log.substr(at, end - at));
    at = end + 1;
  }
  require(same(replay_text(log), replay_text(log)));
  return 0;
}
