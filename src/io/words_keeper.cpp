#include "io/words_keeper.hpp"

#include <filesystem>
#include <system_error>
#include <utility>
#include <variant>

#include "common/base/content_hash.hpp"
#include "common/base/text.hpp"
#include "io/state_folder.hpp"
#include "io/text_file.hpp"
#include "sender/session/record_text.hpp"

namespace kerf::io {
namespace {

namespace fs = std::filesystem;

}  // namespace

WordsKeeper::WordsKeeper(const MachineUrl& url, WordsUse use)
    : keeps_(!std::holds_alternative<VirtualAddress>(url)), use_(use) {}

std::optional<session::Command> WordsKeeper::on_event(const session::Event& event) {
  if (!keeps_) return std::nullopt;
  listener_.on_event(event);
  if (std::holds_alternative<session::FirmwareIdentified>(event) && use_ == WordsUse::Recall) return recall();
  if (std::holds_alternative<session::ControllerFound>(event)) keep();
  return std::nullopt;
}

std::string WordsKeeper::path() const {
  const std::string& identity = listener_.words().identity;
  const std::string folder = identity.empty() ? std::string{} : state_folder();
  if (folder.empty()) return {};
  return (fs::path(folder) / "words" / (base::content_hash(identity) + ".json")).string();
}

std::optional<session::Command> WordsKeeper::recall() {
  const std::string file = path();
  if (file.empty()) return std::nullopt;
  const auto text = read_text_file(file);
  if (!text) return std::nullopt;
  const auto record = session::parse_record(base::trim(*text));
  const auto* given = record ? std::get_if<session::CommandGiven>(&record->what) : nullptr;
  const auto* recalled = given == nullptr ? nullptr : std::get_if<session::RecallWords>(&given->command);
  if (recalled == nullptr || recalled->words.identity != listener_.words().identity) return std::nullopt;
  listener_.start_from(recalled->words);
  return *recalled;
}

void WordsKeeper::keep() {
  const std::string file = path();
  if (!listener_.take_news() || file.empty()) return;
  std::error_code fault;
  fs::create_directories(fs::path(file).parent_path(), fault);
  std::string text;
  session::append_line(text, {.at = {}, .what = session::CommandGiven{session::RecallWords{listener_.words()}}});
  // A disk that is full costs the next connection two seconds.
  static_cast<void>(replace_text_file(file, text));
}

}  // namespace kerf::io
