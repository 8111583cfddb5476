#include <algorithm>
#include <array>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "apps/commands.hpp"
#include "apps/output.hpp"
#include "common/base/text.hpp"
#include "io/event_loop.hpp"
#include "io/link_recorder.hpp"
#include "io/machine_url.hpp"
#include "io/text_file.hpp"
#include "io/transport.hpp"
#include "simulation/talk.hpp"
#include "simulation/talk_conversation.hpp"
#include "simulation/talk_runner.hpp"

namespace kerf::apps {
namespace {

namespace fs = std::filesystem;
using simulation::Talk;
using simulation::TalkFailure;

struct NamedTalk {
  std::string file;
  Talk talk;
};

/// What became of one talk. Neither failed nor skipped: it passed.
struct Result {
  std::optional<TalkFailure> failure;
  std::string skipped_because;
  std::string record;
  std::optional<std::string> link_trouble;  ///< no point in going on
};

/// Folders become the talks in them, sorted.
std::vector<std::string> talk_files(const std::vector<std::string>& names) {
  std::vector<std::string> files;
  for (const std::string& name : names) {
    std::error_code fault;
    if (!fs::is_directory(name, fault)) {
      files.push_back(name);
      continue;
    }
    std::vector<std::string> found;
    for (const auto& entry : fs::recursive_directory_iterator(name, fault)) {
      if (entry.path().extension() == ".talk") found.push_back(entry.path().string());
    }
    std::ranges::sort(found);
    files.insert(files.end(), found.begin(), found.end());
  }
  return files;
}

/// Says what is wrong with the first file that is no talk.
std::optional<std::vector<NamedTalk>> load_talks(const VerifyOptions& options) {
  std::vector<NamedTalk> talks;
  for (const std::string& file : talk_files(options.files)) {
    const auto text = io::read_text_file(file);
    if (!text) {
      complain(io::explain(text.error(), file));
      return std::nullopt;
    }
    std::error_code ignored;
    const std::string folder = fs::absolute(file, ignored).parent_path().filename().string();
    auto talk = simulation::parse_talk(*text, folder);
    if (!talk) {
      complain(fmt::format("{}, line {}: {}.", file, talk.error().line, simulation::explain(talk.error().fault)));
      return std::nullopt;
    }
    talks.push_back({.file = file, .talk = *std::move(talk)});
  }
  if (talks.empty()) complain("There are no .talk files there: name some, for example tests/transcripts.");
  return talks.empty() ? std::nullopt : std::optional(std::move(talks));
}

/// What `[OPT:letters,blocks,bytes,axes,tools]` tells of the machine; zeros where it tells nothing.
struct Build {
  int axes = 0;
  int tools = 0;
};

std::optional<Build> build_in(std::string_view line) {
  constexpr std::string_view kOptions = "[OPT:";
  if (!line.starts_with(kOptions)) return std::nullopt;
  const auto fields = base::split(base::trim(line).substr(kOptions.size()), ',');
  const auto count = [&](std::size_t at) {
    if (at >= fields.size()) return 0;
    std::string_view digits = fields[at];
    digits = digits.substr(0, digits.find(']'));
    return base::parse_int<int>(digits).value_or(0);
  };
  constexpr std::size_t kAxes = 3;
  constexpr std::size_t kTools = 4;
  return Build{.axes = count(kAxes), .tools = count(kTools)};
}

/// Why real firmware cannot hold this talk; empty if it can.
std::string obstacle(const Talk& talk, const Build& build) {
  if (talk.virtual_only_because) return "virtual only: " + *talk.virtual_only_because;
  if (talk.has_card) return "it needs a card with certain files";
  if (talk.has_pendant) return "somebody would have to work the pendant";
  if (talk.moves_switches()) return "somebody would have to press switches";
  const firmware::Hardware& wanted = talk.hardware;
  if (wanted.axes > build.axes)
    return fmt::format("it needs {} axes, the machine tells of {}", wanted.axes, build.axes);
  if (wanted.tools > build.tools) {
    return fmt::format("it needs a table of {} tools, the machine tells of {}", wanted.tools, build.tools);
  }
  return {};
}

/// Holds talks with whatever is behind a URL, one connection a talk, in real time.
class LiveRunner {
 public:
  LiveRunner(io::MachineUrl url, io::RecordingOptions recording)
      : url_(std::move(url)), recording_(std::move(recording)), timer_(loop_) {}

  Result run(const NamedTalk& named) {
    const Talk& talk = named.talk;
    result_ = {};
    const bool asks_for_build = talk.hardware.axes > 0 || talk.hardware.tools > 0;
    if (asks_for_build && !build_) build_ = ask_for_build();
    result_.skipped_because = obstacle(talk, build_.value_or(Build{}));
    if (!result_.skipped_because.empty()) return result_;
    simulation::TalkConversation conversation(talk, loop_.now());
    conversation_ = &conversation;
    was_opened_ = false;
    start_recording(named.file);
    const auto link = io::open_transport(loop_, url_,
                                         {.opened =
                                              [this] {
                                                was_opened_ = true;
                                                recorder_->opened();
                                                settle();
                                              },
                                          .received =
                                              [this](std::string_view bytes) {
                                                recorder_->received(bytes);
                                                conversation_->on_bytes(loop_.now(), bytes);
                                                settle();
                                              },
                                          .lost = [this](const io::TransportError& error) { on_lost(error); }});
    link_ = link.get();
    constexpr std::array<int, 2> kSignals{SIGINT, SIGTERM};
    const io::SignalWatch signals(loop_, kSignals, [this](int) {
      result_.link_trouble = "Interrupted.";
      loop_.stop();
    });
    loop_.run();
    timer_.disarm();
    recorder_.reset();
    result_.failure = conversation.failure();
    result_.record = conversation.record();
    if (conversation.came_too_late()) result_.skipped_because = "only right after the controller was switched on";
    return result_;
  }

