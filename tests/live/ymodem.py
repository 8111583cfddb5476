"""A YModem sender, written from the protocol's description, for receivers that never ask first."""

import binascii

SOH, STX, EOT, ACK, NAK, CAN = b"\x01", b"\x02", b"\x04", b"\x06", b"\x15", b"\x18"


class Cancelled(Exception):
    """The receiver said CAN CAN."""


def block(number, payload, size):
    padding = b"\0" if number == 0 else b"\x1a"
    payload = payload.ljust(size, padding)
    head = (SOH if size == 128 else STX) + bytes([number & 0xFF, ~number & 0xFF])
    return head + payload + binascii.crc_hqx(payload, 0).to_bytes(2, "big")


def deliver(wire, data, expected, tries=5):
    """Sends until it is acknowledged."""
    for _ in range(tries):
        wire.send(data)
        answer = wire.take(1, timeout=5)
        if answer == ACK:
            if expected == ACK + b"C":
                assert wire.take(1) == b"C"
            return
        if answer == CAN:
            raise Cancelled()
        assert answer == NAK, f"{answer!r} came"
    raise AssertionError("it was refused too often")


def blocks_of(data, size):
    for number, at in enumerate(range(0, len(data), size), start=1):
        yield number, data[at:at + size]


def upload(wire, name, data, size=1024):
    deliver(wire, block(0, name.encode() + b"\0" + str(len(data)).encode(), 128), ACK + b"C")
    for number, piece in blocks_of(data, size):
        deliver(wire, block(number, piece, size), ACK)
    deliver(wire, EOT, ACK + b"C")
    deliver(wire, block(0, b"", 128), ACK)
