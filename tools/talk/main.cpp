// talk [-v] FILE…   Holds conversations (tests/transcripts) with the virtual controllers, in virtual time. `kerf
// verify` does the same and can also talk to a real machine; this program needs nothing but the core, so that it also
// runs where the sanitizers check it. Status: 0 all passed, 1 a talk failed, 2 a file is no talk.

#include <cstdio>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>

#include "simulation/talk.hpp"
#include "simulation/talk_runner.hpp"

namespace {

enum class Verdict { Passed, Failed, NoTalk };

/// The folder that a file lies in; it says who speaks.
std::string_view folder_of(std::string_view path) {
  const auto slash = path.rfind('/');
  if (slash == std::string_view::npos) return {};
  const std::string_view folders = path.substr(0, slash);
  return folders.substr(folders.rfind('/') + 1);  // npos + 1 is 0
}

Verdict hold(const std::string& path, bool verbose) {
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    std::fprintf(stderr, "talk: %s cannot be read.\n", path.c_str());
    return Verdict::NoTalk;
  }
  const std::string text(std::istreambuf_iterator<char>(file), {});
  const auto talk = kerf::simulation::parse_talk(text, folder_of(path));
  if (!talk) {
    const std::string_view why = explain(talk.error().fault);
    std::fprintf(stderr, "%s:%zu: %.*s\n", path.c_str(), talk.error().line, static_cast<int>(why.size()), why.data());
    return Verdict::NoTalk;
  }
  const kerf::simulation::TalkOutcome outcome = kerf::simulation::run_talk(*talk);
  if (verbose || outcome.failure) std::fputs(outcome.record.c_str(), stdout);
  if (outcome.failure) {
    std::printf("FAIL  %s:%zu: %s: %s\n", path.c_str(), outcome.failure->line, outcome.failure->step.c_str(),
                outcome.failure->what.c_str());
    return Verdict::Failed;
  }
  std::printf("ok    %s  (%.1f s)\n", path.c_str(), outcome.virtual_s);
  return Verdict::Passed;
}

}  // namespace

int main(int argc, char** argv) {
  bool verbose = false;
  int worst = argc < 2 ? static_cast<int>(Verdict::NoTalk) : 0;
  if (argc < 2) std::fprintf(stderr, "usage: talk [-v] FILE...\n");
  for (int at = 1; at < argc; ++at) {
    const std::string argument = argv[at];
    if (argument == "-v") {
      verbose = true;
      continue;
    }
    const int verdict = static_cast<int>(hold(argument, verbose));
    worst = verdict > worst ? verdict : worst;
  }
  return worst;
}
