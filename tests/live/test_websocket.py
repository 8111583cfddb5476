"""`ws://`: the virtual controller's own WebSocket, and one that speaks as FluidNC's does."""

import base64
import hashlib
import os
import re
import socket
import struct
import threading
import unittest

from kerf_program import DONE, LiveTest, NO_CONNECTION, Peer, VirtualMachine, example, kerf

TEXT, BINARY, CLOSE, PING, PONG = 1, 2, 8, 9, 10


class FluidNcGateway:
    """FluidNC's way to serve a WebSocket, in front of a raw TCP controller: talk for web pages in text frames, the
    machine's words in binary ones. Keeps every frame that it gets."""

    def __init__(self, port):
        self.controller = socket.create_connection(("127.0.0.1", port))
        self.server = socket.create_server(("127.0.0.1", 0))
        self.url = "ws://127.0.0.1:%d/" % self.server.getsockname()[1]
        self.frames = []
        self.request = ""
        self.thread = threading.Thread(target=self.serve, daemon=True)
        self.thread.start()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.server.close()
        self.controller.close()

    def serve(self):
        client, _ = self.server.accept()
        with client:
            while "\r\n\r\n" not in self.request:
                self.request += client.recv(4096).decode("ascii")
            key = re.search(r"Sec-WebSocket-Key: (\S+)", self.request)[1]
            accept = base64.b64encode(
                hashlib.sha1((key + "258EAFA5-E914-47DA-95CA-C5AB0DC85B11").encode()).digest()).decode()
            client.sendall(("HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
                            f"Sec-WebSocket-Accept: {accept}\r\nSec-WebSocket-Protocol: arduino\r\n\r\n").encode())
            for text in (b"currentID:7", b"CURRENT_ID:7"):
                self.say(client, TEXT, text)
            threading.Thread(target=self.pass_on, args=(client,), daemon=True).start()
            self.listen(client)

    @staticmethod
    def say(client, kind, payload):
        length = bytes([len(payload)]) if len(payload) < 126 else b"\x7e" + struct.pack(">H", len(payload))
        client.sendall(bytes([0x80 | kind]) + length + payload)

    def pass_on(self, client):
        try:
            while piece := self.controller.recv(1000):
                self.say(client, BINARY, piece)
                self.say(client, TEXT, b"PING:7")
        except OSError:
            return

    def listen(self, client):
        stream = client.makefile("rb")
        try:
            while head := stream.read(2):
                length = head[1] & 0x7F
                if length == 126:
                    length = struct.unpack(">H", stream.read(2))[0]
                mask = stream.read(4)
                payload = bytes(byte ^ mask[i % 4] for i, byte in enumerate(stream.read(length)))
                self.frames.append((head[0] & 0x0F, payload))
                if head[0] & 0x0F in (TEXT, BINARY):
                    self.controller.sendall(payload)
        except OSError:
            return


class WebSocketMachine(VirtualMachine):
    def __init__(self, personality="grblhal", *arguments):
        super().__init__(personality, "--listen", "ws://127.0.0.1:0", *arguments, tcp=False)
        self.url = re.search(r"ws://127\.0\.0\.1:\d+", self.output)[0]


class WebSocket(LiveTest):
    def test_a_job_goes_through_one(self):
        for personality in ("grblhal", "rabbit"):
            with self.subTest(personality), WebSocketMachine(personality) as machine:
                result = kerf("run", example("coaster.nc"), "--machine", machine.url)
                self.assertEqual(result.returncode, DONE, result.stdout + result.stderr)
                machine.wait_for("went away")

    def test_text_frames_carry_the_same(self):
        with WebSocketMachine() as machine:
            result = kerf("info", "--machine", machine.url + "/?protocol=none", "--json")
            self.assertEqual(result.returncode, DONE, result.stderr)
            self.assertIn('"grblHAL"', result.stdout)

    def test_a_fluidnc_gateway(self):
        with VirtualMachine("grblhal") as machine, FluidNcGateway(machine.port) as gateway:
            result = kerf("run", example("coaster.nc"), "--machine", gateway.url)
            self.assertEqual(result.returncode, DONE, result.stdout + result.stderr)
            self.assertIn("Sec-WebSocket-Protocol: arduino", gateway.request)
            self.assertEqual({kind for kind, _ in gateway.frames}, {BINARY})
            for _, payload in gateway.frames:
                realtime = [byte for byte in payload if byte in b"?!~\x18" or byte >= 0x80]
                self.assertIn(len(realtime), (0, len(payload)), payload)

    def test_who_is_no_websocket_is_named(self):
        with Peer(lambda heard: b"SSH-2.0-OpenSSH_9.2\r\n\r\n" if heard else b"") as peer:
            result = kerf("info", "--machine", peer.url.replace("tcp:", "ws:"))
            self.assert_complains(result, NO_CONNECTION, "not as a WebSocket")

    def test_a_second_client_is_turned_away(self):
        with WebSocketMachine() as machine:
            with socket.create_connection(("127.0.0.1", int(machine.url.rsplit(":", 1)[1]))) as first:
                first.sendall(b"GET / HTTP/1.1\r\nHost: x\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
                              b"Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: "
                              + base64.b64encode(os.urandom(16)) + b"\r\n\r\n")
                self.assertIn(b"101", first.recv(4096))
                result = kerf("info", "--machine", machine.url)
                self.assert_complains(result, NO_CONNECTION, "closed the connection")


if __name__ == "__main__":
    unittest.main()
