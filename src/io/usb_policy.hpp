#pragma once
// What the control lines of a serial port do to the controller behind it, by the USB identity of the port. Any thread.

#include <span>
#include <string>
#include <string_view>

#include "io/ports.hpp"
#include "sender/machine/link_opening.hpp"

namespace kerf::io {

/// What DTR and RTS mean there. Kerf raises both in one step on every port and never lets them fall, which is right for
/// all of these; they differ in what may be expected of it.
enum class ControlLines {
  DtrResets,    ///< an edge of DTR resets the processor, through a capacitor
  EitherAlone,  ///< one of the two without the other resets, or selects the bootloader; both together do nothing
  Depends,      ///< a chip that is found on boards of both kinds
  DtrTalks,     ///< no wires at all: the firmware talks while DTR is up, and may greet when it rises
  Unknown,
};

/// One row for a chip or a board; an empty product stands for all of a vendor's.
struct UsbPolicy {
  std::string_view vendor;   ///< "1a86"
  std::string_view product;  ///< "7523"
  std::string_view name;
  ControlLines lines{};
  std::string_view source;
};

[[nodiscard]] std::span<const UsbPolicy> usb_policies();
/// The row for a port; the last one, which knows nothing, for what is in no table or is no USB device.
[[nodiscard]] const UsbPolicy& policy_for(const SerialPort& port);

/// What the log says about a port that was opened. `lines_fell`: they were down before, so that opening made an edge.
[[nodiscard]] machine::LinkOpening opening_of(const SerialPort& port, bool lines_fell);

}  // namespace kerf::io
