#include "child_process.hpp"

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string_view>

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace kerf::bench {
namespace {

constexpr double kKilobytesAMegabyte = 1024.0;

double steady_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

double seconds_of(const timeval& time) {
  return static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_usec) * 1e-6;
}

[[noreturn]] void become(const std::vector<std::string>& words, int input) {
  std::vector<char*> arguments;
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  const int nowhere = open("/dev/null", O_RDWR | O_CLOEXEC);
  dup2(input < 0 ? nowhere : input, STDIN_FILENO);
  dup2(nowhere, STDOUT_FILENO);
  dup2(nowhere, STDERR_FILENO);
  execv(arguments[0], arguments.data());
  _exit(127);
}

}  // namespace

ChildProcess::ChildProcess(const std::vector<std::string>& words, int input) : started_s_(steady_s()), child_(fork()) {
  if (child_ == 0) become(words, input);
}

ChildProcess::~ChildProcess() {
  if (child_ <= 0) return;
  kill(child_, SIGKILL);
  waitpid(child_, nullptr, 0);
}

void ChildProcess::signal(int number) const {
  if (child_ > 0) kill(child_, number);
}

std::optional<Memory> ChildProcess::memory() const {
  std::ifstream status("/proc/" + std::to_string(child_) + "/status");
  Memory memory;
  std::string name;
  double kilobytes = 0;
  for (std::string line; status >> name && std::getline(status, line);) {
    kilobytes = std::strtod(line.c_str(), nullptr);
    if (name == "VmHWM:") memory.peak_mb = kilobytes / kKilobytesAMegabyte;
    if (name == "RssAnon:") memory.own_mb = kilobytes / kKilobytesAMegabyte;
  }
  if (memory.peak_mb == 0) return std::nullopt;
  return memory;
}

std::optional<ProcessTook> ChildProcess::wait() {
  int status = 0;
  rusage used{};
  const pid_t child = child_;
  if (child < 0 || wait4(child, &status, 0, &used) != child) return std::nullopt;
  child_ = -1;
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) return std::nullopt;
  return ProcessTook{.wall_s = steady_s() - started_s_,
                     .cpu_s = seconds_of(used.ru_utime) + seconds_of(used.ru_stime),
                     .peak_mb = static_cast<double>(used.ru_maxrss) / kKilobytesAMegabyte};
}

std::optional<ProcessTook> run_process(const std::vector<std::string>& words) {
  return ChildProcess(words).wait();
}

ScratchFolder::ScratchFolder() : path_(std::filesystem::temp_directory_path() / "kerf-bench-XXXXXX") {
  if (mkdtemp(path_.data()) == nullptr) path_.clear();
}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;
  if (!path_.empty()) std::filesystem::remove_all(path_, ignored);
}

}  // namespace kerf::bench
