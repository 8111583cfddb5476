"""A link that goes and comes back: Kerf comes back with it, says what it found, and moves nothing by itself."""

import json
import os
import re
import select
import socket
import threading
import time
import unittest

from kerf_program import INTERRUPTED, LiveTest, OnTerminal, Running, VirtualMachine, kerf, wait_until
from wires import Wire


class Cable:
    """The cable of a virtual machine, by its control socket; and what the machine did, by its log."""

    def __init__(self, folder):
        self.path = os.path.join(folder, "control")
        self.log = os.path.join(folder, "log.jsonl")
        self.options = ("--control", "unix:" + self.path, "--log", self.log)

    def order(self, *lines):
        with socket.socket(socket.AF_UNIX) as control:
            control.connect(self.path)
            control.sendall("".join(line + "\n" for line in lines).encode())
            control.settimeout(5)
            return control.recv(4096).decode()


class Relay:
    """Between Kerf and a machine: it can go silent, as a peer whose power is gone, and hang up."""

    def __init__(self, port):
        self.machine_port = port
        self.listener = socket.create_server(("127.0.0.1", 0))
        self.url = "tcp://127.0.0.1:%d" % self.listener.getsockname()[1]
        self.silent = False
        self.pair = None
        self.connections = 0
        threading.Thread(target=self.serve, daemon=True).start()

    def serve(self):
        while True:
            try:
                sender, _ = self.listener.accept()
            except OSError:
                return
            self.connections += 1
            self.pair = (sender, socket.create_connection(("127.0.0.1", self.machine_port)))
            self.silent = False
            self.carry(*self.pair)

    def carry(self, sender, machine):
        while True:
            ready, _, _ = select.select([sender, machine], [], [], 0.5)
            for source in ready:
                try:
                    data = source.recv(4096)
                except OSError:
                    data = b""
                if not data:
                    sender.close()
                    machine.close()
                    return
                if not self.silent:
                    (machine if source is sender else sender).sendall(data)

    def hang_up(self):
        self.pair[0].shutdown(socket.SHUT_RDWR)

    def close(self):
        self.listener.close()


class SilentPeer(LiveTest):
    def test_silence_is_said_and_nothing_goes_on_by_itself(self):
        with VirtualMachine("grblhal", speed="1") as machine:
            relay = Relay(machine.port)
            self.addCleanup(relay.close)
            with OnTerminal("console", "--machine", relay.url) as console:
                console.wait_for("Ctrl-D leaves|> ")
                relay.silent = True
                console.wait_for("has not answered for")
                console.press("G91G1X5F6000\r")
                console.wait_for("not answer")
                relay.hang_up()
                console.wait_for("Nothing goes on by itself")
                wait_until(lambda: console.read(0.1) or relay.connections == 2, what="the second connection")
                found = len(console.output)
                wait_until(lambda: console.read(0.2) or "grblHAL" in console.output[found - 200:], what="the handshake")
                console.press("?")
                # What was typed into the silence was refused, not kept.
                console.wait_for(r"<Idle\|MPos:0\.000,")
                console.press("\x04")
                console.wait()
        # A log with two openings is replayed as one with a single one.
        replayed = kerf("replay", "latest")
        self.assertIn("The same", replayed.stdout, replayed.stderr)
        kinds = [json.loads(line)["kind"] for line in kerf("log", "show", "latest", "--json").stdout.splitlines()]
        self.assertEqual(kinds.count("opened"), 2)
        self.assertEqual(kinds.count("closed"), 2)


class Reconnect(LiveTest):
    def setUp(self):
        super().setUp()
        self.cable = Cable(self.folder)

    def machine(self, *options, **places):
        machine = VirtualMachine("grblhal", *self.cable.options, *options, **places)
        self.addCleanup(machine.end)
        return machine

    def comes_back(self, url):
        with OnTerminal("console", "--machine", url) as console:
            console.wait_for("Ctrl-D leaves|> ")
            found = len(re.findall("grblHAL", console.output))
            console.press("G91G1X5F6000\r")
            console.wait_for("ok")
            self.cable.order("link cut")
            console.wait_for("Nothing goes on by itself")
            console.press("G1X100F6000\r")
            console.wait_for("No controller is connected")
            self.cable.order("link restore")
            wait_until(lambda: console.read(0.1) and len(re.findall("grblHAL", console.output)) > found,
                       what="the sentence of the second handshake")
            console.press("?")
            console.wait_for(r"<Idle\|MPos:5\.000,")
            console.press("\x04")
            console.wait()

    def test_an_idle_console_on_tcp(self):
        self.comes_back(self.machine().url)

    def test_an_idle_console_on_a_websocket(self):
        machine = self.machine("--listen", "ws://127.0.0.1:0", tcp=False)
        self.comes_back(re.search(r"ws://127\.0\.0\.1:\d+", machine.output)[0])

    def test_an_idle_console_on_a_terminal_that_vanishes(self):
        path = os.path.join(self.folder, "tty")
        self.machine(tcp=False, pty_path=path)
        self.comes_back("pty://" + path)

    def test_a_watcher_goes_on_watching(self):
        machine = self.machine()
        with Running("status", "--watch", "--machine", machine.url) as watch:
            watch.wait_for('"state":"Idle"')
            self.cable.order("link cut")
            self.cable.order("link restore")
            machine.wait_for("went away.[^$]*connected")
            with_link = len(watch.output)
            wait_until(lambda: watch.read(0.2) or '"state":"Idle"' in watch.output[with_link:], what="a new report")

    def test_a_machine_that_moves_is_watched_and_left_alone(self):
        machine = self.machine(speed="1")
        with OnTerminal("console", "--machine", machine.url) as console:
            console.wait_for("Ctrl-D leaves|> ")
            console.press("G91G1X40F600\r")  # 4 s
            console.wait_for("ok")
            self.cable.order("link cut")
            console.wait_for("Nothing goes on by itself")
            self.cable.order("link restore")
            console.wait_for("(?i)moving|running|busy|does something|in motion|under way")
            console.press("\x04")
            console.wait()
        with Wire(machine.port) as wire:
            def state():
                wire.send(b"?")
                return wire.line("<")
            # Neither held nor reset: it came where it was sent.
            self.assertIn("MPos:40.000,", wait_until(lambda: "<Idle" in state() and state(), what="Idle"))

    def test_a_job_is_over_when_its_link_is(self):
        machine = self.machine(speed="1")
        part = self.file("part.nc", "G91\n" + "G1X1F6000\n" * 800 + "M2\n")
        with Running("run", part, "--machine", machine.url) as run:
            time.sleep(2.5)
            self.cable.order("link cut")
            self.assertEqual(run.wait(), INTERRUPTED, run.output)
        self.cable.order("link restore")
        with Wire(machine.port) as wire:
            def state():
                wire.send(b"?")
                return wire.line("<")
            first = wait_until(lambda: "<Idle" in state() and state(), what="Idle")
            at = float(re.search(r"MPos:([\d.]+)", first)[1])
            self.assertLess(at, 800)
            time.sleep(1)
            self.assertEqual(state().split("|")[1], first.split("|")[1])


if __name__ == "__main__":
    unittest.main()
