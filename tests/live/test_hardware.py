"""What a virtual machine is built with: axes, tools, ports, slow memory, a pendant for scripts, a greeting."""

import os
import select
import socket
import tempfile
import unittest

from kerf_program import USAGE, LiveTest, VirtualMachine, kerf
from wires import Wire


class Hardware(LiveTest):
    def said(self, personality, options, *lines):
        """What the last of `lines` is answered, without its ok."""
        with VirtualMachine(personality, *options) as machine, Wire(machine.port) as wire:
            for line in lines:
                wire.send(line.encode() + b"\n")
                wire.quiet()
            wire.send(lines[-1].encode() + b"\n")
            return wire.quiet().decode()

    def test_axes_are_told_and_move(self):
        for personality, axes in (("rabbit", 5), ("grblhal", 8)):
            with VirtualMachine(personality, "--axes", str(axes)) as machine, Wire(machine.port) as wire:
                wire.send(b"?")
                position = wire.line("<").split("|")[1]
                self.assertEqual(position.count(","), axes - 1, position)
                wire.send(b"G91G1B1F1000\n")
                wire.line("ok")

    def test_tools_and_ports_are_told(self):
        told = self.said("grblhal", ["--tools", "16", "--ports", "4,3,2,1"], "$I+")
        self.assertIn("[AUX IO:4,3,2,1]", told)
        self.assertRegex(told, r"\[OPT:[^\]]*,16\]")
        told = self.said("grblhal", ["--tools", "2"], "$#")
        self.assertIn("[T:2|", told)

    def test_slow_memory_loses_bytes(self):
        with VirtualMachine("grbl", "--slow-memory", speed="1") as machine, Wire(machine.port) as wire:
            wire.quiet(1.5)  # the memory of a new board is written first
            wire.send(b"$RST=$\n")
            heard = wire.quiet(0.08)
            wire.send(b"G1X1F100\nG1X2\n")  # into a write of a quarter of a second
            self.assertEqual((heard + wire.quiet(1.0)).count(b"ok"), 1)

    def test_a_script_plays_a_pendant_without_a_place(self):
        script = self.file("pendant.script", "pendant take\nafter 100ms pendant say $J=G91X1F600\\n\n")
        with VirtualMachine("grblhal", "--pendant", "script", "--script", script) as machine, \
                Wire(machine.port) as wire:
            self.assertNotIn("pendant at", machine.output)
            wire.send(b"G21\n")
            self.assertNotIn(b"ok", wire.quiet(0.5))

    def test_a_network_client_is_greeted_on_request(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "tty")
            with VirtualMachine("grblhal", "--welcome-on-connect", pty_path=path) as machine:
                terminal = os.open(path, os.O_RDWR | os.O_NOCTTY)
                self.addCleanup(os.close, terminal)
                with Wire(machine.port) as wire:
                    self.assertTrue(wire.line("Grbl").startswith("GrblHAL 1.1f"))
                told = b""
                while b"TELNET STREAM ACTIVE" not in told:
                    self.assertTrue(select.select([terminal], [], [], 10)[0], told)
                    told += os.read(terminal, 4096)
        with VirtualMachine("grblhal") as machine, Wire(machine.port) as wire:
            self.assertEqual(wire.quiet(), b"")

    def test_two_wires_of_rabbit_write_into_one_line_and_both_hear_everything(self):
        path = os.path.join(self.folder, "tty")
        with VirtualMachine("rabbit", pty_path=path) as machine, Wire(machine.port) as wire:
            terminal = os.open(path, os.O_RDWR | os.O_NOCTTY)
            self.addCleanup(os.close, terminal)
            os.write(terminal, b"G2")
            wire.quiet(0.2)
            wire.send(b"1\nG9")
            wire.line("ok")
            os.write(terminal, b"9\n")
            wire.line("error:20")
            told = b""
            while b"error:20" not in told:
                self.assertTrue(select.select([terminal], [], [], 10)[0], told)
                told += os.read(terminal, 4096)

    def test_a_spindle_with_an_encoder(self):
        control = os.path.join(self.folder, "control")
        options = ["--spindle-encoder", "--control", f"unix:{control}"]
        with VirtualMachine("grblhal", *options) as machine, Wire(machine.port) as wire:
            wire.send(b"$I+\n")
            self.assertIn(",SS,", wire.line("[NEWOPT:"))
            wire.send(b"M3S600\nG95F0.5\nG91G1X5\n")
            with socket.socket(socket.AF_UNIX) as orders:
                orders.connect(control)
                lines = orders.makefile("rw")
                lines.write("spindle slow 0.5\n")
                lines.flush()
                self.assertEqual(lines.readline().strip(), "ok")
            wire.send(b"?")
            self.assertRegex(wire.line("<"), r"FS:\d+,600,300\|")

    def test_what_a_firmware_cannot_have_is_refused(self):
        for personality, options, words in (
                ("grbl", ["--axes", "4"], ["3 axes", "--axes", "rabbit, grblhal"]),
                ("grblhal", ["--axes", "9"], ["3 to 8 axes"]),
                ("rabbit", ["--axes", "2"], ["3 to 6 axes"]),
                ("rabbit", ["--tools", "5"], ["tool table", "--tools", "grblhal"]),
                ("grblhal", ["--tools", "99"], ["32 tools"]),
                ("grblhal", ["--tools", "0"], ["--tools"]),
                ("grbl", ["--ports", "1,1,0,0"], ["--ports", "grblhal"]),
                ("grblhal", ["--ports", "17,0,0,0"], ["16"]),
                ("grblhal", ["--ports", "4,4"], ["--ports 4,4,2,2"]),
                ("rabbit", ["--spindle-encoder"], ["--spindle-encoder", "grblhal"]),
                ("grblhal", ["--slow-memory"], ["--slow-memory", "grbl"]),
                ("rabbit", ["--welcome-on-connect"], ["--welcome-on-connect"])):
            with self.subTest(personality=personality, options=options):
                self.assert_complains(kerf("virtual", "-p", personality, "-l", "127.0.0.1:0", *options), USAGE, *words)


if __name__ == "__main__":
    unittest.main()
