"""Starts the real `kerf` (environment variable KERF) on free ports of this computer. Python's standard library only."""

import os
import pty
import re
import select
import signal
import socket
import subprocess
import tempfile
import time
import unittest

KERF = os.environ.get("KERF", "build/kerf")
EXAMPLES = os.environ.get("KERF_EXAMPLES", "examples")
PERSONALITIES = ("grbl", "rabbit", "grblhal")

DONE, USAGE, NO_CONNECTION, REFUSED, ALARM, INTERRUPTED, WARNED = range(7)


def example(name):
    return os.path.join(EXAMPLES, name)


def kerf(*arguments, text="", timeout=60):
    """Runs `kerf` to its end; gives the CompletedProcess with text output."""
    return subprocess.run([KERF, *arguments], input=text, capture_output=True, text=True, timeout=timeout)


def wait_until(condition, timeout=20.0, what="the condition"):
    end = time.monotonic() + timeout
    while time.monotonic() < end:
        value = condition()
        if value:
            return value
        time.sleep(0.02)
    raise AssertionError(f"{what} did not come true within {timeout} s")


class Running:
    """A `kerf` that runs beside the test; its output is read line by line."""

    def __init__(self, *arguments, stdin=subprocess.DEVNULL):
        self.process = subprocess.Popen(
            [KERF, *arguments], stdin=stdin, stdout=subprocess.PIPE, stderr=subprocess.PIPE, bufsize=0)
        self.output = ""

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.end()

    def read(self, timeout):
        ready, _, _ = select.select([self.process.stdout], [], [], timeout)
        if ready:
            self.output += os.read(self.process.stdout.fileno(), 65536).decode("utf-8", "replace")

    def wait_for(self, pattern, timeout=30.0):
        """The first match of `pattern` in everything printed so far and from now on."""
        end = time.monotonic() + timeout
        while True:
            found = re.search(pattern, self.output)
            if found:
                return found
            left = end - time.monotonic()
            if left <= 0 or (self.process.poll() is not None and not self.pending()):
                raise AssertionError(f"'{pattern}' was not printed; there is:\n{self.output}{self.errors()}")
            self.read(min(left, 0.2))

    def pending(self):
        return bool(select.select([self.process.stdout], [], [], 0)[0]) and self.read_rest()

    def read_rest(self):
        before = len(self.output)
        self.read(0)
        return len(self.output) > before

    def errors(self):
        if self.process.poll() is None:
            return ""
        return self.process.stderr.read().decode("utf-8", "replace")

    def signal(self, number):
        self.process.send_signal(number)

    def wait(self, timeout=30.0):
        """The exit status."""
        end = time.monotonic() + timeout
        while self.process.poll() is None and time.monotonic() < end:
            self.read(0.05)
        if self.process.poll() is None:
            raise AssertionError(f"kerf did not end; there is:\n{self.output}")
        self.output += self.process.stdout.read().decode("utf-8", "replace")
        return self.process.returncode

    def end(self):
        if self.process.poll() is None:
            self.process.terminate()
            try:
                self.process.wait(5)
            except subprocess.TimeoutExpired:
                self.process.kill()
                self.process.wait()
        for stream in (self.process.stdout, self.process.stderr, self.process.stdin):
            if stream:
                stream.close()


class VirtualMachine(Running):
    """`kerf virtual` on a free TCP port, and on a pty if one is named."""

    def __init__(self, personality, *arguments, tcp=True, pty_path=None, speed="max"):
        options = ["virtual", "--personality", personality, "--speed", speed, *arguments]
        if tcp:
            options += ["--listen", "tcp://127.0.0.1:0"]
        if pty_path:
            options += ["--pty", pty_path]
        super().__init__(*options)
        self.wait_for(r"Ctrl-C ends it\.")
        found = re.search(r"tcp://127\.0\.0\.1:(\d+)", self.output)
        self.port = int(found[1]) if found else None
        self.url = found[0] if found else None


