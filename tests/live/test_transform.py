"""transform: another program out of a program."""

import os
import unittest

from kerf_program import DONE, PERSONALITIES, REFUSED, USAGE, LiveTest, kerf

PART = "(Part)\nG21 G90 G17\nG0 X10 Y0 Z5\nG1 Z-1 F300\nG2 X20 Y10 I0 J10 F600 ; round\nG0 Z5\nM30\n"


class Transform(LiveTest):
    def test_in_the_order_of_the_command_line(self):
        part = self.file("part.nc", PART)
        turned = kerf("transform", part, "--rotate", "90", "--translate", "5,0")
        self.assertEqual(turned.returncode, DONE, turned.stderr)
        self.assertIn("G0 X5 Y10 Z5\n", turned.stdout)
        self.assertIn("G2 X-5 Y20 I-10 J0 F600 ; round\n", turned.stdout)
        moved = kerf("transform", part, "--translate", "5,0", "--rotate", "90")
        self.assertIn("G0 X0 Y15 Z5\n", moved.stdout)

    def test_writes_a_whole_file_or_none(self):
        part = self.file("part.nc", PART)
        out = os.path.join(os.path.dirname(part), "out.nc")
        result = kerf("transform", part, "--mirror", "x", "-o", out)
        self.assertEqual(result.returncode, DONE, result.stderr)
        with open(out, encoding="utf-8") as file:
            self.assertIn("G3 X-20 Y10 I0 J10", file.read())
        refused = kerf("transform", part, "--scale", "2,1", "-o", out + "2")
        self.assertEqual(refused.returncode, REFUSED)
        self.assertIn("line 5: This cannot be scaled", refused.stderr)
        self.assertFalse(os.path.exists(out + "2"))

    def test_preview_writes_nothing(self):
        result = kerf("transform", self.file("part.nc", PART), "--scale", "2", "--preview")
        self.assertEqual(result.returncode, DONE, result.stderr)
        self.assertIn("cuts X 0.000 to 40.000", result.stdout)
        self.assertNotIn("G1 Z-2", result.stdout)

    def test_examples_on_every_personality(self):
        examples = os.environ["KERF_EXAMPLES"]
        for personality in PERSONALITIES:
            for name in ("coaster.nc", "facing.nc", "laser_label.nc"):
                with self.subTest(personality=personality, name=name):
                    result = kerf("transform", os.path.join(examples, name), "-p", personality, "--translate", "1,2",
                                  "--strip-comments", "--units", "inch", "--units", "mm", "--decimals", "4")
                    self.assertEqual(result.returncode, DONE, result.stderr)

    def test_a_file_for_each_tool(self):
        out = os.path.join(os.path.dirname(self.file("x.nc", PART)), "tools.nc")
        result = kerf("transform", os.path.join(os.environ["KERF_EXAMPLES"], "coaster.nc"), "--split-tools", "-o", out)
        self.assertEqual(result.returncode, DONE, result.stderr)
        for tool in ("-T1", "-T2"):
            part = out.replace(".nc", tool + ".nc")
            checked = kerf("estimate", part, "--personality", "grbl")
            self.assertEqual(checked.returncode, DONE, checked.stdout + checked.stderr)

    def test_follows_a_measured_surface(self):
        part = self.file("part.nc", "G21 G90\nG0 X0 Y0 Z5\nG1 Z-1 F300\nX10\n")
        grid = self.file("grid.csv", "x,y,z\n0,0,0\n10,0,1\n0,10,0\n10,10,1\n")
        result = kerf("transform", part, "--height-map", grid)
        self.assertEqual(result.stdout, "G21 G90\nG0 X0 Y0 Z5\nG1 Z-1 F300\nX10 Z0\n", result.stderr)
        gap = self.file("gap.csv", "0,0,0\n10,0,1\n0,10,0\n")
        result = kerf("transform", part, "--height-map", gap)
        self.assertEqual(result.returncode, USAGE)
        self.assertIn("X10.000 Y10.000 is missing", result.stderr)

    def test_repeats_parts_and_outlines_are_programs(self):
        facing = os.path.join(os.environ["KERF_EXAMPLES"], "facing.nc")
        for words in (["--passes", "3,0.5"], ["--copies", "G54,G55"], ["--outline", "hull"], ["--from-line", "20"],
                      ["--arcs-to-lines", "0.01"], ["--lines-to-arcs", "0.01"]):
            with self.subTest(words):
                out = os.path.join(os.path.dirname(self.file("x.nc", PART)), "out.nc")
                result = kerf("transform", facing, *words, "-o", out)
                self.assertEqual(result.returncode, DONE, result.stderr)
                checked = kerf("estimate", out, "--personality", "grbl")
                self.assertEqual(checked.returncode, DONE, checked.stdout + checked.stderr)

    def test_says_what_is_wrong(self):
        part = self.file("part.nc", PART)
        for words in (["--rotate", "x"], ["--scale", "0"], ["--decimals", "9"], []):
            with self.subTest(words):
                result = kerf("transform", part, *words)
                self.assertEqual(result.returncode, USAGE)
                self.assertTrue(result.stderr)


if __name__ == "__main__":
    unittest.main()
