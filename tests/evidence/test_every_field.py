"""Every field of every index, changed alone: ``check`` rejects the folder, or lists the field."""

import json
import shutil
from collections.abc import Callable, Iterator
from copy import deepcopy
from pathlib import Path
from typing import Any

import pytest

import roadproof as rp
from evidence.folders import Place, check, read, write
from roadproof.evidence.finding import Acceptance
from roadproof.evidence.folder import survey
from roadproof.proving.properties import find_label

MAKE: dict[str, Callable[[Path], Any]] = {
    "overlap": lambda out: rp.overlap(among=[1, 4], out=out, jobs=1),
    "redundancy": lambda out: rp.redundancy(among=[4], out=out, jobs=1),
    "classify": lambda out: rp.classify(among=[1, 4], shares=False, out=out, jobs=1),
    "explore": lambda out: rp.explore(4, vary={"POV.a_lon.min": (-6, -1)}, steps=3, out=out, jobs=1),
    "preventable": lambda out: rp.preventable(
        "cut-in", ["r157"], at={"Ve0": "60 km/h", "Vy": 1}, lines=3, out=out, jobs=1
    ),
}
# Changes that leave what is said as true as it was, and why.
EQUIVALENT = {
    ("preventable", "along[]"): "the lines are worked out again up to there, and have no other spans",
}


def leaves(content: Any, at: Place = ()) -> Iterator[Place]:
    """The places of all values that hold no others; of every list in the first entry and the last."""
    if isinstance(content, dict) and content:
        for key, value in content.items():
            yield from leaves(value, (*at, key))
    elif isinstance(content, list) and content:
        for k in sorted({0, len(content) - 1}):
            yield from leaves(content[k], (*at, k))
    else:
        yield at


def path_of(at: Place) -> str:
    """``explored[].values[].at[]``"""
    return "".join("[]" if isinstance(key, int) else f".{key}" for key in at).removeprefix(".")


def another(value: Any) -> Any:
    match value:
        case bool():
            return not value
        case int() | float():
            return value + 1
        case str():
            return value + "1" if not value or value[-1].isdigit() else f"{value} and x"
        case list():
            return ["x"]
        case dict():
            return {"x": "1"}
    return "x"


@pytest.mark.parametrize("kind", MAKE)
def test_no_field_is_changed_in_silence(kind: str, tmp_path: Path) -> None:
    folder = tmp_path / kind
    MAKE[kind](folder)
    shutil.rmtree(folder / "answers")  # kept answers would tell that the index was changed
    (folder / "question.json").unlink()
    whole = read(folder / "index.json")
    assert {x.outcome for x in check(folder)} == {Acceptance.ACCEPTED}
    said = survey([folder], (), find_label).told[0].not_checked
    accepted: list[str] = []
    tried = 0
    for at in leaves(whole):
        path = path_of(at)
        if any(path == x or path.startswith((f"{x}.", f"{x}[")) for x in said):
            continue
        changed = deepcopy(whole)
        place = changed
        for key in at[:-1]:
            place = place[key]
        place[at[-1]] = another(place[at[-1]])
        write(folder / "index.json", changed)
        tried += 1
        now_said = survey([folder], (), find_label).told[0].not_checked
        if path not in now_said and all(x.outcome is Acceptance.ACCEPTED for x in check(folder)):
            accepted.append(path)
    assert tried > 10
    assert [x for x in accepted if (kind, x) not in EQUIVALENT] == []


def test_check_lists_what_it_does_not_check(tmp_path: Path) -> None:
    found = rp.explore(4, vary={"POV.a_lon.min": (-6, -1)}, steps=2, out=tmp_path, jobs=1)
    found.add_files(False)
    (tmp_path / "notes.txt").write_text("mine")
    checked = rp.check(tmp_path)
    [line] = [x for x in str(checked).splitlines() if x.startswith(f"not checked in {tmp_path}: ")]
    assert "explored[].searches" in line
    assert line.endswith("notes.txt")
    assert json.loads(json.dumps(checked.as_data()))["not_checked"][str(tmp_path)][-1] == "notes.txt"
