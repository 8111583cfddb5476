#include "common/gcode/parameters.hpp"

namespace kerf::gcode {

namespace {

constexpr std::uint16_t kLastLocal = 30;
constexpr int kGlobal = 0;

}  // namespace

std::optional<std::string> clean_name(std::string_view name) {
  std::string clean;
  for (const char letter : name) {
    if (static_cast<signed char>(letter) <= ' ') continue;
    if (clean.size() == Parameters::kLongestName) break;
    clean += letter >= 'A' && letter <= 'Z' ? static_cast<char>(letter - 'A' + 'a') : letter;
  }
  if (clean.empty() || clean == "_") return std::nullopt;
  return clean;
}

int Parameters::owner_of(std::uint16_t id) const {
  return id > kLastLocal || calls_.empty() ? kGlobal : calls_.back();
}

int Parameters::owner_of(std::string_view name) const {
  return name.starts_with('_') || calls_.empty() ? kGlobal : calls_.back();
}

float Parameters::get(std::uint16_t id) const {
  const auto found = numbered_.find({owner_of(id), id});
  return found == numbered_.end() ? 0.0F : found->second;
}

void Parameters::set(std::uint16_t id, float value) {
  numbered_.insert_or_assign({owner_of(id), id}, value);
}

std::optional<float> Parameters::get(std::string_view name) const {
  const auto found = named_.find(std::pair{owner_of(name), std::string{name}});
  if (found == named_.end()) return std::nullopt;
  return found->second;
}

void Parameters::set(std::string_view name, float value) {
  named_.insert_or_assign(std::pair{owner_of(name), std::string{name}}, value);
}

bool Parameters::begin_call(int owner) {
  if (calls_.size() == kDeepestCall) return false;
  calls_.push_back(owner);
  return true;
}

void Parameters::end_call() {
  if (calls_.empty()) return;
  const int owner = calls_.back();
  calls_.pop_back();
  if (owner == kGlobal) return;
  std::erase_if(numbered_, [owner](const auto& entry) { return entry.first.first == owner; });
  std::erase_if(named_, [owner](const auto& entry) { return entry.first.first == owner; });
}

}  // namespace kerf::gcode
