"""A job is cut off by kill -9, found again, and finished: planned, homed, rehearsed, asked for, and run."""

import json
import os
import random
import re
import signal
import time
import unittest

from kerf_program import DONE, INTERRUPTED, PERSONALITIES, USAGE, LiveTest, OnTerminal, Running, VirtualMachine, kerf

# Homing on, quick axes, and a work zero inside the travel.
SETTINGS = ("$22=1", "$27=1", "$110=6000", "$111=6000", "$112=6000", "$120=500", "$121=500", "$122=500",
            "$24=1000", "$25=3000")
ROWS = 60


def milling(rows=ROWS):
    """Each line goes to a place of its own."""
    lines = ["G21 G90 G17 G54", "M3 S1000", "G0 Z5", "G0 X2 Y2", "G1 Z-1 F500"]
    for row in range(rows):
        far = 40 if row % 2 == 0 else 2
        lines += [f"G1 X{far} F2500", f"G1 Y{2 + (row + 1) * 0.5:g}"]
    return "\n".join(lines + ["G0 Z5", "M5", "M30"]) + "\n"


class Resumes(LiveTest):
    def machine(self, personality, **options):
        settings = self.file("settings.txt", "\n".join(SETTINGS) + "\n")
        return VirtualMachine(personality, "--settings", settings, speed="12", **options)

    def prepare(self, machine):
        """Homed, with a work zero in the middle of the table."""
        result = kerf("console", "--machine", machine.url, text="$H\nG10 L2 P1 X-120 Y-120 Z-30\n:status\n")
        self.assertEqual(result.returncode, DONE, result.stdout + result.stderr)

    def cut_off(self, arguments, at_line):
        """Runs until the machine is seen at that line, then kill -9. Gives the last line that was shown."""
        with Running(*arguments, "--json") as job:
            line = 0
            while line < at_line:
                found = job.wait_for(r'"file_line":(\d+).*?\n')
                line = int(found[1])
                job.output = job.output[found.end():]
            time.sleep(random.random() * 0.1)
            job.signal(signal.SIGKILL)
            job.wait()
        return line

    def listed(self):
        result = kerf("resume", "--list", "--json")
        self.assertEqual(result.returncode, DONE, result.stderr)
        return json.loads(result.stdout)

    def events(self, *arguments):
        result = kerf(*arguments, "--json")
        return result, [json.loads(line) for line in result.stdout.splitlines()]

    def test_a_killed_job_is_finished(self):
        program = self.file("part.nc", milling())
        lines = len(milling().splitlines())
        for personality in PERSONALITIES:
            with self.subTest(personality), self.machine(personality) as machine:
                self.prepare(machine)
                killed_at = self.cut_off(("run", program, "--machine", machine.url), 40)
                job = self.listed()[0]
                self.assertEqual((job["path"], job["file"], job["lines"]), (program, "Same", lines))
                text = kerf("resume", "--list").stdout
                self.assertIn(f"{job['number']}  {program}", text)
                self.assertIn("Kerf was killed", text)

                plan, shown = self.events("resume", "--dry-run")
                self.assertEqual(plan.returncode, DONE, plan.stdout + plan.stderr)
                self.assertEqual([event["event"] for event in shown][-2:], ["found", "plan"])
                self.assertLessEqual(shown[-1]["plan"]["from_line"], killed_at)
                self.assertTrue(shown[-1]["plan"]["steps"])
                self.assertEqual(len(self.listed()), 1)

                # A resume that is cut off, too, goes on.
                again_at = self.cut_off(("resume", "--yes", "--trial"), killed_at + 20)
                second = self.listed()[0]
                self.assertEqual(len(self.listed()), 1)
                self.assertGreaterEqual(second["line_sent"], again_at)

                result = kerf("resume", "--yes", "--trial")
                self.assertEqual(result.returncode, DONE, result.stdout + result.stderr)
                self.assertIn("Homes first", result.stdout)
                self.assertIn("Done: ", result.stdout)
                self.assertEqual(self.listed(), [])
                self.assert_complains(kerf("resume"), USAGE, "ran to its end", "kerf resume --list")
                self.assert_complains(kerf("resume", str(job["number"])), USAGE, f"as job {second['number']}")

    def test_the_questions_on_a_terminal(self):
        program = self.file("part.nc", milling())
        with self.machine("grblhal") as machine:
            self.prepare(machine)
            self.cut_off(("run", program, "--machine", machine.url), 30)
            with OnTerminal("resume", "--trial") as terminal:
                terminal.wait_for(r"Home now\? \[y/N\]")
                terminal.press("n")
                self.assertEqual(terminal.wait(), INTERRUPTED)
                self.assertIn("no line was sent", terminal.output)
            with OnTerminal("resume", "--trial") as terminal:
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
            self.prepare(machine)
            self.cut_off(("run", program, "--machine", machine.url), 30)
            number = str(self.listed()[0]["number"])
            self.assert_complains(kerf("resume", "99"), USAGE, "no job 99", "--list")
            self.assert_complains(kerf("resume", "--from-line", "9999"), USAGE, "no line 9999", "part.nc")
            self.assert_complains(kerf("resume", number, "--yes"), USAGE, "on trial")
            result = kerf("resume", "--trial", "--machine", machine.url)
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
        with self.machine("grblhal") as machine:
            self.prepare(machine)
            self.cut_off(("run", program, "--machine", machine.url), 30)
            # The switches are read the wrong way round.
            kerf("console", "--machine", machine.url, text="$5=7\n")
            result = kerf("resume", "--yes", "--trial", timeout=60)
            self.assertEqual(result.returncode, USAGE, result.stdout + result.stderr)
            self.assertIn("No line of the job was sent", result.stderr)

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
