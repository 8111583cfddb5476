"""A job is cut off by kill -9, found again, and finished: planned, homed, rehearsed, asked for, and run."""

import concurrent.futures
import json
import os
import random
import re
import signal
import socket
import time
import unittest

from kerf_program import DONE, INTERRUPTED, PERSONALITIES, USAGE, LiveTest, OnTerminal, Running, VirtualMachine, kerf

# Homing on, a small quick machine.
SETTINGS = ("$22=1", "$24=3000", "$25=10000", "$26=10", "$27=1", "$110=10000", "$111=10000", "$112=10000", "$120=2000",
            "$121=2000", "$122=2000", "$130=60", "$131=60", "$132=60")
# The operator knows that this spindle is quick.
GO = ("--yes", "--spin-up", "0.1")


def milling(rows=20):
    """Each line goes to a place of its own."""
    lines = ["G21 G90 G17 G54", "M3 S1000", "G0 Z5", "G0 X2 Y2", "G1 Z-1 F2000"]
    for row in range(rows):
        far = 20 if row % 2 == 0 else 2
        lines += [f"G1 X{far} F9000", f"G1 Y{2 + (row + 1) * 0.5:g}"]
    return "\n".join(lines + ["G0 Z5", "M5", "M30"]) + "\n"


class Resumes(LiveTest):
    def machine(self, personality, *options):
        settings = self.file(personality + ".txt", "\n".join(SETTINGS) + "\n")
        return VirtualMachine(personality, "--settings", settings, *options, speed="1")

    def prepare(self, machine, personality):
        """Homed, with a work zero inside the travel, which on Rabbit is above zero."""
        inside = 5 if personality == "rabbit" else -45
        result = kerf("console", "--machine", machine.url, text=f"$H\nG10 L2 P1 X{inside} Y{inside} Z-20\n")
        self.assertEqual(result.returncode, DONE, result.stdout + result.stderr)

    def cut_off(self, arguments, at_line):
        """Runs until the machine is seen at that line, then kill -9. Gives the last line that was shown."""
        with Running(*arguments, "--json") as job:
            line = 0
            while line < at_line:
                found = job.wait_for(r'"executing":{"from":(\d+).*?\n')
                line = int(found[1])
                job.output = job.output[found.end():]
            time.sleep(random.random() * 0.1)
            job.signal(signal.SIGKILL)
            job.wait()
        return line

    def listed(self, *arguments):
        result = kerf("resume", "--list", "--json", *arguments)
        self.assertEqual(result.returncode, DONE, result.stderr)
        return json.loads(result.stdout)

    def test_a_killed_job_is_finished(self):
        with concurrent.futures.ThreadPoolExecutor() as pool:  # they wait for their machines most of the time
            for _ in pool.map(self.kill_and_finish, PERSONALITIES):
                pass

    def kill_and_finish(self, personality):
        program = self.file(personality + ".nc", milling())
        journal = ("--journal", os.path.join(self.folder, personality))
        with self.machine(personality) as machine:
            self.prepare(machine, personality)
            killed_at = self.cut_off(("run", program, "--machine", machine.url, *journal), 12)
            job, = self.listed(*journal)
            lines = len(milling().splitlines())
            self.assertEqual((job["path"], job["file"], job["lines"]), (program, "Same", lines), personality)
            text = kerf("resume", "--list", *journal).stdout
            self.assertIn(f"{job['number']}  {program}", text)
            self.assertIn("Kerf was killed", text)

            plan = kerf("resume", "--dry-run", "--json", *journal)
            self.assertEqual(plan.returncode, DONE, plan.stdout + plan.stderr)
            shown = [json.loads(line) for line in plan.stdout.splitlines()]
            self.assertEqual([event["event"] for event in shown][-2:], ["found", "plan"])
            self.assertLessEqual(shown[-1]["plan"]["from_line"], killed_at + 2)
            self.assertTrue(shown[-1]["plan"]["steps"], personality)
            self.assertEqual(len(self.listed(*journal)), 1)

            # A resume that is cut off, too, goes on.
            again_at = self.cut_off(("resume", *GO, *journal), killed_at + 8)
            second, = self.listed(*journal)
            self.assertGreaterEqual(second["line_sent"], again_at)

            result = kerf("resume", *GO, *journal)
            self.assertEqual(result.returncode, DONE, result.stdout + result.stderr)
            self.assertIn("The machine is homed", result.stdout)
            self.assertIn("Done: ", result.stdout)
            self.assertEqual(self.listed(*journal), [])
            self.assert_complains(kerf("resume", *journal), USAGE, "ran to its end", "kerf resume --list")
            again = kerf("resume", str(job["number"]), *journal)
            self.assert_complains(again, USAGE, f"as job {second['number']}")

    def test_the_questions_on_a_terminal(self):
        program = self.file("part.nc", milling())
        with self.machine("grblhal") as machine:
            self.prepare(machine, "grblhal")
            self.cut_off(("run", program, "--machine", machine.url), 15)
            with OnTerminal("resume", "--spin-up", "0.1") as terminal:
                terminal.wait_for(r"Home now\? \[y/N\]")
                terminal.press("n")
                self.assertEqual(terminal.wait(), INTERRUPTED)
                self.assertIn("no line was sent", terminal.output)
            with OnTerminal("resume", "--spin-up", "0.1") as terminal:
                terminal.wait_for(r"Home now\? \[y/N\]")
                terminal.press("y")
                terminal.wait_for(r"Go on\? \[y/N\]")
                self.assertRegex(terminal.output, r"1\. ")
                terminal.press("y")
                terminal.wait_for(r"\d+ %  line \d+/\d+  \d:\d\d gone, \d+:\d\d left")
                self.assertEqual(terminal.wait(), DONE)
                self.assertIn("Done: ", terminal.output)

    def test_what_cannot_be_resumed_is_said_before_anything_moves(self):
        program = self.file("part.nc", milling())
        self.assert_complains(kerf("resume"), USAGE, "nothing to resume")
        with self.machine("grbl") as machine:
            self.prepare(machine, "grbl")
            self.cut_off(("run", program, "--machine", machine.url), 15)
            self.assert_complains(kerf("resume", "99"), USAGE, "no job 99", "--list")
            self.assert_complains(kerf("resume", "--from-line", "9999"), USAGE, "no line 9999", "part.nc")
            result = kerf("resume", "--machine", machine.url)
            self.assert_complains(result, USAGE, "terminal", "--yes")
            with self.machine("grblhal") as other:
                result = kerf("resume", "--dry-run", "--machine", other.url)
                self.assert_complains(result, USAGE, "machine", "grblHAL", "Grbl")
            self.file("part.nc", milling(3))
            self.assert_complains(kerf("resume", "--dry-run"), USAGE, "content has changed", "--from-line")
            self.assertEqual(self.listed()[0]["file"], "Changed")
            os.remove(program)
            self.assert_complains(kerf("resume", "--dry-run"), USAGE, "part.nc", "--file")
            moved = self.file("moved.nc", milling())
            result = kerf("resume", "--dry-run", "--file", moved)
            self.assertEqual(result.returncode, DONE, result.stdout + result.stderr)
            self.assertRegex(result.stdout, r"Goes on from line \d+")

    def test_a_machine_that_does_not_home_is_not_waited_for(self):
        program = self.file("part.nc", milling())
        control = os.path.join(self.folder, "control")
        with self.machine("grblhal", "--control", "unix:" + control) as machine:
            self.prepare(machine, "grblhal")
            self.cut_off(("run", program, "--machine", machine.url), 15)
            with socket.socket(socket.AF_UNIX) as link:
                link.connect(control)
                link.sendall(b"limit X on\n")
                self.assertEqual(link.recv(100).strip(), b"ok")
            result = kerf("resume", *GO)
            self.assertNotEqual(result.returncode, DONE, result.stdout + result.stderr)
            self.assertIn("resume again", result.stderr)

    def test_from_line(self):
        program = self.file("part.nc", milling(10))
        url = "virtual:grblhal?speed=max"
        result = kerf("run", program, "--machine", url, "--from-line", "12", "--yes", "--position-is-right")
        self.assertEqual(result.returncode, DONE, result.stdout + result.stderr)
        self.assertIn("Goes on from line 12", result.stdout)
        self.assertTrue(re.search(r"Done: ", result.stdout))
        self.assert_complains(kerf("run", program, "--machine", url, "--from-line", "99"), USAGE, "no line 99")


if __name__ == "__main__":
    unittest.main()
