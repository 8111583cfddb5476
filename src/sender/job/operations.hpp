#pragma once
// Where the operations of a CAM program begin, by the comments that common post-processors write.

#include <optional>
#include <string>
#include <string_view>

namespace kerf::job {

/// Follows a program line by line, as the file has it.
class OperationFinder {
 public:
  /// The name of the operation that begins at `line`.
  [[nodiscard]] std::optional<std::string> on_line(std::string_view line);

 private:
  bool has_code_ = false;
  bool after_blank_ = false;
};

}  // namespace kerf::job
