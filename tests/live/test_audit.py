"""`kerf audit` on machines that lost steps, and on those that did not."""

import concurrent.futures
import json
import os
import socket
import unittest

from kerf_program import (ALARM, DONE, INTERRUPTED, PERSONALITIES, REFUSED, USAGE, LiveTest, OnTerminal,
                          VirtualMachine, kerf)

SETTINGS = ("$22=1", "$20=1", "$21=1", "$24=100", "$25=5000", "$26=10", "$27=1", "$100=250", "$101=250", "$102=250",
            "$110=10000", "$111=10000", "$112=10000", "$120=1000", "$121=1000", "$122=1000", "$130=30", "$131=30",
            "$132=30")


class Audits(LiveTest):
    def machine(self, personality):
        settings = self.file(personality + ".txt", "\n".join(SETTINGS) + "\n")
        return VirtualMachine(personality, "--settings", settings, "--control", "unix:" + self.control(personality))

    def control(self, personality):
        return os.path.join(self.folder, "control-" + personality)

    def order(self, personality, line):
        with socket.socket(socket.AF_UNIX) as control:
            control.connect(self.control(personality))
            control.sendall(line.encode() + b"\n")
            self.assertEqual(control.recv(100), b"ok\n")

    def home(self, machine):
        result = kerf("console", "--machine", machine.url, text="$H\nG4P0.1\n")
        self.assertEqual(result.returncode, DONE, result.stdout + result.stderr)

    def journal(self, personality):
        return "--journal", os.path.join(self.folder, "journal-" + personality)

    def guards(self, machine):
        result = kerf("settings", "get", "20", "21", "--machine", machine.url)
        self.assertEqual(result.returncode, DONE, result.stdout + result.stderr)
        return result.stdout

    def test_lost_steps_are_found_and_kept(self):
        with concurrent.futures.ThreadPoolExecutor() as pool:
            for _ in pool.map(self.lose_and_find, PERSONALITIES):
                pass

    def lose_and_find(self, personality):
        journal = self.journal(personality)
        with self.machine(personality) as machine:
            self.home(machine)
            self.order(personality, "lose X 40")
            before = self.guards(machine)
            audit = ("audit", "--machine", machine.url, *journal)
            result = kerf(*audit, "--yes", timeout=120)
            self.assertEqual(result.returncode, ALARM, result.stdout + result.stderr)
            self.assertIn("X stood 0.160 mm (40 steps) farther towards minus than it believed.", result.stdout)
            self.assertIn("Y was where it believed to be, to the step.", result.stdout)
            self.assertEqual(self.guards(machine), before, personality)

            again = kerf(*audit, "--yes", "--json", timeout=120)
            self.assertEqual(again.returncode, DONE, again.stdout + again.stderr)
            told = json.loads(again.stdout)
            self.assertEqual((told["outcome"], [axis["difference_steps"] for axis in told["axes"]]),
                             ("Kept", [0, 0, 0]), personality)

            history = json.loads(kerf("audit", "--history", "--json", *journal).stdout)
            self.assertEqual([row["result"]["outcome"] for row in history], ["Kept", "Shifted"])
            self.assertEqual([row["machine"] for row in history], [machine.url, machine.url])
            self.assertIn("X stood 0.160 mm", kerf("audit", "--history", *journal).stdout)

    def test_nothing_moves_unasked(self):
        with self.machine("grbl") as machine:
            self.home(machine)
            audit = ("audit", "--machine", machine.url, *self.journal("grbl"))
            self.assert_complains(kerf(*audit), USAGE, "--yes")
            with OnTerminal(*audit) as terminal:
                terminal.wait_for(r"\$20, \$21")
                terminal.wait_for(r"Begin\? \[y/N\] ")
                terminal.press("n")
                self.assertEqual(terminal.wait(), INTERRUPTED)
            self.assertEqual(json.loads(kerf("audit", "--history", "--json", *self.journal("grbl")).stdout), [])

    def test_what_cannot_be_measured_is_refused(self):
        self.assert_complains(kerf("audit", "--yes", "--machine", "virtual:grbl"), REFUSED, "$22=0")
        with self.machine("grblhal") as machine:
            self.assert_complains(kerf("audit", "--yes", "--machine", machine.url), REFUSED, "$H")


if __name__ == "__main__":
    unittest.main()
