#pragma once
// What is settled between a machine that was found and the job on it, where that takes more than one look.

#include <string>
#include <variant>
#include <vector>

#include "io/json.hpp"
#include "sender/session/command.hpp"
#include "sender/session/session.hpp"

namespace kerf::preparation {

/// Nothing to do before the machine tells more, or a piece of work is done of many: then it asks again at once.
struct KeepWaiting {
  bool is_at_work = false;
  /// Said once; empty: nothing.
  std::string sentence{};
};
/// What is shown before a question, a job or an end: lines for people, and the same as one JSON event (null: none).
struct Told {
  std::vector<std::string> lines{};
  io::Json event{};
};
/// A question whose answer is yes or no; `told` is shown before it.
struct AskOperator {
  Told told{};
  std::string question;
};
struct BeginJob {
  Told told{};
  session::StartJob job;
};
/// There will be no job.
struct NoJob {
  enum class Reason {
    Impossible,   ///< the sentence says why
    FaultsFound,  ///< the check found lines that the controller would refuse, or worse
    NotWished,    ///< all is well, and nothing but the preparation was asked for
  };
  Told told{};
  std::string sentence{};
  Reason reason = Reason::Impossible;
};
using NextInPreparation = std::variant<KeepWaiting, session::Command, AskOperator, BeginJob, NoJob>;

class JobPreparation {
 public:
  JobPreparation() = default;
  JobPreparation(const JobPreparation&) = delete;
  JobPreparation& operator=(const JobPreparation&) = delete;
  virtual ~JobPreparation() = default;

  /// Told of everything that the session tells.
  virtual void on_event(const session::Event& event) = 0;
  /// Asked whenever the machine has told something, and now and then where it is silent.
  [[nodiscard]] virtual NextInPreparation next(Instant now, const session::Session& session) = 0;
  /// The operator said yes to the last question.
  virtual void agree() = 0;
};

}  // namespace kerf::preparation
