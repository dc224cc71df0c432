"""Drive files that are not what they say, or were made with other values than are asked for."""

import json
from pathlib import Path

import roadproof as rp

BRAKING = Path(__file__).parents[2] / "examples" / "catalogue" / "tests" / "drives" / "braking.json"


def with_formula(folder: Path, formula: str) -> Path:
    path = folder / "braking.json"
    data = json.loads(BRAKING.read_text("utf-8"))
    path.write_text(json.dumps({**data, "scenario": None, "formula": formula}), "utf-8")
    return path


def test_a_drive_file_whose_own_formula_is_false_is_a_fault(tmp_path: Path) -> None:
    """Whether it shows what is asked for or not."""
    for formula, faults in (("v_lon(SV) > 0 m/s", 0), ("v_lon(SV) < 0 m/s", 1)):
        path = with_formula(tmp_path, formula)
        found = rp.catalogue(path, among="4", classes=False, jobs=1)
        assert not found.missing
        assert len(found.tested.faults) == faults
        assert found.exit_code == (10 if faults else 0)
    [fault] = found.tested.faults
    assert fault.tests == ("braking",)
    assert "the formula does not hold on the drive: v_lon(SV) < 0 m/s" in fault.told


def test_a_formula_that_cannot_be_read_here_is_noted(tmp_path: Path) -> None:
    path = with_formula(tmp_path, "mine(SV)")
    found = rp.catalogue(path, among="4", classes=False, jobs=1)
    assert not found.tested.faults
    [note] = found.notes
    assert note.startswith("braking: its own formula cannot be read here: ")


def test_drives_made_with_other_values_are_noted() -> None:
    plain = rp.catalogue(BRAKING, among="4", classes=False, jobs=1)
    assert plain.notes == ()
    using = rp.load("ext", params={"minDanger": "0.7 s"})
    [note] = rp.catalogue(BRAKING, among="4", classes=False, using=using, jobs=1).notes
    assert note.startswith("made with set base, minDanger = ")
    assert note.endswith("judged with what is asked for: braking")
