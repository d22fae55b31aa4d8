"""What happens to files when something goes wrong while fspid writes them: matrix.py FSPID [--kills N] [--seed N] [--only COMMAND] [--out TABLE.md]

Each command that writes is run in a folder that holds what it wrote before from other numbers (old), and what it writes undisturbed is known
(new). Then it is disturbed. What must hold:

- every file that it writes is whole: old, or new, or not there where nothing was;
- the exit code is the one that docs/guide/exit-codes.md promises, and never a panic;
- the same command again, undisturbed, leaves exactly new, and nothing else beside it.

Faults that need a mount (a full disk, a folder that cannot be written) need root on Linux and are told where they were left out.
"""

import argparse
import dataclasses
import os
import pathlib
import random
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
PANIC = 101
INTERRUPTED, UNWRITTEN, WRONG = 130, 4, 2
# Longest that anything here may take, s; what takes longer hangs.
PATIENCE_S = 600


@dataclasses.dataclass
class Command:
    """A command that writes: its words, what makes it write other numbers, its outputs, and what has to be there first."""

    name: str
    words: list
    other: list
    outputs: list
    before: list = dataclasses.field(default_factory=list)
    # It keeps what it has and goes on with it: old files are not overwritten but refused.
    goes_on: bool = False
    # A folder of that name is where it writes to.
    into_folders: bool = False

    def is_folder(self):
        return "." not in self.outputs[0]


def commands():
    amplitude = ["--set", "setpoint.amplitude_deg=3"]
    return [
        Command("simulate", ["simulate", "pitch.toml", "--trace", "t.csv", "--report", "r.html"], amplitude, ["t.csv", "r.html"]),
        Command("analyse", ["analyse", "pitch.toml", "--report", "a.html"], amplitude, ["a.html"]),
        Command("certify", ["certify", "navion.toml", "--out", "certificates"], [], ["certificates"]),
        Command("verify", ["verify", "required.toml", "--junit", "v.xml"], ["--set", "ctms"], ["v.xml"]),
        Command(
            "campaign run",
            ["campaign", "run", "campaign.toml", "--runs", "600", "--shard-runs", "150", "--quiet", "--out", "c"],
            [],
            ["c"],
            goes_on=True,
        ),
        Command(
            "campaign report",
            ["campaign", "report", "done/campaign.parquet", "--out", "p.html"],
            ["--confidence", "0.9"],
            ["p.html"],
            before=[["campaign", "run", "campaign.toml", "--runs", "200", "--quiet", "--out", "done"]],
        ),
        Command(
            "campaign merge",
            ["campaign", "merge", "--out", "parts"],
            [],
            ["parts"],
            before=[
                ["campaign", "plan", "campaign.toml", "--runs", "300", "--shard-runs", "100", "--out", "parts"],
                *[["campaign", "shard", str(part), "--quiet", "--out", "parts"] for part in range(3)],
            ],
            goes_on=True,
        ),
        Command(
            "tune",
            ["tune", "tune.toml", "--budget", "80", "--quiet", "--out", "d.toml", "--history", "h.parquet"],
            ["--seed", "2"],
            ["d.toml", "h.parquet"],
            goes_on=True,
        ),
        Command(
            "contest",
            ["contest", "contest.toml", "--budget", "2", "--seeds", "1", "--quiet", "--out", "k"],
            [],
            ["k"],
            goes_on=True,
        ),
        Command("export", ["export", "pitch.toml", "--controller", "FSPID", "--to", "c", "--force", "--out", "flight"], amplitude, ["flight"]),
        Command("surface", ["surface", "tip.toml", "--out", "s.svg"], ["--input", "service=3"], ["s.svg"], into_folders=True),
        Command("audit", ["audit", "tip.toml", "--report", "u.html"], [], ["u.html"]),
        Command("manual", ["manual", "--out", "man"], [], ["man"]),
        Command("reproduce", ["reproduce", "--out", "paper"], [], ["paper"]),
    ]


class Place:
    """A folder in which a command runs."""

    def __init__(self, program, folder):
        self.program, self.folder = program, folder

    def start(self, words, **how):
        how.setdefault("stdout", subprocess.PIPE)
        return subprocess.Popen([self.program, *words], cwd=self.folder, stderr=subprocess.PIPE, **how)

    def run(self, words, **how):
        child = self.start(words, **how)
        try:
            _, told = child.communicate(timeout=PATIENCE_S)
        except subprocess.TimeoutExpired:
            child.kill()
            return None, "it hangs"
        return child.returncode, told.decode(errors="replace")

    def tree(self):
        """Every file below, by its name there."""
        files = sorted(it for it in self.folder.rglob("*") if it.is_file() or it.is_symlink())
        return {str(it.relative_to(self.folder)): it.read_bytes() for it in files}


