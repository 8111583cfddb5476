#include "apps/terminal.hpp"

#include <cstdlib>
#include <string_view>
#include <utility>

#include <sys/ioctl.h>
#include <unistd.h>

namespace kerf::apps {

bool is_terminal(int descriptor) {
  return ::isatty(descriptor) == 1;
}

int terminal_columns() {
  winsize size{};
  constexpr int kUsual = 80;
  if (::ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col == 0) return kUsual;
  return size.ws_col;
}

bool shows_utf8() {
  for (const char* name : {"LC_ALL", "LC_CTYPE", "LANG"}) {
    const char* value = std::getenv(name);
    if (value == nullptr || *value == '\0') continue;
    const std::string_view locale(value);
    return locale.ends_with("UTF-8") || locale.ends_with("utf8");
  }
  return false;
}

KeyReader::KeyReader(io::EventLoop& loop, std::function<void(char)> key) : key_(std::move(key)) {
  ::tcgetattr(STDIN_FILENO, &before_);
  termios keys = before_;
  keys.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
  keys.c_cc[VMIN] = 1;
  keys.c_cc[VTIME] = 0;
  ::tcsetattr(STDIN_FILENO, TCSADRAIN, &keys);
  watch_ = std::make_unique<io::ReadableWatch>(loop, STDIN_FILENO, [this] { read(); });
}

KeyReader::~KeyReader() {
  ::tcsetattr(STDIN_FILENO, TCSADRAIN, &before_);
}

void KeyReader::read() {
  char key = 0;
  if (::read(STDIN_FILENO, &key, 1) == 1) {
    key_(key);
  } else {
    watch_.reset();  // the terminal is gone
  }
}

}  // namespace kerf::apps
