#pragma once
// The programs that a daemon keeps: each a file named by the hash of its content, so that the same program is there
// once, and a row of the store with its name. Loop's thread; files are read and checked on the pool.

#include <cstdint>
#include <expected>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "daemon/machine_view.hpp"
#include "daemon/store.hpp"
#include "io/program_file.hpp"
#include "io/worker_pool.hpp"

namespace kerf::daemon {

/// A program that is read and indexed, and stays so while somebody has it.
struct LibraryProgram {
  std::string id;
  std::string name;
  std::string path;
  io::ProgramFile file;
};
using SharedProgram = std::shared_ptr<const LibraryProgram>;

class ProgramLibrary {
 public:
  /// Pool and store live longer. The folder is made where it is not there; one sentence where it cannot be used.
  [[nodiscard]] static std::expected<std::unique_ptr<ProgramLibrary>, std::string> open(io::WorkerPool& pool,
                                                                                        Store& store,
                                                                                        const std::string& folder);
  ~ProgramLibrary() = default;
  ProgramLibrary(const ProgramLibrary&) = delete;
  ProgramLibrary& operator=(const ProgramLibrary&) = delete;

  [[nodiscard]] const std::map<std::string, ProgramView>& programs() const { return programs_; }
  /// Called whenever a program came or went.
  void on_changed(std::function<void()> changed) { changed_ = std::move(changed); }

  using Added = std::expected<std::string, std::string>;
  /// Takes a program piece by piece; `added` hears its id, or one sentence why it is none.
  class Incoming;
  [[nodiscard]] std::expected<std::unique_ptr<Incoming>, std::string> receive(const std::string& name);
  /// A file that is there already.
  void add_file(const std::string& path, const std::string& name, bool example, std::function<void(Added)> added);

  using Opened = std::expected<SharedProgram, std::string>;
  /// Reads and indexes it, unless somebody has it.
  void open_program(const std::string& id, std::function<void(Opened)> opened);
  [[nodiscard]] std::expected<void, std::string> remove(const std::string& id);

 private:
  ProgramLibrary(io::WorkerPool& pool, Store& store, std::string folder);
  void take_in(const std::string& path, const std::string& name, bool example, std::function<void(Added)> added);
  [[nodiscard]] std::string path_of(const std::string& id) const { return folder_ + "/" + id + ".nc"; }

  io::WorkerPool& pool_;
  Store& store_;
  const std::string folder_;
  std::map<std::string, ProgramView> programs_;
  std::map<std::string, std::weak_ptr<const LibraryProgram>> open_;
  std::function<void()> changed_;
  std::uint64_t incoming_ = 0;
};

class ProgramLibrary::Incoming {
 public:
  Incoming(ProgramLibrary& library, std::string path, std::string name, int descriptor);
  /// What was not finished is deleted.
  ~Incoming();
  Incoming(const Incoming&) = delete;
  Incoming& operator=(const Incoming&) = delete;

  /// One sentence where the disk does not take it.
  [[nodiscard]] std::expected<void, std::string> append(std::string_view bytes);
  void finish(std::function<void(Added)> added);

 private:
  ProgramLibrary& library_;
  const std::string path_;
  const std::string name_;
  int descriptor_;
  bool is_finished_ = false;
};

}  // namespace kerf::daemon
