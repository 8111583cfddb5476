"""Jobs are written down as they run: what is found after a kill -9, on a full disk, and in damaged files."""

import json
import os
import random
import re
import resource
import signal
import subprocess
import time
import unittest

from kerf_program import DONE, KERF, PERSONALITIES, LiveTest, Running, VirtualMachine, example, kerf


def zigzag(rows):
    """Rows of 40 mm, each about a second long."""
    text = "G21 G90 G94\nM3 S1000\nG1 F2400\n"
    for row in range(rows):
        text += "G1 X%d\nY%d\n" % (40 * ((row + 1) % 2), row + 1)
    return text + "M5\nM30\n"


class Journal(LiveTest):
    def setUp(self):
        super().setUp()
        self.journal = os.path.join(self.folder, "journal")

    def interrupted(self):
        result = kerf("resume", "--list", "--json", "--journal", self.journal)
        self.assertEqual(result.returncode, DONE, result.stderr)
        return json.loads(result.stdout)

    def run_and_kill(self, machine, program, after_s):
        """Kills a job in its middle; the line that it showed half a second before."""
        shown = []
        with Running("run", program, "--machine", machine.url, "--journal", self.journal, "--json") as job:
            job.wait_for('"event":"progress"')
            end = time.monotonic() + after_s
            while time.monotonic() < end:
                found = job.wait_for(r'"event":"progress"[^\n]*"file_line":(\d+)[^\n]*\n')
                shown.append((time.monotonic(), int(found[1])))
                job.output = job.output[found.end():]
            killed_at = time.monotonic()
            job.signal(signal.SIGKILL)
            job.wait()
        return max([line for at, line in shown if at < killed_at - 0.5], default=0)

    def test_a_killed_job_is_found(self):
        program = self.file("part.nc", zigzag(200))
        for personality in PERSONALITIES:
            with self.subTest(personality), VirtualMachine(personality, speed="4") as machine:
                shown = self.run_and_kill(machine, program, 1 + random.random())
                jobs = self.interrupted()
                job = jobs[0]
                self.assertEqual(job["path"], program)
                self.assertEqual(job["machine"], machine.url)
                self.assertEqual(job["outcome"], "CutOff")
                self.assertEqual(job["file"], "Same")
                self.assertEqual(job["lines"], 405)
                # 50 ms are the promise; a busy computer gets more.
                self.assertGreaterEqual(job["line_acknowledged"], shown)
                self.assertGreater(shown, 5)
                self.assertGreaterEqual(job["line_sent"], job["line_acknowledged"])
                self.assertEqual(job["damaged_records"], 0)
        self.assertEqual(len(self.interrupted()), len(PERSONALITIES))
        shown = kerf("resume", "--list", "--journal", self.journal)
        self.assertIn("Kerf was killed", shown.stdout)
        self.file("part.nc", "G0X1\n")
        self.assertEqual({job["file"] for job in self.interrupted()}, {"Changed"})
        os.remove(program)
        self.assertEqual({job["file"] for job in self.interrupted()}, {"Missing"})

    def test_a_complete_job_and_a_running_one_are_not_interrupted(self):
        with VirtualMachine("grblhal") as machine:
            result = kerf("run", example("facing.nc"), "--machine", machine.url, "--journal", self.journal)
            self.assertEqual(result.returncode, DONE, result.stderr)
        self.assertEqual(self.interrupted(), [])
        self.assertIn("No job was interrupted", kerf("resume", "--list", "--journal", self.journal).stdout)
        program = self.file("part.nc", zigzag(200))
        with VirtualMachine("grbl", speed="1") as machine:
            with Running("run", program, "--machine", machine.url, "--journal", self.journal, "--json") as job:
                job.wait_for(r'"event":"progress"')
                self.assertEqual(self.interrupted(), [])
                job.signal(signal.SIGTERM)
                job.wait()
            stopped = self.interrupted()
            self.assertEqual([job["outcome"] for job in stopped], ["Unfinished"])
            self.assertIn("stopped", stopped[0]["why"])

    def test_no_journal(self):
        with VirtualMachine("grblhal") as machine:
            kerf("run", example("facing.nc"), "--machine", machine.url, "--no-journal")
        self.assertFalse(os.path.exists(self.journal))

    def test_a_full_disk_is_said_once_and_the_job_goes_on(self):
        os.makedirs(self.journal)

        def small_files():
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
            resource.setrlimit(resource.RLIMIT_FSIZE, (20000, 20000))

        with VirtualMachine("grblhal") as machine:
            result = subprocess.run(
                [KERF, "run", example("coaster.nc"), "--machine", machine.url, "--journal", self.journal,
                 "--no-record"], capture_output=True, text=True, timeout=120, preexec_fn=small_files)
        self.assertEqual(result.returncode, DONE, result.stdout + result.stderr)
        self.assertEqual(len(re.findall("The job is not written down", result.stdout)), 1, result.stdout)
        self.assertIn("Done: ", result.stdout)

    def test_a_damaged_journal_does_not_keep_anybody_from_working(self):
        program = self.file("part.nc", zigzag(200))
        short = self.file("short.nc", "G21\nG0 X1\nG0 X0\n")
        database = os.path.join(self.journal, "journal.db")
        seed = random.randrange(1 << 32)
        chance = random.Random(seed)
        for _ in range(6):
            with self.subTest(seed=seed), VirtualMachine("grblhal", speed="2") as machine:
                self.run_and_kill(machine, program, 0.5)
                self.assertTrue(self.interrupted())
                for path in (database, database + "-wal"):
                    if os.path.exists(path) and chance.random() < 0.7:
                        self.damage(path, chance)
                result = kerf("run", short, "--machine", "virtual:grblhal?speed=max", "--journal", self.journal)
                self.assertEqual(result.returncode, DONE, result.stdout + result.stderr)
                self.interrupted()

    @staticmethod
    def damage(path, chance):
        with open(path, "r+b") as file:
            size = os.path.getsize(path)
            if chance.random() < 0.5:
                file.truncate(chance.randrange(size + 1))
                return
            for _ in range(chance.randrange(1, 200)):
                file.seek(chance.randrange(max(1, size)))
                file.write(bytes([chance.randrange(256)]))


if __name__ == "__main__":
    unittest.main()
