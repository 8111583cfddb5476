#!/usr/bin/env python3
"""The rules of docs/architecture.md as a program.

usage: tidy.py [ROOT]

Prints `file:line: rule: what to do` for every violation below ROOT (the tree that this file lies in, if not given) and
ends with status 1 if there is any. It reads files only: no compiler, no git, nothing but Python's standard library.
"""

import posixpath
import re
import sys
from pathlib import Path
from typing import Callable, Iterator, NamedTuple


class Finding(NamedTuple):
    line: int
    rule: str
    advice: str


class SourceFile(NamedTuple):
    """One file of the tree: `path` from the root with forward slashes, `lines` as they are (without line ends), and for
    C++ `code`, the same lines with comments and the contents of literals blanked out."""

    path: str
    text: str
    lines: list[str]
    code: list[str]

    @property
    def name(self) -> str:
        return self.path.rsplit("/", 1)[-1]

    @property
    def folder(self) -> str:
        return self.path.rsplit("/", 1)[0] if "/" in self.path else ""

    @property
    def is_cpp(self) -> bool:
        return self.name.endswith((".hpp", ".cpp"))

    @property
    def is_test(self) -> bool:
        return self.name.endswith("_test.cpp") or self.path.startswith("tests/")


# --- docs/architecture.md, section 3 ---

COMMON = ["common/base", "common/vocabulary", "common/protocol", "common/gcode", "common/motion"]
SENDER = ["sender/machine", "sender/streaming", "sender/job", "sender/session"]

# Folder below src -> folders below src that it may include, itself apart.
MAY_INCLUDE: dict[str, list[str]] = {
    "common/base": [],
    "common/vocabulary": ["common/base"],
    "common/protocol": ["common/base", "common/vocabulary"],
    "common/gcode": ["common/base", "common/vocabulary"],
    "common/motion": ["common/base", "common/vocabulary", "common/gcode"],
    "sender/machine": COMMON,
    "sender/streaming": ["common/base", "common/vocabulary"],
    "sender/job": COMMON + ["sender/machine"],
    "sender/session": COMMON + SENDER,
    "firmware": COMMON,
    "simulation": COMMON + SENDER + ["firmware"],
    "io": COMMON + SENDER + ["firmware"],
    "rehearsal": COMMON + ["sender/machine", "sender/job", "firmware", "simulation"],
    "preparation": COMMON + SENDER + ["firmware", "simulation", "rehearsal", "io"],
    "daemon": COMMON + SENDER + ["firmware", "simulation", "rehearsal", "io", "preparation"],
    "apps": COMMON + SENDER + ["firmware", "simulation", "rehearsal", "io", "preparation", "daemon"],
}
SUBFOLDERS = {"common/vocabulary/dialects", "firmware/personalities", "io/web", "io/store", "io/notify"}
TABLE_FOLDERS = ("src/common/vocabulary/dialects", "src/firmware/personalities")
EDGES = ("src/io", "src/preparation", "src/daemon", "src/apps")

# Standard headers that bring a thread, a clock, a file, a stream or a suspended stack.
IMPURE_HEADERS = {
    "thread", "mutex", "shared_mutex", "condition_variable", "atomic", "future", "stop_token", "semaphore", "latch",
    "barrier", "fstream", "iostream", "istream", "ostream", "filesystem", "cstdio", "csignal", "csetjmp", "ctime",
    "coroutine", "locale", "clocale", "regex", "stacktrace", "syncstream", "execution", "print",
}
# Foreign headers that one file of the core includes, without linking anything.
FOREIGN_IN_CORE = {
    "xxhash.h": "src/common/base/content_hash.cpp",
    "immintrin.h": "src/common/base/text_masks.hpp",
}
TEST_LIBRARIES = ("gtest/", "gmock/", "rapidcheck", "rapidcheck/")

