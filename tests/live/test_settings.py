"""kerf settings, on virtual machines that remember what they are told."""

import json
import os
import unittest

from kerf_program import DONE, PERSONALITIES, USAGE, LiveTest, VirtualMachine, kerf


class Settings(LiveTest):
    def machine(self, personality, *arguments):
        return VirtualMachine(personality, "--state", os.path.join(self.folder, "state-" + personality), *arguments)

    def settings(self, machine, *arguments):
        return kerf("settings", *arguments, "--machine", machine.url)

    def value(self, machine, setting):
        told = json.loads(self.settings(machine, "get", setting, "--json").stdout)
        return told["settings"][0]["value"]

    def test_list(self):
        for personality in PERSONALITIES:
            with self.subTest(personality), self.machine(personality) as machine:
                told = json.loads(self.settings(machine, "list", "--json").stdout)
                rate = next(setting for setting in told["settings"] if setting["id"] == "110")
                self.assertEqual(rate["unit"], "mm/min")
                self.assertEqual(rate["group"], "X-axis")
                self.assertTrue(rate["help"])
                self.assertIn("number", rate["range"])
                shown = self.settings(machine, "list", "--group", "Axis").stdout
                self.assertIn("$110=", shown)
                self.assertNotIn("$13=", shown)

    def test_set_verify_and_roll_back(self):
        for personality in PERSONALITIES:
            with self.subTest(personality), self.machine(personality) as machine:
                before = self.value(machine, "110")
                result = self.settings(machine, "set", "110=777", "13=off", "--reason", "faster")
                self.assertEqual(result.returncode, DONE, result.stderr)
                self.assertEqual(float(self.value(machine, "$110")), 777)
                history = json.loads(self.settings(machine, "history", "--json").stdout)
                self.assertEqual([version["reason"] for version in history], ["first connection", "faster"])
                result = self.settings(machine, "restore", "@1")
                self.assertEqual(result.returncode, DONE, result.stderr)
                self.assertEqual(self.value(machine, "110"), before)

    def test_saved_set_restores(self):
        for personality in PERSONALITIES:
            with self.subTest(personality), self.machine(personality) as machine:
                file = os.path.join(self.folder, personality + ".settings")
                changed = ["110=1234", "22=1", "20=1", "23=XY", "10=1"]
                self.assertEqual(self.settings(machine, "save", file).returncode, DONE)
                result = self.settings(machine, "set", *changed)
                self.assertEqual(result.returncode, DONE, result.stderr)
                differing = json.loads(self.settings(machine, "diff", file, "--json").stdout)
                self.assertIn("110", [row["id"] for row in differing])
                self.assertEqual(self.settings(machine, "restore", file).returncode, DONE)
                self.assertIn("No difference", self.settings(machine, "diff", file).stdout)
                with VirtualMachine(personality, "--settings", file) as other:
                    self.assertEqual(self.settings(other, "diff", file, "--json").stdout.strip(), "[]")

    def test_what_would_not_be_taken_is_not_sent(self):
        for personality in PERSONALITIES:
            with self.subTest(personality), self.machine(personality) as machine:
                before = self.settings(machine, "save", "-").stdout.splitlines()[3:]
                wrongs = [("110=fast", "mm/min"), ("13=2", "on"), ("9999=1", "$9999")]
                if personality != "rabbit":  # it takes soft limits without homing
                    wrongs.append(("20=1", "$22"))
                for wrong, word in wrongs:
                    self.assert_complains(self.settings(machine, "set", "111=600", wrong), USAGE, word)
                self.assertEqual(self.settings(machine, "save", "-").stdout.splitlines()[3:], before)

    def test_a_foreign_set_is_not_restored(self):
        file = os.path.join(self.folder, "rabbit.settings")
        with self.machine("rabbit") as machine:
            self.settings(machine, "save", file)
        with self.machine("grblhal") as machine:
            self.assert_complains(self.settings(machine, "restore", file), USAGE, "Rabbit", "--force")

    def test_files_that_are_no_sets(self):
        with self.machine("grbl") as machine:
            bad = self.file("bad.settings", "$110=5\nG0X1\n")
            self.assert_complains(self.settings(machine, "restore", bad), USAGE, "line 2", "G0X1")
            self.assert_complains(self.settings(machine, "restore", "@99"), USAGE, "@99")
            self.assert_complains(self.settings(machine, "diff", self.folder + "/none"), USAGE, "none")

    def test_drift_is_told_at_the_next_connection(self):
        for personality in PERSONALITIES:
            with self.subTest(personality), self.machine(personality) as machine:
                self.settings(machine, "list")
                with_port = machine.port
            # Somebody else changes a setting while Kerf is away.
            with VirtualMachine(personality, "--settings", self.file("other", "$110=432\n"),
                                "--listen", f"tcp://127.0.0.1:{with_port}", tcp=False) as machine:
                url = f"tcp://127.0.0.1:{with_port}"
                told = json.loads(kerf("info", "--json", "--machine", url).stdout)
                self.assertEqual([row["id"] for row in told["settings_drift"]], ["110"])
                again = json.loads(kerf("info", "--json", "--machine", url).stdout)
                self.assertEqual(again["settings_drift"], [])

    def test_inches_change_no_setting(self):
        for personality in PERSONALITIES:
            with self.subTest(personality), self.machine(personality) as machine:
                before = self.value(machine, "110")
                self.assertEqual(self.settings(machine, "set", "13=on").returncode, DONE)
                told = json.loads(kerf("info", "--json", "--machine", machine.url).stdout)
                self.assertEqual(told["features"]["report_units"], {"word": "inch", "source": "Told"})
                self.assertEqual(self.value(machine, "110"), before)

    def test_a_busy_machine_is_not_written_to(self):
        with VirtualMachine("grbl", speed="1") as machine:
            kerf("console", "--machine", machine.url, text="G1X50F60\n")
            result = self.settings(machine, "set", "110=600")
            self.assertNotEqual(result.returncode, DONE)

    def test_dry_run(self):
        with self.machine("grblhal") as machine:
            result = self.settings(machine, "set", "22=Enable,Allow manual", "--dry-run")
            self.assertIn("0 -> 33", result.stdout)
            self.assertEqual(self.value(machine, "22"), "0")


if __name__ == "__main__":
    unittest.main()
