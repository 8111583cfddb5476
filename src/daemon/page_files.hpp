#pragma once
// The page, as it was built into the binary.

#include <optional>
#include <span>
#include <string_view>

namespace kerf::daemon {

/// `bytes` and `gzipped` live as long as the program; `gzipped` is empty for what is packed already.
struct PageFile {
  std::string_view path;
  std::string_view content_type;
  /// Of the content.
  std::string_view etag;
  std::string_view bytes;
  std::string_view gzipped;
};

/// All of them, by path; "/index.html" is the page.
[[nodiscard]] std::span<const PageFile> page_files();

}  // namespace kerf::daemon
