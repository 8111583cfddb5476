#pragma once
// Keeps what a firmware says about itself, so that the next connection to one with the same identity need not ask.
//
//   STATE/words/HASH.json   one line: a RecallWords command as a wire log has it (docs/wire_log.md)
//
// A file that cannot be read, or that tells of another firmware, is passed over and written anew; nothing is lost with
// it but two seconds. Belongs to the event loop's thread.

#include <optional>
#include <string>

#include "io/machine_url.hpp"
#include "sender/session/command.hpp"
#include "sender/session/event.hpp"
#include "sender/session/words_listener.hpp"

namespace kerf::io {

enum class WordsUse {
  AskAgain,  ///< the controller is asked, and what it says is kept
  Recall,    ///< asked only if nothing was kept
};

class WordsKeeper {
 public:
  /// Of a virtual machine in this process nothing is kept: it answers at once, and its words change with Kerf.
  WordsKeeper(const MachineUrl& url, WordsUse use);

  /// Told of everything that the session tells. Once the firmware is known, gives what was kept of it.
  [[nodiscard]] std::optional<session::Command> on_event(const session::Event& event);

 private:
  [[nodiscard]] std::optional<session::Command> recall();
  void keep();
  [[nodiscard]] std::string path() const;

  const bool keeps_;
  const WordsUse use_;
  session::WordsListener listener_;
};

}  // namespace kerf::io
