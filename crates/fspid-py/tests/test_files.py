"""Nothing of the user's is lost: what Python writes is whole or not there, and never over what it is made of."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from conftest import ROOT

import fspid

Write = Callable[[fspid.Scenario, Path], object]

#: Everything that writes one file, with the ending that it has.
WRITERS: dict[str, tuple[Write, str]] = {
    "to_csv": (lambda scenario, path: scenario.simulate().to_csv(path), "csv"),
    "flight.save": (lambda scenario, path: scenario.simulate().save(path), "html"),
    "analysis.save": (lambda scenario, path: scenario.analyse().save(path), "html"),
    "out": (lambda scenario, path: scenario.tune(budget=4, out=path), "toml"),
    "history": (lambda scenario, path: scenario.tune(budget=4, history=path), "parquet"),
}

def tuning(folder: Path) -> Path:
    """A scenario with free numbers."""
    text = (ROOT / "crates/fspid-scenario/src/file/templates/tuning.toml").read_text()
    path = folder / "a.toml"
    path.write_text(text)
    return path


def naming(folder: Path) -> tuple[Path, Path]:
    """A scenario, and the rule table that it names."""
    templates = ROOT / "crates/fspid-scenario/src/file/templates"
    named = fspid.Scenario.preset("pitch-hold")._core.text.replace('table = "mirrored"', 'table = "rules.toml"')
    rules = folder / "rules.toml"
    rules.write_text((templates / "rule-table.toml").read_text())
    path = folder / "named.toml"
    path.write_text(named)
    return path, rules


def names(folder: Path) -> list[str]:
    return sorted(path.name for path in folder.iterdir())


@pytest.mark.parametrize("writer", WRITERS)
@pytest.mark.parametrize("way", ["itself", "another name", "hard link", "link", "other folder"])
def test_nothing_is_written_over_the_scenario_by_any_name(
    writer: str, way: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    write, ending = WRITERS[writer]
    path = tuning(tmp_path)
    before = path.read_bytes()
    scenario = fspid.Scenario.from_file(path)
    target = path
    if way == "another name":
        (tmp_path / "deep").mkdir()
        target = tmp_path / "deep" / ".." / "a.toml"
    elif way == "hard link":
        target = tmp_path / f"x.{ending}"
        os.link(path, target)
    elif way == "link":
        target = tmp_path / f"x.{ending}"
        target.symlink_to("a.toml")
    elif way == "other folder":
        monkeypatch.chdir(tmp_path)
        # One that is searched is read again, where it was.
        scenario = fspid.Scenario.from_file(path if writer in ("out", "history") else "a.toml")
        (tmp_path / "deep").mkdir()
        monkeypatch.chdir(tmp_path / "deep")
        target = Path("../a.toml")
    with pytest.raises(fspid.InputError, match="read"):
        write(scenario, target)
    assert path.read_bytes() == before


@pytest.mark.parametrize("writer", ["to_csv", "flight.save", "analysis.save"])
def test_nothing_is_written_over_a_file_that_the_scenario_names(writer: str, tmp_path: Path) -> None:
    path, rules = naming(tmp_path)
    before = rules.read_bytes()
    with pytest.raises(fspid.InputError, match="which was read"):
        WRITERS[writer][0](fspid.Scenario.from_file(path), rules)
    assert rules.read_bytes() == before
    # It was read; another scenario may be answered there.
    fspid.Scenario.preset("pitch-hold").simulate().to_csv(rules)
    assert rules.read_bytes() != before


def test_certificates_campaigns_and_contests_write_over_nothing_that_they_are_made_of(tmp_path: Path) -> None:
    path, _ = naming(tmp_path)
    path = path.rename(tmp_path / "pid.certificate.json")
    before = path.read_bytes()
    scenario = fspid.Scenario.from_file(path)
    with pytest.raises(fspid.InputError, match="which was read"):
        scenario.certify("PID").save(tmp_path)
    dispersions = [{"path": "controller.PID.kp", "distribution": "uniform", "lower": 0.8, "upper": 1.2, "relative": True}]
    dispersed = scenario.with_(dispersion=dispersions)
    for name in ("campaign.parquet", "shards/000000000-000000003.parquet"):
        out = tmp_path / name.replace("/", "-")
        (out / "shards").mkdir(parents=True)
        (out / name).symlink_to(path)
        with pytest.raises(fspid.Error, match="which was read"):
            dispersed.campaign(out, runs=4, shard_runs=4)
    assert path.read_bytes() == before
    campaign = dispersed.campaign(tmp_path / "run", runs=4, shard_runs=4)
    rows = Path(campaign.file).read_bytes()
    for own in (campaign.file, tmp_path / "run/campaign.json", path):
        with pytest.raises(fspid.InputError, match="which was read"):
            campaign.summary().save(own)
    assert Path(campaign.file).read_bytes() == rows and path.read_bytes() == before

    contest = tmp_path / "contest.json"
    contest.write_text(text := fspid.Scenario.preset("contest").toml)
    with pytest.raises(fspid.Error, match="which was read"):
        fspid.Scenario.from_file(contest).contest(tmp_path, seeds=1, budget=2)
    assert contest.read_text() == text


def test_design_and_history_need_a_file_each(tmp_path: Path) -> None:
    scenario = fspid.Scenario.from_file(tuning(tmp_path))
    (tmp_path / "b.toml").symlink_to("c.parquet")
    with pytest.raises(fspid.InputError, match="one file"):
        scenario.tune(budget=4, out=tmp_path / "b.toml", history=tmp_path / "c.parquet")
    assert names(tmp_path) == ["a.toml", "b.toml"]


@pytest.mark.parametrize("writer", WRITERS)
def test_a_link_stays_one_and_a_dash_is_a_file(writer: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    write, ending = WRITERS[writer]
    scenario = fspid.Scenario.from_file(tuning(tmp_path))
    link, target = tmp_path / f"x.{ending}", tmp_path / "deep" / f"y.{ending}"
    target.parent.mkdir()
    target.write_text("old")
    link.symlink_to(f"deep/y.{ending}")
    write(scenario, link)
    assert link.is_symlink() and target.stat().st_size > 3
    assert names(target.parent) == [target.name]
    monkeypatch.chdir(tmp_path)
    write(scenario, Path("-"))
    assert (tmp_path / "-").stat().st_size > 3


@pytest.mark.parametrize("writer", WRITERS)
def test_what_cannot_be_written_is_a_file_error_and_leaves_what_was_there(writer: str, tmp_path: Path) -> None:
    write, ending = WRITERS[writer]
    scenario = fspid.Scenario.from_file(tuning(tmp_path))
    full = tmp_path / f"full.{ending}"
    full.symlink_to("/dev/full")
    folder = tmp_path / f"folder.{ending}"
    folder.mkdir()
    for target in (full, folder, tmp_path / f"none/x.{ending}", Path(f"/proc/x.{ending}")):
        with pytest.raises(fspid.FileError) as raised:
            write(scenario, target)
        assert isinstance(raised.value, OSError) and isinstance(raised.value, fspid.Error)
        assert str(target) in str(raised.value)
    assert not any(name.startswith(".fspid-") for name in names(tmp_path))


#: Writes with a limit of 4 KiB for files, as a disk that is full has.
LIMITED = """
import resource, signal, sys
import fspid
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
scenario = fspid.Scenario.from_file("a.toml")
flight, certified = scenario.simulate(), None
resource.setrlimit(resource.RLIMIT_FSIZE, (4096, 4096))
for write in (lambda: flight.to_csv("x.csv"), lambda: flight.save("x.html"), lambda: scenario.analyse().save("y.html")):
    try:
        write()
    except fspid.FileError as error:
        assert "nothing there was changed" in str(error), error
    else:
        sys.exit("it was written")
