#pragma once
// The file of a job, however long: memory does not grow with it.
//
// Nobody else's file is mapped, because one that is cut short while it is mapped kills the process that reads it, and
// one that is saved again in the middle of a job would change the job. A short file is read; a long one is copied to a
// file without a name in the state folder (at once where the file system shares blocks), and that is mapped. The system
// takes the copy away with the process.

#include <expected>
#include <memory>
#include <string>
#include <variant>

#include "io/event_loop.hpp"
#include "io/text_file.hpp"
#include "sender/job/program.hpp"

namespace kerf::io {

/// Files up to this size are held in memory.
inline constexpr std::size_t kMostHeldBytes = std::size_t{4} << 20U;

using ProgramFileError = std::variant<FileError, job::ProgramFault>;

/// One sentence for people: what, where, what to do.
[[nodiscard]] std::string explain(const ProgramFileError& error, std::string_view path);

/// A program and the memory that it lies in. Loop's thread only.
class ProgramFile {
 public:
  /// Reads, checks and indexes the whole file; a gigabyte takes seconds.
  [[nodiscard]] static std::expected<ProgramFile, ProgramFileError> load(const std::string& path);

  [[nodiscard]] const std::shared_ptr<const job::Program>& program() const { return program_; }

  /// While `loop` runs, gives the pages that were read back to the system ten times a second: they come again when they
  /// are needed. Does nothing for a file that is held in memory.
  void save_memory(EventLoop& loop);

 private:
  class Mapping;
  struct Saver;
  struct SaverEnd {
    void operator()(Saver* saver) const;
  };
  ProgramFile() = default;
  [[nodiscard]] static std::expected<ProgramFile, ProgramFileError> held(const std::string& path);
  [[nodiscard]] static std::expected<ProgramFile, ProgramFileError> mapped(const std::string& path, int copy);

  std::shared_ptr<const Mapping> mapping_;
  std::shared_ptr<const job::Program> program_;
  std::unique_ptr<Saver, SaverEnd> saver_;
};

}  // namespace kerf::io
