#!/usr/bin/env python3
"""Counts the shape of src: how much code there is, and how often the same fact is written.

    shape.py [--list ROW] [REVISION …]

A column for each revision, or one for the working tree. --list prints the places behind a row of the last column.
Unit tests are left out where a row does not say otherwise. Places are found by their looks, not by a compiler: a count is good
for comparing revisions, and every place of a list is to be looked at.
"""

import argparse
import io
import os
import re
import statistics
import subprocess
import sys
import tarfile
import tomllib
from collections import Counter
from functools import cached_property
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
FOLDERS = ("src", "tests", "benches")

TOKENS = re.compile(
    r"""(?P<comment>//[^\n]*|/\*.*?\*/)
    |(?P<text>b?r(?P<hashes>\#*)".*?"(?P=hashes)|b?"(?:\\.|[^"\\])*"|b?'(?:\\(?:u\{\w+\}|x\w\w|.)|[^'\\\n])')""",
    re.DOTALL | re.VERBOSE,
)
TEST_ITEM = re.compile(r"#\[cfg\(test\)\]\s*(?:#\[[^\n]*\]\s*)*")
VISIBLE = r"(?:pub(?:\([^)]*\))? )?"
TYPE = re.compile(rf"^{VISIBLE}(?:struct|enum|union|trait|type) (\w+)", re.MULTILINE)
KINDS = ("LinearModel", "Linear", "Model")

# B = λ² + bλ + 1 and A = a_n + a_v (b + λ), or A at a point where λ has a name of its own.
B_FORMS = (
    r"\[1\.0, [\w.]*\bb, 1\.0\]",
    r"\b(\w+) \* \(\1 \+ [\w.]*\bb\) \+ 1\.0",
    r"\b(?![ab]\b)(\w+) \* \1 [+-] \(?[\w.]*\bb\b",
    r"\b(\w+) \* \1 \+ 1\.0 - \(a_n",
)
A_FORMS = (
    r"a_n \+ [\w.]*a_v \* ",
    r"\bb \* [\w.]*a_v \+ [\w.]*a_n",
    r"a_v\.mul_add\([^)]*a_n",
    r"a_n \+ \([\w.]*b \+ lambda\)",
    r"a_n, [\w.]*a_v \* [\w.]*b\b",
    r"lambda \* [\w.]*a_v \+ [\w.]*a_n",
)
WRITES_A_OR_B = re.compile("|".join(f"(?:{form})" for form in A_FORMS) + "|" + B_FORMS[0] + "|" + B_FORMS[1])
WRITES_B = [re.compile(form) for form in B_FORMS[1:]]


def blanked(text: str) -> str:
    """A text of the same lines and no letters."""
    return re.sub(r"[^\n]", " ", text)


def end_of(code: str, start: int, stops: str) -> int:
    """Where the first of these characters stands outside brackets; the end where none does."""
    depth = 0
    for place in range(start, len(code)):
        letter = code[place]
        if depth == 0 and letter in stops:
            return place
        depth += (letter in "([{") - (letter in ")]}")
    return len(code)


def block(code: str, start: int) -> tuple[int, int]:
    """The block of an item, braces included; an empty one where it ends with a semicolon."""
    opened = end_of(code, start, "{;")
    if code[opened : opened + 1] != "{":
        return opened, opened
    return opened, end_of(code, opened + 1, "}") + 1


