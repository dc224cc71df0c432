"""Every field of every index and kept answer, changed alone: ``check`` rejects it, or lists the field."""

import json
import shutil
from collections.abc import Iterator
from copy import deepcopy
from pathlib import Path
from typing import Any

import pytest

import roadproof as rp
from evidence.folders import Place, check, read, reseal, write
from evidence.kinds import MAKE, copy_of
from roadproof.engines.prove.properties import find_label
from roadproof.evidence.finding import Acceptance
from roadproof.evidence.folder import survey

# Without an index; and tests/analysis/test_catalogue_again.py changes that of a catalogue, beside its tests.
INDEXED = [kind for kind in MAKE if kind not in ("witness", "catalogue")]
# Changes that leave what is said as true as it was, and why.
EQUIVALENT = {
    ("preventable", "along[]"): "the lines are worked out again up to there, and have no other spans",
    ("proofs", "claims[].part"): "the number of a claim of a user's, whose text is beside it",
    ("proofs", "claim.part"): "the same",
    ("witness", "outcome.parameters"): "of a proof, which is about all values",
}


def leaves(content: Any, at: Place = ()) -> Iterator[Place]:
    """The places of all values that hold no others; of every list itself, the first entry and the last."""
    if isinstance(content, dict) and content:
        for key, value in content.items():
            yield from leaves(value, (*at, key))
    elif isinstance(content, list) and content:
        yield at
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
            return value[1:] or ["x"]
        case dict():
            return {"x": "1"}
    return "x"


def changes(content: Any) -> Iterator[tuple[str, Any]]:
    """The content with each of its values changed alone, and the path of that value."""
    for at in leaves(content):
        changed = deepcopy(content)
        place = changed
        for key in at[:-1]:
            place = place[key]
        place[at[-1]] = another(place[at[-1]])
        yield path_of(at), changed


def is_listed(path: str, said: tuple[str, ...]) -> bool:
    return any(path == x or path.startswith((f"{x}.", f"{x}[")) for x in said)


def is_equivalent(kind: str, path: str) -> bool:
    return any(kind == known and is_listed(path, (field,)) for known, field in EQUIVALENT)


def not_checked(folder: Path) -> tuple[str, ...]:
    return survey([folder], (), find_label).told[0].not_checked


def is_accepted(folder: Path) -> bool:
    return all(x.outcome is Acceptance.ACCEPTED for x in check(folder))


@pytest.mark.parametrize("kind", INDEXED)
def test_no_field_is_changed_in_silence(kind: str, tmp_path: Path) -> None:
    folder = copy_of(kind, tmp_path)
    shutil.rmtree(folder / "answers")  # kept answers would tell that the index was changed
    (folder / "question.json").unlink()
    whole = read(folder / "index.json")
    assert is_accepted(folder)
    said = not_checked(folder)
    accepted: list[str] = []
    tried = 0
    for path, changed in changes(whole):
        if is_listed(path, said):
            continue
        write(folder / "index.json", changed)
        tried += 1
        if not is_listed(path, not_checked(folder)) and is_accepted(folder):
            accepted.append(path)
    assert tried > 10
    assert not (left := [x for x in accepted if not is_equivalent(kind, x)]), "\n".join(left)


@pytest.mark.parametrize("beside", ["with the index", "without"])
@pytest.mark.parametrize("kind", MAKE)
def test_no_field_of_a_kept_answer_is_changed_in_silence(kind: str, beside: str, tmp_path: Path) -> None:
    folder = copy_of(kind, tmp_path)
    if beside == "without":
        (folder / "index.json").unlink(missing_ok=True)
    assert is_accepted(folder)
    said = not_checked(folder)
    accepted: list[str] = []
    tried = 0
    for path in (folder / "question.json", *chosen(folder / "answers")):
        whole = read(path)
        for field, changed in changes(whole):
            if field == "seal" or is_listed(field, said):
                continue
            write(path, changed)
            for answer in (folder / "answers").iterdir() if path.name == "question.json" else [path]:
                reseal(answer)
            tried += 1
            if not is_listed(field, not_checked(folder)) and is_accepted(folder):
                accepted.append(f"{path.name}: {field}")
        write(path, whole)
        for answer in (folder / "answers").iterdir():
            reseal(answer)
    assert tried > 3
    left = sorted(x for x in {*accepted} if not is_equivalent(kind, x.partition(": ")[2]))
    assert not left, "\n".join(left)


def chosen(answers: Path) -> list[Path]:
    """An answer of each shape."""
    found = {str([*changed_paths(read(x))]): x for x in sorted(answers.iterdir())}
    return [*found.values()]


def changed_paths(content: Any) -> list[str]:
    return sorted({path_of(x) for x in leaves(content)})


def test_check_lists_what_it_does_not_check(tmp_path: Path) -> None:
    found = rp.explore(4, vary={"POV.a_lon.min": (-6, -1)}, steps=2, out=tmp_path, jobs=1)
    found.add_files(False)
    (tmp_path / "notes.txt").write_text("mine")
    checked = rp.check(tmp_path)
    [line] = [x for x in str(checked).splitlines() if x.startswith(f"not checked in {tmp_path}: ")]
    assert "explored[].searches" in line
    assert line.endswith("notes.txt")
    assert json.loads(json.dumps(checked.as_data()))["not_checked"][str(tmp_path)][-1] == "notes.txt"
