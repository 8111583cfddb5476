#include "daemon/program_library.hpp"

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include "io/wall_clock.hpp"

namespace kerf::daemon {
namespace {

namespace fs = std::filesystem;

constexpr mode_t kOnlyMine = 0600;
constexpr std::size_t kLongestName = 200;

/// The last part of a path, without what a screen or a file system would stumble over.
std::string plain_name(std::string_view name) {
  name.remove_prefix(std::min(name.find_last_of("/\\") + 1, name.size()));
  std::string plain;
  for (const char letter : name.substr(0, kLongestName)) {
    const bool is_control = static_cast<unsigned char>(letter) < ' ' || letter == '\x7f';
    plain += is_control ? '_' : letter;
  }
  return plain.empty() ? "program.nc" : plain;
}

std::string sentence_of(const std::string& what, const std::error_code& fault) {
  return fmt::format("{} ({}).", what, fault.message());
}

}  // namespace

std::expected<std::unique_ptr<ProgramLibrary>, std::string> ProgramLibrary::open(io::WorkerPool& pool, Store& store,
                                                                                 const std::string& folder) {
  std::error_code fault;
  fs::create_directories(folder, fault);
  if (fault) return std::unexpected(sentence_of("The library of programs cannot be kept in " + folder, fault));
  fs::permissions(folder, fs::perms::owner_all, fault);
  for (const auto& entry : fs::directory_iterator(folder, fault)) {
    if (entry.path().filename().string().starts_with("incoming-")) fs::remove(entry.path(), fault);
  }
  std::unique_ptr<ProgramLibrary> library(new ProgramLibrary(pool, store, folder));
  library->programs_ = store.programs();
  std::erase_if(library->programs_, [&](const auto& program) { return !fs::exists(library->path_of(program.first)); });
  return library;
}

ProgramLibrary::ProgramLibrary(io::WorkerPool& pool, Store& store, std::string folder)
    : pool_(pool), store_(store), folder_(std::move(folder)) {}

std::expected<std::unique_ptr<ProgramLibrary::Incoming>, std::string> ProgramLibrary::receive(const std::string& name) {
  std::string path = fmt::format("{}/incoming-{}", folder_, ++incoming_);
  const int descriptor = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, kOnlyMine);
  if (descriptor < 0) {
    return std::unexpected(sentence_of("The program cannot be kept", {errno, std::generic_category()}));
  }
  return std::make_unique<Incoming>(*this, std::move(path), plain_name(name), descriptor);
}

void ProgramLibrary::add_file(const std::string& path, const std::string& name, bool example,
                              std::function<void(Added)> added) {
  const std::string copy = fmt::format("{}/incoming-{}", folder_, ++incoming_);
  std::error_code fault;
  fs::copy_file(path, copy, fs::copy_options::overwrite_existing, fault);
  if (fault) return added(std::unexpected(sentence_of(path + " cannot be read", fault)));
  take_in(copy, plain_name(name), example, std::move(added));
}

void ProgramLibrary::take_in(const std::string& path, const std::string& name, bool example,
                             std::function<void(Added)> added) {
  pool_.run([this, path, name, example, added = std::move(added)]() -> std::function<void()> {
    auto file = io::ProgramFile::load(path, name);
    if (!file) {
      std::error_code ignored;
      fs::remove(path, ignored);
      return [added, why = io::explain(file.error(), name)] { added(std::unexpected(why)); };
    }
    const job::Program& program = *file->program();
    ProgramView view{.name = name,
                     .bytes = program.size_bytes(),
                     .lines = program.line_count(),
                     .added_at = io::to_string(io::wall_clock_now()),
                     .example = example};
    return [this, path, id = program.hash(), view = std::move(view), added]() mutable {
      std::error_code fault;
      fs::rename(path, path_of(id), fault);
      if (fault) return added(std::unexpected(sentence_of("The program cannot be kept", fault)));
      if (auto kept = store_.put_program(id, view); !kept) return added(std::unexpected(kept.error()));
      programs_[id] = std::move(view);
      if (changed_) changed_();
      added(id);
    };
  });
}

void ProgramLibrary::open_program(const std::string& id, std::function<void(Opened)> opened) {
  const auto known = programs_.find(id);
  if (known == programs_.end()) return opened(std::unexpected("There is no such program in the library."));
  if (auto program = open_[id].lock()) return opened(std::move(program));
  pool_.run(
      [this, id, name = known->second.name, path = path_of(id), opened = std::move(opened)]() -> std::function<void()> {
        auto file = io::ProgramFile::load(path, name);
        if (!file) return [opened, why = io::explain(file.error(), name)] { opened(std::unexpected(why)); };
        auto program = std::make_shared<const LibraryProgram>(LibraryProgram{id, name, path, *std::move(file)});
        return [this, id, program, opened] {
          open_[id] = program;
          opened(program);
        };
      });
}

std::expected<void, std::string> ProgramLibrary::remove(const std::string& id) {
  if (!programs_.contains(id)) return std::unexpected("There is no such program in the library.");
  if (auto forgotten = store_.remove_program(id); !forgotten) return forgotten;
  std::error_code ignored;
  fs::remove(path_of(id), ignored);
  programs_.erase(id);
  open_.erase(id);
  if (changed_) changed_();
  return {};
}

ProgramLibrary::Incoming::Incoming(ProgramLibrary& library, std::string path, std::string name, int descriptor)
    : library_(library), path_(std::move(path)), name_(std::move(name)), descriptor_(descriptor) {}

ProgramLibrary::Incoming::~Incoming() {
  if (descriptor_ >= 0) ::close(descriptor_);
  if (!is_finished_) ::unlink(path_.c_str());
}

std::expected<void, std::string> ProgramLibrary::Incoming::append(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) {
      return std::unexpected(sentence_of("The program cannot be kept", {errno, std::generic_category()}));
    }
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  return {};
}

void ProgramLibrary::Incoming::finish(std::function<void(Added)> added) {
  ::close(std::exchange(descriptor_, -1));
  is_finished_ = true;
  library_.take_in(path_, name_, false, std::move(added));
}

}  // namespace kerf::daemon
