#include "apps/line_editor.hpp"

#include <array>
#include <cstdio>
#include <utility>

#include <fmt/format.h>
#include <histedit.h>
#include <unistd.h>

#include "apps/output.hpp"
#include "common/protocol/secrets.hpp"

namespace kerf::apps {
namespace {

constexpr int kHistoryLines = 1000;
constexpr char kControlX = 0x18;

/// Edits a line with libedit, one key at a time, whenever the terminal has one.
class LineEditor final : public InputReader {
 public:
  LineEditor(io::EventLoop& loop, std::string prompt, std::string history_file, InputCallbacks callbacks)
      : prompt_(std::move(prompt)),
        history_file_(std::move(history_file)),
        callbacks_(std::move(callbacks)),
        editor_(el_init("kerf", stdin, stdout, stderr)),
        history_(history_init()) {
    HistEvent event;
    history(history_, &event, H_SETSIZE, kHistoryLines);
    history(history_, &event, H_SETUNIQUE, 1);
    if (!history_file_.empty()) history(history_, &event, H_LOAD, history_file_.c_str());
    el_set(editor_, EL_CLIENTDATA, this);
    el_set(editor_, EL_PROMPT, &LineEditor::prompt_of);
    el_set(editor_, EL_EDITOR, "emacs");
    el_set(editor_, EL_HIST, history, history_);
    el_set(editor_, EL_ADDFN, "kerf-realtime", "Acts at once at the start of a line", &LineEditor::take_realtime_key);
    for (const char* key : {"?", "!", "~", "^X"}) el_set(editor_, EL_BIND, key, "kerf-realtime", nullptr);
    begin_line();
    watch_ = std::make_unique<io::ReadableWatch>(loop, STDIN_FILENO, [this] { read(); });
  }

  ~LineEditor() override {
    watch_.reset();
    HistEvent event;
    if (!history_file_.empty()) history(history_, &event, H_SAVE, history_file_.c_str());
    end_line();
    history_end(history_);
    el_end(editor_);
    put("\n");
  }

  void print(std::string_view line) override {
    put("{}{}\n", is_editing_ ? "\r\x1b[K" : "", line);
    std::fflush(stdout);
    if (is_editing_) el_set(editor_, EL_REFRESH);
  }

  bool clear_line() override {
    const LineInfo* line = el_line(editor_);
    const auto length = static_cast<int>(line->lastchar - line->buffer);
    if (length == 0) return false;
    el_cursor(editor_, length);
    el_deletestr(editor_, length);
    put("\r\x1b[K");
    std::fflush(stdout);
    el_set(editor_, EL_REFRESH);
    return true;
  }

 private:
  static LineEditor& self_of(EditLine* editor) {
    void* self = nullptr;
    el_get(editor, EL_CLIENTDATA, &self);
    return *static_cast<LineEditor*>(self);
  }

  static const char* prompt_of(EditLine* editor) { return self_of(editor).prompt_.c_str(); }

  static unsigned char take_realtime_key(EditLine* editor, int key) {
    const LineInfo* line = el_line(editor);
    if (line->lastchar == line->buffer) {
      self_of(editor).pressed_ = static_cast<char>(key);
      return CC_NORM;
    }
    const std::array<char, 2> text{static_cast<char>(key), '\0'};
    if (key == kControlX || el_insertstr(editor, text.data()) != 0) return CC_ERROR;
    return CC_REFRESH;
  }

  void read() {
    int count = 0;
    const char* text = el_gets(editor_, &count);
    if (const char key = std::exchange(pressed_, '\0'); key != '\0') return callbacks_.realtime_key(key);
    if (text == nullptr || count < 0) return callbacks_.ended();
    std::string line(text, static_cast<std::size_t>(count));
    if (line == "\x04") return callbacks_.ended();  // Ctrl-D
    if (!line.ends_with('\n')) return;              // still being typed
    line.pop_back();
    end_line();
    if (!line.empty()) {
      HistEvent event;
      // The history is a file: a password must not stay there.
      if (protocol::Secrets().secret_in(line).empty()) history(history_, &event, H_ENTER, line.c_str());
    }
    callbacks_.line(line);
    begin_line();
  }

  /// Switches the terminal to single keys, and shows the prompt.
  void begin_line() {
    el_set(editor_, EL_UNBUFFERED, 1);
    is_editing_ = true;
  }

  void end_line() {
    el_set(editor_, EL_UNBUFFERED, 0);
    is_editing_ = false;
  }

  const std::string prompt_;
  const std::string history_file_;
  InputCallbacks callbacks_;
  EditLine* editor_;
  History* history_;
  char pressed_ = '\0';
  bool is_editing_ = false;
  std::unique_ptr<io::ReadableWatch> watch_;
};

class PlainReader final : public InputReader {
 public:
  PlainReader(io::EventLoop& loop, InputCallbacks callbacks)
      : callbacks_(std::move(callbacks)),
        watch_(std::make_unique<io::ReadableWatch>(loop, STDIN_FILENO, [this] { read(); })) {}

  void print(std::string_view line) override {
    put("{}\n", line);
    std::fflush(stdout);
  }

  bool clear_line() override { return false; }

 private:
  void read() {
    std::array<char, 4096> piece{};
    const ssize_t count = ::read(STDIN_FILENO, piece.data(), piece.size());
    if (count <= 0) {
      if (!partial_.empty()) take(std::exchange(partial_, {}));
      watch_.reset();
      return callbacks_.ended();
    }
    partial_.append(piece.data(), static_cast<std::size_t>(count));
    std::size_t end = 0;
    while ((end = partial_.find('\n')) != std::string::npos) {
      const std::string line = partial_.substr(0, end);
      partial_.erase(0, end + 1);
      take(line);
    }
  }

  void take(std::string line) {
    if (line.ends_with('\r')) line.pop_back();
    if (line.size() == 1 && is_realtime_key(line.front())) return callbacks_.realtime_key(line.front());
    callbacks_.line(line);
  }

  InputCallbacks callbacks_;
  std::string partial_;
  std::unique_ptr<io::ReadableWatch> watch_;
};

}  // namespace

bool is_realtime_key(char key) {
  return key == '?' || key == '!' || key == '~' || key == kControlX;
}

std::unique_ptr<InputReader> make_line_editor(io::EventLoop& loop, std::string prompt, std::string history_file,
                                              InputCallbacks callbacks) {
  return std::make_unique<LineEditor>(loop, std::move(prompt), std::move(history_file), std::move(callbacks));
}

std::unique_ptr<InputReader> make_plain_reader(io::EventLoop& loop, InputCallbacks callbacks) {
  return std::make_unique<PlainReader>(loop, std::move(callbacks));
}

}  // namespace kerf::apps
