#include "io/serial_line.hpp"

#include <cerrno>

#include <asm/termbits.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>

namespace kerf::io {

// Linux: UNIX98_PTY_SLAVE_MAJOR and the seven after it.
bool is_pty(int descriptor) {
  constexpr unsigned kFirstMajor = 136;
  constexpr unsigned kLastMajor = 143;
  struct stat status{};
  if (::fstat(descriptor, &status) != 0) return false;
  return major(status.st_rdev) >= kFirstMajor && major(status.st_rdev) <= kLastMajor;
}

int prepare_serial_line(int descriptor, int baud) {
  termios2 line{};
  if (::ioctl(descriptor, TCGETS2, &line) != 0) return errno;
  constexpr tcflag_t kCleared = CBAUD | CSIZE | PARENB | CSTOPB | CRTSCTS | HUPCL;
  line.c_cflag = (line.c_cflag & ~kCleared) | CS8 | CREAD | CLOCAL | BOTHER;
  line.c_ispeed = static_cast<speed_t>(baud);
  line.c_ospeed = static_cast<speed_t>(baud);
  return ::ioctl(descriptor, TCSETS2, &line) == 0 ? 0 : errno;
}

bool lets_lines_fall(int descriptor) {
  termios2 line{};
  return ::ioctl(descriptor, TCGETS2, &line) == 0 && (line.c_cflag & HUPCL) != 0;
}

void raise_control_lines(int descriptor) {
  const int lines = TIOCM_DTR | TIOCM_RTS;
  // A pty has none, and says so.
  ::ioctl(descriptor, TIOCMBIS, &lines);
}

int claim_serial_line(int descriptor) {
  if (::flock(descriptor, LOCK_EX | LOCK_NB) != 0) return errno;
  // On a pty the mark would outlive this program, because the other program keeps the terminal open.
  if (is_pty(descriptor)) return 0;
  return ::ioctl(descriptor, TIOCEXCL) == 0 ? 0 : errno;
}

void discard_serial_input(int descriptor) {
  ::ioctl(descriptor, TCFLSH, TCIFLUSH);
}

}  // namespace kerf::io
