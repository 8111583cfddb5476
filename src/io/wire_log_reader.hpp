#pragma once
// Reads wire logs back, also those that are torn or still being written. Any thread.

#include <cstdint>
#include <expected>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "io/text_file.hpp"
#include "sender/session/record.hpp"

namespace kerf::io {

/// Gives the records of one file, one after the other. Plain JSON lines are understood too.
class WireLogReader {
 public:
  [[nodiscard]] static std::expected<WireLogReader, FileError> open(const std::string& path);
  WireLogReader(WireLogReader&&) noexcept;
  WireLogReader& operator=(WireLogReader&&) noexcept;
  ~WireLogReader();

  /// The next record; nothing at the end, and where the file is torn or stops being a log.
  [[nodiscard]] std::optional<session::Record> next();
  /// After the end: what is wrong with the rest of the file, in one sentence; empty if nothing is.
  [[nodiscard]] const std::string& remark() const;

 private:
  struct State;
  explicit WireLogReader(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/// All parts of the connection that `path` is a part of, from `first` on as far as they lie beside it.
[[nodiscard]] std::vector<std::string> parts_of(const std::string& path, bool from_the_beginning);

/// A file by its path or by its name in `folder`; the one written last for "latest". Empty when there is none.
[[nodiscard]] std::string find_log(const std::string& name, const std::string& folder);

}  // namespace kerf::io