class File:
    """A file of Rust, with its comments and texts blanked."""

    def __init__(self, path: str, text: str):
        self.path = path
        self.text = text
        self.whole = TOKENS.sub(lambda t: blanked(t[0]) if t["comment"] else f'"{blanked(t[0][1:-1])}"', text)
        self.code = self.whole
        self.test_modules = []
        while found := TEST_ITEM.search(self.code):
            start, end = block(self.code, found.end())
            item = re.match(rf"{VISIBLE}mod (\w+);", self.code[found.end() :])
            if item:
                self.test_modules.append(item[1])
            end = max(end, start + 1)
            self.code = self.code[: found.start()] + blanked(self.code[found.start() : end]) + self.code[end:]

    def place(self, at: int, what: str = "") -> str:
        return f"{self.path}:{self.code.count(chr(10), 0, at) + 1} {what}".rstrip()

    def lines(self, start: int = 0, end: int | None = None) -> int:
        """Lines of code, without comments and blanks."""
        return sum(1 for line in self.code[start:end].splitlines() if line.strip())

    @cached_property
    def functions(self) -> list[tuple[str, int, int, int]]:
        """Those with a body: the name, where it starts, where its body starts, where it ends."""
        found = []
        for head in re.finditer(r"\bfn (\w+)", self.code):
            start, end = block(self.code, head.end())
            if end > start:
                found.append((head[1], head.start(), start, end))
        return found

    def matches(self, pattern: str, tests: bool = False) -> list[str]:
        code = self.whole if tests else self.code
        return [self.place(found.start(), found[0].strip()) for found in re.finditer(pattern, code, re.MULTILINE)]


