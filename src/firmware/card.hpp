#pragma once
// An SD card as the controller sees it: folders and files, which somebody else keeps.

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace kerf::firmware {

struct CardEntry {
  std::string name{};  ///< without the folder
  std::uint64_t bytes = 0;
  bool is_folder = false;
  friend bool operator==(const CardEntry&, const CardEntry&) = default;
};

struct CardSpace {
  std::uint64_t total_bytes = 0;
  std::uint64_t free_bytes = 0;
};

/// What a controller asks of the card in its slot. Paths are absolute and plain, as card_path() makes them. A
/// controller asks while it is called, like any program asks a disk; whoever answers may do input and output, but calls
/// nobody back.
class Card {
 public:
  virtual ~Card() = default;

  /// What lies in a folder, in the order of names; nothing if there is no such folder.
  [[nodiscard]] virtual std::optional<std::vector<CardEntry>> list(const std::string& folder) = 0;
  [[nodiscard]] virtual std::optional<CardEntry> find(const std::string& path) = 0;
  /// Up to `most` bytes from `offset` on; fewer at the end, none behind it or when the file cannot be read.
  [[nodiscard]] virtual std::string read(const std::string& path, std::uint64_t offset, std::size_t most) = 0;
  /// Makes an empty file, in place of one that was there. False if the card refuses, as for the two below.
  [[nodiscard]] virtual bool create(const std::string& path) = 0;
  [[nodiscard]] virtual bool append(const std::string& path, std::string_view bytes) = 0;
  [[nodiscard]] virtual bool remove(const std::string& path) = 0;
  [[nodiscard]] virtual CardSpace space() = 0;
};

/// A card that lives in memory, for tests and conversations.
class MemoryCard final : public Card {
 public:
  /// Puts a file on the card; folders on its way come into being.
  void put(std::string_view path, std::string contents);
  /// The contents of a file; nothing if there is none.
  [[nodiscard]] std::optional<std::string> contents(std::string_view path) const;

  std::optional<std::vector<CardEntry>> list(const std::string& folder) override;
  std::optional<CardEntry> find(const std::string& path) override;
  std::string read(const std::string& path, std::uint64_t offset, std::size_t most) override;
  bool create(const std::string& path) override;
  bool append(const std::string& path, std::string_view bytes) override;
  bool remove(const std::string& path) override;
  CardSpace space() override;

 private:
  /// By path.
  std::map<std::string, std::string, std::less<>> files_;
};

/// `name` as seen from `folder`, absolute and without `.`, `..` and doubled slashes; nothing leads above the root.
[[nodiscard]] std::string card_path(std::string_view folder, std::string_view name);

}  // namespace kerf::firmware
