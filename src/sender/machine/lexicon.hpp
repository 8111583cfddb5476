#pragma once
// What codes mean, in the controller's own words where it has told them, else in ours.

#include <map>
#include <string>
#include <vector>

#include "common/protocol/message.hpp"
#include "common/vocabulary/dialect.hpp"
#include "sender/machine/capabilities.hpp"

namespace kerf::machine {

/// Two tables, errors and alarms, that never fail to answer.
class Lexicon {
 public:
  void learn(const protocol::AlarmCodeRow& row);
  void learn(const protocol::ErrorCodeRow& row);
  void forget();

  /// Meaning of a code; where nobody knows it, the text says so.
  [[nodiscard]] CodeFact error(const vocabulary::Dialect& dialect, int code) const;
  [[nodiscard]] CodeFact alarm(const vocabulary::Dialect& dialect, int code) const;

  /// Everything known, by code: what the controller lists if it lists anything, else our table.
  [[nodiscard]] std::vector<CodeFact> errors(const vocabulary::Dialect& dialect) const;
  [[nodiscard]] std::vector<CodeFact> alarms(const vocabulary::Dialect& dialect) const;

 private:
  std::map<int, CodeFact> errors_;
  std::map<int, CodeFact> alarms_;
};

/// "title: text", or what of the two there is, as one sentence.
[[nodiscard]] std::string sentence_of(const CodeFact& fact);

}  // namespace kerf::machine
