#pragma once
// A folder of this computer in the card slot of a virtual machine.

#include <filesystem>

#include "firmware/card.hpp"

namespace kerf::io {

/// Every question goes to the disk, so files that others put there are seen at once. Names that begin with a dot are
/// hidden. Nothing outside of the folder is touched: paths come without `..`, and links that lead out are not followed.
/// Any one thread.
class CardFolder final : public firmware::Card {
 public:
  /// `folder` has to exist.
  explicit CardFolder(const std::filesystem::path& folder);

  std::optional<std::vector<firmware::CardEntry>> list(const std::string& folder) override;
  std::optional<firmware::CardEntry> find(const std::string& path) override;
  std::string read(const std::string& path, std::uint64_t offset, std::size_t most) override;
  bool create(const std::string& path) override;
  bool append(const std::string& path, std::string_view bytes) override;
  bool remove(const std::string& path) override;
  firmware::CardSpace space() override;

 private:
  /// Where `path` lies on the disk; nothing if that is outside, hidden, or in no folder.
  [[nodiscard]] std::optional<std::filesystem::path> place_of(const std::string& path) const;

  std::filesystem::path root_;
};

}  // namespace kerf::io
