#pragma once
// What is settled between a machine that was found and the job on it, where that takes more than one look.

#include <string>
#include <variant>
#include <vector>

#include "apps/exit_status.hpp"
#include "sender/session/command.hpp"
#include "sender/session/session.hpp"

namespace kerf::apps {

/// Nothing to do before the machine tells more.
struct KeepWaiting {};
/// A question whose answer is yes or no; `told` is shown before it.
struct AskOperator {
  std::vector<std::string> told{};
  std::string question;
};
struct BeginJob {
  std::vector<std::string> told{};
  session::StartJob job;
};
/// There will be no job; the exit status says whether that is a failure.
struct NoJob {
  std::vector<std::string> told{};
  std::string sentence{};
  ExitStatus status = ExitStatus::Usage;
};
using NextInPreparation = std::variant<KeepWaiting, session::Command, AskOperator, BeginJob, NoJob>;

class JobPreparation {
 public:
  JobPreparation() = default;
  JobPreparation(const JobPreparation&) = delete;
  JobPreparation& operator=(const JobPreparation&) = delete;
  virtual ~JobPreparation() = default;

  /// Asked whenever the machine has told something.
  [[nodiscard]] virtual NextInPreparation next(const session::Session& session) = 0;
  /// The operator said yes to the last question.
  virtual void agree() = 0;
};

}  // namespace kerf::apps
