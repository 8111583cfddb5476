#include "firmware/card_commands.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>

#include "common/base/text.hpp"

namespace kerf::firmware {

namespace {

enum class CardCommand : std::uint8_t {
  Mount,
  Unmount,
  ListOrRun,
  ListAllOrRun,
  Rewind,
  Remove,
  Format,
  Print,
  MountInformation,
  Folder,
  PrintFolder,
};

struct CardCommandRow {
  std::string_view name;
  CardCommand command;
  bool takes_value = true;
};

constexpr CardCommandRow kCommands[] = {
    {.name = "FM", .command = CardCommand::Mount, .takes_value = false},
    {.name = "FU", .command = CardCommand::Unmount, .takes_value = false},
    {.name = "F", .command = CardCommand::ListOrRun},
    {.name = "F+", .command = CardCommand::ListAllOrRun},
    {.name = "FR", .command = CardCommand::Rewind, .takes_value = false},
    {.name = "FD", .command = CardCommand::Remove},
    {.name = "FF", .command = CardCommand::Format},
    {.name = "F<", .command = CardCommand::Print},
    {.name = "FI", .command = CardCommand::MountInformation, .takes_value = false},
    {.name = "CWD", .command = CardCommand::Folder},
    {.name = "PWD", .command = CardCommand::PrintFolder, .takes_value = false},
};

constexpr std::array<std::string_view, 9> kProgramEndings = {"nc",  "ncc",  "ngc", "cnc",  "gcode",
                                                             "txt", "text", "tap", "macro"};

/// `$F` shows programs only.
bool is_program(std::string_view name) {
  const std::size_t dot = name.rfind('.');
  if (dot == std::string_view::npos) return false;
  return std::ranges::any_of(kProgramEndings,
                             [&](std::string_view ending) { return base::iequals(ending, name.substr(dot + 1)); });
}

/// Nobody can type such a name into `$F=`.
bool is_unusable(std::string_view name) {
  constexpr std::size_t kLongestName = 40;
  return name.size() > kLongestName || name.find_first_of("?!~") != std::string_view::npos;
}

/// grblHAL strutils.c btoa: "7.40 GB", "512 B".
std::string amount_text(std::uint64_t bytes) {
  constexpr std::array<std::string_view, 4> kUnits = {" B", " KB", " MB", " GB"};
  constexpr double kKilo = 1024.0;
  std::size_t unit = 0;
  auto amount = static_cast<double>(bytes);
  for (std::uint64_t left = bytes; left > static_cast<std::uint64_t>(kKilo) && unit + 1 < kUnits.size(); ++unit) {
    left >>= 10U;
    amount /= kKilo;
  }
  return base::to_fixed(amount, unit == 0 ? 0 : 2).append(kUnits.at(unit));
}

}  // namespace

std::optional<CardCommands::Result> CardCommands::execute(std::string_view line, Steps& steps) {
  if (!board_.slot.exists()) return std::nullopt;
  const std::size_t equals = line.find('=');
  std::string name{line.substr(0, equals)};
  std::erase_if(name, base::is_blank);
  const auto* row = std::ranges::find_if(
      kCommands, [&](const CardCommandRow& candidate) { return base::iequals(candidate.name, name); });
  if (row == std::end(kCommands)) return std::nullopt;
  std::optional<std::string_view> value;
  if (equals != std::string_view::npos) value = line.substr(equals + 1);
  if (value && !row->takes_value) return std::nullopt;
  if (board_.critical) return std::unexpected(ErrorCode::NotAllowedInCriticalEvent);
  switch (row->command) {
    case CardCommand::Mount: return mount();
    case CardCommand::Unmount: return unmount();
    case CardCommand::ListOrRun: return run(value, true, steps);
    case CardCommand::ListAllOrRun: return run(value, false, steps);
    case CardCommand::Rewind: return Result{};  // Only a build with the web interface rewinds (fs_stream.c 1.12).
    case CardCommand::Remove:
      if (!value && !refusal()) return std::nullopt;
      return remove(value.value_or(""));
    case CardCommand::Print:
      if (!value && !refusal()) return std::nullopt;
      return print_file(value.value_or(""));
    case CardCommand::Format: return std::unexpected(ErrorCode::InvalidStatement);  // Nobody formats a folder.
    case CardCommand::MountInformation: say_drives(); return Result{};
    case CardCommand::Folder:
      if (value) return change_folder(*value);
      say_folder();
      return Result{};
    case CardCommand::PrintFolder: say_folder(); return Result{};
  }
  return std::nullopt;
}

std::optional<ErrorCode> CardCommands::refusal() const {
  if (!board_.slot.mounted) return ErrorCode::CardNotMounted;
  if (board_.state != MachineState::Idle && board_.state != MachineState::Check) return ErrorCode::SystemLocked;
  return std::nullopt;
}

CardCommands::Result CardCommands::mount() {
  CardSlot& slot = board_.slot;
  slot.mount_changed = slot.mount_changed || !slot.mounted;
  slot.mounted = slot.is_reported = true;
  return {};
}

CardCommands::Result CardCommands::unmount() {
  CardSlot& slot = board_.slot;
  if (!slot.mounted) return std::unexpected(ErrorCode::CardNotMounted);
  slot.mounted = false;
  slot.mount_changed = true;
  slot.folder = "/";
  return {};
}

std::optional<CardCommands::Result> CardCommands::run(std::optional<std::string_view> name, bool filtered,
                                                      Steps& steps) {
  return name ? start(*name, steps) : list(filtered);
}

CardCommands::Result CardCommands::start(std::string_view name, Steps& steps) {
  if (const auto reason = refusal()) return std::unexpected(*reason);
  const std::string path = card_path(board_.slot.folder, name);
  const auto entry = board_.slot.card->find(path);
  if (!entry) return std::unexpected(ErrorCode::FileOpenFailed);
  if (entry->is_folder) {
    board_.slot.folder = path;
    return {};
  }
  // The command is confirmed before its file takes over the stream.
  steps.insert(steps.end(), {Answer{}, BeginFileJob{.path = path, .bytes = entry->bytes}});
  return {};
}

CardCommands::Result CardCommands::list(bool filtered) {
  if (!board_.slot.mounted) return std::unexpected(ErrorCode::FileSystemNotMounted);
  constexpr int kDeepest = 10;
  if (!list_folder(board_.slot.folder, kDeepest, filtered)) return std::unexpected(ErrorCode::DirectoryOpenFailed);
  return {};
}

bool CardCommands::list_folder(const std::string& folder, int depth, bool filtered) {
  // fs_stream.c composes rows in 80 bytes; a longer one is left out.
  constexpr std::size_t kLongestRow = 77;
  const auto entries = board_.slot.card->list(folder);
  if (!entries) return false;
  for (const CardEntry& entry : *entries) {
    if (entry.is_folder || (filtered && !is_program(entry.name))) continue;
    const protocol::FileRow row = {.path = card_path(folder, entry.name),
                                   .size_bytes = static_cast<std::int64_t>(entry.bytes),
                                   .unusable = is_unusable(entry.name)};
    if (protocol::encode(row, {}).size() <= kLongestRow) board_.say(row);
  }
  if (depth == 1) return true;
  return std::ranges::all_of(*entries, [&](const CardEntry& entry) {
    return !entry.is_folder || list_folder(card_path(folder, entry.name), depth - 1, filtered);
  });
}

CardCommands::Result CardCommands::print_file(std::string_view name) {
  if (const auto reason = refusal()) return std::unexpected(*reason);
  const std::string path = card_path(board_.slot.folder, name);
  const auto entry = board_.slot.card->find(path);
  if (!entry) return std::unexpected(ErrorCode::FileOpenFailed);
  if (entry->is_folder) return std::unexpected(ErrorCode::FileOpenFailed);
  FileJob file;
  file.begin(board_.slot.card, path, entry->bytes);
  std::string text;
  while (!file.is_drained()) {
    const auto byte = file.next(true);
    if (!byte || file.is_drained()) break;
    if (*byte == '\r' || *byte == '\n') {
      text += "\r\n";
    } else {
      text += *byte;
    }
  }
  board_.outbox.say_bytes(text);
  return {};
}

CardCommands::Result CardCommands::remove(std::string_view name) {
  if (const auto reason = refusal()) return std::unexpected(*reason);
  const std::string path = card_path(board_.slot.folder, name);
  if (!board_.slot.card->remove(path)) return std::unexpected(ErrorCode::FileReadFailed);
  return {};
}

CardCommands::Result CardCommands::change_folder(std::string_view name) {
  const std::string path = card_path(board_.slot.folder, name);
  const auto entry = board_.slot.mounted ? board_.slot.card->find(path) : std::nullopt;
  if (!entry || !entry->is_folder) return std::unexpected(ErrorCode::DirectoryNotFound);
  board_.slot.folder = path;
  return {};
}

void CardCommands::say_folder() {
  board_.say(protocol::BuildRow{.key = "CWD", .value = board_.slot.folder});
}

void CardCommands::say_drives() {
  if (!board_.slot.mounted) return;
  const CardSpace space = board_.slot.card->space();
  board_.say(protocol::BuildRow{
      .key = "FS",
      .value = "FatFs@/ size " + amount_text(space.total_bytes) + ", free " + amount_text(space.free_bytes)});
}

}  // namespace kerf::firmware
