#include "firmware/card.hpp"

#include "common/base/text.hpp"

namespace kerf::firmware {

namespace {

/// What every file in `folder` begins with.
std::string prefix_of(std::string_view folder) {
  return folder == "/" ? "/" : std::string{folder} + "/";
}

}  // namespace

std::string card_path(std::string_view folder, std::string_view name) {
  std::vector<std::string_view> parts;
  const auto add = [&](std::string_view path) {
    for (const std::string_view part : base::split(path, '/')) {
      if (part == "..") {
        if (!parts.empty()) parts.pop_back();
      } else if (!part.empty() && part != ".") {
        parts.push_back(part);
      }
    }
  };
  if (!name.starts_with('/')) add(folder);
  add(name);
  std::string path;
  for (const std::string_view part : parts) path.append("/").append(part);
  return path.empty() ? "/" : path;
}

void MemoryCard::put(std::string_view path, std::string contents) {
  files_.insert_or_assign(card_path("/", path), std::move(contents));
}

std::optional<std::string> MemoryCard::contents(std::string_view path) const {
  const auto found = files_.find(path);
  if (found == files_.end()) return std::nullopt;
  return found->second;
}

std::optional<std::vector<CardEntry>> MemoryCard::list(const std::string& folder) {
  const std::string prefix = prefix_of(folder);
  std::map<std::string, CardEntry, std::less<>> entries;
  for (const auto& [path, contents] : files_) {
    if (!path.starts_with(prefix)) continue;
    const std::string rest = path.substr(prefix.size());
    const std::size_t slash = rest.find('/');
    const bool is_folder = slash != std::string::npos;
    const std::string name = rest.substr(0, slash);
    entries.insert_or_assign(name,
                             CardEntry{.name = name, .bytes = is_folder ? 0 : contents.size(), .is_folder = is_folder});
  }
  if (entries.empty() && folder != "/") return std::nullopt;
  std::vector<CardEntry> list;
  for (auto& [name, entry] : entries) list.push_back(std::move(entry));
  return list;
}

std::optional<CardEntry> MemoryCard::find(const std::string& path) {
  const std::string name = path.substr(path.rfind('/') + 1);
  if (const auto found = files_.find(path); found != files_.end()) {
    return CardEntry{.name = name, .bytes = found->second.size(), .is_folder = false};
  }
  if (!list(path)) return std::nullopt;
  return CardEntry{.name = name, .bytes = 0, .is_folder = true};
}

std::string MemoryCard::read(const std::string& path, std::uint64_t offset, std::size_t most) {
  const auto found = files_.find(path);
  if (found == files_.end() || offset >= found->second.size()) return {};
  return found->second.substr(static_cast<std::size_t>(offset), most);
}

bool MemoryCard::create(const std::string& path) {
  if (const auto there = find(path); there && there->is_folder) return false;
  files_.insert_or_assign(path, std::string{});
  return true;
}

bool MemoryCard::append(const std::string& path, std::string_view bytes) {
  const auto found = files_.find(path);
  if (found == files_.end()) return false;
  found->second += bytes;
  return true;
}

bool MemoryCard::remove(const std::string& path) {
  return files_.erase(path) != 0;
}

CardSpace MemoryCard::space() {
  constexpr std::uint64_t kTotalBytes = 8'000'000'000;
  std::uint64_t used = 0;
  for (const auto& [path, contents] : files_) used += contents.size();
  return {.total_bytes = kTotalBytes, .free_bytes = kTotalBytes - used};
}

}  // namespace kerf::firmware