# What the core may not call or write; `::now(` in io/ is where real time enters.
IMPURE_CODE = [
    (r"::\s*now\s*\(", "ambient", "take the instant as a parameter; clocks are read in io/"),
    (r"\b(?:sleep_for|sleep_until|usleep|nanosleep)\b", "ambient", "give a deadline to the owner instead of sleeping"),
    (r"\bstd::(?:function|move_only_function)\b", "callback", "a part never calls out: put it into the outbox"),
    (r"\bstd::(?:random_device|getenv|time|system)\b", "ambient", "pass it in as a value from io/ or apps/"),
    (r"\bstd::(?:cout|cerr|clog|cin|printf|puts|fopen)\b", "ambient", "return text; io/ and apps/ print it"),
    (r"\b(?:throw|try|catch)\b", "exception", "an expected failure is a std::expected value"),
    (r"\bco_(?:await|yield|return)\b", "coroutine", "keep the state in a struct that can be printed"),
    (r"\bthread_local\b|\bvolatile\b", "thread", "the core belongs to one thread at a time"),
]

BANNED_WORDS = r"manager|helper|util|utils|utility|utilities|impl"
UNFINISHED = "|".join(["TO" + "DO", "FIX" + "ME", "XX" + "X", "HA" + "CK"])
LONG_FILE = 500
LONG_LINE = 120
# Not spelt out, because this file is looked at too.
CONFLICT = ("<" * 7 + " ", ">" * 7 + " ", "|" * 7 + " ")


def blank_literals(text: str) -> str:
    """`text` of a C++ file with comments and the contents of string and character literals replaced by blanks."""
    token = re.compile(
        r"//[^\n]*|/\*.*?\*/"
        r'|(?P<raw>\bR|\b(?:u8|u|U|L)R)"(?P<delimiter>[^()\\\s]*)\(.*?\)(?P=delimiter)"'
        r'|"(?:\\.|[^"\\\n])*"'
        r"|\b\d[\w.']*"  # numbers may contain ' as a separator
        r"|'(?:\\.|[^'\\\n])+'",
        re.DOTALL,
    )

    def blank(match: re.Match[str]) -> str:
        found = match.group(0)
        if found[0].isdigit():
            return found
        kept = re.sub(r"[^\n]", " ", found)
        return kept if found.startswith("/") else found[0] + kept[1:-1] + found[-1]

    return token.sub(blank, text)


def module_of(path: str) -> str | None:
    """The row of MAY_INCLUDE for a path below src, such as `firmware` for `firmware/personalities/grbl.cpp`."""
    for folder in MAY_INCLUDE:
        if path.startswith(folder + "/"):
            return folder
    return None


def in_core(file: SourceFile) -> bool:
    return file.path.startswith("src/") and not file.path.startswith(EDGES)


# --- the rules: each takes a file and yields what is wrong with it ---


def check_place(file: SourceFile) -> Iterator[Finding]:
    if not file.path.startswith("src/"):
        return
    folder = file.folder.removeprefix("src/") if file.folder != "src" else ""
    if folder not in MAY_INCLUDE and folder not in SUBFOLDERS:
        yield Finding(1, "tree", f"`{file.folder}` is no folder of docs/architecture.md section 3: move the file")
    if not file.is_cpp:
        yield Finding(1, "tree", "src holds .hpp and .cpp files only: move the file")


def check_file_name(file: SourceFile) -> Iterator[Finding]:
    if not file.path.startswith(("src/", "tests/", "bench/", "tools/", "examples/")):
        return
    if file.name in ("CMakeLists.txt", "README.md", "package-lock.json") or file.path.startswith("tests/corpus/"):
        return
    stem = file.name.split(".")[0]
    if not re.fullmatch(r"[a-z][a-z0-9]*(_[a-z0-9]+)*", stem):
        yield Finding(1, "file-name", "write the file name in snake_case")
    if re.search(rf"(?:^|_)(?:{BANNED_WORDS})(?:_|$)", stem):
        yield Finding(1, "file-name", "name the file for the main thing that it defines")


def check_includes(file: SourceFile, known: set[str]) -> Iterator[Finding]:
    if not file.is_cpp:
        return
    for number, line in enumerate(file.lines, 1):
        match = re.match(r'\s*#\s*include\s*([<"])([^>"]+)[>"]', line)
        if not match or not file.code[number - 1].lstrip().startswith("#"):
            continue
        quote, target = match.groups()
        advice = advice_on_own(file, target, known) if quote == '"' else advice_on_foreign(file, target)
        if advice:
            yield Finding(number, "include", advice)


