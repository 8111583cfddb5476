#pragma once
// How many lines may be on their way at once.

#include <boost/describe.hpp>

namespace kerf::streaming {

/// What keeps a controller's receive buffer from overflowing.
enum class FlowPolicy {
  CharacterCounting,  ///< as many lines as the window holds
  OneAtATime,         ///< the next line leaves when the one before is answered: slow, and right on every controller
};
BOOST_DESCRIBE_ENUM(FlowPolicy, CharacterCounting, OneAtATime)

}  // namespace kerf::streaming
