#pragma once
// A connected link, whatever frames its bytes: what a transport writes to and a server serves. Loop's thread only.

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include <boost/system/error_code.hpp>

#include "common/vocabulary/realtime.hpp"

namespace kerf::io {

/// Lives as long as an operation of it is under way. Nothing is called after close() nor after `lost`.
class ByteLink {
 public:
  struct Callbacks {
    std::function<void(std::string_view)> received;
    std::function<void(boost::system::error_code)> lost;
    /// Most bytes that `received` may be given now; without it, any number. At 0 nothing is read until go_on().
    std::function<std::size_t()> room = {};
    /// Bytes can pass from now on.
    std::function<void()> opened = {};
  };

  ByteLink() = default;
  virtual ~ByteLink() = default;
  ByteLink(const ByteLink&) = delete;
  ByteLink& operator=(const ByteLink&) = delete;

  virtual void start() = 0;
  /// There may be room again.
  virtual void go_on() = 0;
  /// Goes out before every line byte that the operating system does not have yet. A soft reset voids those: behind it a
  /// controller would execute them with default modes.
  void write_realtime(std::string_view bytes) {
    if (bytes.contains(static_cast<char>(vocabulary::Realtime::SoftReset))) lines_.clear();
    realtime_.append(bytes);
    write();
  }
  void write_lines(std::string_view bytes) {
    lines_.append(bytes);
    write();
  }
  virtual void close() = 0;

  /// Bytes that wait here because the other end reads too slowly.
  [[nodiscard]] std::size_t waiting_bytes() const { return realtime_.size() + lines_.size(); }

 protected:
  /// Gives the next piece to the operating system, unless it still has one.
  virtual void write() = 0;
  /// The next piece, realtime bytes first; empty when nothing waits.
  [[nodiscard]] std::string take_piece();

 private:
  std::string realtime_;
  std::string lines_;
};

/// Most bytes that are given to the operating system at once: small enough that a realtime byte never waits long behind
/// one piece, large enough for a fast link.
inline constexpr std::size_t kMostBytesAtOnce = 256;

inline std::string ByteLink::take_piece() {
  std::string& queue = realtime_.empty() ? lines_ : realtime_;
  std::string piece = queue.substr(0, kMostBytesAtOnce);
  queue.erase(0, piece.size());
  return piece;
}

}  // namespace kerf::io
