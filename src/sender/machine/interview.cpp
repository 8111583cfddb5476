#include "sender/machine/interview.hpp"

#include <algorithm>
#include <utility>

namespace kerf::machine {

void Interview::begin(bool brief) {
  brief_ = brief;
  asked_.clear();
  passed_over_.clear();
}

bool Interview::was_asked(const std::string& question) const {
  return std::ranges::find(asked_, question) != asked_.end();
}

void Interview::pass_over(const Words& words) {
  for (const KeptAnswer& answer : words.answers) passed_over_.push_back(answer.question);
}

std::optional<std::string> Interview::next(const CapabilityCollector& known) {
  // What was kept is out of date: settings come and go with the values of others.
  if (!passed_over_.empty() && known.has_undescribed_value()) passed_over_.clear();
  for (std::string& question : questions(known)) {
    if (was_asked(question) || std::ranges::find(passed_over_, question) != passed_over_.end()) continue;
    asked_.push_back(question);
    return std::move(question);
  }
  return std::nullopt;
}

std::vector<std::string> Interview::questions(const CapabilityCollector& known) const {
  if (brief_) return {"$G", "$#"};
  const auto& dialect = known.dialect();
  std::vector<std::string> list;
  // The plain form comes first while the firmware is not known: Grbl refuses the other.
  if (was_asked("$I") || !dialect.answers_full_status) list.emplace_back("$I");
  if (dialect.answers_full_status) list.emplace_back("$I+");
  list.insert(list.end(), {"$G", "$#"});
  if (enumerate_) add_enumerations(list, known);
  // Behind the descriptions: they say which values are passwords.
  list.emplace_back("$$");
  list.emplace_back("$N");
  if (enumerate_ && !dialect.named_settings_query.empty()) list.emplace_back(dialect.named_settings_query);
  return list;
}

void Interview::add_enumerations(std::vector<std::string>& list, const CapabilityCollector& known) const {
  const bool enumerates = known.has_token("ENUMS");
  if (enumerates || known.dialect().can_enumerate_codes) list.insert(list.end(), {"$EA", "$EE"});
  if (!enumerates) return;
  list.insert(list.end(), {"$EG", "$ES"});
  if (known.has_token("SED")) list.emplace_back("$ESH");
  list.emplace_back("$SPINDLESH");
  if (was_asked("$SPINDLESH") && !known.knows_spindles()) list.emplace_back("$SPINDLES");
}

}  // namespace kerf::machine
