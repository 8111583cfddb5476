#include "sender/job/journal_text.hpp"

#include <array>
#include <utility>
#include <variant>

#include "common/base/described_json.hpp"

namespace kerf::job {
namespace {

/// Names of JournalRecord::What's alternatives, in their order.
constexpr std::array<std::string_view, std::variant_size_v<JournalRecord::What>> kKinds = {"begun", "advanced", "noted",
                                                                                           "closed"};

}  // namespace

std::string_view kind_of(const JournalRecord& record) {
  return kKinds.at(record.what.index());
}

std::string body_of(const JournalRecord& record) {
  std::string body;
  std::visit([&body](const auto& what) { base::described::write(body, what); }, record.what);
  return body;
}

std::expected<JournalRecord::What, JournalFault> parse_body(std::string_view kind, std::string_view body) {
  const auto json = base::parse_json(body);
  if (!json) return std::unexpected(JournalFault::NotJson);
  std::expected<JournalRecord::What, JournalFault> found = std::unexpected(JournalFault::UnknownKind);
  boost::mp11::mp_for_each<boost::mp11::mp_iota_c<kKinds.size()>>([&](auto index) {
    if (kKinds[index] != kind) return;
    std::variant_alternative_t<index, JournalRecord::What> what{};
    if (base::described::read(*json, what)) {
      found = JournalRecord::What{std::move(what)};
    } else {
      found = std::unexpected(JournalFault::NotARecord);
    }
  });
  return found;
}

}  // namespace kerf::job