class OnTerminal:
    """A `kerf` in front of a terminal of its own, on which the test presses keys."""

    def __init__(self, *arguments):
        self.process_id, self.terminal = pty.fork()
        if self.process_id == 0:
            os.environ.update(TERM="xterm", LC_ALL="C.UTF-8")
            try:
                os.execv(KERF, [KERF, *arguments])
            finally:
                os._exit(127)
        self.output = ""
        self.status = None

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self.status is None:
            os.kill(self.process_id, signal.SIGKILL)
            os.waitpid(self.process_id, 0)
        os.close(self.terminal)

    def wait_for(self, pattern, timeout=30.0):
        end = time.monotonic() + timeout
        while True:
            found = re.search(pattern, self.output)
            if found:
                return found
            left = end - time.monotonic()
            if left <= 0 or not self.read(left):
                raise AssertionError(f"'{pattern}' was not shown; there is:\n{self.output}")

    def read(self, timeout):
        """False at the end of the program."""
        if not select.select([self.terminal], [], [], timeout)[0]:
            return True
        try:
            piece = os.read(self.terminal, 65536)
        except OSError:
            return False
        self.output += piece.decode("utf-8", "replace")
        return bool(piece)

    def press(self, keys):
        os.write(self.terminal, keys.encode())

    def wait(self, timeout=30.0):
        end = time.monotonic() + timeout
        while self.read(max(0.0, end - time.monotonic())):
            if time.monotonic() >= end:
                raise AssertionError(f"kerf did not end; there is:\n{self.output}")
        self.status = os.waitstatus_to_exitcode(os.waitpid(self.process_id, 0)[1])
        return self.status


class Peer:
    """A TCP server of the test's own, for peers that are no controller. `answer` turns what came into what to say."""

    def __init__(self, answer=lambda heard: b""):
        self.socket = socket.create_server(("127.0.0.1", 0))
        self.url = "tcp://127.0.0.1:%d" % self.socket.getsockname()[1]
        self.heard = b""
        self.answer = answer
        self.running = True
        import threading
        self.thread = threading.Thread(target=self.serve, daemon=True)
        self.thread.start()

    def serve(self):
        self.socket.settimeout(0.1)
        while self.running:
            try:
                client, _ = self.socket.accept()
            except TimeoutError:
                continue
            except OSError:
                return
            with client:
                self.talk(client)

    def talk(self, client):
        client.settimeout(0.1)
        try:
            client.sendall(self.answer(b""))
            while self.running:
                try:
                    heard = client.recv(4096)
                except TimeoutError:
                    heard = None
                if heard == b"":
                    return
                if heard:
                    self.heard += heard
                client.sendall(self.answer(heard or b""))
        except OSError:
            return

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.running = False
        self.thread.join()
        self.socket.close()


def free_port():
    with socket.create_server(("127.0.0.1", 0)) as server:
        return server.getsockname()[1]


class LiveTest(unittest.TestCase):
    """With a folder that goes when the test ends, and the check that every error message has to pass. The logs of all
    connections are replayed at the end: the same bytes must come out."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="kerf-live-")
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        before = os.environ.get("XDG_STATE_HOME", "")
        self.addCleanup(os.environ.update, XDG_STATE_HOME=before)
        # What one test's machines were seen with is nothing to another's.
        os.environ["XDG_STATE_HOME"] = os.path.join(self.folder, "state")
        self.addCleanup(self.replay_logs)

    def logs(self):
        """The logs of the test so far, the oldest first."""
        folder = os.path.join(self.folder, "state", "kerf", "logs")
        if not os.path.isdir(folder):
            return []
        return [path for path in sorted(os.path.join(folder, name) for name in os.listdir(folder))
                if os.path.getsize(path) > 0]

    def replay_logs(self):
        for log in self.logs():
            replayed = kerf("replay", log)
            self.assertEqual(replayed.returncode, DONE, replayed.stdout + replayed.stderr)

    def file(self, name, content):
        path = os.path.join(self.folder, name)
        with open(path, "wb") as file:
            file.write(content if isinstance(content, bytes) else content.encode())
        return path

    def assert_complains(self, result, status, *words):
        """It ends with `status`, and says one sentence on standard error that holds all `words`."""
        self.assertEqual(result.returncode, status, result.stdout + result.stderr)
        sentence = result.stderr.strip()
        self.assertTrue(sentence.startswith("kerf: "), sentence)
        self.assertNotIn("\n", sentence)
        self.assertRegex(sentence[-2:], r"[.'?]", sentence)
        for word in words:
            self.assertIn(word, sentence)


if __name__ == "__main__":
    unittest.main()
