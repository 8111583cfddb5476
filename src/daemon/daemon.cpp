#include "daemon/daemon.hpp"

#include <filesystem>
#include <utility>

namespace kerf::daemon {

std::expected<std::unique_ptr<Daemon>, std::string> Daemon::begin(io::EventLoop& loop, const DaemonOptions& options) {
  auto store = Store::open(options.state_folder + "/daemon.sqlite");
  if (!store) return std::unexpected(store.error());
  auto pool = std::make_unique<io::WorkerPool>(loop);
  auto library = ProgramLibrary::open(*pool, **store, options.state_folder + "/programs");
  if (!library) return std::unexpected(library.error());
  std::unique_ptr<Daemon> daemon(new Daemon(loop, options, *std::move(store), std::move(pool), *std::move(library)));
  for (const MachineRow& row : options.machines) {
    if (const auto id = daemon->park_.add_fixed(row); !id) {
      return std::unexpected("The machine '" + row.name + "' of the configuration: " + id.error());
    }
  }
  daemon->park_.add_remembered();
  const auto address = daemon->server_.listen(options.listen);
  if (!address) return std::unexpected(io::explain(address.error(), io::to_string(options.listen)));
  daemon->address_ = *address;
  if (!options.program.empty()) {
    const std::string name = std::filesystem::path(options.program).filename().string();
    daemon->library_->add_file(options.program, name, true,
                               [daemon = daemon.get()](const ProgramLibrary::Added& added) {
                                 if (added) daemon->load_everywhere(*added);
                               });
  }
  return daemon;
}

Daemon::Daemon(io::EventLoop& loop, const DaemonOptions& options, std::unique_ptr<Store> store,
               std::unique_ptr<io::WorkerPool> pool, std::unique_ptr<ProgramLibrary> library)
    : store_(std::move(store)),
      pool_(std::move(pool)),
      library_(std::move(library)),
      park_({.loop = &loop,
             .pool = pool_.get(),
             .store = store_.get(),
             .library = library_.get(),
             .recording = options.recording},
            {.published = [this](const Frame& patch) { clients_.on_published(patch); },
             .traffic = [this](const std::string& machine) { clients_.on_traffic(machine); }}),
      answers_(park_),
      clients_(park_, answers_),
      api_(*pool_, park_, *library_, clients_, answers_),
      server_(loop, *pool_, api_) {
  library_->on_changed([this] { park_.on_programs_changed(); });
}

Daemon::~Daemon() = default;

bool Daemon::hold_jobs() {
  bool holds = false;
  for (const auto& [id, station] : park_.stations()) {
    if (!station->has_job()) continue;
    static_cast<void>(station->obey(Hold{}));
    holds = true;
  }
  return holds;
}

void Daemon::load_everywhere(const std::string& program) {
  for (const auto& [id, station] : park_.stations()) static_cast<void>(station->obey(Load{program}));
}

}  // namespace kerf::daemon
