"""What the indices of each command say, read entry by entry: what they rightly say, and what they do not.

The files that they name are not looked at here.
"""

from typing import Any

import pytest

from roadproof.engines.prove.properties import find_label
from roadproof.errors import InputError
from roadproof.evidence.answers.entry import Entry
from roadproof.evidence.answers.read import (
    faults_of,
    index_fields,
    read_index,
)
from roadproof.evidence.answers.reader import first_set
from roadproof.evidence.strict import Fields
from roadproof.library.loading import bundled_library
from roadproof.library.scenarios import Scenario
from roadproof.library.specification import Library
from roadproof.runtime.version import VERSION

LIBRARY = bundled_library()
HEADED: dict[str, Any] = {"roadproof": VERSION, "library": LIBRARY.fingerprint}
SAID: dict[str, Any] = {"options": {}, "parameters": {}, "specs": []}


def entries(data: dict[str, Any], library: Library = LIBRARY) -> list[Entry]:
    return read_index(index_fields(HEADED | data, "index.json"), library, find_label)


def faults(data: dict[str, Any], formulas: dict[str, str] | None = None) -> list[str]:
    return list(faults_of(index_fields(HEADED | data, "index.json"), LIBRARY, formulas or {}))


def with_one(data: dict[str, Any], field: str, **changed: Any) -> dict[str, Any]:
    """``data`` with the first entry of a list changed."""
    first, *rest = data[field]
    return {**data, field: [{**first, **changed}, *rest]}


# --- prove ---------------------------------------------------------------------------------------

PROVED = {
    "schema": "roadproof/index/1",
    "options": {},
    "specs": [],
    "claims": [
        {"property": "claim", "claim": claim, "set": "base", "verdict": "PROVED", "evidence": f"{k}.json"}
        | {"part": "", "scenario": None}
        for k, claim in enumerate(("F p -> F p", "G p -> p"))
    ],
}


def test_claims_are_numbered_from_one() -> None:
    assert [x.where for x in entries(PROVED)] == ["index.json, claim 1", "index.json, claim 2"]


@pytest.mark.parametrize(
    ("changed", "fault"),
    [
        ({"part": "2"}, ""),
        ({"part": "more"}, "is called claim-more"),
        ({"scenario": 4}, "is called claim scenario 4"),
        ({"property": "P3"}, "is called P3, but its claim is no template property"),
    ],
)
def test_a_claim_of_ones_own_is_called_claim_and_may_have_a_number(
    changed: dict[str, Any], fault: str
) -> None:
    found = entries(with_one(PROVED, "claims", **changed))[0].fault
    assert fault in found
    assert bool(fault) == bool(found)


# --- overlap -------------------------------------------------------------------------------------

APART = "not (scenario_5(SV,POV,L) and scenario_6(SV,POV,L))"
APART_TOO = "not (scenario_5(SV,POV,L) and scenario_6(POV,SV,L))"
PAIR = {"a": 5, "b": 6, "set_a": "base", "set_b": "base", "core": [], "cores": [], "drive": None}
OVERLAP = {
    "schema": "roadproof/overlap/1",
    "set": "base",
    "lanes": "same",
    "roles": "same",
    "start": "same",
    **SAID,
    "verdicts": [{**PAIR, "verdict": "IMPOSSIBLE", "formula": APART, "certificate": "c.json"}],
}


def test_a_pair_of_scenarios() -> None:
    (entry,) = entries(OVERLAP)
    assert (entry.fault, entry.shows, entry.file, entry.claim) == ("", "proof", "c.json", APART)
    assert entry.where == "index.json, pair 1"
    assert entry.key == ("pair", "5@base", "6@base")


@pytest.mark.parametrize("changed", [{"b": 4}, {"formula": APART_TOO}, {"a": 4}])
def test_a_pair_that_its_formula_is_not_about(changed: dict[str, Any]) -> None:
    (entry,) = entries(with_one(OVERLAP, "verdicts", **changed))
    assert "but its formula is not" in entry.fault


def test_in_any_roles_all_assignments_of_vehicles_are_impossible() -> None:
    either = {**OVERLAP, "roles": "any"}
    assert "but its formula is not" in entries(either)[0].fault
    (entry,) = entries(with_one(either, "verdicts", formula=f"{APART} and {APART_TOO}"))
    assert entry.fault == ""
    drive = {"verdict": "WITNESSED", "certificate": None, "drive": "d.json"}
    formula = "scenario_5(SV,POV,L) and scenario_6(POV,SV,L)"
    assert entries(with_one(either, "verdicts", **drive, formula=formula))[0].fault == ""
    assert entries(with_one(OVERLAP, "verdicts", **drive, formula=formula))[0].fault != ""


# --- redundancy ----------------------------------------------------------------------------------

CHANGED = "scenario_4(SV,POV,L) and danger(SV,POV)"
SAME = f"scenario_4(SV,POV,L) <-> ({CHANGED})"
REDUNDANCY = {
    "schema": "roadproof/redundancy/1",
    "set": "base",
    **SAID,
    "verdicts": [
        {"scenario": 4, "part": "danger", "where": ["scenario_4"], "as": True, "changed": CHANGED}
        | {"redundant": True, "verdict": "PROVED", "assuming": "", "claim": SAME, "certificate": "c.json"}
    ],
}


def test_a_part_that_could_be_left_out() -> None:
    (entry,) = entries(REDUNDANCY)
    assert (entry.fault, entry.shows, entry.file) == ("", "proof", "c.json")
    assert entry.where == "index.json, change 1"
    assert entry.key == (Scenario(4, "base"), "danger", ("scenario_4",), "true", CHANGED)


@pytest.mark.parametrize(
    ("changed", "fault"),
    [
        ({"redundant": False}, "redundant=False, but PROVED"),
        ({"scenario": 5}, "but its claim is not"),
        ({"changed": "true"}, "but its claim is not"),
        ({"assuming": "G p"}, "but its claim is not"),
        ({"verdict": "REFUTED", "certificate": None, "drive": "d.json"}, "redundant=True, but REFUTED"),
    ],
)
def test_a_part_of_which_an_entry_says_what_is_not_shown(changed: dict[str, Any], fault: str) -> None:
    (entry,) = entries(with_one(REDUNDANCY, "verdicts", **changed))
    assert fault in entry.fault


def test_fields_that_no_index_has() -> None:
    with pytest.raises(InputError, match="is none of an index"):
        index_fields({"schema": "roadproof/index/9"}, "index.json")
    with pytest.raises(InputError, match="names no set"):
        first_set(Fields({"sets": []}, "index.json"))
