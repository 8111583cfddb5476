// `kerf alarms` and `kerf errors`: what the numbers mean, and what to do.

#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "apps/commands.hpp"
#include "apps/inquiry.hpp"
#include "apps/output.hpp"
#include "common/vocabulary/dialect.hpp"
#include "firmware/personality.hpp"
#include "io/json.hpp"
#include "sender/machine/explanation.hpp"
#include "sender/machine/lexicon.hpp"

namespace kerf::apps {
namespace {

using machine::CodeFact;
using machine::Explanation;
using machine::IncidentKind;

IncidentKind kind_of(const CodesOptions& options) {
  return options.errors ? IncidentKind::Error : IncidentKind::Alarm;
}

void print_list(const std::vector<CodeFact>& codes, const CodesOptions& options) {
  if (options.json) {
    put("{}\n", io::print(io::to_json(codes), 2));
    return;
  }
  for (const CodeFact& code : codes) {
    const std::string meaning = sentence_of(code);
    if (!meaning.empty()) put("{:>4}  {}\n", code.id, meaning);
  }
  put("\n'kerf {} CODE' says what to do about one.\n", options.errors ? "errors" : "alarms");
}

void print_one(const Explanation& explanation, bool json) {
  if (json) {
    put("{}\n", io::print(io::to_json(explanation), 2));
    return;
  }
  put("{}\n", explanation.headline);
  for (const std::string& line : details_of(explanation)) put("  {}\n", line);
}

/// The list, or the one that was asked for.
ExitStatus print(const std::vector<CodeFact>& codes, const vocabulary::Dialect& dialect, const CodesOptions& options) {
  if (!options.code) {
    print_list(codes, options);
    return ExitStatus::Done;
  }
  const auto found = std::ranges::find(codes, *options.code, &CodeFact::id);
  if (found == codes.end()) {
    complain(fmt::format("{} has no {} {}: see 'kerf {}' for those that it has.", dialect.name,
                         options.errors ? "error" : "alarm", *options.code, options.errors ? "errors" : "alarms"));
    return ExitStatus::Usage;
  }
  print_one(explain_code(kind_of(options), *found, dialect), options.json);
  return ExitStatus::Done;
}

ExitStatus print_tables(const CodesOptions& options) {
  const vocabulary::Dialect* const dialect = vocabulary::find_dialect(options.personality);
  if (dialect == nullptr) {
    complain(fmt::format("There is no personality '{}': choose one of {}.", options.personality,
                         firmware::personality_names()));
    return ExitStatus::Usage;
  }
  const machine::Lexicon lexicon;
  return print(options.errors ? lexicon.errors(*dialect) : lexicon.alarms(*dialect), *dialect, options);
}

}  // namespace

ExitStatus list_codes(const CodesOptions& options) {
  if (!options.personality.empty()) return print_tables(options);
  ExitStatus status = ExitStatus::Done;
  const ExitStatus visited = visit(options.machine, {.recording = options.recording}, [&](const io::SessionHost& host) {
    const machine::Capabilities& known = host.session().capabilities();
    status = print(options.errors ? known.errors : known.alarms, vocabulary::dialect_of(known.family), options);
  });
  return visited == ExitStatus::Done ? status : visited;
}

}  // namespace kerf::apps
