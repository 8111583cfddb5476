#pragma once
// The parts of a report's page, in the order in which they stand there.

#include <string>
#include <string_view>
#include <utility>

#include "rehearsal/report.hpp"

namespace kerf::rehearsal {

/// A page in the making: markup of our own, and text from anywhere, which is escaped.
class Markup {
 public:
  Markup& raw(std::string_view markup) {
    page_ += markup;
    return *this;
  }
  Markup& text(std::string_view words) {
    page_ += escape_markup(words);
    return *this;
  }
  Markup& svg(const Drawing& drawing) {
    page_ += to_svg(drawing, SvgPlace::Inline);
    return *this;
  }
  /// A cell of a table; `kind` is a class, or empty.
  Markup& cell(std::string_view words, std::string_view kind = {});
  /// A row of column names. Those that begin with `#` are for numbers.
  Markup& heads(std::initializer_list<std::string_view> names);

  [[nodiscard]] std::string take() && { return std::move(page_); }

 private:
  std::string page_;
};

void add_head(Markup& page, const Report& report);
void add_figures(Markup& page, const Report& report);
void add_pictures(Markup& page, const Report& report);
void add_findings(Markup& page, const Report& report);
void add_times(Markup& page, const Report& report);
void add_operations(Markup& page, const Report& report);
void add_tools(Markup& page, const Report& report);
void add_limits(Markup& page, const Report& report);
void add_file(Markup& page, const Report& report);

}  // namespace kerf::rehearsal
