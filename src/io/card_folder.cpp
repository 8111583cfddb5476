#include "io/card_folder.hpp"

#include <algorithm>
#include <fstream>
#include <system_error>

namespace kerf::io {

namespace fs = std::filesystem;
using firmware::CardEntry;

namespace {

/// A file or a folder; anything else (sockets, devices, dangling links) is not on the card.
std::optional<CardEntry> entry_at(const fs::path& place) {
  std::error_code fault;
  const fs::file_status status = fs::status(place, fault);
  CardEntry entry{.name = place.filename().string()};
  if (fs::is_directory(status)) {
    entry.is_folder = true;
    return entry;
  }
  if (!fs::is_regular_file(status)) return std::nullopt;
  const std::uintmax_t bytes = fs::file_size(place, fault);
  entry.bytes = fault ? 0 : bytes;
  return entry;
}

bool is_inside(const fs::path& root, const fs::path& place) {
  const auto [root_end, at] = std::ranges::mismatch(root, place);
  return root_end == root.end();
}

}  // namespace

CardFolder::CardFolder(const fs::path& folder) : root_(fs::canonical(folder)) {}

std::optional<fs::path> CardFolder::place_of(const std::string& path) const {
  fs::path place = root_;
  for (const fs::path& part : fs::path{path}.relative_path()) {
    if (part.native().starts_with('.')) return std::nullopt;
    place /= part;
  }
  std::error_code fault;
  const fs::path real = fs::weakly_canonical(place, fault);
  if (fault || !is_inside(root_, real)) return std::nullopt;
  return real;
}

std::optional<std::vector<CardEntry>> CardFolder::list(const std::string& folder) {
  const auto place = place_of(folder);
  if (!place) return std::nullopt;
  std::error_code fault;
  fs::directory_iterator at(*place, fs::directory_options::skip_permission_denied, fault);
  if (fault) return std::nullopt;
  std::vector<CardEntry> entries;
  for (; at != fs::directory_iterator{}; at.increment(fault)) {
    if (fault) break;
    if (at->path().filename().native().starts_with('.')) continue;
    if (!is_inside(root_, fs::weakly_canonical(at->path(), fault))) continue;
    if (auto entry = entry_at(at->path())) entries.push_back(*std::move(entry));
  }
  std::ranges::sort(entries, {}, &CardEntry::name);
  return entries;
}

std::optional<CardEntry> CardFolder::find(const std::string& path) {
  const auto place = place_of(path);
  return place ? entry_at(*place) : std::nullopt;
}

std::string CardFolder::read(const std::string& path, std::uint64_t offset, std::size_t most) {
  const auto place = place_of(path);
  if (!place) return {};
  std::ifstream file(*place, std::ios::binary);
  file.seekg(static_cast<std::streamoff>(offset));
  std::string bytes(most, '\0');
  file.read(bytes.data(), static_cast<std::streamsize>(most));
  bytes.resize(file.gcount() > 0 ? static_cast<std::size_t>(file.gcount()) : 0);
  return bytes;
}

bool CardFolder::create(const std::string& path) {
  const auto place = place_of(path);
  if (!place || *place == root_) return false;
  std::error_code fault;
  if (fs::exists(*place, fault) && !fs::is_regular_file(*place, fault)) return false;
  return std::ofstream(*place, std::ios::binary | std::ios::trunc).good();
}

bool CardFolder::append(const std::string& path, std::string_view bytes) {
  const auto place = place_of(path);
  if (!place) return false;
  std::ofstream file(*place, std::ios::binary | std::ios::app);
  file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  file.close();
  return file.good();
}

bool CardFolder::remove(const std::string& path) {
  const auto place = place_of(path);
  std::error_code fault;
  // Folders stay: one of this computer's is more than one of a card's.
  return place && fs::is_regular_file(*place, fault) && fs::remove(*place, fault);
}

firmware::CardSpace CardFolder::space() {
  std::error_code fault;
  const fs::space_info space = fs::space(root_, fault);
  if (fault) return {};
  return {.total_bytes = space.capacity, .free_bytes = space.available};
}

}  // namespace kerf::io
