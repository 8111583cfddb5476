"""Doors, switches, power, cables and bytes of a virtual machine, by script and by control socket; many machines."""

import json
import os
import re
import socket
import time
import unittest

from kerf_program import DONE, PERSONALITIES, USAGE, LiveTest, Running, VirtualMachine, kerf, wait_until

QUICK = "".join(f"$10{axis}=250\n$11{axis}=6000\n$12{axis}=500\n" for axis in range(3))


class Control:
    """A connection to a control socket."""

    def __init__(self, address):
        if isinstance(address, str):
            self.socket = socket.socket(socket.AF_UNIX)
        else:
            self.socket = socket.socket()
        self.socket.settimeout(20)
        self.socket.connect(address)
        self.lines = self.socket.makefile("rw")

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.lines.close()
        self.socket.close()

    def order(self, line):
        self.lines.write(line + "\n")
        self.lines.flush()
        return self.lines.readline().strip()


class Sender:
    """Somebody who talks raw bytes over TCP."""

    def __init__(self, port):
        self.socket = socket.create_connection(("127.0.0.1", port), timeout=20)
        self.heard = ""

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.socket.close()

    def send(self, text):
        self.socket.sendall(text.encode("latin-1"))

    def wait_for(self, pattern):
        while not re.search(pattern, self.heard):
            piece = self.socket.recv(4096)
            if not piece:
                raise AssertionError(f"the connection ended before '{pattern}'; there is:\n{self.heard}")
            self.heard += piece.decode("latin-1")
        found = re.search(pattern, self.heard)
        self.heard = self.heard[found.end():]
        return found


class Workcell(LiveTest):
    def setUp(self):
        super().setUp()
        self.control_path = os.path.join(self.folder, "control")
        self.settings = self.file("settings", QUICK)

    def machine(self, personality, *arguments, **options):
        return VirtualMachine(personality, "--settings", self.settings, "--control", f"unix:{self.control_path}",
                              *arguments, **options)

    def test_a_door_opens_and_a_test_waits_for_it(self):
        for personality in PERSONALITIES:
            with self.subTest(personality), self.machine(personality, speed="1") as machine, \
                    Control(self.control_path) as control, Sender(machine.port) as sender:
                sender.send("G21G91G1X100F3000\n")
                self.assertEqual(control.order("when state Run"), "ok")
                self.assertEqual(control.order("after 300ms door open"), "ok")
                self.assertEqual(control.order("when state Door:1"), "ok")
                self.assertEqual(control.order("state"), "ok Door:1")
                sender.send("?")
                sender.wait_for(r"<Door:1\|.*Pn:D")
                x = float(control.order("position").split()[1])
                self.assertTrue(0 < x < 100, x)
                self.assertEqual(control.order("door close"), "ok")
                self.assertEqual(control.order("state"), "ok Door:0")

    def test_power_and_cable(self):
        with self.machine("grblhal", speed="1") as machine, Control(self.control_path) as control:
            with Sender(machine.port) as sender:
                sender.send("G21\n")
                sender.wait_for("ok")
                self.assertEqual(control.order("power off"), "ok")
                self.assertEqual(control.order("state"), "ok no power")
                self.assertEqual(control.order("power on"), "ok")
                sender.wait_for(r"GrblHAL 1.1f.*\r\n")
                self.assertEqual(control.order("link silent"), "ok")
                sender.send("?")
                self.assertEqual(control.order("after 500ms link restore"), "ok")
                sender.send("G90\n")
                self.assertEqual(sender.wait_for(r"(?s)(.*)ok")[1].strip(), "")
                self.assertEqual(control.order("link cut"), "ok")
                self.assertEqual(sender.socket.recv(100), b"")
            self.assertEqual(control.order("link restore"), "ok")
            with Sender(machine.port) as sender:
                sender.send("?")
                sender.wait_for("<Idle")

    def test_a_terminal_that_is_pulled_out_comes_back(self):
        path = os.path.join(self.folder, "tty")
        with self.machine("grbl", tcp=False, pty_path=path), Control(self.control_path) as control:
            terminal = os.open(path, os.O_RDWR | os.O_NOCTTY)
            self.assertEqual(control.order("link cut"), "ok")
            self.assertFalse(os.path.lexists(path))
            with self.assertRaises(OSError):
                while os.read(terminal, 100):
                    pass
                raise OSError("the end")
            os.close(terminal)
            self.assertEqual(control.order("link restore"), "ok")
            self.assertEqual(kerf("console", "--machine", path, text="$G\n").returncode, DONE)

    def test_a_script_is_played_and_logged(self):
        script = self.file("a.script", "# once\nwhen line 5 drop from next 2\nwhen line 8 note near the end\n")
        log = os.path.join(self.folder, "log")
        with self.machine("grbl", "--script", script, "--log", log, speed="1") as machine, \
                Sender(machine.port) as sender:
            for line in range(8):
                sender.send("G4P0.01\n")
                sender.wait_for("\n")
            machine.wait_for("near the end")
        with open(log) as file:
            entries = [json.loads(line) for line in file]
        scripted = [entry for entry in entries if entry["kind"] == "Script"]
        self.assertEqual([entry["from"] for entry in scripted], [f"{script}:2", f"{script}:3"])
        fault, = (entry for entry in entries if entry["kind"] == "Fault")
        self.assertRegex(fault["what"], r"dropped byte \d+ to \d+ on the way from the controller: ok")
        self.assertGreaterEqual(fault["at"], scripted[0]["at"])
        self.assertTrue(any(entry["kind"] == "Link" and "connected" in entry["what"] for entry in entries))

    def test_every_error_names_its_place(self):
        wrong = self.file("wrong.script", "door open\n\nlimit Q on\n")
        self.assert_complains(kerf("virtual", "-l", "127.0.0.1:0", "--script", wrong), USAGE, "wrong.script:3",
                              "limit Q on", "X|Y|Z")
        self.assert_complains(kerf("virtual", "-l", "127.0.0.1:0", "--script", self.folder + "/none"), USAGE, "none")
        self.assert_complains(kerf("virtual", "-l", "127.0.0.1:0", "--control", "http://here"), USAGE, "unix:")
        self.assert_complains(kerf("virtual", "-l", "127.0.0.1:0", "--log", self.folder + "/no/log"), USAGE, "no/log")
        self.assert_complains(kerf("virtual", "-l", "127.0.0.1:0", "--control", f"unix:{wrong}"), USAGE, "exists")
        self.assert_complains(kerf("virtual", "-l", "127.0.0.1:0", "-l", "127.0.0.1:0", "--count", "3"), USAGE,
                              "--listen")
        self.assert_complains(kerf("virtual", "-l", "127.0.0.1:65530", "--count", "30"), USAGE, "65535")

    def test_a_control_line_that_is_wrong_changes_nothing(self):
        with self.machine("grblhal"), Control(self.control_path) as control:
            self.assertRegex(control.order("when state Running hold"), r"^error: 'Running' is no state; accepted: Idle")
            self.assertRegex(control.order("@2 state"), r"^error: '@2' is no machine")
            self.assertEqual(control.order(""), "ok")
            self.assertEqual(control.order("state"), "ok Idle")
            self.assertIn("surface Z|none", control.order("help"))
            self.assertRegex(control.order("time"), r"^ok \d+\.\d{6}$")

    def test_a_job_survives_latency(self):
        with self.machine("grblhal", speed="10") as machine, Control(self.control_path) as control:
            self.assertEqual(control.order("delay both 100ms"), "ok")
            result = kerf("run", self.file("part.nc", "G21G91\n" + "G1X1F3000\nX-1\n" * 40 + "M30\n"),
                          "--machine", machine.url)
            self.assertEqual(result.returncode, DONE, result.stdout + result.stderr)


