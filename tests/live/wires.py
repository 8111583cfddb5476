"""Two ends of one controller, for tests that speak the protocol themselves."""

import select
import socket
import time


class Wire:
    """A raw connection to a controller, read line by line."""

    def __init__(self, port):
        self.socket = socket.create_connection(("127.0.0.1", port))
        self.socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self.bytes = b""

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.socket.close()

    def send(self, data):
        self.socket.sendall(data)

    def read(self, timeout):
        """False if nothing came."""
        if not select.select([self.socket], [], [], timeout)[0]:
            return False
        piece = self.socket.recv(65536)
        self.bytes += piece
        return bool(piece)

    def take(self, count, timeout=10.0):
        """Exactly `count` bytes, or fewer when time is up."""
        end = time.monotonic() + timeout
        while len(self.bytes) < count and time.monotonic() < end:
            self.read(max(0.0, end - time.monotonic()))
        taken, self.bytes = self.bytes[:count], self.bytes[count:]
        return taken

    def line(self, start, timeout=10.0):
        """The next line that begins with `start`; lines before it are passed over."""
        end = time.monotonic() + timeout
        while True:
            while b"\n" in self.bytes:
                line, self.bytes = self.bytes.split(b"\n", 1)
                text = line.decode("latin-1").strip("\r")
                if text.startswith(start):
                    return text
            left = end - time.monotonic()
            if left <= 0:
                raise AssertionError(f"'{start}…' did not come; there is {self.bytes!r}")
            self.read(left)

    def quiet(self, time_s=0.3):
        """What comes within the time."""
        end = time.monotonic() + time_s
        while time.monotonic() < end:
            self.read(max(0.0, end - time.monotonic()))
        heard, self.bytes = self.bytes, b""
        return heard
