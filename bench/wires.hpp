#pragma once
// Wires with a sender's program on one end and an ideal controller on the other.

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "child_process.hpp"
#include "ideal_controller.hpp"

namespace kerf::bench {

enum class WireKind { Pty, Tcp };

/// How programs are told where the controller is.
struct WireEnd {
  WireKind kind{};
  std::string path{};  ///< of the pty
  int port = 0;        ///< on the loopback
};

/// One program that streamed to an ideal controller, from its start to its end.
struct StreamRun {
  WireAccount account;
  ProcessTook took;
  /// As seen last before the end.
  Memory memory;
};

/// The words of a command line for a wire's end.
using CommandFor = std::function<std::vector<std::string>(const WireEnd&)>;
/// Called again and again while the program runs; sleeps itself.
using Meanwhile = std::function<void(IdealController&, ChildProcess&)>;

/// Nothing if the program could not be run, or did not end with status 0.
[[nodiscard]] std::optional<StreamRun> run_stream(WireKind kind, const IdealOptions& options, const CommandFor& command,
                                                  const Meanwhile& meanwhile);

}  // namespace kerf::bench
