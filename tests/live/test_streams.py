"""A folder as the SD card of `kerf virtual`, and a pendant beside the sender."""

import os
import re
import tempfile
import unittest

from kerf_program import USAGE, VirtualMachine, kerf, wait_until
import ymodem
from wires import Wire


def ask(wire):
    """A status report."""
    wire.send(b"?")
    return wire.line("<")


class Card(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def put(self, name, text):
        with open(os.path.join(self.folder.name, name), "w", encoding="ascii") as file:
            file.write(text)

    def machine(self, speed="max"):
        machine = VirtualMachine("grblhal", "--card", self.folder.name, speed=speed)
        self.addCleanup(machine.end)
        return machine

    def test_a_file_is_listed_and_run(self):
        self.put("part.nc", "G91\nG1X5F600\nM30\n")
        with Wire(self.machine().port) as wire:
            wire.send(b"$FM\n$F\n")
            wire.line("ok")
            self.assertEqual(wire.line("[FILE:"), "[FILE:/part.nc|SIZE:17]")
            wire.line("ok")
            wire.send(b"$F=part.nc\n")
            wire.line("ok")
            wire.line("[MSG:Pgm End]")
            wire.line("ok")
            wire.send(b"?")
            self.assertIn("MPos:5.000,", wire.line("<"))

    def test_files_put_there_later_are_seen(self):
        with Wire(self.machine().port) as wire:
            wire.send(b"$FM\n")
            wire.line("ok")
            self.put("late.nc", "G0X1\n")
            wire.send(b"$F\n")
            self.assertIn("late.nc", wire.line("[FILE:"))
            wire.send(b"$FD=late.nc\n")
            wire.line("ok")
            wire.line("ok")
        self.assertEqual(os.listdir(self.folder.name), [])

    def uploader(self):
        # A receiver whose clock jumps gives a block up before the rest of it can arrive.
        wire = Wire(self.machine(speed="1").port)
        self.addCleanup(wire.socket.close)
        wire.send(b"$FM\n")
        wire.line("ok")
        return wire

    def landed(self, name):
        with open(os.path.join(self.folder.name, name), "rb") as file:
            return file.read()

    def test_an_upload_lands_byte_for_byte(self):
        wire = self.uploader()
        # Realtime bytes, cancels and ends of text are data here.
        data = bytes(range(256)) * 37 + b"\x18\x18\x04?!~"
        for name, size in (("long.nc", 1024), ("short.nc", 128)):
            ymodem.upload(wire, name, data, size)
            self.assertEqual(self.landed(name), data)
        ymodem.upload(wire, "even.nc", b"G0X1\n" * 256)  # a whole number of blocks
        wire.send(b"$F\n")
        self.assertEqual(wire.line("[FILE:"), "[FILE:/even.nc|SIZE:1280]")
        wire.line("ok")
        wire.send(b"$F=even.nc\n")
        wire.line("ok")
        wire.line("[MSG:Pgm End]")

    def test_a_damaged_block_is_sent_again(self):
        wire = self.uploader()
        data = b"G0X1\n" * 60
        ymodem.deliver(wire, ymodem.block(0, b"part.nc\0" + b"300", 128), ymodem.ACK + b"C")
        for number, piece in ymodem.blocks_of(data, 128):
            good = ymodem.block(number, piece, 128)
            if number == 2:
                wire.send(good[:20] + b"\xff" + good[21:])
                self.assertEqual(wire.take(1), ymodem.NAK)
                wire.send(good[:3])  # a torn block
                self.assertEqual(wire.take(1), ymodem.NAK)
            ymodem.deliver(wire, good, ymodem.ACK)
        ymodem.deliver(wire, ymodem.EOT, ymodem.ACK + b"C")
        self.assertEqual(self.landed("part.nc"), data)

    def test_an_aborted_upload_leaves_what_came(self):
        wire = self.uploader()
        ymodem.deliver(wire, ymodem.block(0, b"part.nc\0" + b"1000", 128), ymodem.ACK + b"C")
        ymodem.deliver(wire, ymodem.block(1, b"x" * 128, 128), ymodem.ACK)
        wire.send(ymodem.CAN * 2)
        wire.send(b"?")
        self.assertIn("<Idle", wire.line("<"))
        self.assertEqual(self.landed("part.nc"), b"x" * 128)

    def test_an_upload_without_a_mounted_card_is_cancelled(self):
        wire = self.uploader()
        wire.send(b"$FU\n")
        wire.line("ok")
        with self.assertRaises(ymodem.Cancelled):
            ymodem.upload(wire, "part.nc", b"G0X1\n")

    def test_only_grblhal_has_a_card(self):
        for options in (["--card", self.folder.name], ["--pendant", "tcp://127.0.0.1:0"]):
            result = kerf("virtual", "--personality", "grbl", "--listen", "tcp://127.0.0.1:0", *options)
            self.assertEqual(result.returncode, USAGE)
            self.assertIn("grblhal", result.stderr)

    def test_a_missing_folder_is_named(self):
        result = kerf("virtual", "--listen", "tcp://127.0.0.1:0", "--card", "/nonexistent-card")
        self.assertEqual(result.returncode, USAGE)
        self.assertIn("/nonexistent-card", result.stderr)


class Pendant(unittest.TestCase):
    def test_command_goes_to_the_pendant_and_back(self):
        with VirtualMachine("grblhal", "--pendant", "tcp://127.0.0.1:0") as machine:
            pendant_port = int(re.search(r"pendant at tcp://127\.0\.0\.1:(\d+)", machine.output)[1])
            with Wire(machine.port) as sender, Wire(pendant_port) as pendant:
                pendant.send(b"\x8b")
                self.assertIn("|MPG:1|", pendant.line("<"))
                self.assertIn("|MPG:1|", sender.line("<"))
                sender.send(b"G0X9\n?")
                self.assertEqual(sender.quiet(), b"")
                pendant.send(b"$J=G91X1F600\n")
                pendant.line("ok")
                pendant.send(b"\x8b")
                self.assertIn("|MPG:0", sender.line("<"))
                wait_until(lambda: "MPos:1.000," in ask(sender), what="the jog's end")
                sender.send(b"G4P0\n")
                sender.line("ok")

    def test_a_pendant_on_a_terminal(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "pendant")
            with VirtualMachine("grblhal", "--pendant", "pty://" + path) as machine, Wire(machine.port) as sender:
                terminal = os.open(path, os.O_RDWR | os.O_NOCTTY)
                self.addCleanup(os.close, terminal)
                os.write(terminal, b"\x8b")
                self.assertIn("|MPG:1|", sender.line("<"))


if __name__ == "__main__":
    unittest.main()
