#pragma once
// The file of a job, however long: memory does not grow with it.
//
// Nobody else's file is mapped, because one that is cut short while it is mapped kills the process that reads it, and
// one that is saved again in the middle of a job would change the job. A short file is read; a long one is copied to a
// file without a name in the state folder (at once where the file system shares blocks), and that is mapped. The system
// takes the copy away with the process. What is packed with gzip or zstd is unpacked on the way.

#include <expected>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <variant>

#include "io/text_file.hpp"
#include "io/unpacking.hpp"
#include "sender/job/program.hpp"

namespace kerf::io {

/// Files up to this size are held in memory.
inline constexpr std::size_t kMostHeldBytes = std::size_t{4} << 20U;

using ProgramFileError = std::variant<FileError, job::ProgramFault>;

/// One sentence for people: what, where, what to do.
[[nodiscard]] std::string explain(const ProgramFileError& error, std::string_view path);

/// A program and the memory that it lies in. While a mapped one lives, a thread gives the pages that were read back to
/// the system ten times a second: they come again when they are needed. Any thread, one at a time.
class ProgramFile {
 public:
  /// Reads, checks and indexes the whole file; a gigabyte takes seconds.
  [[nodiscard]] static std::expected<ProgramFile, ProgramFileError> load(const std::string& path);
  /// The program has another name than its file.
  [[nodiscard]] static std::expected<ProgramFile, ProgramFileError> load(const std::string& path,
                                                                         const std::string& name);

  /// The same for a text that `write` gives away piece by piece.
  using Put = std::function<void(std::string_view)>;
  [[nodiscard]] static std::expected<ProgramFile, ProgramFileError> assemble(
      const std::string& name, const std::function<void(const Put&)>& write);

  [[nodiscard]] const std::shared_ptr<const job::Program>& program() const { return program_; }
  /// Now, for whoever reads faster than the thread gives back.
  void give_back() const;

 private:
  class Mapping;
  class Assembly;
  ProgramFile() = default;
  [[nodiscard]] static std::expected<ProgramFile, ProgramFileError> read_whole(const std::string& path,
                                                                               const std::string& name);
  [[nodiscard]] static std::expected<ProgramFile, ProgramFileError> held(const std::string& name, std::string text);
  [[nodiscard]] static std::expected<ProgramFile, ProgramFileError> mapped(const std::string& name, int copy);

  [[nodiscard]] static std::expected<ProgramFile, ProgramFileError> unpacked(const std::string& name, int packed,
                                                                             Packing packing);

  /// Null for a program in memory.
  std::shared_ptr<const Mapping> mapping_;
  std::shared_ptr<const job::Program> program_;
};

}  // namespace kerf::io
