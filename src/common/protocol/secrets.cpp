#include "common/protocol/secrets.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <variant>

#include "common/base/text.hpp"
#include "common/protocol/decode.hpp"
#include "common/vocabulary/dialect.hpp"
#include "common/vocabulary/settings.hpp"

namespace kerf::protocol {
namespace {

using vocabulary::SettingType;

/// A setting in a line: its number or name without blanks and leading zeros, as Grbl reads it, and where its value
/// begins.
struct Assignment {
  std::string id;
  std::size_t value_at = 0;
};

bool is_id_letter(char letter) {
  const char upper = base::to_upper(letter);
  return base::is_digit(letter) || (upper >= 'A' && upper <= 'Z') || letter == '/' || letter == '_';
}

/// The next `$id=` at or after `from`.
std::optional<Assignment> next_assignment(std::string_view line, std::size_t from) {
  for (std::size_t dollar = line.find('$', from); dollar != std::string_view::npos;
       dollar = line.find('$', dollar + 1)) {
    Assignment found;
    std::size_t at = dollar + 1;
    for (; at < line.size() && (is_id_letter(line[at]) || line[at] == ' '); ++at) {
      const bool is_leading_zero = line[at] == '0' && found.id.empty() && at + 1 < line.size() && line[at + 1] != '=';
      if (line[at] != ' ' && !is_leading_zero) found.id += line[at];
    }
    if (at == line.size() || line[at] != '=' || found.id.empty()) continue;
    found.value_at = at + 1;
    return found;
  }
  return std::nullopt;
}

bool is_number(std::string_view value) {
  return value.empty() || base::parse_decimal(base::trim(value)).has_value();
}

/// The value runs to the end of the line; the bracket of `[echo:$75=…]` is not part of it.
std::string_view value_in(std::string_view line, std::size_t value_at) {
  std::string_view value = line.substr(value_at);
  if (line.starts_with('[') && value.ends_with(']')) value.remove_suffix(1);
  return value;
}

constexpr std::string_view kEspCommand = "[ESP";
/// Commands whose argument is a password, or has some: of the network and of the access point, of the user, and of the
/// service that sends notifications (ESP3D, documentation of its commands).
constexpr std::array<std::string_view, 6> kEspPasswordCommands{"[ESP101]", "[ESP106]", "[ESP550]",
                                                               "[ESP551]", "[ESP555]", "[ESP610]"};
/// `[ESP401]P=1 T=S V=hunter2`: which of the positions hold passwords differs from one firmware to the next.
constexpr std::string_view kEspSetCommand = "[ESP401]";

std::string upper_cased(std::string_view text) {
  std::string upper(text);
  std::ranges::transform(upper, upper.begin(), base::to_upper);
  return upper;
}

std::optional<std::size_t> esp_command_at(std::string_view line) {
  for (std::size_t at = line.find('['); at != std::string_view::npos; at = line.find('[', at + 1)) {
    if (base::starts_with_ignoring_case(line.substr(at), kEspCommand)) return at;
  }
  return std::nullopt;
}

/// `[ESP101]hunter2`, `[ESP444]RESTART pwd=hunter2`: where the passwords of a command begin; nothing in other lines.
std::optional<std::size_t> esp_secret_at(std::string_view line) {
  const auto command_at = esp_command_at(line);
  if (!command_at) return std::nullopt;
  const std::string command = upper_cased(line.substr(*command_at));
  const auto behind = [&](std::string_view key) -> std::optional<std::size_t> {
    const std::size_t at = command.find(key);
    return at == std::string::npos ? std::nullopt : std::optional(*command_at + at + key.size());
  };
  for (const std::string_view whole : kEspPasswordCommands) {
    if (command.starts_with(whole)) return *command_at + whole.size();
  }
  const auto value = command.starts_with(kEspSetCommand) ? behind("V=") : std::nullopt;
  return value ? value : behind("PWD=");
}

/// Names of settings tell it where nobody else does: `$Sta/Password` of FluidNC.
bool is_named_as_password(std::string_view id) {
  const std::string name = upper_cased(id);
  return name.contains("PASSWORD") || name.contains("/PSK");
}

using KnownSettings = std::map<std::string, bool, std::less<>>;

/// The settings of all firmwares' tables; true for passwords.
const KnownSettings& settings_of_tables() {
  static const KnownSettings kSettings = [] {
    KnownSettings known;
    for (const vocabulary::Dialect* dialect : vocabulary::all_dialects()) {
      for (const vocabulary::SettingRow& row : dialect->settings) {
        const bool is_password = row.type == SettingType::Password;
        for (int axis = 0; axis < (row.per_axis ? static_cast<int>(vocabulary::kMaxAxes) : 1); ++axis) {
          if (row.id >= 0) known[std::to_string(row.id + axis)] |= is_password;
          if (auto path = vocabulary::path_of({.row = &row, .axis = axis}); !path.empty()) known[path] |= is_password;
        }
      }
    }
    return known;
  }();
  return kSettings;
}

}  // namespace

void Secrets::learn(const SettingDefinition& row) {
  bool& is_password = told_[std::to_string(row.id)];
  is_password = is_password || row.type == static_cast<int>(SettingType::Password);
}

void Secrets::learn(const NewOptions& options) {
  has_descriptions_ = std::ranges::find(options.flags, "ENUMS") != options.flags.end();
}

void Secrets::learn_from(std::string_view line) {
  if (!line.starts_with("[SETTING:") && !line.starts_with("[NEWOPT:")) return;
  const auto message = decode(line);
  if (const auto* row = std::get_if<SettingDefinition>(&message)) {
    learn(*row);
    was_described_ = true;
  }
  if (const auto* options = std::get_if<NewOptions>(&message)) learn(*options);
}

void Secrets::recall_from(std::string_view line) {
  const auto message = decode(line);
  if (const auto* row = std::get_if<SettingDefinition>(&message)) learn(*row);
}

Secrets::Kind Secrets::kind_of(std::string_view id) const {
  // Startup lines `$N0=…` and jogs `$J=…` are no settings.
  if (id.empty() || !(base::is_digit(id.front()) || id.find('/') != std::string_view::npos)) return Kind::Open;
  const auto& tables = settings_of_tables();
  const auto tabled = tables.find(id);
  const auto told = told_.find(id);
  if ((tabled != tables.end() && tabled->second) || (told != told_.end() && told->second)) return Kind::Password;
  if (tabled != tables.end() || told != told_.end()) return Kind::Open;
  return is_named_as_password(id) ? Kind::Password : Kind::Unknown;
}

bool Secrets::is_secret(std::string_view id, std::string_view value) const {
  switch (kind_of(id)) {
    case Kind::Password: return !value.empty();
    case Kind::Open: return false;
    case Kind::Unknown: return !is_number(value) || (!value.empty() && has_descriptions_ && !was_described_);
  }
  return true;
}

std::string_view Secrets::secret_in(std::string_view line) const {
  if (const auto at = esp_secret_at(line)) return line.substr(*at);
  std::size_t from = 0;
  while (const auto found = next_assignment(line, from)) {
    const std::string_view value = value_in(line, found->value_at);
    if (is_secret(found->id, value)) return value;
    from = found->value_at;
  }
  return {};
}

std::size_t Secrets::doubtful_from(std::string_view unfinished) const {
  if (const auto command_at = esp_command_at(unfinished)) return *command_at;
  std::size_t from = 0;
  while (const auto found = next_assignment(unfinished, from)) {
    if (kind_of(found->id) != Kind::Open) return found->value_at;
    from = found->value_at;
  }
  return unfinished.size();
}

std::string Secrets::hidden(std::string_view line) const {
  std::string shown(line);
  if (const auto secret = secret_in(line); !secret.empty()) {
    shown.replace(static_cast<std::size_t>(secret.data() - line.data()), secret.size(), secret.size(), '*');
  }
  return shown;
}

std::string Secrets::hidden_part(std::string_view before, std::string_view part) const {
  std::string line(before);
  std::string shown;
  for (const char letter : part) {
    const bool ends = letter == '\r' || letter == '\n';
    if (!ends) line += letter;
    shown += !ends && doubtful_from(line) < line.size() ? '*' : letter;
    if (ends) line.clear();
  }
  return shown;
}

}  // namespace kerf::protocol
