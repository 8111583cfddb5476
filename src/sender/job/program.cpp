#include "sender/job/program.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <utility>

#include "common/base/text.hpp"
#include "sender/job/wire_form.hpp"

namespace kerf::job {
namespace {

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
constexpr char kDosEndOfFile = 0x1A;
constexpr std::size_t kExcerptLength = 60;
/// Stays in a processor's cache between reading and hashing.
constexpr std::size_t kSliceBytes = std::size_t{64} << 10U;

constexpr bool is_control(char letter) {
  const auto byte = static_cast<unsigned char>(letter);
  return (byte < ' ' && letter != '\t') || byte == 0x7F;
}

constexpr bool acts_at_once(char letter) {
  return letter == '?' || letter == '!' || letter == '~' || static_cast<unsigned char>(letter) > 0x7F;
}

/// The end of the line that starts at `start`. Looks for one kind of line end at a time, which is fast, in stretches,
/// because a file may have only the other kind.
const char* line_end(const char* start, const char* end) {
  constexpr std::ptrdiff_t kStretch = 128;
  for (;; start += kStretch) {
    const auto length = static_cast<std::size_t>(std::min(kStretch, end - start));
    if (length == 0) return end;
    const auto* const feed = static_cast<const char*>(std::memchr(start, '\n', length));
    const std::size_t before = feed == nullptr ? length : static_cast<std::size_t>(feed - start);
    const auto* const carriage = static_cast<const char*>(std::memchr(start, '\r', before));
    if (carriage != nullptr) return carriage;
    if (feed != nullptr) return feed;
    if (end - start <= kStretch) return end;
  }
}

/// The part of `line` that a parser looks at, comments replaced by nothing.
std::string outside_comments(std::string_view line) {
  std::string kept;
  bool inside = false;
  for (const char letter : line) {
    if (!inside && letter == ';') break;
    if (letter == '(') inside = true;
    if (!inside) kept += letter;
    if (letter == ')') inside = false;
  }
  return kept;
}

}  // namespace

std::expected<std::shared_ptr<const Program>, ProgramFault> Program::load(std::string name, std::string text) {
  auto owner = std::make_shared<const std::string>(std::move(text));
  const std::string_view view = *owner;
  return load(std::move(name), std::move(owner), view);
}

std::expected<std::shared_ptr<const Program>, ProgramFault> Program::load(std::string name,
                                                                          std::shared_ptr<const void> owner,
                                                                          std::string_view text) {
  ProgramReader reader(std::move(name), std::move(owner), text);
  while (reader.read_on(text.size())) {
  }
  return reader.finish();
}

std::optional<ProgramLine> Program::line_at(std::size_t offset_bytes, std::uint32_t number) const {
  if (offset_bytes >= text_.size()) return std::nullopt;
  const char* const start = text_.data() + offset_bytes;
  const char* const end = line_end(start, text_.data() + text_.size());
  return ProgramLine{.number = number, .offset_bytes = offset_bytes, .text = {start, end}};
}

std::size_t Program::offset_after(const ProgramLine& line) const {
  const std::size_t end = line.offset_bytes + line.text.size();
  if (end >= text_.size()) return text_.size();
  const bool pair = text_[end] == '\r' && end + 1 < text_.size() && text_[end + 1] == '\n';
  return end + (pair ? 2 : 1);
}

std::optional<ProgramLine> Program::line(std::uint32_t number) const {
  if (number == 0 || number > line_count_) return std::nullopt;
  const std::uint32_t entry = (number - 1) / index_step_;
  auto found = line_at(index_[entry], entry * index_step_ + 1);
  while (found && found->number < number) found = line_at(offset_after(*found), found->number + 1);
  return found;
}

void Program::add_to_index(std::uint32_t number, std::size_t offset_bytes) {
  if (index_.size() == kMostIndexEntries) {
    for (std::size_t kept = 0; kept < kMostIndexEntries / 2; ++kept) index_[kept] = index_[2 * kept];
    index_.resize(kMostIndexEntries / 2);
    index_step_ *= 2;
  }
  if ((number - 1) % index_step_ == 0) index_.push_back(offset_bytes);
  next_indexed_ = number + index_step_ - (number - 1) % index_step_;
}

ProgramReader::ProgramReader(std::string name, std::shared_ptr<const void> owner, std::string_view text)
    : program_(new Program), whole_(text) {
  program_->name_ = std::move(name);
  program_->owner_ = std::move(owner);
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  if (text.ends_with(kDosEndOfFile)) text.remove_suffix(1);
  program_->text_ = text;
}

bool ProgramReader::read_on(std::size_t most_bytes) {
  if (fault_) return false;
  const std::string_view text = program_->text_;
  const std::string_view piece = text.substr(read_bytes_, most_bytes);
  const std::size_t until = read_bytes_ + piece.size();
  const base::TextMaskMaker masks_of = base::fastest_text_masks();
  while (read_bytes_ < until && !fault_) {
    const std::size_t slice_end = std::min(until, read_bytes_ + kSliceBytes);
    while (read_bytes_ + base::kMaskedBytes <= slice_end) {
      read_masked(masks_of(text.data() + read_bytes_), base::kMaskedBytes);
    }
    if (read_bytes_ < slice_end) {
      std::array<char, base::kMaskedBytes> rest{};
      rest.fill(' ');
      std::ranges::copy(text.substr(read_bytes_, slice_end - read_bytes_), rest.begin());
      read_masked(masks_of(rest.data()), slice_end - read_bytes_);
    }
    hash_until(static_cast<std::size_t>(text.data() - whole_.data()) + read_bytes_);
  }
  const bool is_last = until == text.size();
  if (is_last && line_start_bytes_ < until && !fault_) end_line(until, line_is_special_);
  if (fault_ && piece.contains('\0')) fault_ = ProgramFault{.error = ProgramError::Binary};
  return !fault_ && !is_last;
}

// A CR ends a line, and so does a line feed that does not stand behind one.
void ProgramReader::read_masked(const base::TextMasks& masks, std::size_t length) {
  const std::uint64_t behind_return = masks.carriage_returns << 1U | (after_return_ ? 1U : 0U);
  const std::uint64_t of_pairs = masks.line_feeds & behind_return;
  std::uint64_t special = masks.special;
  for (std::uint64_t ends = masks.line_feeds | masks.carriage_returns; ends != 0; ends &= ends - 1) {
    const std::uint64_t end = ends & -ends;
    const std::size_t at = read_bytes_ + static_cast<std::size_t>(std::countr_zero(end));
    if ((end & of_pairs) == 0) {
      end_line(at, line_is_special_ || (special & (end - 1)) != 0);
      special &= ~(end - 1);
      line_is_special_ = false;
    }
    line_start_bytes_ = at + 1;
  }
  line_is_special_ = line_is_special_ || special != 0;
  after_return_ = (masks.carriage_returns >> (length - 1) & 1U) != 0;
  read_bytes_ += length;
}

void ProgramReader::end_line(std::size_t end, bool is_special) {
  if (fault_) return;
  Program& program = *program_;
  const std::uint32_t number = ++program.line_count_;
  if (number == program.next_indexed_) program.add_to_index(number, line_start_bytes_);
  const std::size_t length = end - line_start_bytes_;
  // Most lines are plain and not the longest: look closer only where one asks for it.
  if (!is_special && length <= program.longest_bare_.length) return;
  const ProgramLine line{
      .number = number, .offset_bytes = line_start_bytes_, .text = program.text_.substr(line_start_bytes_, length)};
  if (is_special) fault_ = look_at(line);
  if (fault_) return;
  // The wire form is never longer than the line without its blanks. Without comments its two kinds are alike.
  const auto blanks = static_cast<std::size_t>(std::ranges::count(line.text, ' '));
  const bool may_be_longest = length - blanks > program.longest_bare_.length;
  if (is_special || may_be_longest || !is_executable_) measure(line);
}

void ProgramReader::hash_until(std::size_t bytes_of_whole) {
  hash_.add(whole_.substr(hashed_bytes_, bytes_of_whole - hashed_bytes_));
  hashed_bytes_ = bytes_of_whole;
}

std::expected<std::shared_ptr<const Program>, ProgramFault> ProgramReader::finish() {
  if (!fault_ && !is_executable_) fault_ = ProgramFault{.error = ProgramError::Empty};
  if (fault_) return std::unexpected{*std::move(fault_)};
  hash_until(whole_.size());
  program_->hash_ = hash_.digits();
  return std::move(program_);
}

std::optional<ProgramFault> ProgramReader::look_at(const ProgramLine& line) const {
  const auto fault = [&line](ProgramError error) {
    return ProgramFault{
        .error = error, .line = line.number, .excerpt = base::escape(line.text.substr(0, kExcerptLength))};
  };
  const auto is_fine = [](char letter) { return !is_control(letter) && !acts_at_once(letter); };
  if (std::ranges::all_of(line.text, is_fine)) return std::nullopt;
  if (line.text.contains('\0')) return ProgramFault{.error = ProgramError::Binary};
  const std::string words = outside_comments(line.text);
  if (std::ranges::any_of(words, is_control)) return fault(ProgramError::Binary);
  if (std::ranges::any_of(words, acts_at_once)) return fault(ProgramError::RealtimeByte);
  return std::nullopt;
}

void ProgramReader::measure(const ProgramLine& line) {
  const auto note = [this, &line](bool keeps_messages, LongestLine& longest) {
    if (is_executable_ && line.text.size() <= longest.length) return;
    form_.clear();
    append_wire_form(form_, line.text,
                     {.keeps_messages = keeps_messages, .keeps_marks = keeps_messages, .keeps_percent = false});
    if (form_.size() > longest.length) longest = {.length = form_.size(), .number = line.number};
    if (!form_.empty()) is_executable_ = true;
  };
  note(true, program_->longest_);
  note(false, program_->longest_bare_);
}

std::string describe(const ProgramFault& fault, std::string_view name) {
  const std::string where{name};
  const std::string at = fault.line == 0 ? where : where + ", line " + std::to_string(fault.line);
  switch (fault.error) {
    case ProgramError::Empty: return where + " holds no line that a controller would execute; choose another file.";
    case ProgramError::Binary:
      return at + " is not text but binary; choose a file with G-code as the CAM program writes it.";
    case ProgramError::RealtimeByte:
      return at +
             " has a character outside a comment that a controller would obey at once (?, !, ~ or a letter that is "
             "not ASCII): \"" +
             fault.excerpt + "\". Take it out of the file.";
  }
  return at + " cannot be used.";
}

}  // namespace kerf::job