def advice_on_own(file: SourceFile, target: str, known: set[str]) -> str | None:
    if not file.path.startswith("src/"):
        beside = posixpath.normpath(posixpath.join(file.folder, target))
        return None if {"src/" + target, beside} & known else f"`{target}` is neither below src nor beside this file"
    if "src/" + target not in known:
        return f"`{target}` is not below src: write the path from there"
    here, there = module_of(file.path[4:]), module_of(target)
    if here is None or there is None or here == there or there in MAY_INCLUDE[here]:
        return None
    if {here.split("/")[0], there.split("/")[0]} == {"sender", "firmware"}:
        return "sender and firmware meet only as bytes: no include from one to the other"
    return f"`{here}` may not include `{there}` (docs/architecture.md section 3)"


def advice_on_foreign(file: SourceFile, target: str) -> str | None:
    if file.is_test and target.startswith(TEST_LIBRARIES):
        return None
    if not in_core(file):
        return None
    if target.startswith(("boost/describe", "boost/mp11")) or FOREIGN_IN_CORE.get(target) == file.path:
        return None
    if target in IMPURE_HEADERS:
        return f"<{target}> belongs to io/ and apps/: the core has no threads, clocks, files or streams"
    if "/" in target or "." in target:
        return f"<{target}> belongs to io/ and apps/: the core includes the standard library and Boost.Describe"
    return None


def check_purity(file: SourceFile) -> Iterator[Finding]:
    if not file.is_cpp or not in_core(file):
        return
    for number, line in enumerate(file.code, 1):
        for pattern, rule, advice in IMPURE_CODE:
            if re.search(pattern, line):
                yield Finding(number, rule, advice)


def check_names(file: SourceFile) -> Iterator[Finding]:
    if not file.is_cpp:
        return
    camel = "|".join(word.capitalize() for word in BANNED_WORDS.split("|"))
    banned = re.compile(rf"(?:^|_)(?:{BANNED_WORDS})(?=_|$)|(?:{camel})(?=[A-Z_0-9]|$)")
    for number, line in enumerate(file.code, 1):
        if line.lstrip().startswith("#"):
            continue
        for match in re.finditer(r"(?<![\w])[A-Za-z_]\w*", line):
            word = match.group(0)
            if banned.search(word):
                yield Finding(number, "name", f"`{word}`: name it for what it does, without {banned.search(word)[0]}")
            before = line[: match.start()].rstrip()
            is_type = word in ("Data", "Info") and re.search(r"\b(?:class|struct|using)$", before)
            is_name = word.rstrip("_") in ("data", "info") and not before.endswith((".", "->", "::"))
            if is_type or is_name:
                yield Finding(number, "name", f"`{word}` says nothing: name what it holds")


def check_header(file: SourceFile) -> Iterator[Finding]:
    if file.name.endswith(".hpp") and (not file.lines or file.lines[0] != "#pragma once"):
        yield Finding(1, "header", "begin the header with `#pragma once`")


def check_tables(file: SourceFile) -> Iterator[Finding]:
    if file.folder not in TABLE_FOLDERS or file.is_test:
        return
    for number, line in enumerate(file.code, 1):
        match = re.search(r"\b(?:if|for|while|do|switch|goto)\b|\?", line)
        if match and not line.lstrip().startswith("#"):
            yield Finding(number, "table", f"`{match[0]}`: a table has no control flow; use a value or a named policy")


def check_form(file: SourceFile) -> Iterator[Finding]:
    counts_columns = file.is_cpp or file.name.endswith((".py", ".sh", ".cmake")) or file.name in (
        "CMakeLists.txt", "Makefile", "run")
    for number, line in enumerate(file.lines, 1):
        if "\t" in line and file.name != "Makefile":
            yield Finding(number, "form", "replace the tab by blanks")
        if line != line.rstrip() and not file.name.endswith(".talk"):
            yield Finding(number, "form", "remove the blanks (or carriage return) at the end of the line")
        if line.startswith(CONFLICT):
            yield Finding(number, "form", "a merge was left half done: settle it")
        if counts_columns and len(line) > LONG_LINE:
            yield Finding(number, "form", f"{len(line)} columns: break the line before column {LONG_LINE}")
        if file.name.endswith(".nc") and not line.isascii():
            yield Finding(number, "form", "G-code is ASCII")
    if file.text and not file.text.endswith("\n"):
        yield Finding(len(file.lines), "form", "end the file with a newline")


