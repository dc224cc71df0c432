"""Evidence of one entry put under another one, of every kind of index: ``check`` rejects the folder."""

import shutil
from collections.abc import Iterator
from copy import deepcopy
from itertools import combinations
from pathlib import Path
from random import Random
from typing import Any

import pytest

import roadproof as rp
from evidence.folders import Place, check, read, reseal, write
from evidence.kinds import MAKE, copy_of
from roadproof.evidence.finding import Acceptance

MOST = 24  # pairs of entries of one kind
EVIDENCE = ("certificate", "drive", "evidence", "trace")
SAID = ("claim", "formula", "verdict", "premise", "conclusion", "gaps", "core")
"""What an entry says of its evidence, which an attacker exchanges with it."""
KINDS = [kind for kind in MAKE if kind not in ("witness", "gaps")]  # these are in the second test


def holders(content: Any, at: Place = ()) -> Iterator[Place]:
    """The places of all objects that name evidence."""
    if isinstance(content, dict):
        if any(content.get(key) for key in EVIDENCE):
            yield at
        for key, value in content.items():
            yield from holders(value, (*at, key))
    elif isinstance(content, list):
        for k, value in enumerate(content):
            yield from holders(value, (*at, k))


def at_place(content: Any, place: Place) -> Any:
    for key in place:
        content = content[key]
    return content


def exchanged(whole: Any, one: Place, other: Place, keys: tuple[str, ...]) -> Any | None:
    """The index with these fields of two entries exchanged; None where that changes nothing."""
    changed = deepcopy(whole)
    first, second = at_place(changed, one), at_place(changed, other)
    for key in keys:
        values = first.pop(key, None), second.pop(key, None)
        for entry, value in zip((second, first), values, strict=True):
            if value is not None or key in at_place(whole, one):
                entry[key] = value
    return None if changed == whole else changed


@pytest.mark.parametrize("kind", KINDS)
def test_evidence_of_another_entry_is_rejected(kind: str, tmp_path: Path) -> None:
    folder = copy_of(kind, tmp_path)
    shutil.rmtree(
        folder / "answers", ignore_errors=True
    )  # kept answers would tell that the index was changed
    (folder / "question.json").unlink(missing_ok=True)
    whole = read(folder / "index.json")
    assert {x.outcome for x in check(folder)} == {Acceptance.ACCEPTED}
    places = [*holders(whole)]
    pairs = [(a, b) for a, b in combinations(places, 2) if a[: len(b)] != b and b[: len(a)] != a]
    Random(kind).shuffle(pairs)
    tried, accepted = 0, []
    for one, other in pairs[: MOST if kind != "catalogue" else MOST // 4]:
        for keys in (EVIDENCE, (*EVIDENCE, *SAID)):
            changed = exchanged(whole, one, other, keys)
            mine, theirs = at_place(whole, one), at_place(whole, other)
            if changed is None or _alike(mine, theirs) or (keys != EVIDENCE and _are_numbered(mine, theirs)):
                continue
            write(folder / "index.json", changed)
            tried += 1
            found = check(folder) if kind != "catalogue" else rp.check(folder, jobs=1).findings
            if all(x.outcome is Acceptance.ACCEPTED for x in found):
                accepted.append((one, other, keys == EVIDENCE))
    assert tried >= 1
    assert accepted == []


def _alike(one: dict[str, Any], other: dict[str, Any]) -> bool:
    """Whether two entries say the same, so that the evidence of each is that of the other."""
    said = [{x: entry.get(x) for x in ("claim", "formula")} for entry in (one, other)]
    return said[0] == said[1] and any(said[0].values())


def _are_numbered(one: dict[str, Any], other: dict[str, Any]) -> bool:
    """Whether two claims have nothing but a running number beside what they say and its evidence."""
    return one.get("property") == other.get("property") == "claim" and one["set"] == other["set"]


def files_of(folder: Path) -> list[Path]:
    """The certificates and drive files of a folder."""
    found = (x for x in sorted(folder.rglob("*.json")) if x.parent.name != "answers")
    return [x for x in found if x.name not in ("index.json", "question.json")]


def _shown(file: Path) -> tuple[object, ...]:
    """What a file is evidence of; two files that say the same here may stand for each other."""
    said = read(file)
    road = said["road"]["name"] if "road" in said else ""
    starts = {name: {**x, "pieces": 0} for name, x in said.get("vehicles", {}).items()}
    claim = said.get("claim", said.get("formula"))
    return claim, said["set"], said.get("assuming"), said.get("parameters"), road, starts


@pytest.mark.parametrize("kind", MAKE)
def test_evidence_of_any_index_under_an_entry_of_another_is_rejected(kind: str, tmp_path: Path) -> None:
    """The files of an entry are those of an entry of each of the other kinds, and of its own kind."""
    folder = copy_of(kind, tmp_path / "this")
    if (folder / "index.json").exists():
        shutil.rmtree(folder / "answers", ignore_errors=True)
        (folder / "question.json").unlink(missing_ok=True)
    assert {x.outcome for x in check(folder)} == {Acceptance.ACCEPTED}
    chance, accepted = Random(kind), []
    for other in MAKE:
        theirs = files_of(copy_of(other, tmp_path / "other" / other))
        pairs = [(a, b) for a in files_of(folder) for b in theirs if _shown(a) != _shown(b)]
        assert pairs
        for mine, foreign in chance.sample(pairs, min(len(pairs), 2 if other == kind else 1)):
            before = mine.read_bytes()
            mine.write_bytes(foreign.read_bytes())
            for answer in folder.glob("answers/*.json"):
                reseal(answer)
            found = check(folder) if kind != "catalogue" else rp.check(folder, jobs=1).findings
            if all(x.outcome is Acceptance.ACCEPTED for x in found):
                accepted.append((mine.name, other, foreign.name))
            mine.write_bytes(before)
    assert accepted == []
