"""What `kerf` writes down about its connections, shows and repeats."""

import json
import os
import resource
import signal
import subprocess
import unittest

from kerf_program import (DONE, KERF, PERSONALITIES, REFUSED, USAGE, LiveTest, Running, VirtualMachine, example, kerf,
                          wait_until)


def entries(*arguments):
    shown = kerf("log", "show", *arguments, "--json")
    assert shown.returncode == DONE, shown.stderr
    return [json.loads(line) for line in shown.stdout.splitlines()]


class Recording(LiveTest):
    def test_every_connection_is_recorded_and_replayed(self):
        for personality in PERSONALITIES:
            with self.subTest(personality):
                part = self.file("part.nc", "G21\nG0X1\nG1X2F500\nM30\n")
                self.assertEqual(kerf("run", part, "--machine", f"virtual:{personality}?speed=max").returncode, DONE)
                result = json.loads(kerf("replay", "latest", "--json").stdout)
                self.assertTrue(result["same"])
                self.assertEqual(result["tally"]["commands"], 1)
                sent = [entry["text"] for entry in entries("--direction", "sent", "--kind", "line")]
                self.assertIn("G1X2F500", sent)
        listed = json.loads(kerf("log", "list", "--json").stdout)
        self.assertEqual([row["path"] for row in listed], self.logs())
        self.assertEqual(os.stat(self.logs()[0]).st_mode & 0o777, 0o600)

    def test_a_log_says_who_hung_up(self):
        kerf("info", "--machine", "virtual:grbl")
        closed = [entry["text"] for entry in entries("--kind", "closed")]
        self.assertEqual(len(closed), 1)
        self.assertIn("HungUp", closed[0])
        self.assertEqual(kerf("replay", "latest").returncode, DONE)

    def test_talks_are_recorded(self):
        talk = self.file("hello.talk", "% personality grbl\n-> $G\n<- [GC:*\n<- ok\n")
        with VirtualMachine("grbl", speed="1") as machine:
            held = kerf("verify", talk, "--machine", machine.url)
        self.assertIn("1 passed", held.stdout, held.stderr)
        self.assertIn("hello.talk", entries("--kind", "header")[0]["text"])
        self.assertIn("$G", [entry["text"] for entry in entries("--direction", "sent")])
        self.assertEqual(kerf("replay", "latest").returncode, DONE)

    def test_info_says_that_it_is_not_recorded(self):
        told = kerf("info", "--machine", "virtual:grbl", "--record", "/proc/nowhere")
        self.assertEqual(told.returncode, DONE)
        self.assertIn("not recorded", told.stderr)

    def test_unless_told_not_to(self):
        kerf("info", "--machine", "virtual:grbl", "--no-record")
        self.assertEqual(self.logs(), [])
        elsewhere = os.path.join(self.folder, "elsewhere")
        kerf("info", "--machine", "virtual:grbl", "--record", elsewhere)
        self.assertEqual(self.logs(), [])
        self.assertEqual(len(os.listdir(elsewhere)), 1)

    def test_a_killed_kerf_leaves_a_log(self):
        with VirtualMachine("grblhal", speed="1") as machine:
            with Running("run", example("coaster.nc"), "--machine", machine.url) as running:
                running.wait_for("line 1|[0-9] %|Cutting")
                wait_until(lambda: self.logs() and any(e["kind"] == "command" for e in entries(self.logs()[-1])))
                running.signal(signal.SIGKILL)
                running.wait()
        replayed = kerf("replay", "latest")
        self.assertEqual(replayed.returncode, DONE, replayed.stderr)
        self.assertIn("as far as the log goes", replayed.stdout)
        self.assertIn("ends in the middle", replayed.stderr)

    def test_a_full_disk_does_not_disturb_the_job(self):
        def few_bytes():
            resource.setrlimit(resource.RLIMIT_FSIZE, (4096, 4096))

        with VirtualMachine("grblhal") as machine:
            job = subprocess.run([KERF, "run", example("coaster.nc"), "--machine", machine.url], text=True,
                                 capture_output=True, timeout=60, preexec_fn=few_bytes)
        self.assertEqual(job.returncode, DONE, job.stderr)
        self.assertEqual(job.stdout.count("is not recorded any more"), 1, job.stdout)
        os.remove(self.logs()[-1])  # it was full before its first block was whole

    def test_a_folder_that_cannot_be_does_not_disturb_the_job(self):
        blocked = os.path.join(self.file("file", "x"), "logs")
        job = kerf("run", example("coaster.nc"), "--machine", "virtual:grbl?speed=max", "--record", blocked)
        self.assertEqual(job.returncode, DONE, job.stderr)
        self.assertEqual(job.stdout.count("is not recorded"), 1, job.stdout)

    def test_passwords_are_in_no_log(self):
        with VirtualMachine("grblhal") as machine:
            console = kerf("console", "--machine", machine.url, text="$75=hunter2\n$330=hunter3\n$330\n")
            self.assertEqual(console.returncode, DONE, console.stderr)
            self.assertNotIn("hunter", console.stdout + console.stderr)
            part = self.file("part.nc", "G21\n$9001=hunter2\n")
            for form in ([], ["--json"]):
                job = kerf("run", part, "--machine", machine.url, *form)
                self.assertEqual(job.returncode, REFUSED, job.stdout)
                self.assertNotIn("hunter", job.stdout + job.stderr)
                self.assertIn("$9001=*******", job.stdout + job.stderr)
        shown = "".join(kerf("log", "show", log).stdout for log in self.logs())
        self.assertNotIn("hunter", shown)
        self.assertIn("$75=******1", shown)


