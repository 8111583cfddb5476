#include "sender/job/program.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

#include "common/base/text.hpp"
#include "sender/job/wire_form.hpp"

namespace kerf::job {
namespace {

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
constexpr char kDosEndOfFile = 0x1A;
constexpr std::size_t kExcerptLength = 60;

constexpr bool is_control(char letter) {
  const auto byte = static_cast<unsigned char>(letter);
  return (byte < ' ' && letter != '\t') || byte == 0x7F;
}

constexpr bool acts_at_once(char letter) {
  return letter == '?' || letter == '!' || letter == '~' || static_cast<unsigned char>(letter) > 0x7F;
}

/// What a letter may mean for its line.
enum LetterTrait : std::uint8_t {
  kSuspicious = 1,  ///< a control character, or one that acts at once, unless it is in a comment
  kComment = 2,     ///< a comment begins
};

constexpr auto kTraits = [] {
  std::array<std::uint8_t, 256> traits{};
  for (std::size_t byte = 0; byte < traits.size(); ++byte) {
    const char letter = static_cast<char>(byte);
    if (is_control(letter) || acts_at_once(letter)) traits[byte] = kSuspicious;
  }
  traits['('] = traits[';'] = kComment;
  return traits;
}();

std::uint8_t traits_of(std::string_view line) {
  std::uint8_t traits = 0;
  for (const char letter : line) traits |= kTraits[static_cast<unsigned char>(letter)];
  return traits;
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

void Program::add_to_index(const ProgramLine& line) {
  if ((line.number - 1) % index_step_ != 0) return;
  if (index_.size() == kMostIndexEntries) {
    for (std::size_t kept = 0; kept < kMostIndexEntries / 2; ++kept) index_[kept] = index_[2 * kept];
    index_.resize(kMostIndexEntries / 2);
    index_step_ *= 2;
    if ((line.number - 1) % index_step_ != 0) return;
  }
  index_.push_back(line.offset_bytes);
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
  const std::size_t length = std::min(most_bytes, program_->text_.size() - offset_bytes_);
  if (program_->text_.substr(offset_bytes_, length).contains('\0')) {
    fault_ = ProgramFault{.error = ProgramError::Binary};
    return false;
  }
  const std::size_t until = offset_bytes_ + length;
  while (offset_bytes_ < until) {
    const auto line = program_->line_at(offset_bytes_, program_->line_count_ + 1);
    program_->add_to_index(*line);
    fault_ = read_line(*line);
    if (fault_) return false;
    program_->line_count_ = line->number;
    offset_bytes_ = program_->offset_after(*line);
  }
  hash_until(static_cast<std::size_t>(program_->text_.data() - whole_.data()) + offset_bytes_);
  return offset_bytes_ < program_->text_.size();
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

std::optional<ProgramFault> ProgramReader::read_line(const ProgramLine& line) {
  const auto fault = [&line](ProgramError error) {
    return ProgramFault{
        .error = error, .line = line.number, .excerpt = base::escape(line.text.substr(0, kExcerptLength))};
  };
  // Most lines are plain ASCII without comments: look closer only where a byte asks for it.
  const std::uint8_t traits = traits_of(line.text);
  if ((traits & kSuspicious) != 0) {
    const std::string words = outside_comments(line.text);
    if (std::ranges::any_of(words, is_control)) return fault(ProgramError::Binary);
    if (std::ranges::any_of(words, acts_at_once)) return fault(ProgramError::RealtimeByte);
  }
  // The wire form is never longer than the line. Without comments its two kinds are alike.
  const bool may_be_longest = line.text.size() > program_->longest_bare_.length;
  if (may_be_longest || !is_executable_ || (traits & kComment) != 0) measure(line);
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
