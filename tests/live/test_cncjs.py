"""An independent sender, cncjs, finds the virtual controllers on a pseudo-terminal and works with them as if real.

Its server runs as it is; tests/live/cncjs/browser.js stands in for the browser. KERF_CNCJS names the folder where
tests/live/cncjs/install.sh has put it."""

import json
import os
import queue
import re
import subprocess
import threading
import time
import unittest

from kerf_program import LiveTest, VirtualMachine, free_port, wait_until

CNCJS = os.environ.get("KERF_CNCJS", "build/release/cncjs")
BROWSER = os.path.join(os.path.dirname(os.path.abspath(__file__)), "cncjs", "browser.js")

QUICK = "".join(f"$10{axis}=250\n$11{axis}=6000\n$12{axis}=500\n" for axis in range(3))
ROWS = 10
PROGRAM = "\n".join(
    ["(a zigzag with a corner in every row)", "G21 G90 G94", "M3 S500 F3000"]
    + [f"G1 X{20 if row % 2 else 0} ; row {row}\nG{3 if row % 2 else 2} Y{row} J0.5" for row in range(1, ROWS + 1)]
    + ["G0 X3 Y4 Z5", "M5", "M30"])
END = {"x": 3.0, "y": 4.0, "z": 5.0}

# What cncjs makes of the welcome. Rabbit's is none that it knows: it finds that machine by its status reports.
VERSIONS = {"grbl": "1.1h", "grblhal": "1.1f", "rabbit": ""}


class Cncjs:
    """Its server on a free port with a home of its own, and somebody in front of it."""

    def __init__(self, home):
        self.url = f"http://127.0.0.1:{free_port()}"
        self.environment = {**os.environ, "HOME": home, "NODE_ENV": "production"}
        port = self.url.rsplit(":", 1)[1]
        self.server = self.start("node_modules/cncjs/bin/cncjs", "-H", "127.0.0.1", "-p", port,
                                 "-c", os.path.join(home, "cncrc"))
        self.told = ""
        threading.Thread(target=self.keep_log, daemon=True).start()
        wait_until(lambda: "Starting the server" in self.told, 60, "cncjs starting")
        self.browser = self.start(BROWSER, self.url)
        self.events = []
        self.queue = queue.Queue()
        threading.Thread(target=self.listen, daemon=True).start()
        self.wait_for("startup")

    def start(self, *arguments):
        return subprocess.Popen(["node", *arguments], cwd=CNCJS, env=self.environment, text=True,
                                stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)

    def keep_log(self):
        for line in self.server.stdout:
            self.told += line

    def listen(self):
        for line in self.browser.stdout:
            self.queue.put(line)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        for process in (self.browser, self.server):
            process.terminate()
            process.wait(10)
            process.stdin.close()
            process.stdout.close()

    def emit(self, *event):
        self.browser.stdin.write(json.dumps(event) + "\n")
        self.browser.stdin.flush()

    def wait_for(self, name, condition=lambda *_: True, timeout=30.0):
        """The next event of this name that fulfils `condition`, from now on."""
        end = time.monotonic() + timeout
        while True:
            try:
                line = self.queue.get(timeout=max(0.0, end - time.monotonic()))
            except queue.Empty:
                recent = "\n".join(self.events[-20:])
                raise AssertionError(f"no such {name} came; the last events:\n{recent}\n{self.told}") from None
            self.events.append(line.strip())
            try:
                event = json.loads(line)
            except ValueError:
                continue
            if event[0] == name and condition(*event[1:]):
                return event[1:]


class Port:
    """One serial port as a person in front of cncjs uses it."""

    def __init__(self, cncjs, path):
        self.cncjs = cncjs
        self.path = path
        cncjs.emit("open", path, {"controllerType": "Grbl", "baudrate": 115200})
        cncjs.wait_for("serialport:open", lambda port: port["port"] == path)

    def command(self, *arguments):
        self.cncjs.emit("command", self.path, *arguments)

    def write_line(self, line):
        self.cncjs.emit("writeln", self.path, line)

    def hear(self, pattern):
        return self.cncjs.wait_for("serialport:read", lambda line: re.search(pattern, line))[0]

    def status(self, condition, timeout=30.0):
        """The next change of the machine's status that fulfils `condition(state, position)`: cncjs tells no others."""
        def fulfils(_, told):
            status = told["status"]
            return condition(f"{status['activeState']}:{status.get('subState', 0)}", position_of(status))
        return self.cncjs.wait_for("controller:state", fulfils, timeout)[1]["status"]

    def close(self):
        self.cncjs.emit("close", self.path)
        self.cncjs.wait_for("serialport:close")


def position_of(status):
    return {axis: float(value) for axis, value in status["mpos"].items()}


class WithCncjs(LiveTest):
    def setUp(self):
        super().setUp()
        self.assertTrue(os.path.isdir(os.path.join(CNCJS, "node_modules", "cncjs")), "cncjs is not installed there")

    def assert_identified(self, port, personality):
        """It found the machine by itself, read its settings, and knows the version from the welcome."""
        _, found = port.cncjs.wait_for("controller:settings", lambda _, told: "$122" in told["settings"])
        self.assertEqual(float(found["settings"]["$110"]), 6000)
        port.status(lambda state, _: state == "Idle:0")
        port.command("reset")
        if VERSIONS[personality]:
            kind, _ = port.cncjs.wait_for("controller:settings",
                                          lambda _, told: told["version"] == VERSIONS[personality])
            self.assertEqual(kind, "Grbl")
        port.write_line("$I")
        self.assertIn(VERSIONS[personality] or "1.1h", port.hear(r"^\[VER:"))
        port.hear(r"^ok")

    def assert_held_in_the_middle(self, port):
        port.status(lambda state, at: state == "Run:0" and at["y"] >= 3)
        port.command("gcode:pause")
        here = position_of(port.status(lambda state, _: state == "Hold:0"))
        self.assertTrue(3 <= here["y"] < ROWS, here)
        place = ",".join(f"{here[axis]:.3f}" for axis in "xyz")
        for _ in range(3):
            time.sleep(0.3)
            port.write_line("?")
            self.assertIn(f"|MPos:{place}|", port.hear(r"<Hold:0\|"))

    def assert_runs_to_the_end(self, port):
        sender, = port.cncjs.wait_for("sender:status", lambda told: told["finishTime"] > 0, 60)
        self.assertEqual((sender["sent"], sender["received"]), (sender["total"], sender["total"]))
        port.write_line("?")
        place = ",".join(f"{END[axis]:.3f}" for axis in "xyz")
        self.assertIn(f"<Idle|MPos:{place}|", port.hear(r"<Idle\|"))


def make_test(personality):
    def test(self):
        settings = self.file("settings", QUICK)
        path = os.path.join(self.folder, "tty")
        with VirtualMachine(personality, "--settings", settings, tcp=False, pty_path=path, speed="1"), \
                Cncjs(self.folder) as cncjs:
            port = Port(cncjs, path)
            self.assert_identified(port, personality)
            port.command("gcode:load", "zigzag.nc", PROGRAM)
            cncjs.wait_for("gcode:load")
            port.command("gcode:start")
            cncjs.wait_for("workflow:state", lambda state: state == "running")
            self.assert_held_in_the_middle(port)
            port.command("gcode:resume")
            self.assert_runs_to_the_end(port)
            self.assertNotIn("error:", "".join(cncjs.events))
            self.assertNotIn("ALARM:", "".join(cncjs.events))
            port.close()
    return test


for firmware in VERSIONS:
    setattr(WithCncjs, f"test_{firmware}", make_test(firmware))


if __name__ == "__main__":
    unittest.main()
