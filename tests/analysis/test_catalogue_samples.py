"""Samples that contradict themselves are no coverage: refused or noted as recordings are."""

import csv
import shutil
from collections.abc import Callable, Mapping
from pathlib import Path

import pytest

import roadproof as rp
from roadproof.analysis.catalogue import traces
from roadproof.analysis.catalogue.traces import digest_of
from roadproof.errors import InputError
from roadproof.recordings.evaluate.one_trace import read_pair, read_samples

SAMPLES = Path(__file__).parents[2] / "examples" / "catalogue" / "tests" / "samples"
Row = dict[str, str]


def in_kmh(row: Row, subject: Row) -> Row:
    return {**row, "v_lon": str(3.6 * float(row["v_lon"]))}


def with_a_jump(row: Row, subject: Row) -> Row:
    return {**row, "s": str(float(row["s"]) + 75 * (float(row["time"]) > 1))}


def through(row: Row, subject: Row) -> Row:
    """Whoever is not SV falls back through it."""
    if row["vehicle"] == "SV":
        return row
    time = float(row["time"])
    place, speed = float(subject["s"]) + 30 - 20 * time, float(subject["v_lon"]) - 20
    return {**subject, "vehicle": row["vehicle"], "s": str(place), "v_lon": str(speed)}


def changed(folder: Path, change: Callable[[Row, Row], Row] | None) -> Path:
    """The samples ``braking.csv`` with each row changed, and the road beside them."""
    rows = list(csv.DictReader((SAMPLES / "braking.csv").open()))
    subject: Mapping[str, Row] = {x["time"]: x for x in rows if x["vehicle"] == "SV"}
    path = folder / "braking.csv"
    with path.open("w") as file:
        writer = csv.DictWriter(file, list(rows[0]))
        writer.writeheader()
        writer.writerows(x if change is None else change(x, subject[x["time"]]) for x in rows)
    shutil.copy(SAMPLES / "braking_road.toml", folder)
    return path


@pytest.mark.parametrize("change", [in_kmh, with_a_jump])
def test_samples_that_contradict_themselves_are_refused_as_in_an_evaluation(
    change: Callable[[Row, Row], Row], tmp_path: Path
) -> None:
    path = changed(tmp_path, change)
    found = rp.catalogue(path, among="4", classes=False, jobs=1)
    assert found.missing == ("scenario_4",)
    assert found.exit_code == 10
    [fault] = found.tested.faults
    for read in (lambda: read_samples(path), lambda: rp.evaluate(tmp_path, jobs=1)):
        with pytest.raises(InputError) as refused:
            read()
        assert fault.told == f"cannot be read: {refused.value}"


def test_vehicles_in_one_place_are_noted(tmp_path: Path) -> None:
    path = changed(tmp_path, through)
    found = rp.catalogue(path, among="4", classes=False, jobs=1)
    [note] = found.notes
    assert note.startswith("braking: vehicles SV and POV overlap in ")
    assert note in str(found)
    assert found.as_data()["notes"] == [note]
    told = note.partition(" overlap in ")[2]
    for trace in (read_samples(path), read_pair(f"{path}:1,2")):
        assert [x.partition(" overlap in ")[2] for x in trace.notes if " overlap in " in x] == [told]


def test_samples_without_contradictions_have_no_notes(tmp_path: Path) -> None:
    path = changed(tmp_path, None)
    found = rp.catalogue(path, among="4", classes=False, jobs=1)
    assert (found.missing, found.notes) == ((), ())


def test_samples_begin_as_their_first_sample_does() -> None:
    path = SAMPLES / "braking.csv"
    first = {x["vehicle"]: x for x in reversed([*csv.DictReader(path.open())])}
    found = rp.catalogue(path, among="4", classes=False, jobs=1)
    [answer] = found.concrete
    assert answer.begins["v_lon(SV)"] == pytest.approx(float(first["SV"]["v_lon"]))
    assert answer.begins["v_lon(POV)"] == pytest.approx(float(first["POV"]["v_lon"]))
    apart = float(first["POV"]["s"]) - float(first["SV"]["s"])
    assert answer.begins["s(POV) - s(SV)"] == pytest.approx(apart)


def test_the_digest_of_samples_is_that_of_both_files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """It is empty where one of the files cannot be read."""
    path = changed(tmp_path, None)
    whole = digest_of(str(path))
    assert len(whole) == 64
    road = tmp_path / "braking_road.toml"
    road.write_text(road.read_text() + "\n")
    assert digest_of(str(path)) not in ("", whole)
    assert digest_of(str(tmp_path / "none.json")) == ""
    monkeypatch.setattr(traces, "files_of", lambda place: (path, tmp_path / "none.toml"))
    assert digest_of(str(path)) == ""
