#!/usr/bin/env python3
"""Changes the code as check.sh does, all changes built into one program that makes the one it is told: a change costs its tests alone.

    at_once.py FILE… [-- FILTER…]   files of one crate; of its tests those whose names have one of the words
    at_once.py crates/fspid-lti/src/frequency/*.rs -- frequency:: loops::
    at_once.py --again LOG FILE… -- FILTER…     of all changes those alone whose names a log of before calls missed
    at_once.py --also CRATE FILE… -- FILTER…    tests of another crate as well, which use the files through what they export

The body of each function becomes a choice among itself and its changes (as cargo-mutants, from the registry, lists them), in a copy
of the repository under target/mutation. Changes that do not compile are found by the compiler and left out, all at once. Not for
crates without the standard library, whose changes check.sh asks; and changes of constants and of functions that answer an `impl`
cannot be chosen: they are told, and not asked.

Ends with 1 where a change survives that equivalent.txt does not explain.
"""

import argparse
import contextlib
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import threading
from collections import Counter, defaultdict
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).parents[2]
WORK = ROOT / "target/mutation/at-once"
COPY, TARGET, TOOLS = WORK / "copy", WORK / "target", ROOT / "target/tools"
# A test that takes so much longer than without a change does not end.
LONGEST_S = 60
CHOICE = '''//! Which change is made: the one whose number the variable MUTANT has.
use std::sync::LazyLock;
static ID: LazyLock<u32> = LazyLock::new(|| std::env::var("MUTANT").ok().and_then(|it| it.parse().ok()).unwrap_or(0));
#[inline]
pub(crate) fn id() -> u32 {
    *ID
}
'''


class Body(NamedTuple):
    """Where the body of an outermost function lies in a file."""

    file: str
    begin: int
    end: int


class Tests(NamedTuple):
    """A program of tests and the folder of its crate, in which it runs."""

    program: str
    folder: Path


class Change(NamedTuple):
    """One change; the body that it is in, if that can be chosen."""

    number: int
    name: str
    line: int
    begin: int
    end: int
    replacement: str
    body: Body | None


def behind(text: str, at: int) -> int:
    """The place behind a comment or a literal that begins here; here where none does."""
    if text.startswith("//", at):
        end = text.find("\n", at)
        return len(text) if end < 0 else end
    if text.startswith("/*", at):
        return text.index("*/", at) + 2
    if found := re.compile(r'b?r(#*)"').match(text, at):
        end = '"' + found.group(1)
        return text.index(end, found.end()) + len(end)
    if found := re.compile(r'b?"(?:\\.|[^"\\])*"|\'(?:\\.[^\']*|[^\'\\])\'', re.S).match(text, at):
        return found.end()
    return at


def body_of(text: str, begin: int, end: int) -> int:
    """The brace that opens the body of the function between two places, attributes before it left out."""
    depth, at, is_named = 0, begin, False
    while at < end:
        if (after := behind(text, at)) != at:
            at = after
            continue
        letter = text[at]
        depth += (letter in "([") - (letter in ")]")
        is_named = is_named or re.compile(r"(?<!\w)fn\b").match(text, at) is not None
        if letter == "{" and depth == 0 and is_named:
            return at
        at += 1
    raise SystemExit(f"a function without a body: {text[begin:begin + 60]!r}")


def bodies(file: str, text: str, spans: set[tuple[int, int]]) -> dict[tuple[int, int], Body | None]:
    """The bodies of outermost functions; None where a body cannot be a choice."""
    outermost = [it for it in spans if not any(other != it and other[0] <= it[0] and it[1] <= other[1] for other in spans)]
    found = {}
    for begin, end in outermost:
        brace = body_of(text, begin, end)
        head = re.sub(r"//[^\n]*", "", text[begin:brace])
        answers_impl = "->" in head and "impl " in head.rsplit("->", 1)[1]
        can_choose = not answers_impl and not re.search(r"\bconst\s+fn\b", head)
        found[begin, end] = Body(file, brace, end) if can_choose else None
    return found


