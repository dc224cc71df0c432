"""Folders in which one thing was changed: none is accepted, but for changes that change nothing."""

from pathlib import Path

import pytest

from evidence.folders import CHOSEN, changes, check, code, places, read, some_proofs, write
from roadproof.evidence.finding import Outcome


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    return some_proofs(tmp_path / "proofs")


def test_the_folder_is_accepted_and_names_each_claim(folder: Path) -> None:
    findings = check(folder)
    assert {x.outcome for x in findings} == {Outcome.ACCEPTED}
    told = [(x.verdict, x.label) for x in findings]
    assert told == [
        ("PROVED", "P1 scenario 4 base"),
        ("PROVED", "P2 base"),
        ("PROVED", "P9 base"),
        ("REFUTED", "C4 scenario 4 base"),
        ("REFUTED", "C5 base"),
    ]
    assert str(findings[0]) == ("PROVED    P1 scenario 4 base  scenario_4(SV,POV,L) -> dangerArises(SV,POV)")


# Where a file may be changed and says the same still: by place and change, and why.
EQUIVALENT = {
    # Nobody reads what is true at an instant of a trace: the judge finds it from the values.
    ("counterexample", "instants", 0, "true"): {"turned around"},
    # Values that the claim does not speak of.
    ("counterexample", "instants", 0, "values"): {"one less", "one more field"},
}


def spoil(folder: Path, name: str) -> list[str]:
    """The changes of one file that are accepted."""
    path = folder / name
    whole = read(path)
    accepted = []
    for place in places(whole):
        for word, changed in changes(whole, place):
            write(path, changed)
            if code(folder) == 0:
                accepted.append(f"{'.'.join(map(str, place))}: {word}")
    write(path, whole)
    assert code(folder) == 0
    return accepted


@pytest.mark.parametrize("name", [f"{name}.json" for name in CHOSEN if name and name[0] in "PC"])
def test_no_change_of_a_file_is_accepted(folder: Path, name: str) -> None:
    assert spoil(folder, name) == []


def test_no_change_of_the_index_is_accepted(folder: Path) -> None:
    assert spoil(folder, "index.json") == []