class Shape:
    """All files of a revision."""

    def __init__(self, texts: dict[str, str], manifest: str):
        self.files = [File(path, text) for path, text in sorted(texts.items())]
        self.manifest = tomllib.loads(manifest)
        tests = set()
        for file in self.files:
            folder, name = os.path.split(file.path)
            inside = folder if name in ("mod.rs", "lib.rs", "main.rs") else os.path.join(folder, name[:-3])
            for module in file.test_modules:
                tests.add(os.path.join(inside, module))
        inside = [f for f in self.files if f.path.startswith("src/")]
        self.src = [f for f in inside if not any(f.path[:-3] == t or f.path.startswith(f"{t}/") for t in tests)]

    def all(self, pattern: str) -> list[str]:
        return [place for file in self.src for place in file.matches(pattern)]

    def with_tests(self, pattern: str) -> list[str]:
        return [place for file in self.files for place in file.matches(pattern, tests=True)]

    def function_lines(self) -> list[int]:
        return [f.lines(start, end) for f in self.src for _, start, _, end in f.functions]

    def with_memory_and_latency(self) -> list[str]:
        found = []
        for file in self.src:
            for head in re.finditer(rf"^{VISIBLE}struct (\w+)", file.code, re.MULTILINE):
                fields = re.findall(r"\b(\w+):(?!:)", file.code[slice(*block(file.code, head.end()))])
                if {"memory", "latency"} <= set(fields):
                    found.append(file.place(head.start(), head[1]))
        return found

    def writes_a_or_b(self) -> list[str]:
        found = []
        for file in self.src:
            for name, start, body, end in file.functions:
                code = " ".join(file.code[body:end].split())
                if WRITES_A_OR_B.search(code) or any(form.search(code) for form in WRITES_B):
                    found.append(file.place(start, name))
        return found

    def twice_for_the_letter(self) -> list[str]:
        """Traits that two types are, one of them beyond the letter by its name or its file."""
        traits, types = {}, {}
        for file in self.src:
            for head in re.finditer(rf"^{VISIBLE}trait (\w+)", file.code, re.MULTILINE):
                traits.setdefault(head[1], []).append(file.place(head.start()))
        for file in self.src:
            for head in re.finditer(r"^impl\b(?:<[^{]*?>)? (?:\w+::)*(\w+)(?:<[^{]*?>)? for ([^{]+)\{", file.code, re.MULTILINE):
                if head[1] in traits:
                    # Of traits of one name it is the one nearest to it.
                    near = max(traits[head[1]], key=lambda place: len(os.path.commonprefix([place, file.path])))
                    types.setdefault((head[1], near), []).append((" ".join(head[2].split()), file.path))
        found = []
        for (name, place), pair in sorted(types.items()):
            beyond = [bool(re.search(r"general|beyond|System|RootCounter", f"{path} {of}")) for of, path in pair]
            if len(pair) == 2 and sum(beyond) == 1:
                found.append(f"{place} {name}: {', '.join(of for of, _ in pair)}")
        return found

    def matches_on_kind(self) -> list[str]:
        kinds = [kind for kind in KINDS if self.all(rf"^{VISIBLE}enum {kind}\b")]
        found = []
        for file in self.src:
            code = file.code
            for kind in kinds:
                for head in re.finditer(rf"^impl {kind} ", code, re.MULTILINE):
                    start, end = block(code, head.start())
                    code = code[:start] + code[start:end].replace("Self::", f"{kind}::") + code[end:]
            of_kind = rf"\b(?:{'|'.join(kinds)})::[A-Z]\w*"
            for head in re.finditer(r"\bmatch ", code):
                start, end = block(code, head.start())
                body = re.sub(r"=> \{", "=>{", code[start:end])
                if re.search(rf"^\s*[^=\n]*{of_kind}[^=]*=>", body, re.MULTILINE):
                    found.append(file.place(head.start(), "match"))
            for head in re.finditer(rf"\blet [^;={{]*{of_kind}[^;=]*=|\bmatches!\([^;]*?{of_kind}", code):
                found.append(file.place(head.start(), head[0].split("(")[0].split()[0]))
        return found

    def calls(self, names: str) -> list[str]:
        return self.all(rf"(?<!fn )\b(?:{names})\(")

    def with_tuple_arguments(self) -> list[str]:
        found = []
        for file in self.src:
            for name, start, body, _ in file.functions:
                opened = file.code.find("(", start)
                arguments = file.code[opened + 1 : min(end_of(file.code, opened + 1, ")"), body)]
                if re.search(r"(?<![\w>])\((?!\))", re.sub(r"\bFn(?:Mut|Once)?\(", "F(", arguments)):
                    found.append(file.place(start, name))
        return found

    @cached_property
    def homonyms(self) -> dict[str, list[str]]:
        places = {}
        for file in self.src:
            for head in TYPE.finditer(file.code):
                places.setdefault(head[1], []).append(file.place(head.start()))
        return {name: at for name, at in sorted(places.items()) if len(at) > 1}

    def homonyms_that_meet(self) -> list[str]:
        """Files that use a name of several types from two places, or use it and define it."""
        found = []
        for file in self.src:
            names = Counter()
            for head in re.finditer(r"^\s*(?:pub(?:\([^)]*\))? )?use ([^;]+);", file.code, re.MULTILINE):
                names.update(re.findall(r"\b([A-Z]\w*)\b(?! as _)(?!::)", re.sub(r" as \w+", "", head[1])))
            names.update(set(TYPE.findall(file.code)))
            found += [f"{file.path} {name}" for name in sorted(names) if names[name] > 1 and name in self.homonyms]
        return found

    def error_types(self) -> list[str]:
        derived = r"#\[derive\([^)]*\bError\b[^)]*\)\]\s*(?:#\[[^\n]*\]\s*)*pub[^\n]*"
        return [place.replace("\n", " ") for place in self.all(rf"{derived}|^impl\b[^\n]*\bError for \w+")]

    def doc_examples(self) -> list[str]:
        found = []
        for file in self.src:
            inside = False
            for number, line in enumerate(file.text.splitlines(), 1):
                fence = re.match(r"\s*//[/!]\s*```(\S*)", line)
                if fence and not inside and re.fullmatch(r"(?:rust|should_panic|no_run)?", fence[1]):
                    found.append(f"{file.path}:{number}")
                inside ^= bool(fence)
        return found

    def test_binaries(self) -> list[str]:
        named = {of["path"] for of in self.manifest.get("test", []) if "path" in of}
        tops = {f.path for f in self.files if re.fullmatch(r"tests/[^/]+(?:\.rs|/main\.rs)", f.path)}
        return sorted(named | tops)


