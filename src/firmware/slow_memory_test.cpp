#include "firmware/slow_memory.hpp"

#include <gtest/gtest.h>

namespace kerf::firmware {
namespace {

using namespace std::chrono_literals;

TEST(SlowMemory, WritesInNoTimeByDefault) {
  SlowMemory memory(Duration::zero());
  memory.write(Instant{}, 100);
  EXPECT_FALSE(memory.is_busy(Instant{}));
  EXPECT_TRUE(memory.hears(Instant{}));
}

TEST(SlowMemory, IsDeafWhileItWrites) {
  SlowMemory memory(3400us);
  memory.write(Instant{}, 2);
  EXPECT_EQ(memory.busy_until(), Instant{} + 6800us);
  int heard = 0;
  for (int byte = 0; byte < 39; ++byte) heard += memory.hears(Instant{} + byte * 87us) ? 1 : 0;
  EXPECT_EQ(heard, 2);  // what the UART holds until the first byte is written
  EXPECT_TRUE(memory.hears(Instant{} + 3500us));
  EXPECT_FALSE(memory.is_busy(Instant{} + 6800us));
  EXPECT_TRUE(memory.hears(Instant{} + 6800us));
}

TEST(SlowMemory, WritesFollowEachOther) {
  SlowMemory memory(1ms);
  memory.write(Instant{}, 3);
  memory.write(Instant{} + 1ms, 2);
  EXPECT_EQ(memory.busy_until(), Instant{} + 5ms);
}

}  // namespace
}  // namespace kerf::firmware
