#include "sender/session/hidden_passwords.hpp"

#include <optional>
#include <string>
#include <variant>

#include "common/protocol/decode.hpp"

namespace kerf::session {
namespace {

class Hider {
 public:
  explicit Hider(const protocol::Secrets& secrets) : secrets_(secrets) {}

  void operator()(LineSent& sent) const { hide(sent.text); }
  void operator()(LinesLost& lost) const {
    for (auto& line : lost.lines) hide(line.text);
  }
  void operator()(LineRefused& refused) const { hide(refused.refusal.text); }
  void operator()(JobProgressed& progressed) const { hide(progressed.job.refusal); }
  void operator()(JobEnded& ended) const { hide(ended.job.refusal); }
  void operator()(LineReceived& received) const {
    if (received.answers) hide(received.answers->text);
    if (hide(received.raw)) received.message = protocol::decode(received.raw);
  }
  /// The others quote no line.
  template <typename Other>
  void operator()(Other&) const {}

 private:
  bool hide(std::string& line) const {
    if (secrets_.secret_in(line).empty()) return false;
    line = secrets_.hidden(line);
    return true;
  }
  void hide(std::optional<job::Refusal>& refusal) const {
    if (refusal) hide(refusal->text);
  }

  const protocol::Secrets& secrets_;
};

}  // namespace

void hide_passwords(Event& event, const protocol::Secrets& secrets) {
  std::visit(Hider(secrets), event);
}

}  // namespace kerf::session
