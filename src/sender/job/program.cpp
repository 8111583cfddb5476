#include "sender/job/program.hpp"

#include <algorithm>
#include <utility>

#include "common/base/content_hash.hpp"
#include "common/base/text.hpp"
#include "sender/job/wire_form.hpp"

namespace kerf::job {
namespace {

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
constexpr char kDosEndOfFile = 0x1A;
constexpr std::size_t kExcerptLength = 60;

bool is_line_end(char letter) {
  return letter == '\n' || letter == '\r';
}

bool is_control(char letter) {
  const auto byte = static_cast<unsigned char>(letter);
  return (byte < ' ' && letter != '\t') || byte == 0x7F;
}

bool acts_at_once(char letter) {
  return letter == '?' || letter == '!' || letter == '~' || static_cast<unsigned char>(letter) > 0x7F;
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
  std::shared_ptr<Program> program{new Program};
  program->name_ = std::move(name);
  program->owner_ = std::move(owner);
  program->hash_ = base::content_hash(text);
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  if (text.ends_with(kDosEndOfFile)) text.remove_suffix(1);
  program->text_ = text;
  if (auto fault = program->scan()) return std::unexpected{std::move(*fault)};
  return program;
}

std::optional<ProgramLine> Program::line_at(std::size_t offset_bytes, std::uint32_t number) const {
  if (offset_bytes >= text_.size()) return std::nullopt;
  const char* const start = text_.data() + offset_bytes;
  const char* const end = std::find_if(start, text_.data() + text_.size(), is_line_end);
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
  const std::uint32_t entry = (number - 1) / kIndexStep;
  auto found = line_at(index_[entry], entry * kIndexStep + 1);
  while (found && found->number < number) found = line_at(offset_after(*found), found->number + 1);
  return found;
}

std::optional<ProgramFault> Program::scan_line(const ProgramLine& line, bool& executable) {
  const auto fault = [&line](ProgramError error) {
    return ProgramFault{
        .error = error, .line = line.number, .excerpt = base::escape(line.text.substr(0, kExcerptLength))};
  };
  // Most lines are plain ASCII without comments: look closer only where a byte asks for it.
  if (std::ranges::any_of(line.text, [](char c) { return is_control(c) || acts_at_once(c); })) {
    const std::string words = outside_comments(line.text);
    if (std::ranges::any_of(words, is_control)) return fault(ProgramError::Binary);
    if (std::ranges::any_of(words, acts_at_once)) return fault(ProgramError::RealtimeByte);
  }
  std::string form;
  append_wire_form(form, line.text, {.keeps_messages = true, .keeps_marks = true, .keeps_percent = false});
  if (form.size() > longest_.length) longest_ = {.length = form.size(), .number = line.number};
  if (!form.empty()) executable = true;
  if (form.size() > longest_bare_.length) {
    form.clear();
    append_wire_form(form, line.text, {.keeps_messages = false, .keeps_marks = false, .keeps_percent = false});
    if (form.size() > longest_bare_.length) longest_bare_ = {.length = form.size(), .number = line.number};
  }
  return std::nullopt;
}

std::optional<ProgramFault> Program::scan() {
  if (text_.find('\0') != std::string_view::npos) return ProgramFault{.error = ProgramError::Binary};
  bool executable = false;
  auto line = line_at(0, 1);
  while (line) {
    if ((line->number - 1) % kIndexStep == 0) index_.push_back(line->offset_bytes);
    if (auto fault = scan_line(*line, executable)) return fault;
    line_count_ = line->number;
    line = line_at(offset_after(*line), line->number + 1);
  }
  if (!executable) return ProgramFault{.error = ProgramError::Empty};
  return std::nullopt;
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
