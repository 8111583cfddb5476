// Thousands of jobs in virtual time, each struck by what its seed says, on all cores.
//
//   campaign --runs 10000 --seed 1 --jobs 2     seeds 1 to 10000; exit status 1 when one failed
//   campaign --runs 10000 --seconds 150         as many of them as that time allows
//   campaign --runs 10000 --resumes 0           nobody resumes what was interrupted
//   campaign --replay 4711                      one seed, with everything that was said and done

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <map>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include <boost/describe/enum_to_string.hpp>
#include <sys/wait.h>
#include <unistd.h>

#include "common/base/text.hpp"
#include "simulation/campaign.hpp"

namespace kerf::simulation {
namespace {

using Clock = std::chrono::steady_clock;

struct Options {
  std::uint64_t runs = 1000;
  std::uint64_t seed = 1;
  std::uint64_t jobs = std::max(1U, std::thread::hardware_concurrency());
  std::uint64_t seconds = 0;
  std::uint64_t replay = 0;
  std::uint64_t resumes = 6;
};

/// What a worker has counted, one line `name<TAB>count` each, and what failed.
class Tally {
 public:
  void add(const std::string& name, std::uint64_t count = 1) { counts_[name] += count; }
  void fail(const std::string& text) { failures_.push_back(text); }
  void merge_line(std::string_view line) {
    if (line.starts_with("! ")) {
      failures_.emplace_back(line.substr(2));
    } else if (const auto tab = line.find('\t'); tab != std::string_view::npos) {
      add(std::string{line.substr(0, tab)}, base::parse_int<std::uint64_t>(line.substr(tab + 1)).value_or(0));
    }
  }
  [[nodiscard]] std::string text() const {
    std::string text;
    for (const auto& [name, count] : counts_) text += name + "\t" + std::to_string(count) + "\n";
    for (const std::string& failure : failures_) text += "! " + failure + "\n";
    return text;
  }
  [[nodiscard]] std::uint64_t count(const std::string& name) const {
    const auto found = counts_.find(name);
    return found == counts_.end() ? 0 : found->second;
  }
  [[nodiscard]] const std::map<std::string, std::uint64_t>& counts() const { return counts_; }
  [[nodiscard]] const std::vector<std::string>& failures() const { return failures_; }