class Trial:
    """A command with what it wrote before, what it writes, and how long it takes."""

    def __init__(self, program, command, work):
        self.program, self.command = program, command
        self.inputs = work / "inputs"
        self.inputs.mkdir(parents=True)
        inputs = Place(program, self.inputs)
        gather(inputs)
        for words in command.before:
            code, told = inputs.run(words)
            assert code == 0, (words, code, told)
        self.given = inputs.tree()
        undisturbed = self.copy(work / "new")
        begin = time.monotonic()
        self.code, told = undisturbed.run(command.words)
        self.takes_s = time.monotonic() - begin
        assert self.code in (0, 1), (command.words, self.code, told)
        self.new = undisturbed.tree()
        self.old = self.given
        if command.other:
            before = self.copy(work / "old")
            code, told = before.run([*command.words, *command.other])
            assert code in (0, 1), (command.other, code, told)
            self.old = before.tree()
        self.work, self.count, self.bitten = work, 0, 0

    def copy(self, folder):
        shutil.copytree(self.inputs, folder, symlinks=True)
        return Place(self.program, folder)

    def disturbed(self, with_old=True):
        """A new folder, with what was written before where the command overwrites it."""
        self.count += 1
        folder = self.work / f"try-{self.count}"
        use_old = with_old and self.command.other and not self.command.goes_on
        shutil.copytree(self.work / "old" if use_old else self.inputs, folder, symlinks=True)
        return Place(self.program, folder), (self.old if use_old else self.given)

    def wrong(self, place, before):
        """What is neither old nor new of the command's outputs."""
        found = []
        for name, content in place.tree().items():
            top = name.split("/")[0]
            if top not in self.command.outputs or content in (before.get(name), self.new.get(name)):
                continue
            # What it goes on with is its own affair, and so is a file of work beside an output, as long as it is cleared.
            if self.command.goes_on and name not in self.new:
                continue
            if name in self.new or name in before:
                found.append(f"{name} is neither old nor new ({len(content)} bytes)")
        lost = [name for name in before if name not in place.tree()]
        return found + [f"{name} is lost" for name in lost]

    def again(self, place, before):
        """What the same command, undisturbed, leaves wrong."""
        code, told = place.run(self.command.words)
        if code != self.code:
            return [f"again: exit code {code} in place of {self.code}: {told.strip()[:300]}"]
        tree, expected = place.tree(), {**before, **self.new}
        wrong = [f"again: {name} differs" for name in expected if tree.get(name) != expected[name]]
        return wrong + [f"again: {name} is left over" for name in tree if name not in expected]

    def judged(self, place, before, code, told, allowed):
        self.bitten += code != self.code
        wrong = [] if code in allowed else [f"exit code {code}, expected {sorted(map(str, allowed))}: {told.strip()[:300]}"]
        if "panicked" in told:
            wrong.append(f"a panic: {told.strip()[:300]}")
        wrong += self.wrong(place, before)
        wrong += self.again(place, before)
        if not wrong:
            shutil.rmtree(place.folder)
        return wrong


def gather(place):
    """The files that commands ask for."""
    code, told = place.run(["init", "pitch.toml"])
    assert code == 0, told
    scenarios = ROOT / "scenarios"
    for name, source in [
        ("campaign.toml", scenarios / "campaign.toml"),
        ("required.toml", scenarios / "requirements.toml"),
        ("navion.toml", scenarios / "gallery" / "navion-linear.toml"),
        ("tune.toml", scenarios / "gallery" / "tune-navion.toml"),
    ]:
        shutil.copy(source, place.folder / name)
    for template, name in [("contest", "contest.toml"), ("fuzzy-system", "tip.toml")]:
        code, told = place.run(["init", "--template", template, name])
        assert code == 0, told


def signalled(sent, allowed):
    """Ended by a signal after a part of its time."""

    def fault(trial, dice):
        place, before = trial.disturbed()
        child = place.start(trial.command.words)
        time.sleep(dice.uniform(0.0, 1.1 * trial.takes_s))
        child.send_signal(sent)
        _, told = child.communicate(timeout=PATIENCE_S)
        ends = {*allowed, trial.code}
        return trial.judged(place, before, child.returncode, told.decode(errors="replace"), ends)

    return fault


