#include "io/unpacking.hpp"

#include <cerrno>
#include <memory>
#include <optional>
#include <vector>

#include <unistd.h>
#define ZLIB_CONST  // what is read is not written to
#include <zlib.h>
#include <zstd.h>

namespace kerf::io {
namespace {

constexpr std::size_t kPieceBytes = std::size_t{256} << 10U;

std::unexpected<FileError> damaged() {
  return std::unexpected(FileError{.fault = FileFault::Damaged, .system_text = {}});
}

/// One direction of a stream: packed bytes go in, unpacked ones come out.
class Unpacker {
 public:
  Unpacker() = default;
  virtual ~Unpacker() = default;
  Unpacker(const Unpacker&) = delete;
  Unpacker& operator=(const Unpacker&) = delete;
  /// Takes something of `in` away, and gives how many bytes of `out` it filled; empty if the stream is damaged.
  virtual std::optional<std::size_t> step(std::string_view& in, std::vector<char>& out) = 0;
  /// What came so far is whole.
  [[nodiscard]] virtual bool is_whole() const = 0;
};

class GzipUnpacker final : public Unpacker {
 public:
  GzipUnpacker() {
    constexpr int kGzipOnly = 16;
    is_good_ = inflateInit2(&stream_, MAX_WBITS + kGzipOnly) == Z_OK;
  }
  ~GzipUnpacker() override {
    if (is_good_) inflateEnd(&stream_);
  }
  GzipUnpacker(const GzipUnpacker&) = delete;
  GzipUnpacker& operator=(const GzipUnpacker&) = delete;

  std::optional<std::size_t> step(std::string_view& in, std::vector<char>& out) override {
    if (!is_good_) return std::nullopt;
    // Behind a member another one may follow.
    if (is_whole_ && !in.empty() && inflateReset(&stream_) != Z_OK) return std::nullopt;
    if (!in.empty()) is_whole_ = false;
    stream_.next_in = reinterpret_cast<const Bytef*>(in.data());
    stream_.avail_in = static_cast<uInt>(in.size());
    stream_.next_out = reinterpret_cast<Bytef*>(out.data());
    stream_.avail_out = static_cast<uInt>(out.size());
    const int result = inflate(&stream_, Z_NO_FLUSH);
    in.remove_prefix(in.size() - stream_.avail_in);
    if (result == Z_STREAM_END) is_whole_ = true;
    if (result != Z_OK && result != Z_STREAM_END && result != Z_BUF_ERROR) return std::nullopt;
    return out.size() - stream_.avail_out;
  }
  [[nodiscard]] bool is_whole() const override { return is_whole_; }

 private:
  z_stream stream_{};
  bool is_good_ = false;
  bool is_whole_ = false;
};

class ZstdUnpacker final : public Unpacker {
 public:
  ZstdUnpacker() : stream_(ZSTD_createDCtx(), &ZSTD_freeDCtx) {}

  std::optional<std::size_t> step(std::string_view& in, std::vector<char>& out) override {
    ZSTD_inBuffer from{.src = in.data(), .size = in.size(), .pos = 0};
    ZSTD_outBuffer to{.dst = out.data(), .size = out.size(), .pos = 0};
    const std::size_t rest = ZSTD_decompressStream(stream_.get(), &to, &from);
    if (ZSTD_isError(rest) != 0) return std::nullopt;
    in.remove_prefix(from.pos);
    // Asked once more behind the end of a frame it says what the next one would need.
    if (from.pos > 0 || to.pos > 0) is_whole_ = rest == 0;
    return to.pos;
  }
  [[nodiscard]] bool is_whole() const override { return is_whole_; }

 private:
  std::unique_ptr<ZSTD_DCtx, decltype(&ZSTD_freeDCtx)> stream_;
  bool is_whole_ = false;
};

std::unique_ptr<Unpacker> unpacker_for(Packing packing) {
  if (packing == Packing::Gzip) return std::make_unique<GzipUnpacker>();
  return std::make_unique<ZstdUnpacker>();
}

}  // namespace

Packing packing_of(std::string_view first_bytes) {
  if (first_bytes.starts_with("\x1F\x8B\x08")) return Packing::Gzip;
  if (first_bytes.starts_with("\x28\xB5\x2F\xFD")) return Packing::Zstd;
  return Packing::None;
}

std::expected<void, FileError> unpack(int descriptor, Packing packing,
                                      const std::function<int(std::string_view)>& put) {
  const auto unpacker = unpacker_for(packing);
  std::vector<char> packed(kPieceBytes);
  std::vector<char> piece(kPieceBytes);
  std::uint64_t total = 0;
  for (off_t at = 0;;) {
    const ssize_t got = ::pread(descriptor, packed.data(), packed.size(), at);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return std::unexpected(file_error(errno));
    if (got == 0) break;
    at += got;
    std::string_view in(packed.data(), static_cast<std::size_t>(got));
    for (bool is_full = false; !in.empty() || is_full;) {
      const auto filled = unpacker->step(in, piece);
      if (!filled) return damaged();
      total += *filled;
      if (total > kMostUnpackedBytes)
        return std::unexpected(FileError{.fault = FileFault::TooLarge, .system_text = {}});
      if (const int fault = put({piece.data(), *filled}); fault != 0) return std::unexpected(file_error(fault));
      is_full = *filled == piece.size();
    }
  }
  if (!unpacker->is_whole()) return damaged();
  return {};
}

}  // namespace kerf::io
