#include "daemon/answers.hpp"

#include <utility>

namespace kerf::daemon {
namespace {

constexpr std::size_t kAnswersKept = 2000;
constexpr std::size_t kLongestKey = 100;

CommandAnswer invalid(std::string reason, std::string sentence) {
  return {.outcome = Outcome::Invalid, .reason = std::move(reason), .sentence = std::move(sentence)};
}

}  // namespace

CommandAnswer Answers::obey(const std::string& machine, Json request, const std::string& origin) {
  if (!request.is_object()) return invalid("NotAnObject", "A command is an object.");
  const auto key = request.find("key");
  if (key == request.end()) return carry_out(machine, std::move(request));
  if (!key->is_string() || key->get_ref<const std::string&>().size() > kLongestKey) {
    return invalid("BadKey", "A key is a text of at most 100 letters.");
  }
  std::string name = origin + "\n" + machine + "\n" + key->get<std::string>();
  request.erase("key");
  if (const auto known = known_.find(name); known != known_.end()) return known->second;
  CommandAnswer answer = carry_out(machine, std::move(request));
  known_[name] = answer;
  order_.push_back(std::move(name));
  if (order_.size() > kAnswersKept) {
    known_.erase(order_.front());
    order_.pop_front();
  }
  return answer;
}

CommandAnswer Answers::carry_out(const std::string& machine, Json request) {
  Station* const station = park_.find(machine);
  if (station == nullptr) return invalid("NoSuchMachine", "There is no machine '" + machine + "'.");
  const auto name = request.find("command");
  if (name == request.end() || !name->is_string()) return invalid("NoCommand", "`command` names what to do.");
  const std::string command_name = name->get<std::string>();
  request.erase("command");
  const auto command = parse_command(command_name, request);
  if (!command) {
    return invalid("BadCommand", (command.error().where.empty() ? command_name : command.error().where) + " " +
                                     command.error().what + ".");
  }
  return station->obey(*command);
}

}  // namespace kerf::daemon
