// `kerf replay`: the decisions of a recorded connection once more.

#include "sender/session/replay.hpp"

#include <cstdio>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <fmt/format.h>

#include "apps/commands.hpp"
#include "apps/output.hpp"
#include "common/base/text.hpp"
#include "io/json.hpp"
#include "io/text_file.hpp"
#include "io/wire_log.hpp"
#include "io/wire_log_reader.hpp"

namespace kerf::apps {

/// What `kerf replay --json` prints.
struct ReplayResult {
  std::string log;
  std::string recorded_by;
  std::string machine;
  bool same = false;
  session::ReplayTally tally;
  /// Where it left the log.
  std::optional<session::ReplayStop> stop;
  /// What is wrong with the file, if it did not end as it should.
  std::string remark;
};
BOOST_DESCRIBE_STRUCT(ReplayResult, (), (log, recorded_by, machine, same, tally, stop, remark))

namespace {

/// What Kerf told its operator, for people who follow a replay.
std::string told(const session::Event& event) {
  const auto text = []<typename Kind>(const Kind& kind) -> std::string {
    if constexpr (requires { kind.sentence; }) {
      return kind.sentence;
    } else if constexpr (requires { kind.reason; }) {
      return io::print(io::to_json(kind.reason));
    } else if constexpr (requires { kind.refusal; }) {
      return fmt::format("'{}' was refused: {}", kind.refusal.text, kind.refusal.meaning);
    } else if constexpr (requires { kind.title; }) {
      return kind.title;
    } else if constexpr (requires { kind.program; }) {
      return kind.program;
    } else {
      return {};
    }
  };
  return std::visit(text, event);
}

/// The program that is not in the log: from the file that the operator names, or from where it was.
std::string supply(session::ProgramLoaded& loaded, const std::string& supplied) {
  if (!loaded.text.empty() || loaded.size_bytes == 0) return {};
  const std::string path = supplied.empty() ? loaded.path : supplied;
  auto text = io::read_text_file(path);
  if (!text) return io::explain(text.error(), path) + " The log needs this program; name it with --program.";
  const auto program = job::Program::load(loaded.name, *text);
  if (!program || (*program)->hash() != loaded.hash) {
    return fmt::format("{} is not the program that was sent ({} bytes, hash {}): find it and name it with --program.",
                       path, loaded.size_bytes, loaded.hash);
  }
  loaded.text = *std::move(text);
  return {};
}

class Replayer {
 public:
  explicit Replayer(const ReplayOptions& options) : options_(options) {}

  ExitStatus run() {
    result_.log = io::find_log(options_.log, io::log_folder());
    const auto parts = io::parts_of(result_.log, true);
    for (std::size_t index = 0; index < parts.size(); ++index) {
      auto reader = io::WireLogReader::open(parts[index]);
      if (!reader) return refuse(io::explain(reader.error(), parts[index]));
      while (auto record = reader->next()) {
        if (const auto status = follow(*record)) return *status;
      }
      if (reader->remark().empty()) continue;
      result_.remark = reader->remark();
      if (replay_.tally().records == 0) return refuse(fmt::format("{}: {}.", parts[index], reader->remark()));
      // Only the end may be torn.
      if (index + 1 < parts.size()) return refuse(fmt::format("{}: {}.", parts[index], reader->remark()));
    }
    if (replay_.tally().records == 0) return refuse(fmt::format("{} is empty: nothing was recorded.", result_.log));
    return report();
  }

 private:
  std::optional<ExitStatus> follow(session::Record& record) {
    if (const auto* header = std::get_if<session::LogHeader>(&record.what)) {
      result_.recorded_by = header->kerf;
      result_.machine = header->machine;
    }
    if (auto* loaded = std::get_if<session::ProgramLoaded>(&record.what)) {
      if (const std::string why = supply(*loaded, options_.program); !why.empty()) return refuse(why);
    }
    result_.stop = replay_.feed(record);
    const auto events = replay_.take_events();
    for (const session::Event& event : events) {
      const std::string text = options_.verbose ? told(event) : std::string();
      if (!text.empty()) put("{:>13.6f} {}\n", base::to_seconds(record.at), text);
    }
    if (!result_.stop) return std::nullopt;
    return report();
  }

  ExitStatus report() {
    result_.tally = replay_.tally();
    result_.same = !result_.stop;
    const bool differs = result_.stop && result_.stop->end == session::ReplayEnd::Different;
    const ExitStatus status = result_.same ? ExitStatus::Done : differs ? ExitStatus::Refused : ExitStatus::Usage;
    if (options_.json) {
      put("{}\n", io::print(io::to_json(result_), 2));
      return status;
    }
    if (!result_.remark.empty()) complain(fmt::format("{}: {}.", result_.log, result_.remark));
    if (result_.same) {
      put("The same: {} bytes sent, {} received, {} commands, {} records{}.\n", result_.tally.bytes_sent,
          result_.tally.bytes_received, result_.tally.commands, result_.tally.records,
          result_.remark.empty() ? "" : ", as far as the log goes");
      return status;
    }
    complain(
        fmt::format("{}: {}{}", result_.log, session::sentence_of(*result_.stop),
                    differs && result_.recorded_by != KERF_VERSION
                        ? fmt::format(" It was recorded by kerf {}, and this is {}.", result_.recorded_by, KERF_VERSION)
                        : ""));
    return status;
  }

  static ExitStatus refuse(const std::string& sentence) {
    complain(sentence);
    return ExitStatus::Usage;
  }

  const ReplayOptions& options_;
  session::Replay replay_;
  ReplayResult result_;
};

}  // namespace

ExitStatus replay(const ReplayOptions& options) {
  return Replayer(options).run();
}

}  // namespace kerf::apps
