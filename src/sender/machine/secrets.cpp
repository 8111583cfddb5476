#include "sender/machine/secrets.hpp"

#include <algorithm>
#include <optional>

#include "common/base/text.hpp"
#include "common/vocabulary/dialect.hpp"
#include "common/vocabulary/settings.hpp"

namespace kerf::machine {
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

void Secrets::learn(const protocol::SettingDefinition& row) {
  bool& is_password = told_[std::to_string(row.id)];
  is_password = is_password || row.type == static_cast<int>(SettingType::Password);
}

Secrets::Kind Secrets::kind_of(std::string_view id) const {
  // Startup lines `$N0=…` and jogs `$J=…` are no settings.
  if (id.empty() || !(base::is_digit(id.front()) || id.find('/') != std::string_view::npos)) return Kind::Open;
  const auto& tables = settings_of_tables();
  const auto tabled = tables.find(id);
  const auto told = told_.find(id);
  if ((tabled != tables.end() && tabled->second) || (told != told_.end() && told->second)) return Kind::Password;
  return tabled == tables.end() && told == told_.end() ? Kind::Unknown : Kind::Open;
}

bool Secrets::is_secret(std::string_view id, std::string_view value) const {
  switch (kind_of(id)) {
    case Kind::Password: return !value.empty();
    case Kind::Open: return false;
    case Kind::Unknown: return !is_number(value);
  }
  return true;
}

std::string_view Secrets::secret_in(std::string_view line) const {
  std::size_t from = 0;
  while (const auto found = next_assignment(line, from)) {
    const std::string_view value = value_in(line, found->value_at);
    if (is_secret(found->id, value)) return value;
    from = found->value_at;
  }
  return {};
}

std::size_t Secrets::doubtful_from(std::string_view unfinished) const {
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

}  // namespace kerf::machine
