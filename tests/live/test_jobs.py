"""A G-code file goes from disk through a real port to a virtual controller of every kind and is cut."""

import json
import os
import subprocess
import unittest

from kerf_program import DONE, KERF, PERSONALITIES, REFUSED, LiveTest, OnTerminal, VirtualMachine, example, kerf


class Jobs(LiveTest):
    def test_over_tcp(self):
        for personality in PERSONALITIES:
            with self.subTest(personality), VirtualMachine(personality) as machine:
                result = kerf("run", example("coaster.nc"), "--machine", machine.url)
                self.assertEqual(result.returncode, DONE, result.stdout + result.stderr)
                self.assertIn("100 %", result.stdout)
                self.assertRegex(result.stdout, r"\nDone: ")
                self.assertEqual(result.stderr, "")

    def test_over_a_pty(self):
        for personality in PERSONALITIES:
            path = os.path.join(self.folder, personality)
            with self.subTest(personality), VirtualMachine(personality, tcp=False, pty_path=path):
                self.assertTrue(os.path.islink(path))
                result = kerf("run", example("facing.nc"), "--machine", "pty://" + path)
                self.assertEqual(result.returncode, DONE, result.stdout + result.stderr)
            self.assertFalse(os.path.lexists(path))

    def test_over_a_serial_line_at_an_odd_rate(self):
        path = os.path.join(self.folder, "machine")
        with VirtualMachine("grbl", tcp=False, pty_path=path):
            result = kerf("run", example("laser_label.nc"), "--machine", f"serial://{path}?baud=250000")
            self.assertEqual(result.returncode, DONE, result.stdout + result.stderr)

    def test_nobody_reads_the_log(self):
        with subprocess.Popen([KERF, "run", example("facing.nc"), "--machine", "virtual:grbl?speed=max"],
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE) as run:
            run.stdout.close()
            self.assertEqual(run.wait(60), DONE, run.stderr.read())

    def test_inside_the_process(self):
        for personality in PERSONALITIES:
            with self.subTest(personality):
                result = kerf("run", example("laser_label.nc"), "--machine", f"virtual:{personality}?speed=max")
                self.assertEqual(result.returncode, DONE, result.stdout + result.stderr)

    def test_twice_on_one_machine(self):
        with VirtualMachine("grblhal") as machine:
            for _ in range(2):
                result = kerf("run", example("facing.nc"), "--machine", machine.url)
                self.assertEqual(result.returncode, DONE, result.stdout + result.stderr)

    def test_events_as_json(self):
        result = kerf("run", example("facing.nc"), "--machine", "virtual:grbl?speed=max", "--json")
        self.assertEqual(result.returncode, DONE, result.stdout + result.stderr)
        events = [json.loads(line) for line in result.stdout.splitlines()]
        names = [event["event"] for event in events]
        self.assertEqual(names[-1], "ended")
        self.assertLess(names.index("found"), names.index("started"))
        self.assertLess(names.index("started"), names.index("progress"))
        self.assertEqual(events[-1]["outcome"], "Finished")
        self.assertEqual(events[-1]["exit_status"], DONE)
        last = [event for event in events if event["event"] == "progress"][-1]
        self.assertEqual(last["percent"], 100)
        for key in ("file_line", "lines_total", "elapsed_s", "state", "machine_position_mm"):
            self.assertIn(key, last)

    def test_refused_line_is_named(self):
        program = self.file("bad.nc", "G21\nG0 X1\nM77 X5\nG0 X2\n")
        for personality in PERSONALITIES:
            with self.subTest(personality):
                anyway = ("run", program, "--machine", f"virtual:{personality}?speed=max", "--despite-errors")
                result = kerf(*anyway)
                self.assert_complains(result, REFUSED, "bad.nc", "line 3", "M77X5", "error 20")
                events = kerf(*anyway, "--json").stdout
                refusal = json.loads(events.splitlines()[-1])["refusal"]
                self.assertEqual((refusal["file_line"], refusal["code"]), (3, 20))
                self.assertTrue(refusal["meaning"])

    def test_the_check_comes_first(self):
        program = self.file("bad.nc", "G21 G90\nG0 X1\nM77 X5\nG0 X2\n")
        for personality in PERSONALITIES:
            with self.subTest(personality):
                run = ("run", program, "--machine", f"virtual:{personality}?speed=max")
                result = kerf(*run)
                self.assert_complains(result, REFUSED, "bad.nc was not started", "line 3", "--despite-errors")
                self.assertIn("line 3: M77 X5", result.stdout)
                self.assertNotIn("Cutting", result.stdout)
                events = [json.loads(line) for line in kerf(*run, "--json").stdout.splitlines()]
                checked = [event["check"] for event in events if event["event"] == "checked"]
                self.assertEqual([(f["line"], f["code"]) for f in checked[0]["findings"]], [(3, "error:20")])
                self.assertEqual(events[-1]["exit_status"], REFUSED)

    def test_warnings_do_not_stop_a_job(self):
        program = self.file("fast.nc", "G21 G90\nM3 S500\nG0 Z1\nG1 X1 F90000\nM5\n")
        result = kerf("run", program, "--machine", "virtual:grbl?speed=max")
        self.assertEqual(result.returncode, DONE, result.stderr)
        self.assertIn("warning, line 4: The feed is higher than the machine goes.", result.stdout)

    def test_bar_on_a_terminal(self):
        with OnTerminal("run", example("facing.nc"), "--machine", "virtual:grblhal?speed=50") as terminal:
            terminal.wait_for(r"\d+ %  line \d+/\d+  \d:\d\d gone, .* left")
            self.assertEqual(terminal.wait(), DONE)
            self.assertRegex(terminal.output, r"█+  100 %")
            self.assertRegex(terminal.output, r"Done: ")


if __name__ == "__main__":
    unittest.main()
