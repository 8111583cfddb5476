"""plot and report: pictures of programs, and pages about them."""

import os
import struct
import unittest
import xml.etree.ElementTree as ElementTree

from kerf_program import DONE, REFUSED, USAGE, LiveTest, example, kerf

SVG = "{http://www.w3.org/2000/svg}"


class Plot(LiveTest):
    def picture(self, name, *arguments):
        path = os.path.join(self.folder, name)
        result = kerf("plot", *arguments, "-o", path)
        self.assertEqual(result.returncode, DONE, result.stderr)
        with open(path, "rb") as file:
            return file.read()

    def test_svg_of_every_view(self):
        for view in ("top", "front", "side", "isometric"):
            with self.subTest(view):
                svg = ElementTree.fromstring(self.picture("a.svg", example("coaster.nc"), "--view", view))
                texts = [element.text for element in svg.iter(SVG + "text")]
                self.assertIn("coaster.nc", texts)
                self.assertIn("Work zero", texts)
                dashed = [path for path in svg.iter(SVG + "path") if path.get("stroke-dasharray")]
                self.assertTrue(dashed, "rapids")

    def test_png_has_the_size_that_was_asked(self):
        png = self.picture("a.PNG", example("coaster.nc"), "--view", "top", "--size", "800x500", "--color", "height")
        self.assertEqual(png[:8], b"\x89PNG\r\n\x1a\n")
        width, height = struct.unpack(">II", png[16:24])
        self.assertEqual(width, 800)
        self.assertLessEqual(height, 500)

    def test_comments_cannot_break_out_of_the_picture(self):
        part = self.file("<i>.nc", "G21 G90\n(Toolpath:- </text><script>x</script>)\nT1 M6\nG1 X1 F100\n"
                         "(Toolpath:- \"b\" & c)\nG1 X2\n")
        svg = ElementTree.fromstring(self.picture("a.svg", part))
        self.assertEqual(list(svg.iter(SVG + "script")), [])
        self.assertIn("</text><script>x</script>", [element.text for element in svg.iter(SVG + "text")])

    def test_refused_lines_are_counted(self):
        part = self.file("part.nc", "G21 G90\nG1 X1 F100\nG99.7\nX2\n")
        result = kerf("plot", part, "-o", os.path.join(self.folder, "a.svg"))
        self.assertEqual(result.returncode, REFUSED)
        self.assertIn("1 line of", result.stderr)

    def test_wrong_wishes_are_explained(self):
        part = self.file("part.nc", "G21 G90\nG1 X1 F100\n")
        self.assert_complains(kerf("plot", part, "-o", "a.pdf"), USAGE, "a.pdf", ".svg or .png")
        self.assert_complains(kerf("plot", part, "-o", "a.png", "--size", "3x"), USAGE, "3x", "1200x900")
        self.assert_complains(kerf("plot", "none.nc", "-o", "a.png"), USAGE, "none.nc")
        self.assert_complains(kerf("plot", part, "-o", "/nowhere/a.svg"), USAGE, "/nowhere/a.svg")
        still = self.file("still.nc", "G21 G90\nM3 S1\n")
        self.assert_complains(kerf("plot", still, "-o", "a.svg"), USAGE, "moves nothing")


class Report(LiveTest):
    def page(self, *arguments, status=DONE):
        path = os.path.join(self.folder, "report.html")
        result = kerf("report", *arguments, "-o", path)
        self.assertEqual(result.returncode, status, result.stderr)
        with open(path, encoding="utf-8") as file:
            return file.read()

    def test_one_page_that_needs_nothing_else(self):
        page = self.page(example("coaster.nc"), "--settings", self.file("machine.settings", "$30=24000\n$110=3000\n"))
        for words in ("coaster.nc", "machine.settings", "Nothing against it", "Thumb notch", "T2", "Soft limits"):
            self.assertIn(words, page)
        self.assertEqual(page.count("<svg"), page.count("</svg>"))
        for outside in ("<script", "<link", "<img", "url("):
            self.assertNotIn(outside, page)

    def test_of_a_machine_that_is_asked(self):
        page = self.page(example("coaster.nc"), "--machine", "virtual:rabbit")
        self.assertIn("Rabbit", page)
        self.assertIn("the settings of virtual:rabbit", page)

    def test_errors_are_the_exit_status(self):
        page = self.page(self.file("part.nc", "G21 G90\nG1 X1 F100\nG99.7 (<b>)\n"), status=REFUSED)
        self.assertIn("G99.7 (&lt;b&gt;)", page)
        self.assertNotIn("<b>", page)

    def test_wrong_wishes_are_explained(self):
        part = self.file("part.nc", "G21 G90\nG1 X1 F100\n")
        self.assert_complains(kerf("report", "none.nc", "-o", "a.html"), USAGE, "none.nc")
        self.assert_complains(kerf("report", part, "-o", "/nowhere/a.html"), USAGE, "/nowhere/a.html")


if __name__ == "__main__":
    unittest.main()
