#pragma once
// What a serial port needs beyond opening it. Apart from Asio's file, because the kernel's termios2 and the C library's
// termios cannot be included together.

namespace kerf::io {

/// 8 data bits, no parity, one stop bit, no flow control, any baud rate (termios2), and DTR left up when the port is
/// closed (an Uno-class board resets when DTR falls and rises: protocol.md 1.3). Returns 0 or the system's error
/// number; EINVAL means the driver cannot do that rate.
[[nodiscard]] int prepare_serial_line(int descriptor, int baud);

/// The port drops DTR and RTS when it is closed, so they were down before it was opened. False after Kerf had it: the
/// kernel keeps a port's settings until it is unplugged.
[[nodiscard]] bool lets_lines_fall(int descriptor);

/// DTR and RTS up, in one step: either of them alone resets an ESP32 or puts it into its bootloader. The kernel has
/// done that on opening, but for drivers that leave it to the program.
void raise_control_lines(int descriptor);

/// Claims the port for this program: TIOCEXCL keeps everybody but the superuser out, an advisory lock also him. A pty
/// gets the lock only. Returns 0 or the system's error number; EWOULDBLOCK means that another program holds it.
[[nodiscard]] int claim_serial_line(int descriptor);

/// A pty's client side: no wire, no rate, no control lines.
[[nodiscard]] bool is_pty(int descriptor);

/// Throws away what arrived before anybody listened.
void discard_serial_input(int descriptor);

}  // namespace kerf::io