"""


def test_a_disk_that_is_full_leaves_the_old_file_and_nothing_beside(tmp_path: Path) -> None:
    tuning(tmp_path)
    for name in ("x.csv", "x.html", "y.html"):
        (tmp_path / name).write_text("old")
    subprocess.run([sys.executable, "-c", LIMITED], cwd=tmp_path, check=True)
    assert [(tmp_path / name).read_text() for name in ("x.csv", "x.html", "y.html")] == ["old"] * 3
    assert names(tmp_path) == ["a.toml", "x.csv", "x.html", "y.html"]


def test_certificates_are_written_all_or_none(tmp_path: Path) -> None:
    certified = fspid.Scenario.preset("pitch-hold").certify()
    (first, *rest) = certified.certificates
    assert rest
    folder = tmp_path / "proofs"
    (folder / rest[-1]).mkdir(parents=True)
    with pytest.raises(fspid.FileError, match="it is a folder"):
        certified.save(folder)
    assert names(folder) == [rest[-1]]
    (folder / rest[-1]).rmdir()
    assert sorted(path.name for path in certified.save(folder)) == sorted([first, *rest]) == names(folder)


def test_a_damaged_answer_of_a_worker_takes_no_whole_part_away(tmp_path: Path) -> None:
    kp = {"path": "controller.PID.kp", "distribution": "uniform", "lower": 0.8, "upper": 1.2, "relative": True}
    scenario = fspid.Scenario.preset("pitch-hold").with_(dispersion=[kp])
    core = scenario.campaign(tmp_path / "run", runs=4, shard_runs=4)._core
    part = Path(core.part(0))
    before = part.read_bytes()
    core.put(0, before[:-100])
    assert part.read_bytes() == before
    part.unlink()
    with pytest.raises(fspid.Error, match="is not shard 0"):
        core.put(0, before[:-100])
    assert not part.exists()
