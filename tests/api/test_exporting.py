"""rp.export: what is taken, what is refused, and that a folder is written whole or not at all."""

from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import pytest

import roadproof as rp
from exporting.kept import kept, motion, subject
from roadproof.evidence.drive_file import DriveFile, drive_data
from roadproof.evidence.judged import JudgedDrive
from roadproof.library.loading import bundled_library
from roadproof.recordings.export.registry import FORMATS
from roadproof.runtime.files import write_json
from roadproof.world.drive import Drive


@pytest.fixture
def drives(tmp_path: Path) -> Path:
    """Two drive files, and beside them evidence of another kind."""
    folder = tmp_path / "drives"
    for name in ("scenario-04-base", "scenario-12-ext"):
        write_json(folder / f"{name}.json", drive_data(kept()[name], {}))
    write_json(folder / "index.json", {"schema": "roadproof/index/1"})
    return folder


def contents(folder: Path) -> dict[str, bytes]:
    return {str(x.relative_to(folder)): x.read_bytes() for x in sorted(folder.rglob("*.*"))}


def test_a_folder_of_drives_in_every_format(drives: Path, tmp_path: Path) -> None:
    made = rp.export(drives, FORMATS, tmp_path / "out")
    assert {x.relative_to(made.folder).parts[0] for x in made.files} == {*FORMATS}
    assert {*made.files} == {x for x in made.folder.rglob("*.*") if x.is_file()}
    assert str(made) == f"2 drives as {', '.join(FORMATS)}: {len(made.files)} files in {made.folder}"
    frame = made.to_frame()
    assert frame.filter(format="highd")["files"].to_list()[0].startswith("highd/01_recordingMeta.csv")
    assert frame["vehicles"].unique().to_list() == ["SV=1 POV=2"]


def test_values_paths_and_files_are_the_same(drives: Path, tmp_path: Path) -> None:
    file = kept()["scenario-04-base"]
    given = (drives / "scenario-04-base.json", file, JudgedDrive(file, bundled_library()))
    each = [rp.export(x, "openscenario", tmp_path / f"{k}") for k, x in enumerate(given)]
    found = [contents(x.folder) for x in each]
    assert [*found[0]] == ["scenario-04-base.xodr", "scenario-04-base.xosc"]
    assert found[0] == found[1] == found[2]


def test_values_of_one_name_are_counted(tmp_path: Path) -> None:
    file = kept()["scenario-04-base"]
    made = rp.export([file, file], "csv", tmp_path / "out")
    assert [x.name for x in made.drives] == ["scenario-04-base", "scenario-04-base-2"]


def test_more_samples(tmp_path: Path) -> None:
    made = rp.export(kept()["scenario-04-base"], "csv", tmp_path / "out", rate=50)
    lines = made.files[0].read_text().splitlines()
    assert (len(lines), lines[3][:8]) == (1 + 2 * 301, "0.02,SV,")


def spoiled(**changes: object) -> DriveFile:
    return replace(kept()["scenario-04-base"], **changes)  # type: ignore[arg-type]


NAMED = Drive({"SV": motion((None, "0", "0")), "a b": motion((None, "0", "0"), start=("90", "2", "30", "0"))})


@pytest.mark.parametrize(
    ("ask", "error", "message"),
    [
        (lambda: rp.export([], "csv", "no"), rp.UsageError, "no drive to export"),
        (lambda: rp.export("nowhere.json", "csv", "no"), rp.InputError, "cannot read nowhere.json"),
        (lambda: rp.export(spoiled(), "cvs", "no"), rp.UsageError, "did you mean 'csv'"),
        (lambda: rp.export(spoiled(), (), "no"), rp.UsageError, "name a format: openscenario"),
        (lambda: rp.export(spoiled(), "csv", "no", rate=7), rp.UsageError, "rate=7: write samples"),
        (
            lambda: rp.export(spoiled(formula="false"), "csv", "no"),
            rp.InputError,
            "drive: the drive fails its check and is not exported: the formula does not hold",
        ),
        (
            lambda: rp.export(spoiled(formula="true", horizon=Fraction(1, 100)), "csv", "no"),
            rp.UsageError,
            "less than a step; write a greater rate",
        ),
        (
            lambda: rp.export(spoiled(formula="true", drive=Drive({})), "csv", "no"),
            rp.InputError,
            "the drive has no vehicle",
        ),
        (
            lambda: rp.export(spoiled(formula="true", drive=NAMED), "csv", "no"),
            rp.InputError,
            "vehicle 'a b': other tools want letters",
        ),
    ],
)
def test_what_cannot_be_exported_is_told(ask, error, message, tmp_path: Path, monkeypatch) -> None:
    monkeypatch.chdir(tmp_path)
    with pytest.raises(error, match=message):
        ask()
    assert not (tmp_path / "no").exists()


def test_nothing_is_written_where_one_of_several_is_refused(tmp_path: Path) -> None:
    turns = Drive({"SV": motion((None, "-10", "0"))})
    back = replace(subject().file, drive=turns, formula="true")
    with pytest.raises(rp.InputError, match="v_lon=-"):
        rp.export([kept()["scenario-04-base"], back], ["csv", "openscenario"], tmp_path / "out")
    assert not (tmp_path / "out").exists()
