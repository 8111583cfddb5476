// However a byte stream is cut, the same messages come out of the reader, and it keeps a bounded number of bytes.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/protocol/message_reader.hpp"

using namespace kerf::protocol;

namespace {

void require(bool holds) {
  if (!holds) std::abort();
}

// A byte of the input stands for a run of bytes, so that small inputs reach the longest line too.
std::string widen(std::string_view text) {
  std::string out;
  for (const char letter : text) out.append(letter == '\x01' ? 700 : 1, letter);
  return out;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  if (size < 2) return 0;
  const std::size_t first_cut = 1U + bytes[0];
  const std::size_t growth = bytes[1];
  const std::string stream = widen({reinterpret_cast<const char*>(bytes) + 2, size - 2});

  MessageReader whole_reader;
  const std::vector<ReceivedMessage> whole = whole_reader.read(stream);

  MessageReader reader;
  std::vector<ReceivedMessage> pieces;
  std::size_t length = first_cut;
  for (std::size_t at = 0; at < stream.size();
       at += length, length = std::max<std::size_t>(1, length * growth % 5003)) {
    for (ReceivedMessage& message : reader.read(std::string_view{stream}.substr(at, length))) {
      require(!message.raw.empty() && message.raw.size() <= MessageReader::kLongestLine);
      pieces.push_back(std::move(message));
    }
    require(reader.pending().size() <= MessageReader::kLongestLine);
  }
  require(pieces == whole);
  require(reader.pending() == whole_reader.pending());
  return 0;
}
