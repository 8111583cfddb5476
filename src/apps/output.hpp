#pragma once
// Printing that never fails: a job must not end because nobody reads its log any more (`kerf run … | head`).

#include <cstdio>
#include <string>
#include <utility>

#include <fmt/format.h>

namespace kerf::apps {

/// As fmt::print, but a broken pipe or a full disk is ignored.
template <typename... Args>
void put_to(std::FILE* file, fmt::format_string<Args...> format, Args&&... args) {
  const std::string text = fmt::format(format, std::forward<Args>(args)...);
  if (std::fwrite(text.data(), 1, text.size(), file) != text.size()) std::clearerr(file);
}

template <typename... Args>
void put(fmt::format_string<Args...> format, Args&&... args) {
  put_to(stdout, format, std::forward<Args>(args)...);
}

}  // namespace kerf::apps
