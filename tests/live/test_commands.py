"""info, console, ports, verify, and what `kerf virtual` keeps."""

import json
import os
import signal
import unittest

from kerf_program import (DONE, NO_CONNECTION, PERSONALITIES, REFUSED, USAGE, WARNED, LiveTest, OnTerminal, Running,
                          VirtualMachine, kerf)

FIRMWARES = {"grbl": "Grbl", "rabbit": "Rabbit GRBL", "grblhal": "grblHAL"}


class Describe(LiveTest):
    def test_json(self):
        for personality in PERSONALITIES:
            with self.subTest(personality), VirtualMachine(personality) as machine:
                result = kerf("info", "--machine", machine.url, "--json")
                self.assertEqual(result.returncode, DONE, result.stderr)
                told = json.loads(result.stdout)
                self.assertEqual(told["firmware"], FIRMWARES[personality])
                for key in ("version", "options", "capabilities", "axes", "buffers"):
                    self.assertIn(key, told)
                for key in ("alarms", "errors", "settings"):
                    self.assertIsInstance(told[key], list)
                    self.assertTrue(told[key], key)

    def test_text(self):
        result = kerf("info", "--machine", "virtual:grblhal")
        self.assertEqual(result.returncode, DONE, result.stderr)
        for words in ("grblHAL 1.1f", "Axes", "Receive buffer", "Alarms (", "Errors (", "Settings ("):
            self.assertIn(words, result.stdout)


class Estimate(LiveTest):
    PART = "G21 G90\n(Toolpath:- Slot)\nT1\nG0 X5\nG1 Z-1 F300\nX25 F900\nM0\nG0 Z5\nM30\n"

    def test_total_is_that_of_the_simulation(self):
        part = self.file("part.nc", self.PART.replace("M0\n", ""))
        for personality in PERSONALITIES:
            with self.subTest(personality):
                totals = [json.loads(kerf(command, part, "-p", personality, "--json").stdout)["total_s"]
                          for command in ("estimate", "simulate")]
                self.assertEqual(*totals)

    def test_tells_operations_stops_and_a_slow_link(self):
        part = self.file("part.nc", self.PART)
        result = kerf("estimate", part, "--machine", "virtual:grbl", "--link", "115200")
        self.assertEqual(result.returncode, DONE, result.stderr)
        for words in ("Slot", "waits for the operator at line 7", "keeps the planner full"):
            self.assertIn(words, result.stdout)

    def test_refused_lines_are_named(self):
        result = kerf("estimate", self.file("part.nc", "G21\nG99.7\n"))
        self.assertEqual(result.returncode, REFUSED, result.stderr)
        self.assertIn("Line 2 would be refused: error:", result.stdout)


class Check(LiveTest):
    CLEAN = "G21 G90\nM3 S500\nG0 Z5\nG0 X5 Y5\nG1 Z-1 F100\nG1 X20 F300\nG0 Z5\nM5\nM30\n"

    def test_clean_warned_refused(self):
        for personality in PERSONALITIES:
            for text, status, words in ((self.CLEAN, DONE, "nothing found"),
                                        (self.CLEAN.replace("F300", "F99999"), WARNED, "line 6: G1 X20 F99999"),
                                        (self.CLEAN.replace("F100", ""), REFUSED, "(error:22)")):
                with self.subTest(f"{personality} {words}"):
                    result = kerf("check", self.file("part.nc", text), "-p", personality)
                    self.assertEqual(result.returncode, status, result.stdout + result.stderr)
                    self.assertIn(words, result.stdout)

    def test_a_machine_is_asked_where_it_stands(self):
        part = self.file("part.nc", "G21 G90\nG0 X5 Y5\nG0 Z5\nM3 S500\nG1 Z-1 F100\nG1 X20\nG0 Z5\nM5\nM30\n")
        with VirtualMachine("grbl") as machine:
            result = kerf("check", part, "--machine", machine.url, "--json")
        self.assertEqual(result.returncode, WARNED, result.stderr)
        told = json.loads(result.stdout)
        self.assertEqual((told["firmware"], told["worst"], told["warnings"]), ("Grbl", "Warning", 1))
        finding = told["findings"][0]
        self.assertEqual((finding["line"], finding["kind"]), (2, "RapidBelowCut"))
        for key in ("text", "severity", "what", "reason", "next"):
            self.assertTrue(finding[key], key)

    def test_travel_with_a_zero(self):
        part = self.file("part.nc", self.CLEAN)
        settings = self.file("settings.txt", "$22=1\n$20=1\n$130=200\n$131=200\n$132=100\n")
        check = ("check", part, "-p", "grbl", "--settings", settings)
        self.assertEqual(kerf(*check, "--zero", "-100,-100,-50").returncode, DONE)
        result = kerf(*check, "--zero", "-15,-100,-50")
        self.assertEqual(result.returncode, REFUSED, result.stdout)
        for words in ("ALARM:2", "line 6: G1 X20 F300", "5 mm beyond the travel from -200 to 0"):
            self.assertIn(words, result.stdout)

    def test_what_cannot_be_used_is_named(self):
        part = self.file("part.nc", self.CLEAN)
        self.assert_complains(kerf("check", part, "--zero", "1,here"), USAGE, "1,here", "--zero")
        self.assert_complains(kerf("check", part + "x"), USAGE, "part.ncx")
        self.assert_complains(kerf("check", part, "-m", "tcp://127.0.0.1:1"), NO_CONNECTION, "127.0.0.1:1")


