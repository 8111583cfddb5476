#include "firmware/file_job.hpp"

namespace kerf::firmware {

namespace {

constexpr std::size_t kPieceBytes = 4096;
/// `SD:` cuts longer names (fs_stream.c).
constexpr std::size_t kLongestName = 49;

}  // namespace

void FileJob::begin(std::shared_ptr<Card> card, const std::string& path, std::uint64_t bytes) {
  *this = {};
  card_ = std::move(card);
  path_ = path;
  name_ = path.substr(path.rfind('/') + 1).substr(0, kLongestName);
  bytes_ = bytes;
  is_open_ = true;
}

std::optional<char> FileJob::next_raw() {
  if (taken_ == ahead_.size()) {
    ahead_ = card_->read(path_, position_, kPieceBytes);
    taken_ = 0;
    if (ahead_.empty()) return std::nullopt;
  }
  ++position_;
  return ahead_[taken_++];
}

std::optional<char> FileJob::next_in_file() {
  for (;;) {
    const auto byte = next_raw();
    if (byte != '\r' && byte != '\n') {
      line_end_ = '\0';
      return byte;
    }
    const bool is_second_half = line_end_ != '\0' && *byte != line_end_;
    if (is_second_half) continue;
    line_end_ = *byte;
    return byte;
  }
}

std::optional<char> FileJob::next(bool may_read) {
  if (line_end_ != '\0') ++line_;
  if (!is_open_) return std::nullopt;
  if (may_read) {
    if (const auto byte = next_in_file()) return byte;
  }
  is_open_ = false;
  if (line_end_ == '\0') return '\n';
  line_end_ = '\0';
  return std::nullopt;
}

void FileJob::go_to(std::uint64_t position, std::int32_t line) {
  position_ = position;
  ahead_.clear();
  taken_ = 0;
  line_ = line;
}

double FileJob::percent() const {
  constexpr double kWhole = 100.0;
  return bytes_ == 0 ? 0.0 : static_cast<double>(position_) / static_cast<double>(bytes_) * kWhole;
}

}  // namespace kerf::firmware
