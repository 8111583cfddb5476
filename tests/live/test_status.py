"""status, alarms, errors."""

import json
import signal
import time
import unittest

from kerf_program import ALARM, DONE, PERSONALITIES, USAGE, LiveTest, OnTerminal, Peer, Running, VirtualMachine, kerf


class Status(LiveTest):
    def test_once(self):
        for personality in PERSONALITIES:
            with self.subTest(personality), VirtualMachine(personality, speed="1") as machine:
                result = kerf("status", "--machine", machine.url)
                self.assertEqual(result.returncode, DONE, result.stderr)
                self.assertRegex(result.stdout, r"^Idle: ")
                for word in ("Work position", "Inputs", "Homed", "Modes", "Link"):
                    self.assertIn(word, result.stdout)

    def test_json(self):
        with VirtualMachine("grblhal", speed="1") as machine:
            told = json.loads(kerf("status", "--json", "--machine", machine.url).stdout)
        self.assertEqual(told["firmware"], "grblHAL")
        self.assertEqual(told["machine"]["state"], "Idle")
        self.assertEqual(told["machine"]["machine_position_mm"], [0, 0, 0])
        self.assertEqual(told["machine"]["modes"]["units"], "G21")
        self.assertEqual(told["machine"]["accessories"]["spindle"], "Off")
        self.assertFalse(told["machine"]["inputs"]["door"])
        self.assertLess(told["link"]["report_age_s"], 5)

    def test_an_alarm_is_explained(self):
        settings = self.file("locked.settings", "$22=5\n")
        with VirtualMachine("grblhal", "--settings", settings, speed="1") as machine:
            result = kerf("status", "--machine", machine.url)
            self.assertEqual(result.returncode, ALARM, result.stderr)
            self.assertIn("Alarm 11", result.stdout)
            self.assertIn("$H", result.stdout)
            told = json.loads(kerf("status", "--json", "--machine", machine.url).stdout)
            self.assertEqual(told["alarm"]["code"], 11)
            self.assertTrue(told["alarm"]["next_steps"])

    def test_watch_prints_changes_as_json_lines(self):
        with VirtualMachine("grblhal", speed="1") as machine, \
                Running("status", "--watch", "--machine", machine.url) as watch:
            watch.wait_for(r'"state":"Idle"')
            time.sleep(1)
            before = watch.output.count("\n")
            time.sleep(2)
            watch.read(0)
            self.assertLessEqual(watch.output.count("\n") - before, 2, "nothing has changed")
            watch.signal(signal.SIGINT)
            self.assertEqual(watch.wait(), DONE)
        for line in watch.output.splitlines():
            json.loads(line)

    def test_watch_on_a_terminal_grows_old(self):
        status = b"<Idle|MPos:1.000,2.000,3.000|FS:0,0|WCO:0.000,0.000,0.000>\r\n"
        talking = [True]
        polled = []

        def answer(heard):
            if heard.strip(b"?"):
                polled.clear()
            polled.append(heard)
            reply = b"ok\r\n" * heard.count(b"\n")
            if heard == b"$I\n":
                reply = b"[VER:1.1h.20190830:]\r\n[OPT:V,15,128]\r\n" + reply
            if heard == b"$G\n":
                reply = b"[GC:G0 G54 G17 G21 G90 G94 M5 M9 T0 F0 S0]\r\n" + reply
            return reply + status * heard.count(b"?") if talking[0] else b""

        with Peer(answer) as peer, OnTerminal("status", "--watch", "--machine", peer.url) as terminal:
            terminal.wait_for(r"Idle  X1\.000 Y2\.000 Z3\.000")
            while len(polled) < 10:  # only status questions: the controller is known
                time.sleep(0.05)
            talking[0] = False
            terminal.wait_for(r"not answering for 2\.\d s  Idle")
            talking[0] = True
            terminal.press("\x03")
            self.assertEqual(terminal.wait(), DONE)
        self.assertNotIn("\n", terminal.output.strip())


class Codes(LiveTest):
    def test_lists(self):
        for personality in PERSONALITIES:
            with self.subTest(personality):
                alarms = json.loads(kerf("alarms", "--json", "--personality", personality).stdout)
                self.assertIn(2, [alarm["id"] for alarm in alarms])
                self.assertIn("error", kerf("errors", "--personality", personality).stdout)

    def test_one(self):
        result = kerf("alarms", "2", "--personality", "grbl")
        self.assertEqual(result.returncode, DONE, result.stderr)
        self.assertIn("Alarm 2", result.stdout)
        self.assertIn("1. ", result.stdout)
        self.assertEqual(json.loads(kerf("errors", "20", "-p", "rabbit", "--json").stdout)["code"], 20)
        self.assertEqual(kerf("alarms", "99", "--personality", "grbl").returncode, USAGE)
        self.assertEqual(kerf("alarms", "--personality", "marlin").returncode, USAGE)

    def test_a_machine_tells_its_own(self):
        told = json.loads(kerf("alarms", "--json", "--machine", "virtual:rabbit").stdout)
        self.assertEqual(told[0]["source"], "Told")


if __name__ == "__main__":
    unittest.main()