class Console(LiveTest):
    def test_from_a_pipe(self):
        result = kerf("console", "--machine", "virtual:grbl", text="$G\n?\nG99\n")
        self.assertEqual(result.returncode, DONE, result.stderr)
        self.assertIn("[GC:", result.stdout)
        self.assertIn("<Idle|", result.stdout)
        self.assertRegex(result.stdout, r"error:20\n    \S")

    def test_on_a_terminal(self):
        with OnTerminal("console", "--machine", "virtual:grblhal") as terminal:
            terminal.wait_for("Ctrl-D leaves")
            terminal.press("$I\n")
            terminal.wait_for(r"\[FIRMWARE:grblHAL\]")
            terminal.press("?")
            terminal.wait_for(r"<Idle\|")
            terminal.press("!")
            terminal.press("?")
            terminal.wait_for(r"<Hold:0\|")
            terminal.press("~")
            terminal.press("\x18")
            terminal.wait_for(r"GrblHAL 1\.1f")
            terminal.press("\x04")
            self.assertEqual(terminal.wait(), DONE)


class Ports(LiveTest):
    def test_lists_the_virtual_machines(self):
        told = json.loads(kerf("ports", "--json").stdout)
        self.assertEqual([machine["url"] for machine in told["virtual_machines"]],
                         ["virtual:grbl", "virtual:rabbit", "virtual:grblhal"])
        self.assertIsInstance(told["serial"], list)
        self.assertIn("virtual:rabbit", kerf("ports").stdout)


    def test_the_network_is_told_of_or_why_not(self):
        """With or without an Avahi daemon on this computer."""
        told = json.loads(kerf("ports", "--network", "--json").stdout)
        self.assertNotEqual(told.get("announced") is not None, told.get("not_listening") is not None, told)
        if told.get("not_listening"):
            self.assertIn("avahi", told["not_listening"].lower())
            self.assertIn(told["not_listening"], kerf("ports", "--network").stdout)

    def test_watching_says_the_list_at_once_and_ends_with_ctrl_c(self):
        with Running("ports", "--network", "--watch", "--json") as watch:
            line = watch.wait_for(r"\{.*\}\n")[0]
            self.assertEqual(len(json.loads(line)["virtual_machines"]), 3)
            watch.signal(signal.SIGINT)
            self.assertEqual(watch.wait(), DONE)


class Verify(LiveTest):
    TALK = "% personality grbl\n-> G21\n<- ok\n-> G99\n<- error:20\n-> ?\n<- <Idle|*\n"

    def test_virtual_and_live(self):
        talk = self.file("units.talk", self.TALK)
        self.assertEqual(kerf("verify", talk).returncode, DONE)
        with VirtualMachine("grbl", speed="1") as machine:
            result = kerf("verify", "--machine", machine.url, talk)
            self.assertEqual(result.returncode, DONE, result.stdout + result.stderr)
            self.assertIn("1 passed", result.stdout)

    def test_failure_names_the_line(self):
        result = kerf("verify", self.file("wrong.talk", "% personality grbl\n-> G21\n<- error:1\n"))
        self.assertEqual(result.returncode, REFUSED)
        self.assertIn("wrong.talk:3", result.stdout)

    def test_no_talk(self):
        self.assert_complains(kerf("verify", self.file("a.talk", "G21\n")), 1, "a.talk", "line 1")
        self.assert_complains(kerf("verify", self.folder + "/b.talk"), 1, "b.talk")


class Memory(LiveTest):
    def test_settings_and_offsets_survive_a_restart(self):
        state = os.path.join(self.folder, "state")
        for personality in PERSONALITIES:
            with self.subTest(personality):
                path = state + personality
                with VirtualMachine(personality, "--state", path) as machine:
                    kerf("console", "--machine", machine.url, text="$110=321\nG10 L2 P1 X5\n")
                with VirtualMachine(personality, "--state", path) as machine:
                    told = kerf("console", "--machine", machine.url, text="$$\n$#\n").stdout
                self.assertIn("$110=321", told)
                self.assertIn("[G54:5.000", told)

    def test_settings_file(self):
        settings = self.file("settings", "; a comment\n$110=777\n")
        with VirtualMachine("grbl", "--settings", settings) as machine:
            told = json.loads(kerf("info", "--machine", machine.url, "--json").stdout)
        values = {setting["id"]: setting.get("value") for setting in told["settings"]}
        self.assertEqual(float(values["110"]), 777)


if __name__ == "__main__":
    unittest.main()
