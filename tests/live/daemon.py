"""A `kerf serve` of the test's own, and clients of it. Python's standard library only."""

import base64
import http.client
import json
import os
import re
import socket
import struct
import tempfile
import time

from kerf_program import Running

TEXT, CLOSE, PING, PONG = 1, 8, 9, 10


class Daemon(Running):
    """`kerf serve` on a free port; its state is kept in `folder`, or nowhere for long."""

    def __init__(self, *arguments, folder=None):
        self.own = tempfile.TemporaryDirectory() if folder is None else None
        self.folder = folder or self.own.name
        super().__init__("serve", "--listen", "127.0.0.1:0", "--state", self.folder, *arguments)
        self.port = int(self.wait_for(r"http://127\.0\.0\.1:(\d+)")[1])

    def end(self):
        super().end()
        if self.own:
            self.own.cleanup()

    def request(self, method, path, body=None, headers=None):
        """Status and reply; JSON is read."""
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=30)
        if isinstance(body, (dict, list)):
            body = json.dumps(body)
        connection.request(method, path, body, headers or {})
        reply = connection.getresponse()
        text = reply.read()
        connection.close()
        is_json = reply.getheader("Content-Type", "").startswith("application/json")
        return reply.status, json.loads(text) if is_json else text

    def get(self, path):
        status, reply = self.request("GET", "/api/v1" + path)
        assert status == 200, (path, status, reply)
        return reply

    def command(self, machine, name, **members):
        return self.request("POST", f"/api/v1/machines/{machine}/commands", {"command": name, **members})[1]

    def machine(self, machine):
        return self.get("/state")["state"]["machines"][machine]

    def upload(self, name, text):
        status, reply = self.request("POST", f"/api/v1/programs?name={name}", text)
        assert status == 201, (status, reply)
        return reply["id"]

    def wait_for_machine(self, machine, condition, timeout=20.0, what="the condition"):
        end = time.monotonic() + timeout
        while time.monotonic() < end:
            view = self.machine(machine)
            if condition(view):
                return view
            time.sleep(0.03)
        raise AssertionError(f"{what} did not come true within {timeout} s: {json.dumps(view)}")

    def wait_until_ready(self, machine):
        return self.wait_for_machine(machine, lambda view: view["link"]["phase"] == "Ready", what="Ready")


class Live:
    """A WebSocket at /api/v1/live, and the state as it says it is."""

    def __init__(self, port, start=None, headers=""):
        self.socket = socket.create_connection(("127.0.0.1", port), timeout=20)
        path = "/api/v1/live" + (f"?from={start}" if start is not None else "")
        key = base64.b64encode(os.urandom(16)).decode()
        self.socket.sendall((f"GET {path} HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nUpgrade: websocket\r\n"
                             f"Connection: Upgrade\r\nSec-WebSocket-Key: {key}\r\nSec-WebSocket-Version: 13\r\n"
                             f"{headers}\r\n").encode())
        self.bytes = b""
        head = b""
        while b"\r\n\r\n" not in head:
            piece = self.socket.recv(4096)
            if not piece:
                break
            head += piece
        self.status = int(re.match(rb"HTTP/1\.1 (\d+)", head)[1])
        self.bytes = head.split(b"\r\n\r\n", 1)[1]
        self.state = None
        self.number = None
        self.client = None
        self.answers = {}
        self.traffic = []
        self.kinds = []

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.socket.close()

    def take(self, count):
        while len(self.bytes) < count:
            piece = self.socket.recv(65536)
            if not piece:
                raise ConnectionError("the daemon closed the WebSocket")
            self.bytes += piece
        taken, self.bytes = self.bytes[:count], self.bytes[count:]
        return taken

    def frame(self, timeout=20.0):
        """The next text frame, read; what it tells is kept."""
        self.socket.settimeout(timeout)
        while True:
            first, length = self.take(2)
            if length == 126:
                length = struct.unpack(">H", self.take(2))[0]
            elif length == 127:
                length = struct.unpack(">Q", self.take(8))[0]
            payload = self.take(length)
            if first & 15 == PING:
                self.send_frame(PONG, payload)
            elif first & 15 == CLOSE:
                raise ConnectionError("the daemon closed the WebSocket")
            elif first & 15 == TEXT:
                return self.keep(json.loads(payload))

    def keep(self, frame):
        kind = frame["type"]
        self.kinds.append(kind)
        if kind == "hello":
            self.client = frame["client"]
        elif kind == "snapshot":
            self.state, self.number = frame["state"], frame["number"]
        elif kind == "patch":
            if self.number is not None and self.state is not None:
                assert frame["number"] == self.number + 1, (frame["number"], self.number)
                merge(self.state, frame["patch"])
            self.number = frame["number"]
        elif kind == "answer":
            self.answers[frame["key"]] = frame
        elif kind == "traffic":
            self.traffic += frame["lines"]
        return frame

    def read_for(self, seconds):
        end = time.monotonic() + seconds
        while (left := end - time.monotonic()) > 0:
            try:
                self.frame(left)
            except TimeoutError:
                return

    def wait_for(self, condition, timeout=20.0, what="the condition"):
        end = time.monotonic() + timeout
        while not (self.state and condition(self.state)):
            left = end - time.monotonic()
            assert left > 0, f"{what} did not come true within {timeout} s"
            self.frame(left)

    def send_frame(self, kind, payload):
        mask = os.urandom(4)
        length = len(payload)
        head = bytes([0x80 | kind])
        head += bytes([0x80 | length]) if length < 126 else b"\xfe" + struct.pack(">H", length)
        self.socket.sendall(head + mask + bytes(byte ^ mask[at % 4] for at, byte in enumerate(payload)))

    def send(self, **frame):
        self.send_frame(TEXT, json.dumps(frame).encode())

    def ask(self, **frame):
        """Sends a frame with a key, and waits for its answer."""
        key = base64.b16encode(os.urandom(8)).decode()
        self.send(key=key, **frame)
        while key not in self.answers:
            self.frame()
        return self.answers[key]


def merge(target, patch):
    """RFC 7396, in place; both are objects."""
    for name, value in patch.items():
        if value is None:
            target.pop(name, None)
        elif isinstance(value, dict):
            if not isinstance(target.get(name), dict):
                target[name] = {}
            merge(target[name], value)
        else:
            target[name] = value