def small_files(trial, dice):
    """No file may grow beyond a size."""
    place, before = trial.disturbed()
    sizes = [len(content) for name, content in trial.new.items() if name.split("/")[0] in trial.command.outputs]
    most = dice.randrange(0, max(sizes) + 1)

    def limited():
        resource.setrlimit(resource.RLIMIT_FSIZE, (most, most))

    code, told = place.run(trial.command.words, preexec_fn=limited)
    return trial.judged(place, before, code, told, {UNWRITTEN, trial.code})


def full_disk(trial, dice):
    """The disk is full after a number of bytes."""
    place, before = trial.disturbed()
    size = sum(len(content) for content in trial.new.values()) + sum(len(content) for content in before.values())
    there = sum(4096 * (1 + len(content) // 4096) for content in place.tree().values())
    room = there + dice.randrange(0, 2 * size + 1)
    script = (
        'set -e; mount -t tmpfs -o "size=$1" none "$2.disk"; cp -a "$2/." "$2.disk/"; cd "$2.disk"; shift 2; code=0; "$@" || code=$?; '
        'cd /; rm -rf "$KEEP"; cp -a "$DISK" "$KEEP"; exit $code'
    )
    disk = pathlib.Path(f"{place.folder}.disk")
    disk.mkdir()
    ask = ["unshare", "-m", "bash", "-c", script, "bash", str(room), str(place.folder), trial.program, *trial.command.words]
    environment = {**os.environ, "KEEP": str(place.folder), "DISK": f"{disk}/."}
    done = subprocess.run(ask, capture_output=True, env=environment, timeout=PATIENCE_S)
    disk.rmdir()
    return trial.judged(place, before, done.returncode, done.stderr.decode(errors="replace"), {UNWRITTEN, trial.code})


def cannot_be_written(trial, _):
    """The folder is mounted so that nothing can be written."""
    place, before = trial.disturbed()
    script = 'mount --bind "$1" "$1"; mount -o remount,ro,bind "$1"; cd "$1"; shift; exec "$@"'
    ask = ["unshare", "-m", "bash", "-c", script, "bash", str(place.folder), trial.program, *trial.command.words]
    done = subprocess.run(ask, capture_output=True, timeout=PATIENCE_S)
    return trial.judged(place, before, done.returncode, done.stderr.decode(errors="replace"), {UNWRITTEN})


def closed_pipe(trial, _):
    """Nobody reads what it prints."""
    place, before = trial.disturbed()
    reading, writing = os.pipe()
    os.close(reading)
    child = place.start(trial.command.words, stdout=writing)
    os.close(writing)
    _, told = child.communicate(timeout=PATIENCE_S)
    return trial.judged(place, before, child.returncode, told.decode(errors="replace"), {UNWRITTEN, trial.code})


def full_device(trial, _):
    """What it prints goes to a device that is always full."""
    place, before = trial.disturbed()
    with open("/dev/full", "wb") as full:
        code, told = place.run(trial.command.words, stdout=full)
    return trial.judged(place, before, code, told, {UNWRITTEN, trial.code})


def folder_in_the_way(trial, _):
    """A folder stands where a file would go, or a file where a folder would."""
    place, _ = trial.disturbed(with_old=False)
    name = trial.command.outputs[0]
    target = place.folder / name
    if target.exists() or trial.command.into_folders:
        return []
    if trial.command.is_folder():
        target.write_bytes(b"in the way")
    else:
        target.mkdir()
        (target / "kept").write_bytes(b"in the way")
    before = place.tree()
    code, told = place.run(trial.command.words)
    wrong = [] if code in (WRONG, UNWRITTEN) else [f"exit code {code}: {told.strip()[:300]}"]
    if name not in told:
        wrong.append(f"it does not name {name}: {told.strip()[:300]}")
    lost = [it for it, content in before.items() if place.tree().get(it) != content]
    return wrong + [f"{it} is lost" for it in lost]


def two_at_once(trial, _):
    """The same command twice at the same time."""
    place, before = trial.disturbed()
    children = [place.start(trial.command.words) for _ in range(2)]
    wrong = []
    for child in children:
        _, told = child.communicate(timeout=PATIENCE_S)
        told = told.decode(errors="replace")
        # One of two that would go on with the same folder is refused.
        if child.returncode not in (trial.code, WRONG, UNWRITTEN):
            wrong.append(f"exit code {child.returncode}: {told.strip()[:300]}")
    if all(child.returncode != trial.code for child in children):
        wrong.append("neither came to an end")
    return wrong + trial.judged(place, before, trial.code, "", {trial.code})


def elsewhere(trial, _):
    """No home, no other settings, another language and time zone."""
    place, before = trial.disturbed()
    environment = {"LC_ALL": "tr_TR.UTF-8", "LANG": "de_DE", "TZ": "Pacific/Apia", "PATH": "/nowhere"}
    code, told = place.run(trial.command.words, env=environment)
    wrong = trial.judged(place, before, code, told, {trial.code})
    return wrong


def named(name):
    """Its first output has another name."""

    def fault(trial, _):
        place, before = trial.disturbed(with_old=False)
        output = trial.command.outputs[0]
        if output in {it.split("/")[0] for it in before}:
            return []
        ending = pathlib.Path(output).suffix.encode()
        other = name[: 255 - len(ending)] + ending
        words = [other if word == output else word for word in trial.command.words]
        code, told = place.run(words)
        if code in (WRONG, UNWRITTEN):
            return [] if told.strip() and place.tree() == before else [f"refused, and something is left: {sorted(set(place.tree()) - set(before))}"]
        if code != trial.code:
            return [f"exit code {code}: {told.strip()[:300]}"]
        there = {os.fsencode(it) for it in place.tree()}
        return [] if any(it.split(b"/")[0] == other for it in there) else ["nothing has the name"]

    return fault


def faults(kills):
    mounts = os.geteuid() == 0 and subprocess.run(["unshare", "-m", "true"], capture_output=True).returncode == 0
    found = {
        "killed": (signalled(signal.SIGKILL, {-signal.SIGKILL}), kills),
        "interrupted": (signalled(signal.SIGINT, {INTERRUPTED}), max(2, kills // 10)),
        "terminated": (signalled(signal.SIGTERM, {INTERRUPTED, -signal.SIGTERM}), max(2, kills // 10)),
        "file size limit": (small_files, max(3, kills // 10)),
        "full disk": (full_disk, max(3, kills // 10)),
        "read-only": (cannot_be_written, 1),
        "closed pipe": (closed_pipe, 1),
        "/dev/full": (full_device, 1),
        "folder in the way": (folder_in_the_way, 1),
        "two at once": (two_at_once, 2),
        "no HOME, other locale": (elsewhere, 1),
        "255 bytes": (named(b"n" * 255), 1),
        "not UTF-8": (named(b"n\xff\xfe"), 1),
    }
    if not mounts:
        for name in ["full disk", "read-only"]:
            print(f"{name}: left out, since nothing can be mounted here", file=sys.stderr)
            del found[name]
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("--kills", type=int, default=10, help="kills of each command; a tenth as many of what comes seldom")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", help="a command, by its name")
    parser.add_argument("--fault", help="a fault, by its name")
    parser.add_argument("--out", type=pathlib.Path, help="the table, as Markdown: how often, and in brackets how often the command was cut short by it")
    asked = parser.parse_args()
    dice = random.Random(asked.seed)
    every = {name: it for name, it in faults(asked.kills).items() if asked.fault in (None, name)}
    rows, broken = [], 0
    for command in commands():
        if asked.only not in (None, command.name):
            continue
        with tempfile.TemporaryDirectory() as work:
            trial = Trial(str(asked.program.resolve()), command, pathlib.Path(work))
            cells = []
            for name, (fault, times) in every.items():
                trial.bitten = 0
                wrong = [told for _ in range(times) for told in fault(trial, dice)]
                broken += bool(wrong)
                held = f"{times} ({trial.bitten})"
                cells.append(held if not wrong else f"**{len(wrong)} of {times}**")
                for told in dict.fromkeys(wrong):
                    print(f"{command.name}, {name}: {told}", file=sys.stderr)
            print(f"{command.name} ({trial.takes_s:.2f} s): {', '.join(f'{k} {v}' for k, v in zip(every, cells))}", flush=True)
            rows.append(f"| `{command.name}` | {' | '.join(cells)} |")
    head = f"| command | {' | '.join(every)} |\n| --- |{' --- |' * len(every)}"
    table = "\n".join([head, *rows]) + "\n"
    if asked.out:
        asked.out.write_text(table, encoding="utf-8")
    print(table)
    sys.exit(1 if broken else 0)


if __name__ == "__main__":
    main()