 private:
  std::map<std::string, std::uint64_t> counts_;
  std::vector<std::string> failures_;
};

template <class Enum>
std::string name(Enum value) {
  return boost::describe::enum_to_string(value, "?");
}

void enter(Tally& tally, const CampaignCase& made_up, const CampaignVerdict& verdict) {
  tally.add("runs");
  tally.add("machine hours (in seconds)", static_cast<std::uint64_t>(base::to_seconds(verdict.took)));
  tally.add("firmware " + name(made_up.world.firmware));
  tally.add("link " + name(made_up.link));
  tally.add("ending " + name(verdict.ending));
  if (verdict.unjudged) tally.add("cut not judged");
  if (verdict.cut_amiss) tally.add("changed bytes: on the path, cut amiss");
  if (verdict.left_path) tally.add("off the path of the job");
  if (verdict.resumes > 0) tally.add("resumes", static_cast<std::uint64_t>(verdict.resumes));
  if (!verdict.refusal.empty()) tally.add("no plan: " + verdict.refusal);
  for (const FaultKind kind : verdict.struck) {
    tally.add("fault " + std::string{name_of(kind)} + " on " + name(made_up.world.firmware));
  }
  if (verdict.complaints.empty()) return;
  tally.add("failed");
  tally.fail(
      describe(made_up) + " -> " + verdict.complaints.front() +
      (verdict.complaints.size() > 1 ? " (and " + std::to_string(verdict.complaints.size() - 1) + " more)" : ""));
}

/// Every `jobs`-th seed from `first`. Each seed is told before it is tried, so that one that crashes is known.
void work(const Options& options, std::uint64_t first, int out) {
  Tally tally;
  const auto end = Clock::now() + std::chrono::seconds{options.seconds};
  for (std::uint64_t i = first; i < options.runs; i += options.jobs) {
    if (options.seconds != 0 && Clock::now() >= end) break;
    const std::string trying = "@" + std::to_string(options.seed + i) + "\n";
    static_cast<void>(!write(out, trying.data(), trying.size()));
    const CampaignCase made_up = campaign_case(options.seed + i);
    enter(tally, made_up, judge(made_up, static_cast<int>(options.resumes)));
  }
  const std::string text = tally.text() + "@done\n";
  for (std::string_view rest = text; !rest.empty();) {
    const auto written = write(out, rest.data(), rest.size());
    if (written <= 0) break;
    rest.remove_prefix(static_cast<std::size_t>(written));
  }
}

struct Worker {
  pid_t pid = 0;
  int in = 0;
};

Worker start_worker(const Options& options, std::uint64_t first) {
  std::array<int, 2> ends{};
  if (pipe(ends.data()) != 0) return {};
  const pid_t pid = fork();
  if (pid == 0) {
    close(ends[0]);
    work(options, first, ends[1]);
    _exit(0);
  }
  close(ends[1]);
  return {.pid = pid, .in = ends[0]};
}

/// Reads what a worker says to its end.
void collect(const Worker& worker, Tally& tally) {
  std::string said;
  std::array<char, 65536> block{};
  for (ssize_t got = 0; (got = read(worker.in, block.data(), block.size())) > 0;) {
    said.append(block.data(), static_cast<std::size_t>(got));
  }
  close(worker.in);
  waitpid(worker.pid, nullptr, 0);
  std::string_view last;
  for (const std::string_view line : base::split(said, '\n')) {
    if (line.starts_with('@')) {
      last = line.substr(1);
    } else {
      tally.merge_line(line);
    }
  }
  if (last == "done") return;
  tally.add("failed");
  tally.fail("seed " + std::string{last} + ": the program broke off");
}

int run(const Options& options) {
  const auto began = Clock::now();
  std::vector<Worker> workers;
  for (std::uint64_t first = 0; first < options.jobs; ++first) workers.push_back(start_worker(options, first));
  Tally tally;
  for (const Worker& worker : workers) collect(worker, tally);
  const double took_s = std::chrono::duration<double>(Clock::now() - began).count();

  for (const auto& [what, count] : tally.counts())
    std::printf("%8llu  %s\n", static_cast<unsigned long long>(count), what.c_str());
  std::printf("%8.1f  seconds, %.1f runs a second\n", took_s, static_cast<double>(tally.count("runs")) / took_s);
  for (const std::string& failure : tally.failures()) std::printf("FAILED %s\n", failure.c_str());
  if (!tally.failures().empty()) std::printf("\nOne of them with everything said and done: campaign --replay SEED\n");
  return tally.failures().empty() ? 0 : 1;
}

int replay(const Options& options) {
  const CampaignCase made_up = campaign_case(options.replay);
  std::printf("%s\n\n%s\n", describe(made_up).c_str(), made_up.program.c_str());
  const CampaignVerdict verdict = judge(made_up, static_cast<int>(options.resumes), true);
  std::printf("%s\n", verdict.transcript.c_str());
  std::printf("%s after %.1f s\n", name(verdict.ending).c_str(), base::to_seconds(verdict.took));
  for (const std::string& complaint : verdict.complaints) std::printf("FAILED %s\n", complaint.c_str());
  return verdict.complaints.empty() ? 0 : 1;
}

bool parse(int count, char** words, Options& options) {
  for (int i = 1; i < count; i += 2) {
    const auto value = i + 1 < count ? base::parse_int<std::uint64_t>(words[i + 1]) : std::nullopt;
    if (!value) return false;
    const std::string_view word = words[i];
    if (word == "--runs") {
      options.runs = *value;
    } else if (word == "--seed") {
      options.seed = *value;
    } else if (word == "--jobs") {
      options.jobs = std::max<std::uint64_t>(1, *value);
    } else if (word == "--seconds") {
      options.seconds = *value;
    } else if (word == "--resumes") {
      options.resumes = *value;
    } else if (word == "--replay") {
      options.replay = *value;
    } else {
      return false;
    }
  }
  return true;
}

}  // namespace
}  // namespace kerf::simulation

int main(int count, char** words) {
  kerf::simulation::Options options;
  if (!kerf::simulation::parse(count, words, options)) {
    std::fputs("campaign [--runs N] [--seed N] [--jobs N] [--seconds N] [--resumes N] [--replay SEED]\n", stderr);
    return 2;
  }
  return options.replay != 0 ? kerf::simulation::replay(options) : kerf::simulation::run(options);
}
