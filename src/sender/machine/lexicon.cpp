#include "sender/machine/lexicon.hpp"

#include <span>
#include <string_view>

#include "common/base/text.hpp"

namespace kerf::machine {
namespace {

// `[ALARMCODE:1||Hard limit has been triggered. …]`: grblHAL leaves the title empty.
CodeFact told(int id, const std::string& title, const std::string& text) {
  CodeFact fact{.id = id, .title = title, .text = text, .source = FactSource::Told};
  if (fact.title.empty()) {
    const auto stop = text.find(". ");
    fact.title = std::string{base::trim(std::string_view{text}.substr(0, stop))};
    if (fact.title.ends_with('.')) fact.title.pop_back();
  }
  return fact;
}

FactSource source_of(const vocabulary::Dialect& dialect) {
  return dialect.firmware == vocabulary::Firmware::Unknown ? FactSource::Assumed : FactSource::Inferred;
}

CodeFact from_table(const vocabulary::Dialect& dialect, const vocabulary::CodeRow& row) {
  return {.id = row.code, .title = std::string{row.title}, .text = std::string{row.text}, .source = source_of(dialect)};
}

CodeFact look_up(const std::map<int, CodeFact>& told_facts, const vocabulary::Dialect& dialect,
                 std::span<const vocabulary::CodeRow> rows, int code, std::string_view kind) {
  if (const auto found = told_facts.find(code); found != told_facts.end()) return found->second;
  if (const auto* row = vocabulary::find_code(rows, code)) return from_table(dialect, *row);
  const std::string text = "The meaning of " + std::string{kind} + " " + std::to_string(code) +
                           " is not known; see the firmware's documentation.";
  return {.id = code, .title = "Unknown " + std::string{kind}, .text = text, .source = FactSource::Assumed};
}

std::vector<CodeFact> list(const std::map<int, CodeFact>& told_facts, const vocabulary::Dialect& dialect,
                           std::span<const vocabulary::CodeRow> rows) {
  std::vector<CodeFact> facts;
  facts.reserve(told_facts.size());
  for (const auto& [id, fact] : told_facts) facts.push_back(fact);
  if (facts.empty()) {
    for (const auto& row : rows) facts.push_back(from_table(dialect, row));
  }
  return facts;
}

}  // namespace

void Lexicon::learn(const protocol::AlarmCodeRow& row) {
  alarms_[row.id] = told(row.id, row.title, row.text);
}

void Lexicon::learn(const protocol::ErrorCodeRow& row) {
  errors_[row.id] = told(row.id, row.title, row.text);
}

void Lexicon::forget() {
  errors_.clear();
  alarms_.clear();
}

CodeFact Lexicon::error(const vocabulary::Dialect& dialect, int code) const {
  return look_up(errors_, dialect, dialect.errors, code, "error");
}

CodeFact Lexicon::alarm(const vocabulary::Dialect& dialect, int code) const {
  return look_up(alarms_, dialect, dialect.alarms, code, "alarm");
}

std::vector<CodeFact> Lexicon::errors(const vocabulary::Dialect& dialect) const {
  return list(errors_, dialect, dialect.errors);
}

std::vector<CodeFact> Lexicon::alarms(const vocabulary::Dialect& dialect) const {
  return list(alarms_, dialect, dialect.alarms);
}

std::string sentence_of(const CodeFact& fact) {
  if (fact.text.empty()) return fact.title;
  const bool repeats = base::starts_with_ignoring_case(fact.text, fact.title);
  return fact.title.empty() || repeats ? fact.text : fact.title + ": " + fact.text;
}

}  // namespace kerf::machine
