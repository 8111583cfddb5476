#pragma once
// What a wire log holds: everything that went into a session, and the bytes that came out. Written down one record a
// line (record_text.hpp); from it Kerf's own decisions can be repeated (replay.hpp).

#include <cstdint>
#include <string>
#include <variant>

#include <boost/describe.hpp>

#include "common/base/time.hpp"
#include "sender/session/command.hpp"
#include "sender/session/session.hpp"

namespace kerf::session {

/// Who wrote the log: what a replay needs before the first byte, and what a reader wants to know.
struct LogHeader {
  int version = 1;         ///< of the format
  std::string kerf{};      ///< the program's version
  std::string machine{};   ///< the address, as given
  std::string began{};     ///< wall clock, such as "2026-11-22T13:05:01.250Z", at this record's instant
  std::uint32_t part = 1;  ///< a long connection is cut into parts; only part 1 can be replayed alone
  bool listening = false;  ///< Kerf only listened: there is nothing that it decided
  std::string talk{};      ///< the recorded talk that was held instead of a session's own; nothing was decided either
  SessionOptions options{};
};

/// The link is open.
struct LinkOpened {
  machine::LinkOpening opening{};
};

/// Bytes from the controller, as one read gave them.
struct BytesReceived {
  std::string bytes;
};

/// Bytes that Kerf sent because of the record before this one. The realtime bytes went first.
struct BytesSent {
  std::string realtime;
  std::string lines;
  friend bool operator==(const BytesSent&, const BytesSent&) = default;
};

/// A program that the next StartJob starts. Its text is in the log up to `kMostEmbeddedBytes`; a larger one is named by
/// its path and recognised by its hash.
struct ProgramLoaded {
  std::string name;
  std::string path{};  ///< where the file was, for a text that is not in the log
  std::uint64_t size_bytes = 0;
  std::string hash{};  ///< Program::hash()
  std::string text{};
};

/// What the operator asked for. A StartJob's program is in the ProgramLoaded before it.
struct CommandGiven {
  Command command;
};

/// A deadline of the session passed.
struct TimePassed {};

/// The link is gone.
struct LinkGone {
  LinkLoss loss{};
};

BOOST_DESCRIBE_STRUCT(LogHeader, (), (version, kerf, machine, began, part, listening, talk, options))
BOOST_DESCRIBE_STRUCT(LinkOpened, (), (opening))
BOOST_DESCRIBE_STRUCT(BytesReceived, (), (bytes))
BOOST_DESCRIBE_STRUCT(BytesSent, (), (realtime, lines))
BOOST_DESCRIBE_STRUCT(ProgramLoaded, (), (name, path, size_bytes, hash, text))
BOOST_DESCRIBE_STRUCT(CommandGiven, (), (command))
BOOST_DESCRIBE_STRUCT(TimePassed, (), ())
BOOST_DESCRIBE_STRUCT(LinkGone, (), (loss))

/// One entry of a log. Records stand in the order in which things happened; instants never decrease.
struct Record {
  Instant at{};
  std::variant<LogHeader, LinkOpened, BytesReceived, BytesSent, ProgramLoaded, CommandGiven, TimePassed, LinkGone> what;
};

/// Larger programs are not copied into a log.
inline constexpr std::size_t kMostEmbeddedBytes = std::size_t{4} << 20U;

}  // namespace kerf::session
