#include "io/serial_line.hpp"

#include <cerrno>

#include <asm/termbits.h>
#include <sys/file.h>
#include <sys/ioctl.h>

namespace kerf::io {

int prepare_serial_line(int descriptor, int baud) {
  termios2 line{};
  if (::ioctl(descriptor, TCGETS2, &line) != 0) return errno;
  constexpr tcflag_t kCleared = CBAUD | CSIZE | PARENB | CSTOPB | CRTSCTS | HUPCL;
  line.c_cflag = (line.c_cflag & ~kCleared) | CS8 | CREAD | CLOCAL | BOTHER;
  line.c_ispeed = static_cast<speed_t>(baud);
  line.c_ospeed = static_cast<speed_t>(baud);
  return ::ioctl(descriptor, TCSETS2, &line) == 0 ? 0 : errno;
}

int claim_serial_line(int descriptor) {
  if (::flock(descriptor, LOCK_EX | LOCK_NB) != 0) return errno;
  return ::ioctl(descriptor, TIOCEXCL) == 0 ? 0 : errno;
}

void discard_serial_input(int descriptor) {
  ::ioctl(descriptor, TCFLSH, TCIFLUSH);
}

}  // namespace kerf::io
