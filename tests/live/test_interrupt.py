"""What Ctrl-C does, with and without a terminal."""

import signal
import time
import unittest

from kerf_program import DONE, INTERRUPTED, LiveTest, OnTerminal, Running, VirtualMachine, kerf


class Interrupt(LiveTest):
    def setUp(self):
        super().setUp()
        self.long_job = self.file("long.nc", "G21 G91\n" + "G1 X5 F300\nG1 X-5\n" * 200)

    def test_without_a_terminal_the_second_one_stops(self):
        with VirtualMachine("grblhal", speed="1") as machine:
            with Running("run", self.long_job, "--machine", machine.url) as run:
                run.wait_for(r"line [1-9]\d*/401")
                run.signal(signal.SIGINT)
                run.wait_for(r"Held at line \d+")
                self.assertIsNone(run.process.poll())
                run.signal(signal.SIGINT)
                self.assertEqual(run.wait(), INTERRUPTED)
                self.assertIn("stopped", run.errors())
            after = kerf("info", "--machine", machine.url)
            self.assertEqual(after.returncode, DONE, after.stderr)

    def test_termination_stops_the_machine_first(self):
        with VirtualMachine("grbl", speed="1") as machine:
            with Running("run", self.long_job, "--machine", machine.url) as run:
                run.wait_for(r"line [1-9]\d*/401")
                run.signal(signal.SIGTERM)
                self.assertEqual(run.wait(), INTERRUPTED)

    def test_on_a_terminal_it_asks_and_goes_on(self):
        short_job = self.file("short.nc", "G21 G91\n" + "G1 X1 F300\nG1 X-1\n" * 10)
        with OnTerminal("run", short_job, "--machine", "virtual:grblhal") as terminal:
            terminal.wait_for(r"Run  F")
            terminal.press("\x03")
            terminal.wait_for(r"\[c\]ontinue or \[s\]top\?")
            terminal.press("c")
            terminal.wait_for(r"Going on")
            self.assertEqual(terminal.wait(), DONE)

    def test_on_a_terminal_it_asks_and_stops(self):
        for keys in (["\x03", "s"], [" ", "s"], ["\x03", "\x03"]):
            with self.subTest(keys), OnTerminal("run", self.long_job, "--machine", "virtual:grblhal") as terminal:
                terminal.wait_for(r"Run  F")
                terminal.press(keys[0])
                terminal.wait_for(r"\[c\]ontinue or \[s\]top\?")
                terminal.press(keys[1])
                self.assertEqual(terminal.wait(), INTERRUPTED)
                self.assertIn("position is kept", terminal.output)

    def test_lost_link(self):
        with VirtualMachine("grblhal", speed="1") as machine:
            with Running("run", self.long_job, "--machine", machine.url) as run:
                run.wait_for(r"line [1-9]\d*/401")
                time.sleep(0.2)
                machine.end()
                self.assertEqual(run.wait(), INTERRUPTED)
                self.assertIn("link", run.errors())


if __name__ == "__main__":
    unittest.main()
