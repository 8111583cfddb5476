#include "apps/inquiry.hpp"

#include <array>
#include <chrono>
#include <csignal>
#include <memory>
#include <optional>
#include <utility>

#include "apps/commands.hpp"

namespace kerf::apps {
namespace {

using namespace std::chrono_literals;

/// A machine that is busy with something else is not waited for longer than this.
constexpr Duration kBusyLimit = 5s;

class Visitor {
 public:
  Visitor(io::EventLoop& loop, io::MachineUrl url, const VisitOptions& options, Errand& errand)
      : loop_(loop), url_(std::move(url)), options_(options), errand_(errand), limit_(loop) {}

  ExitStatus run() {
    session::SessionOptions options;
    options.reset_policy = session::ResetPolicy::Never;  // somebody's modal state must survive a question
    options.enumerate = options_.enumerate;
    host_ = std::make_unique<io::SessionHost>(
        loop_, url_, options,
        io::SessionHost::Callbacks{.event = [this](const session::Event& event) { on_event(event); },
                                   .lost = [this](const io::TransportError& error) { fail(io::explain(url_, error)); },
                                   .noted = [](const std::string& sentence) { complain(sentence); }},
        options_.recording);
    loop_.run();
    return status_.value_or(ExitStatus::NoConnection);
  }

 private:
  void on_event(const session::Event& event) {
    if (status_) return;
    if (has_begun_) {
      finish(errand_.on_event(*host_, event));
    } else if (std::holds_alternative<session::ControllerFound>(event)) {
      begin();
    } else if (const auto* failed = std::get_if<session::HandshakeFailed>(&event)) {
      // The link itself says better what became of it.
      if (failed->failure != session::HandshakeFailure::LinkLost) fail(failed->sentence);
    } else if (const auto* busy = std::get_if<session::ControllerBusy>(&event)) {
      if (options_.takes_busy) return begin();
      limit_.arm(loop_.now() + kBusyLimit,
                 [this, sentence = busy->sentence] { fail(sentence + " Ask again when the machine is idle."); });
    }
  }

  void begin() {
    limit_.disarm();
    has_begun_ = true;
    finish(errand_.begin(*host_, url_));
  }

  void finish(std::optional<ExitStatus> status) {
    if (!status) return;
    status_ = status;
    loop_.stop();
  }

  void fail(const std::string& sentence) {
    if (status_) return;
    complain(sentence);
    finish(has_begun_ ? ExitStatus::Interrupted : ExitStatus::NoConnection);
  }

  io::EventLoop& loop_;
  const io::MachineUrl url_;
  const VisitOptions options_;
  Errand& errand_;
  io::Timer limit_;
  bool has_begun_ = false;
  std::optional<ExitStatus> status_;
  std::unique_ptr<io::SessionHost> host_;
};

class Glance : public Errand {
 public:
  explicit Glance(const Visit& visit) : visit_(visit) {}
  std::optional<ExitStatus> begin(io::SessionHost& host, const io::MachineUrl&) override {
    visit_(host);
    return ExitStatus::Done;
  }
  std::optional<ExitStatus> on_event(io::SessionHost&, const session::Event&) override { return std::nullopt; }

 private:
  const Visit& visit_;
};

}  // namespace

ExitStatus run_errand(const std::string& machine, const VisitOptions& options, Errand& errand) {
  const auto url = io::parse_machine_url(machine);
  if (!url) {
    complain(io::explain(url.error()));
    return ExitStatus::Usage;
  }
  io::EventLoop loop;
  bool interrupted = false;
  constexpr std::array<int, 2> kSignals{SIGINT, SIGTERM};
  const io::SignalWatch signals(loop, kSignals, [&](int) {
    interrupted = true;
    loop.stop();
  });
  Visitor visitor(loop, *url, options, errand);
  const ExitStatus status = visitor.run();
  return interrupted ? ExitStatus::Interrupted : status;
}

ExitStatus visit(const std::string& machine, const VisitOptions& options, const Visit& visit) {
  Glance glance(visit);
  return run_errand(machine, options, glance);
}

}  // namespace kerf::apps