class Network(LiveTest):
    """More bytes than fit, in one piece, while the planner is full."""

    LINES = 400

    def test_grblhal_lets_the_network_wait(self):
        with VirtualMachine("grblhal", "--settings", self.file("settings", QUICK), speed="20") as machine, \
                Sender(machine.port) as sender:
            sender.send("G21G91\n" + "G1X1F3000\nG1X-1\n" * (self.LINES // 2))
            for _ in range(self.LINES + 1):
                self.assertEqual(sender.wait_for(r"([^\r\n]+)\r\n")[1], "ok")

    def test_grbl_loses_what_does_not_fit(self):
        with VirtualMachine("grbl", "--settings", self.file("settings", QUICK), speed="20") as machine, \
                Sender(machine.port) as sender:
            sender.send("G21G91\n" + "G1X1F3000\nG1X-1\n" * (self.LINES // 2))
            wait_until(lambda: self.is_idle(sender), what="the end of the motion")
            self.assertLess(sender.heard.count("ok"), self.LINES // 2)

    @staticmethod
    def is_idle(sender):
        time.sleep(0.3)
        sender.send("?")
        before = sender.heard
        sender.heard = ""
        state = sender.wait_for(r"(?s)(.*)<(\w+)")
        sender.heard = before + state[1] + sender.heard
        return state[2] == "Idle"


class Many(LiveTest):
    MOST_BYTES = 5_000_000

    def resident_bytes(self, count):
        """Of `kerf virtual --count N`, after each machine was talked to."""
        control = os.path.join(self.folder, f"control{count}")
        with Running("virtual", "--count", str(count), "--listen", "127.0.0.1:0", "--speed", "max",
                     "--control", f"unix:{control}") as fleet:
            fleet.wait_for(r"Ctrl-C ends it\.")
            ports = [int(port) for port in re.findall(r"at tcp://127\.0\.0\.1:(\d+)", fleet.output)]
            self.assertEqual(len(ports), count)
            for port in ports:
                with Sender(port) as sender:
                    sender.send("$$\n$#\nG21G91\n" + "G1X0.1F1000\nX-0.1\n" * 60)
                    for _ in range(100):
                        sender.wait_for("ok")
            with Control(control) as control:
                self.assertRegex(control.order(f"@{count} state"), r"^ok (Run|Idle)$")
            with open(f"/proc/{fleet.process.pid}/statm") as statm:
                return int(statm.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")

    def test_a_hundred_machines_take_five_megabytes_each_at_most(self):
        one, hundred = self.resident_bytes(1), self.resident_bytes(100)
        each = (hundred - one) / 99
        print(f"resident: {one / 1e6:.1f} MB with one machine, {hundred / 1e6:.1f} MB with 100, "
              f"{each / 1e6:.3f} MB each", flush=True)
        self.assertLess(each, self.MOST_BYTES)

    def test_each_has_its_own_place_and_state(self):
        path = os.path.join(self.folder, "tty")
        with Running("virtual", "-p", "grbl", "--count", "3", "--pty", path, "--speed", "max") as fleet:
            fleet.wait_for(r"Ctrl-C ends it\.")
            for number in (1, 2, 3):
                kerf("console", "--machine", f"{path}-{number}", text=f"$110={number}00\n")
            for number in (1, 2, 3):
                told = kerf("console", "--machine", f"{path}-{number}", text="$$\n").stdout
                self.assertIn(f"$110={number}00.000", told)


if __name__ == "__main__":
    unittest.main()
