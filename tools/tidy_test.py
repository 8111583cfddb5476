#!/usr/bin/env python3
"""Plants a violation of each rule of tidy.py in a temporary tree and asserts that tidy names it."""

import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

TIDY = Path(__file__).resolve().parent / "tidy.py"

GOOD_HEADER = "#pragma once\n// What it is.\n\nnamespace kerf {}\n"


class TidyTest(unittest.TestCase):
    def setUp(self) -> None:
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.root = Path(scratch.name)
        for path in ("src/common/base/time.hpp", "src/sender/session/session.hpp", "src/firmware/receiver.hpp",
                     "src/common/motion/planner.hpp", "src/io/transport.hpp"):
            self.plant(path, GOOD_HEADER)

    def plant(self, path: str, text: str) -> None:
        file = self.root / path
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_bytes(text.encode())

    def tidy(self) -> tuple[int, str]:
        result = subprocess.run([sys.executable, TIDY, self.root], capture_output=True, text=True, check=False)
        self.assertEqual(result.stderr, "")
        return result.returncode, result.stdout

    def accepts(self, path: str, text: str) -> None:
        self.plant(path, text)
        status, output = self.tidy()
        self.assertEqual((status, output.count("\n")), (0, 1), output)

    def refuses(self, path: str, text: str, expected: str) -> None:
        """`expected` is how the one finding begins, after the path: `line: rule: part of the advice`."""
        self.plant(path, text)
        status, output = self.tidy()
        self.assertEqual((status, output.count("\n")), (1, 2), output)
        line, rule, advice = expected.split(": ", 2)
        self.assertTrue(output.startswith(f"{path}:{line}: {rule}: "), output)
        self.assertIn(advice, output)
        (self.root / path).unlink()

    def test_accepts_a_clean_tree(self) -> None:
        status, output = self.tidy()
        self.assertEqual((status, output), (0, "tidy: 5 files, no violations\n"))

    # --- the tree ---

    def test_folders(self) -> None:
        self.refuses("src/common/misc/text.hpp", GOOD_HEADER, "1: tree: no folder of docs/architecture.md")
        self.refuses("src/text.hpp", GOOD_HEADER, "1: tree: no folder")
        self.refuses("src/firmware/notes.txt", "x\n", "1: tree: .hpp and .cpp files only")

    def test_file_names(self) -> None:
        self.refuses("src/firmware/MyReceiver.hpp", GOOD_HEADER, "1: file-name: snake_case")
        self.refuses("src/firmware/wire_util.hpp", GOOD_HEADER, "1: file-name: main thing")

    # --- includes ---

    def include(self, path: str, target: str, expected: str) -> None:
        self.refuses(path, f"#include {target}\n", f"1: include: {expected}")

    def test_includes_between_folders(self) -> None:
        self.include("src/common/base/x.cpp", '"common/motion/planner.hpp"', "`common/base` may not include")
        self.include("src/common/motion/x.cpp", '"sender/session/session.hpp"', "`common/motion` may not include")
        self.include("src/sender/streaming/x.cpp", '"common/motion/planner.hpp"', "`sender/streaming` may not")
        self.include("src/simulation/x.cpp", '"io/transport.hpp"', "`simulation` may not include `io`")
        self.include("src/firmware/x.cpp", '"receiver.hpp"', "write the path from there")
        self.include("tests/scenarios/x.cpp", '"absent.hpp"', "neither below src nor beside")
        self.accepts("tests/scenarios/scenario.hpp", GOOD_HEADER)
        self.accepts("tests/scenarios/x.cpp", '#include "firmware/receiver.hpp"\n#include "scenario.hpp"\n')
        self.accepts("bench/x.cpp", '#include "../tests/scenarios/scenario.hpp"\n')
        self.accepts("src/apps/x.cpp", '#include "io/transport.hpp"\n#include "firmware/receiver.hpp"\n')

    def test_the_two_sides_meet_only_as_bytes(self) -> None:
        self.include("src/sender/session/x.cpp", '"firmware/receiver.hpp"', "meet only as bytes")
        self.include("src/firmware/x.cpp", '"sender/session/session.hpp"', "meet only as bytes")
        self.include("src/firmware/x_test.cpp", '"sender/session/session.hpp"', "meet only as bytes")

    def test_foreign_headers(self) -> None:
        for header in ("boost/asio.hpp", "thread", "mutex", "atomic", "fstream", "filesystem", "sys/socket.h",
                       "unistd.h", "fmt/format.h", "nlohmann/json.hpp", "gtest/gtest.h"):
            self.include("src/firmware/x.cpp", f"<{header}>", "io/ and apps/")
        self.accepts("src/firmware/x.cpp", "#include <boost/describe.hpp>\n\n#include <vector>\n")
        self.accepts("src/firmware/x_test.cpp", "#include <gtest/gtest.h>\n#include <rapidcheck/gtest.h>\n")
        self.accepts("src/io/x.cpp", "#include <boost/asio/post.hpp>\n#include <thread>\n#include <unistd.h>\n")

    # --- what the core does not do ---

    def test_ambient_time_callbacks_and_exceptions(self) -> None:
        path = "src/firmware/x.cpp"
        self.refuses(path, "auto t = std::chrono::steady_clock::now();\n", "1: ambient: take the instant")
        self.refuses(path, "\nvoid f() { std::this_thread::sleep_for(d); }\n", "2: ambient: deadline")
        self.refuses(path, "std::function<void()> on_ready;\n", "1: callback: outbox")
        self.refuses(path, "void f() { throw 1; }\n", "1: exception: std::expected")
        self.refuses(path, "void f() { co_return; }\n", "1: coroutine: struct")
        self.refuses(path, 'void f() { std::cerr << "x"; }\n', "1: ambient: print")
        self.accepts("src/io/x.cpp", "auto t = std::chrono::steady_clock::now();\nstd::function<void()> on_ready;\n")

    def test_comments_and_literals_are_not_code(self) -> None:
        self.accepts("src/firmware/x.cpp",
                     '// Manager: throw now()\n/* if (data)\n   throw */\nconst char* k = "throw; Manager";\n'
                     'const char* r = R"x(throw "Manager" )" )x";\nconst char c = \'"\';\nint n = 1\'000; // throw\n')

    def test_tests_do_not_sleep(self) -> None:
        text = "void f() { usleep(1); }\n"
        self.refuses("tests/scenarios/x.cpp", text, "1: sleep: pass the time in")
        self.refuses("tests/scenarios/x.py", "import time\ntime.sleep(1)\n", "2: sleep: pass the time in")
        self.refuses("src/io/x_test.cpp", text, "1: sleep: pass the time in")
        self.accepts("tests/live/x.cpp", text)

    def test_tables_have_no_control_flow(self) -> None:
        for text in ("int f() { if (x) return 1; }\n", "int a = b ? 1 : 2;\n", "int f() { for (;;) {} }\n"):
            self.refuses("src/firmware/personalities/grbl.cpp", text, "1: table: named policy")
            self.refuses("src/common/vocabulary/dialects/grbl.hpp", "#pragma once\n" + text, "2: table: named policy")
        self.accepts("src/firmware/personalities/grbl.cpp", "constexpr char kQuery = '?';\n")

    # --- names and form ---

    def test_banned_words(self) -> None:
        path = "src/io/x.cpp"
        for word in ("PortManager", "port_helper", "Utils", "SessionImpl", "impl_", "kHelperCount", "HelperOf"):
            self.refuses(path, f"class {word};\n", f"1: name: `{word}`")
        for declaration, word in (("int data", "data"), ("int info_", "info_"), ("struct Info", "Info")):
            self.refuses(path, f"{declaration};\n", f"1: name: `{word}` says nothing")
        self.accepts(path, "auto n = text.data(); auto m = p->data; auto s = std::data(v); int implied, utilised;\n")

    def test_headers(self) -> None:
        self.refuses("src/firmware/x.hpp", "// no guard\n", "1: header: #pragma once")

    def test_form(self) -> None:
        path = "src/firmware/x.cpp"
        self.refuses(path, "int " + "a" * 120 + ";\n", "1: form: 125 columns")
        self.refuses(path, "\n\tint a;\n", "2: form: tab")
        self.refuses(path, "int a; \n", "1: form: end of the line")
        self.refuses(path, "int a;\r\n", "1: form: end of the line")
        self.refuses(path, "int a;\nint b;", "2: form: newline")
        self.refuses(path, "int a;\n" + "<" * 7 + " HEAD\nint b;\n", "2: form: merge")
        self.refuses("examples/x.nc", "(d\u00e9j\u00e0)\n", "1: form: ASCII")

    def test_length(self) -> None:
        path = "src/firmware/x.cpp"
        self.refuses(path, "int a;\n" * 501, "1: length: 501 lines")
        self.accepts(path, "// long: one table\n" + "int a;\n" * 500)

    def test_unfinished(self) -> None:
        for word in ("TO" + "DO", "FIX" + "ME", "XX" + "X", "HA" + "CK"):
            self.refuses("docs/x.md", f"\n{word}: later\n", f"2: unfinished: `{word}`")

    def test_banners(self) -> None:
        self.refuses("src/firmware/x.cpp", "// ======= Receiver =======\n", "1: comment: banners")

    def test_machines(self) -> None:
        for path in ("wo" + "rk/x", "ro" + "ot/.cache", "ho" + "me/anna/x", "tm" + "p/x"):
            self.refuses("docs/x.md", f"see /{path}\n", "1: machine: path")
        for host in ("registry" + ".example.org", "deb" + ".debian.org"):
            self.refuses("docs/x.md", f"from {host}\n", "1: machine: host")
        self.accepts("docs/x.md", "pty:///tmp/kerf-grblhal, and/or /tmp/kerf-x\n")


if __name__ == "__main__":
    unittest.main()
