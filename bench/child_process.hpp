#pragma once
// Other programs as processes, and what they took.

#include <atomic>
#include <optional>
#include <string>
#include <vector>

#include <sys/types.h>

namespace kerf::bench {

/// What a process took.
struct ProcessTook {
  double wall_s = 0;
  double cpu_s = 0;
  double peak_mb = 0;
};

/// Memory of a process.
struct Memory {
  double peak_mb = 0;  ///< most that was ever resident, pages of files too
  double own_mb = 0;   ///< anonymous, now: what no file can give back
};

/// A running program whose output is thrown away; it is killed when this is destroyed. One thread may wait while
/// another one watches.
class ChildProcess {
 public:
  /// `input` becomes its standard input; -1 for nothing.
  explicit ChildProcess(const std::vector<std::string>& words, int input = -1);
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  void signal(int number) const;
  /// Nothing once it has ended.
  [[nodiscard]] std::optional<Memory> memory() const;
  /// Waits for its end; nothing if it could not be run or ended with a status other than 0.
  [[nodiscard]] std::optional<ProcessTook> wait();

 private:
  double started_s_;
  std::atomic<pid_t> child_{-1};
};

/// Runs a program to its end.
[[nodiscard]] std::optional<ProcessTook> run_process(const std::vector<std::string>& words);

/// A new folder for files that nobody needs afterwards; removed with this.
class ScratchFolder {
 public:
  ScratchFolder();
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  [[nodiscard]] const std::string& path() const { return path_; }

 private:
  std::string path_;
};

}  // namespace kerf::bench
