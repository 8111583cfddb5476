// Any bytes are a line: decoding never fails, and printing what was read settles at once, in every dialect.

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "common/protocol/decode.hpp"
#include "common/protocol/encode.hpp"
#include "common/vocabulary/messages.hpp"
#include "common/vocabulary/options.hpp"
#include "common/vocabulary/settings.hpp"

using namespace kerf;

namespace {

void require(bool holds) {
  if (!holds) std::abort();
}

// Look-ups by text take whatever came.
void look_up(std::string_view line) {
  (void)vocabulary::feedback_of(line);
  (void)vocabulary::find_bracket(line);
  (void)vocabulary::find_new_option(line);
  (void)vocabulary::find_setting(vocabulary::setting_rows(vocabulary::Firmware::Rabbit), line);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  const std::string_view line{reinterpret_cast<const char*>(bytes), size};
  const protocol::Message message = protocol::decode(line);
  require(!protocol::name_of(message).empty());
  for (const vocabulary::Dialect* dialect : vocabulary::all_dialects()) {
    for (const bool inches : {false, true}) {
      const protocol::PrintStyle style = protocol::style_of(*dialect, inches);
      const protocol::Message once = protocol::decode(protocol::encode(message, style));
      const protocol::Message twice = protocol::decode(protocol::encode(once, style));
      require(once == twice);
      require(once.index() == message.index());
    }
  }
  look_up(line);
  return 0;
}