def listed(files: list[str], texts: dict[str, str]) -> list[Change]:
    """All changes of files, numbered from 1."""
    path = f"{TOOLS / 'bin'}:{os.environ['PATH']}"
    names = [word for file in files for word in ("--file", file)]
    command = ["cargo", "mutants", "--list", "--json", "--workspace", *names]
    told = json.loads(subprocess.check_output(command, cwd=ROOT, env={**os.environ, "PATH": path}))
    lines = {file: [0, *(at + 1 for at, letter in enumerate(text) if letter == "\n")] for file, text in texts.items()}

    def span(file: str, where: dict) -> tuple[int, int]:
        begin, end = where["start"], where["end"]
        return lines[file][begin["line"] - 1] + begin["column"] - 1, lines[file][end["line"] - 1] + end["column"] - 1

    functions = defaultdict(set)
    for one in told:
        if one["function"]:
            functions[one["file"]].add(span(one["file"], one["function"]["span"]))
    choices = {file: bodies(file, texts[file], functions[file]) for file in texts}
    changes = []
    for number, one in enumerate(told, 1):
        begin, end = span(one["file"], one["span"])
        within = [body for body in choices[one["file"]].values() if body and body.begin < begin and end <= body.end]
        name = re.sub(r"^([^:]+):\d+:\d+: ", r"\1: ", one["name"])
        body = within[0] if within and one["function"] else None
        changes.append(Change(number, name, one["span"]["start"]["line"], begin, end, one["replacement"], body))
    return changes


def written(file: str, text: str, changes: list[Change]) -> dict[int, int]:
    """Writes a file of the copy with its choices; answers which change each of its lines is of."""
    by_body = defaultdict(list)
    for change in changes:
        if change.body and change.body.file == file:
            by_body[change.body].append(change)
    parts, at, line, of_line = [], 0, 1, {}

    def put(part: str) -> range:
        nonlocal line
        first, line = line, line + part.count("\n")
        parts.append(part)
        return range(first, line)

    for body, each in sorted(by_body.items()):
        put(text[at:body.begin] + "{ match crate::mutant::id() {\n")
        for change in each:
            before, after = text[body.begin:change.begin], text[change.end:body.end]
            for place in put(f"{change.number} => {before} {change.replacement} {after},\n"):
                of_line[place] = change.number
        put(f"_ => {text[body.begin:body.end]} }} }}")
        at = body.end
    put(text[at:])
    (COPY / file).write_text("".join(parts))
    return of_line


def expanded(span: dict) -> list[dict]:
    """A span, and where the macros that it comes of are called."""
    return [span, *(expanded(span["expansion"]["span"]) if span["expansion"] else [])]


def compiled(packages: list[str], places: dict[tuple[str, int], int]) -> tuple[set[int], list[Tests]]:
    """Builds the tests of the copy: numbers of changes that do not compile, and the programs where all do."""
    chosen = [word for package in packages for word in ("-p", package)]
    command = ["cargo", "test", *chosen, "--lib", "--tests", "--all-features", "--no-run", "--locked", "--message-format=json"]
    environment = {**os.environ, "CARGO_TARGET_DIR": str(TARGET), "CARGO_INCREMENTAL": "0", "RUSTFLAGS": "--cap-lints=warn -Awarnings"}
    done = subprocess.run(command, cwd=COPY, env=environment, capture_output=True, text=True)
    wrong, programs, others = set(), [], []
    for told in map(json.loads, done.stdout.splitlines()):
        if told["reason"] == "compiler-artifact" and told.get("executable") and told["profile"]["test"]:
            programs.append(Tests(told["executable"], Path(told["manifest_path"]).parent))
        if told["reason"] != "compiler-message" or told["message"]["level"] != "error":
            continue
        spans = sorted(told["message"]["spans"], key=lambda it: not it["is_primary"])
        spans = [place for span in spans for place in expanded(span)]
        hit = [places[where] for it in spans if (where := (it["file_name"], it["line_start"])) in places]
        wrong.update(hit[:1])
        if not hit:
            others.append(told["message"]["rendered"] or "")
    if done.returncode and not wrong:
        raise SystemExit("".join(others[:5]) or done.stderr[-3000:])
    return wrong, programs