ROWS = {
    "lines": ("lines of code", lambda s: sum(f.lines() for f in s.src)),
    "files": ("files", lambda s: [f"{f.path} {f.lines()}" for f in s.src]),
    "functions": ("functions", lambda s: [f.place(at, name) for f in s.src for name, at, _, _ in f.functions]),
    "median": ("median lines of a function", lambda s: statistics.median(s.function_lines())),
    "memory-latency": ("structs with memory and latency", Shape.with_memory_and_latency),
    "a-or-b": ("functions that write A or B", Shape.writes_a_or_b),
    "twice": ("traits for the letter and one other", Shape.twice_for_the_letter),
    "kind": ("matches on the kind of linear model", Shape.matches_on_kind),
    "late": ("calls of late", lambda s: s.all(r"\.late\(\)")),
    "beyond": (
        "calls that ask beyond the letter or of a file",
        lambda s: s.calls("beyond_letter|has_state|own_system|system_in|is_of_letter|check_of_letter|is_beyond"),
    ),
    "no-memory": ("memory: 0.0, with tests", lambda s: s.with_tests(r"\bmemory: 0\.0")),
    "problems": (
        "Problem literals, with tests",
        lambda s: s.with_tests(r"(?<!struct )(?<!enum )(?<!impl )(?<!for )(?<!> )(?<!let )\bProblem \{"),
    ),
    "drafts": ("types called Draft", lambda s: s.all(r"^(?:struct|enum) Draft\b")),
    "tuples": ("functions with tuples as arguments", Shape.with_tuple_arguments),
    "homonyms": ("names of several types", lambda s: [f"{name}: {', '.join(at)}" for name, at in s.homonyms.items()]),
    "meet": ("of those, met in one file", Shape.homonyms_that_meet),
    "pub": ("pub items", lambda s: s.all(r"^\s*pub (?:(?:const|unsafe|async) )*(?:fn|struct|enum|union|trait|type|const|static|mod|use) ?\w*")),
    "pub-fields": ("pub fields", lambda s: s.all(r"^\s+pub \w+:(?!:)")),
    "errors": ("types of errors", Shape.error_types),
    "examples": ("examples in comments that run", Shape.doc_examples),
    "tests": ("test binaries", Shape.test_binaries),
    "long": ("long files", lambda s: [f.path for f in s.src if "//! Longer than most files" in f.text]),
}


def at_revision(revision: str) -> Shape:
    """The shape of a revision, read from git."""
    done = subprocess.run(
        ["git", "-C", ROOT, "archive", revision, *FOLDERS, "Cargo.toml"], capture_output=True, check=False
    )
    if done.returncode != 0:
        sys.exit(f"{revision}: {done.stderr.decode()}")
    with tarfile.open(fileobj=io.BytesIO(done.stdout)) as archive:
        texts = {
            entry.name: archive.extractfile(entry).read().decode()
            for entry in archive
            if entry.isfile() and entry.name.endswith((".rs", "Cargo.toml"))
        }
    manifest = texts.pop("Cargo.toml")
    return Shape({name: text for name, text in texts.items() if name.endswith(".rs")}, manifest)


def of_working_tree() -> Shape:
    """The shape of the files as they are."""
    paths = [path for folder in FOLDERS for path in (ROOT / folder).rglob("*.rs") if "target" not in path.parts[len(ROOT.parts) :]]
    texts = {str(path.relative_to(ROOT)): path.read_text(encoding="utf-8") for path in paths}
    return Shape(texts, (ROOT / "Cargo.toml").read_text(encoding="utf-8"))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--list", choices=ROWS, metavar="ROW", help=f"one of {', '.join(ROWS)}")
    parser.add_argument("revisions", nargs="*", metavar="REVISION")
    given = parser.parse_args()
    shapes = {revision: at_revision(revision) for revision in given.revisions} or {"now": of_working_tree()}
    if given.list:
        found = ROWS[given.list][1](list(shapes.values())[-1])
        print("\n".join(found) if isinstance(found, list) else found)
        return
    print(f"{'':15}{'':47}" + "".join(f"{name:>10.9}" for name in shapes))
    for key, (label, row) in ROWS.items():
        found = [row(shape) for shape in shapes.values()]
        counts = [len(one) if isinstance(one, list) else one for one in found]
        print(f"{key:15}{label:47}" + "".join(f"{count:>10,g}" if count == int(count) else f"{count:>10}" for count in counts))


if __name__ == "__main__":
    main()