def check_length(file: SourceFile) -> Iterator[Finding]:
    if not file.name.endswith((".hpp", ".cpp", ".py", ".ts", ".svelte")) or len(file.lines) <= LONG_FILE:
        return
    if not any(re.match(r"\s*(?://|#) long: \S", line) for line in file.lines[:20]):
        yield Finding(1, "length", f"{len(file.lines)} lines: find the missing part, or say `// long: why` at the top")


def check_unfinished(file: SourceFile) -> Iterator[Finding]:
    for number, line in enumerate(file.lines, 1):
        match = re.search(rf"\b(?:{UNFINISHED})\b", line)
        if match:
            yield Finding(number, "unfinished", f"`{match[0]}`: finish it, or file an issue and remove the note")


def check_comments(file: SourceFile) -> Iterator[Finding]:
    if not file.is_cpp:
        return
    for number, line in enumerate(file.lines, 1):
        if re.match(r"\s*//\s*[-=*#/~]{4,}", line):
            yield Finding(number, "comment", "no banners: a section that needs one is a file of its own")


def check_portability(file: SourceFile) -> Iterator[Finding]:
    paths = re.compile(r"(?<![\w.~-])/(?:(?:work|root|farm)(?![\w-])|home/[a-z]|tmp/(?!kerf-))")
    hosts = re.compile(r"\bregistry\.[a-z]|\bdeb\.debian\.|\bnpmjs\.|\bpypi\.|\bproxy\.golang\.", re.IGNORECASE)
    for number, line in enumerate(file.lines, 1):
        if paths.search(line.replace("pty:///tmp/", "")):
            yield Finding(number, "machine", "a path of one machine: pass it in; examples are pty:///tmp/kerf-...")
        if hosts.search(line):
            yield Finding(number, "machine", "a registry's host: packages come from the machine's own sources")


def check_sleeps(file: SourceFile) -> Iterator[Finding]:
    if not file.is_test or file.path.startswith(("tests/live/", "tests/browser/")):
        return
    lines = file.code if file.is_cpp else file.lines
    for number, line in enumerate(lines, 1):
        if re.search(r"\b(?:sleep_for|sleep_until|usleep|nanosleep|time\.sleep)\b|^\s*sleep\s", line):
            yield Finding(number, "sleep", "pass the time in; only tests/live and tests/browser wait for real clocks")


RULES: list[Callable[[SourceFile], Iterator[Finding]]] = [
    check_place, check_file_name, check_purity, check_names, check_header, check_tables, check_form, check_length,
    check_unfinished, check_comments, check_portability, check_sleeps,
]

SKIPPED_FOLDERS = {".git", "build", "out", ".cache", "node_modules", "dist", "__pycache__"}


def read_tree(root: Path) -> Iterator[SourceFile]:
    """Every text file below `root`; what is no UTF-8 (fuzz inputs, pictures) is nobody's prose and is left out."""
    for path in sorted(root.rglob("*")):
        relative = path.relative_to(root)
        if SKIPPED_FOLDERS.intersection(relative.parts) or path.is_symlink() or not path.is_file():
            continue
        if relative.as_posix().startswith("tests/corpus/"):
            continue
        try:
            text = path.read_bytes().decode("utf-8")
        except UnicodeDecodeError:
            continue
        is_cpp = path.suffix in (".hpp", ".cpp")
        code = blank_literals(text).split("\n") if is_cpp else []
        lines = text.split("\n")
        if lines[-1] == "":
            lines.pop()
        yield SourceFile(relative.as_posix(), text, lines, code)


def main(arguments: list[str]) -> int:
    root = Path(arguments[0]) if arguments else Path(__file__).resolve().parent.parent
    files = list(read_tree(root))
    known = {file.path for file in files}
    violations = 0
    for file in files:
        findings = [finding for rule in RULES for finding in rule(file)]
        findings.extend(check_includes(file, known))
        violations += len(findings)
        for finding in sorted(findings):
            print(f"{file.path}:{finding.line}: {finding.rule}: {finding.advice}")
    print(f"tidy: {len(files)} files, {violations or 'no'} violation{'' if violations == 1 else 's'}")
    return 1 if violations else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
