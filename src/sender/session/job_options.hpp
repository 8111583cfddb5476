#pragma once
// What the operator chooses for one job.

#include <boost/describe.hpp>

#include "sender/job/error_policy.hpp"
#include "sender/job/wire_form.hpp"
#include "sender/streaming/flow_policy.hpp"

namespace kerf::session {

struct JobOptions {
  job::ErrorPolicy on_error = job::ErrorPolicy::HoldAndAsk;
  streaming::FlowPolicy flow = streaming::FlowPolicy::CharacterCounting;
  /// M1: On stops at it, Off passes over it. Grbl and Rabbit know no switch and pass over it.
  job::ProgramSwitch optional_stop = job::ProgramSwitch::AsMachine;
  /// Lines that begin with `/`: On leaves them out, Off cuts them. Grbl and Rabbit know no switch and cut them.
  job::ProgramSwitch block_delete = job::ProgramSwitch::AsMachine;
  bool operator==(const JobOptions&) const = default;
};
// Complete, because a log that lacks an option cannot be replayed.
BOOST_DESCRIBE_STRUCT(JobOptions, (), (on_error, flow, optional_stop, block_delete))

}  // namespace kerf::session