def asked(programs: list[Tests], filters: list[str], number: int, longest_s: float) -> str:
    """What tests make of a change: caught, missed or too long."""
    # One seed, so that a change that is noticed is noticed again.
    environment = {**os.environ, "MUTANT": str(number), "PROPTEST_RNG_SEED": "1"}
    begin = {"env": environment, "start_new_session": True, "text": True}
    for program, folder in programs:
        is_too_long = threading.Event()
        with subprocess.Popen([program, *filters], cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, **begin) as run:

            def end() -> None:
                # Programs that a test has begun are of its group.
                with contextlib.suppress(ProcessLookupError):
                    os.killpg(run.pid, signal.SIGKILL)

            watch = threading.Timer(longest_s, lambda: (is_too_long.set(), end()))
            watch.start()
            # The first test that fails is enough: the others need not be waited for.
            fails = any(line.rstrip().endswith("... FAILED") for line in run.stdout)
            watch.cancel()
            if fails:
                end()
                return "caught"
        if is_too_long.is_set():
            return "too long"
        if run.returncode:
            return "caught"
    return "missed"


def copied() -> None:
    """What git knows, or would, as it is now; what was copied and is the same stays as old as it is."""
    told = subprocess.check_output(["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"], cwd=ROOT, text=True)
    names = set(filter(None, told.split("\0")))
    # A module that has become a folder would be there twice.
    for stale in COPY.glob("crates/**/*.rs"):
        if str(stale.relative_to(COPY)) not in names:
            stale.unlink()
    for name in names:
        ours, theirs = ROOT / name, COPY / name
        if ours.is_file() and not (theirs.is_file() and theirs.read_bytes() == ours.read_bytes()):
            theirs.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(ours, theirs)


def built(files: list[str], crate: str, also: list[str]) -> tuple[list[Change], set[int], list[Tests]]:
    """All changes, numbers of those that do not compile, and the tests' programs with all others."""
    texts = {file: (ROOT / file).read_text() for file in files}
    changes, unviable = listed(files, texts), set()
    library = COPY / crate / "src/lib.rs"
    library.with_name("mutant.rs").write_text(CHOICE)
    if "mod mutant;" not in library.read_text():
        library.write_text(library.read_text() + "\nmod mutant;\n")
    while True:
        left = [it for it in changes if it.number not in unviable]
        places = {(file, line): number for file in files for line, number in written(file, texts[file], left).items()}
        print(f"building {sum(it.body is not None for it in left)} changes", flush=True)
        wrong, programs = compiled([Path(crate).name, *also], places)
        if not wrong:
            return changes, unviable, programs
        unviable |= wrong


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("files", nargs="+", metavar="FILE")
    parser.add_argument("--again", metavar="LOG", type=Path)
    parser.add_argument("--also", metavar="CRATE", action="append", default=[])
    words, filters = sys.argv[1:], []
    if "--" in words:
        words, filters = words[: words.index("--")], words[words.index("--") + 1:]
    options = parser.parse_args(words)
    files = [str(Path(file)) for file in options.files]
    again = options.again and set(re.findall(r"(?m)^missed: (.*?)(?:, in line \d+)?$", options.again.read_text()))
    [crate] = {"/".join(Path(file).parts[:2]) for file in files}
    install = ["cargo", "install", "cargo-mutants", "--version", "27.1.0", "--locked", "--debug", "--quiet", "--root", TOOLS]
    subprocess.run(install, check=True)
    copied()
    changes, unviable, programs = built(files, crate, options.also)
    if asked(programs, filters, 0, 3600) != "missed":
        raise SystemExit("the tests fail without a change")
    found = {}
    for change in changes:
        if change.body and change.number not in unviable and (again is None or change.name in again):
            found[change] = asked(programs, filters, change.number, LONGEST_S)
            if found[change] == "missed":
                print(f"missed: {change.name}, in line {change.line}", flush=True)
    if not found:
        raise SystemExit("no change is to be asked" + (f": none that {options.again} calls missed is in these files" if options.again else ""))
    lines = (ROOT / "checks/mutation/equivalent.txt").read_text().splitlines()
    explained = {line.split("\t")[0] for line in lines if not line.startswith("#")}
    missed = [change.name for change, what in found.items() if what == "missed"]
    left = sorted({name for name in missed if name not in explained})
    count = Counter(found.values())
    print(
        f"caught {count['caught']}, survived {len(missed)}, of which explained {sum(it in explained for it in missed)}; "
        f"do not compile {len(unviable)}, ran too long {count['too long']}, not asked {sum(it.body is None for it in changes)}"
    )
    for name in left:
        print(f"nobody noticed, and nobody explains: {name}")
    return 1 if left else 0


sys.exit(main())