class Watching(LiveTest):
    def test_record(self):
        with VirtualMachine("grblhal", speed="1") as machine:
            with Running("record", "--machine", machine.url) as watcher:
                watcher.wait_for(r"> \$I\+")
                watcher.wait_for(r"\$\$")
                watcher.signal(signal.SIGINT)
                self.assertEqual(watcher.wait(), DONE)
                self.assertIn("Recorded in " + self.logs()[-1], watcher.output)

    def test_listening_sends_nothing(self):
        with VirtualMachine("grblhal", speed="1") as machine:
            with Running("record", "--listen", "--machine", machine.url) as watcher:
                watcher.wait_for("The link is open")
                watcher.signal(signal.SIGINT)
                self.assertEqual(watcher.wait(), DONE)
        self.assertEqual(entries("--direction", "sent"), [])
        self.assertEqual(kerf("replay", "latest").returncode, DONE)


class Showing(LiveTest):
    def setUp(self):
        super().setUp()
        kerf("info", "--machine", "virtual:grblhal")
        self.all = entries()

    def test_filters(self):
        self.assertEqual({entry["direction"] for entry in entries("--direction", "received")}, {"Received"})
        self.assertEqual({entry["kind"] for entry in entries("--kind", "ok,setting_v")}, {"ok", "setting_value"})
        self.assertNotIn("ok", {entry["kind"] for entry in entries("--hide", "ok")})
        self.assertEqual({entry["text"] for entry in entries("--grep", r"^\$13=")}, {"$13=0"})
        middle = self.all[len(self.all) // 2]["at"]
        before, after = entries("--until", str(middle)), entries("--since", str(middle))
        self.assertEqual(before + after, self.all)
        self.assertTrue(all(entry["at"] < middle for entry in before))
        self.assertEqual(entries("--since", "2000-01-01T00:00:00"), self.all)
        self.assertEqual(entries("--until", "2000-01-01T00:00:00"), [])

    def test_what_is_no_filter(self):
        self.assert_complains(kerf("log", "show", "--since", "noon"), USAGE, "noon")
        self.assert_complains(kerf("log", "show", "--grep", "("), USAGE, "regular expression")
        self.assert_complains(kerf("log", "show", self.folder + "/none"), USAGE, "none")


class Replaying(LiveTest):
    HEADER = ('{"at":0.0,"kind":"header","version":1,"kerf":"0.0.1","machine":"test","began":"2026-01-01T00:00:00Z",'
              '"part":1,"listening":false,"options":{}}\n{"at":0.1,"kind":"opened"}\n')

    def test_other_bytes(self):
        log = self.file("other.jsonl", self.HEADER + '{"at":0.1,"kind":"sent","realtime":"!","lines":""}\n')
        self.assert_complains(kerf("replay", log), REFUSED, "Record 3", "the log has '!'", "kerf 0.0.1")
        self.assertEqual(json.loads(kerf("replay", log, "--json").stdout)["stop"]["end"], "Different")

    def test_what_is_no_log(self):
        self.assert_complains(kerf("replay", self.file("a.nc", "G0X1\n")), USAGE, "a.nc")
        self.assert_complains(kerf("replay", self.file("empty", "")), USAGE, "empty")
        self.assert_complains(kerf("replay", self.folder + "/none"), USAGE, "none")
        self.assert_complains(kerf("replay", self.folder), USAGE, "folder")
        middle = self.HEADER.replace('"part":1', '"part":3')
        self.assert_complains(kerf("replay", self.file("middle.jsonl", middle)), USAGE, "part")

    def test_a_large_program_is_found_again(self):
        part = self.file("large.nc", "G21\n" + "".join(f"G0X{i % 100}Y{i % 7} ;{'-' * 90}\n" for i in range(45000)))
        with VirtualMachine("grblhal") as machine:
            with Running("run", part, "--machine", machine.url) as job:
                job.wait_for("Cutting")
                for said in ("Holding", "Stopping"):
                    job.signal(signal.SIGINT)
                    job.wait_for(said)
                job.wait()
        self.assertEqual(kerf("replay", "latest").returncode, DONE)
        moved = part + ".moved"
        os.rename(part, moved)
        self.assert_complains(kerf("replay", "latest"), USAGE, "large.nc", "--program")
        self.assertEqual(kerf("replay", "latest", "--program", moved).returncode, DONE)
        other = self.file("x.nc", "G0\n")
        self.assert_complains(kerf("replay", "latest", "--program", other), USAGE, "x.nc", "hash")
        os.rename(moved, part)


if __name__ == "__main__":
    unittest.main()