 private:
  /// Asks the machine with `$I`, once; a machine that does not answer tells of nothing.
  Build ask_for_build() {
    using namespace std::chrono_literals;
    Build build;
    std::string heard;
    start_recording("$I");
    io::Transport* link = nullptr;
    const auto opened = io::open_transport(loop_, url_,
                                           {.opened =
                                                [&] {
                                                  recorder_->opened();
                                                  timer_.arm(loop_.now() + 2s, [&] {
                                                    link->write_lines("$I\n");
                                                    recorder_->sent("$I\n");
                                                    timer_.arm(loop_.now() + 3s, [this] { loop_.stop(); });
                                                  });
                                                },
                                            .received =
                                                [&](std::string_view bytes) {
                                                  recorder_->received(bytes);
                                                  heard += bytes;
                                                  if (heard.ends_with("ok\r\n")) loop_.stop();
                                                },
                                            .lost = [this](const io::TransportError&) { loop_.stop(); }});
    link = opened.get();
    loop_.run();
    timer_.disarm();
    for (const std::string_view line : base::split(heard, '\n')) build = build_in(line).value_or(build);
    return build;
  }

  void start_recording(const std::string& talk) {
    recorder_ = std::make_unique<io::LinkRecorder>(
        loop_, recording_, session::LogHeader{.machine = to_string(url_), .talk = talk},
        io::LinkRecorder::Callbacks{.noted = [](const std::string& sentence) { complain(sentence); }});
  }

  void on_lost(const io::TransportError& error) {
    recorder_->gone(io::loss_of(error.fault));
    if (!was_opened_) result_.link_trouble = io::explain(url_, error);
    conversation_->on_closed();
    loop_.stop();
  }

  void settle() {
    for (;;) {
      conversation_->advance_to(loop_.now());
      const simulation::TalkOutbox said = conversation_->take_outbox();
      if (said.is_empty()) break;
      link_->write_lines(said.bytes);
      recorder_->sent(said.bytes);
    }
    if (conversation_->is_finished()) return loop_.stop();
    timer_.arm(conversation_->next_deadline(), [this] { settle(); });
  }

  const io::MachineUrl url_;
  const io::RecordingOptions recording_;
  io::EventLoop loop_;
  io::Timer timer_;
  std::unique_ptr<io::LinkRecorder> recorder_;
  simulation::TalkConversation* conversation_ = nullptr;
  io::Transport* link_ = nullptr;
  bool was_opened_ = false;
  std::optional<Build> build_;
  Result result_;
};

Result run_virtually(const Talk& talk) {
  simulation::TalkOutcome outcome = simulation::run_talk(talk);
  return {.failure = std::move(outcome.failure),
          .skipped_because = {},
          .record = std::move(outcome.record),
          .link_trouble = {}};
}

void print_result(const NamedTalk& talk, const Result& result, bool verbose) {
  if (!result.skipped_because.empty()) {
    put("skip  {}  ({})\n", talk.file, result.skipped_because);
  } else if (result.failure) {
    put("FAIL  {}:{}: {}: {}\n", talk.file, result.failure->line, result.failure->step, result.failure->what);
  } else {
    put("ok    {}\n", talk.file);
  }
  if (verbose || result.failure) put("{}", result.record);
  std::fflush(stdout);
}

ExitStatus hold_talks(const std::vector<NamedTalk>& talks, const VerifyOptions& options, LiveRunner* live) {
  int passed = 0;
  int failed = 0;
  int skipped = 0;
  for (const NamedTalk& talk : talks) {
    const Result result = live != nullptr ? live->run(talk) : run_virtually(talk.talk);
    if (result.link_trouble) {
      complain(*result.link_trouble);
      return ExitStatus::NoConnection;
    }
    print_result(talk, result, options.verbose);
    if (!result.skipped_because.empty()) {
      ++skipped;
    } else if (result.failure) {
      ++failed;
    } else {
      ++passed;
    }
  }
  put("{} passed, {} failed, {} skipped\n", passed, failed, skipped);
  return failed > 0 ? ExitStatus::Refused : ExitStatus::Done;
}

}  // namespace

ExitStatus verify(const VerifyOptions& options) {
  std::unique_ptr<LiveRunner> live;
  const firmware::Personality* only = nullptr;
  if (!options.machine.empty()) {
    const auto url = io::parse_machine_url(options.machine);
    if (!url) {
      complain(io::explain(url.error()));
      return ExitStatus::Usage;
    }
    live = std::make_unique<LiveRunner>(*url, options.recording);
  }
  if (!options.personality.empty()) {
    const auto personality = io::parse_personality(options.personality);
    if (!personality) {
      complain(io::explain(personality.error()));
      return ExitStatus::Usage;
    }
    only = *personality;
  }
  auto talks = load_talks(options);
  if (!talks) return ExitStatus::Usage;
  if (only != nullptr) std::erase_if(*talks, [&](const NamedTalk& talk) { return talk.talk.personality != only; });
  return hold_talks(*talks, options, live.get());
}

}  // namespace kerf::apps
