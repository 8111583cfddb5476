#pragma once
// Files that are packed with gzip or zstd, unpacked piece by piece.

#include <cstdint>
#include <expected>
#include <functional>
#include <string_view>

#include "io/text_file.hpp"

namespace kerf::io {

enum class Packing : std::uint8_t { None, Gzip, Zstd };

/// As the first four bytes say (RFC 1952, RFC 8878); names mean nothing.
[[nodiscard]] Packing packing_of(std::string_view first_bytes);

/// No program unpacks to more than this; something that was made to fill disks does.
inline constexpr std::uint64_t kMostUnpackedBytes = std::uint64_t{16} << 30U;

/// Reads the file behind `descriptor` from its beginning and gives what it unpacks to away piece by piece; several
/// members or frames in a row belong together. `put` says the system's fault, 0 if none. Any thread.
[[nodiscard]] std::expected<void, FileError> unpack(int descriptor, Packing packing,
                                                    const std::function<int(std::string_view)>& put);

}  // namespace kerf::io
