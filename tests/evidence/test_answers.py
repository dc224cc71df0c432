"""What the indices of each command say, read entry by entry: what they rightly say, and what they do not.

The files that they name are not looked at here.
"""

from dataclasses import replace
from typing import Any

import pytest

from evidence.test_drive_file import FILE
from roadproof.analysis.coverage.classes import claims_of
from roadproof.engines.prove.properties import find_label
from roadproof.errors import InputError
from roadproof.evidence.answers.coverage import Entries, KeptClass
from roadproof.evidence.answers.entry import Entry
from roadproof.evidence.answers.read import (
    faults_of,
    index_fields,
    read_index,
)
from roadproof.evidence.answers.reader import Background, first_set
from roadproof.evidence.codec import read as read_as
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


# --- coverage ------------------------------------------------------------------------------------


def coverage(set_name: str) -> dict[str, Any]:
    claims = claims_of(LIBRARY.select(set_name))
    return {
        "schema": "roadproof/coverage/1",
        "set": set_name,
        "wider": [],
        **SAID,
        "verdict": "COVERED",
        "claims": [
            {"claim": claim.text, "verdict": "PROVED", "certificate": f"{k}.json", "reason": ""}
            for k, claim in enumerate(claims)
        ],
        "classes": [],
        "gaps": [],
        "needs": [],
    }


@pytest.mark.parametrize("set_name", ["complete", "ext"])
def test_a_set_without_gaps(set_name: str) -> None:
    data = coverage(set_name)
    found = entries(data)
    assert [x.file for x in found] == [x["certificate"] for x in data["claims"]]
    assert found[0].where == "index.json, claim 1"
    assert faults(data) == []
    for less in (data["claims"][1:], data["claims"][:-1], data["claims"][::-1], []):
        for verdict in ("COVERED", "UNKNOWN"):
            [fault] = faults({**data, "claims": less, "verdict": verdict})
            assert fault == "its claims are not those that together say that there is no gap"
    unproved = with_one(data, "claims", verdict="UNKNOWN")
    assert faults(unproved) == ["COVERED, but its claims are not all proved"]


def test_a_gap_is_on_the_road_that_is_said_and_its_class_is_not_proved_empty() -> None:
    part = {"scenario": 1, "component": "behaviourPOV_1", "description": "", "condition": ""}
    gap = {"road": "main-2", "formula": "v_lon(SV) > 0 m/s", "first": "", "caught_by": [], "classes": []}
    gap |= {"drive": "gap.json", "elsewhere": {"main-3": "gap-main-3.json"}}
    said = {**part, "verdict": "WITNESSED", "gaps": [gap], "claim": "", "certificate": None, "reason": ""}
    common = Background(Fields(coverage("ext"), "index.json"), LIBRARY, "index.json").at("ext")

    def read_class(said: dict[str, Any]) -> list[Entry]:
        return list(Entries(common, [4]).of_classes([read_as(KeptClass, said, "class")]))

    there, elsewhere = read_class(said)
    on = {road: replace(FILE, road=replace(FILE.road, name=road)) for road in ("main-2", "main-3")}
    for entry, road, other in ((there, "main-2", "main-3"), (elsewhere, "main-3", "main-2")):
        assert entry.fault_of_drive is not None
        assert entry.fault_of_drive(on[road]) == ""
        assert entry.fault_of_drive(on[other]) == f"its road is {road}, but that of its file {other}"
    for more in ({"claim": "false"}, {"certificate": "empty.json"}):
        assert "with a claim or a certificate" in read_class({**said, **more})[0].fault
    assert there.expected is not None
    assert elsewhere.fault_of is not None
    assert there.expected() == []
    assert "of a gap its formula has to say initSafe(SV, POV)" in elsewhere.fault_of(gap["formula"])
    missed = [f"not (some M in lanes: scenario_4({pair}, M))" for pair in ("SV, POV", "POV, SV")]
    whole = " and ".join(["initSafe(SV, POV)", "F danger(SV, POV)", *missed, gap["formula"]])
    there, _ = read_class({**said, "gaps": [gap | {"formula": whole}]})
    assert there.expected is not None
    assert there.expected() == [common.formula(whole)]
    assert elsewhere.fault_of(whole) == ""
    assert f"has to say {missed[1]}" in elsewhere.fault_of(whole.replace(missed[1], "v_lon(SV) > 0 m/s"))


def test_a_claim_and_a_need_of_another_set() -> None:
    data = coverage("complete")
    need = {"definition": "cutIn", "extends": "ext", "verdict": "WITNESSED", "road": "main-2"}
    need |= {"formula": "v_lon(SV) > 0 m/s", "drive": "needed.json"}
    *claims, found = entries({**data, "needs": [need]})
    assert found.fault == ""
    assert found.fault_of_drive is not None
    assert found.fault_of_drive(replace(FILE, road=replace(FILE.road, name="merge"))).startswith(
        "its road is"
    )
    assert all(x.expected is not None and x.common.formula(str(x.claim)) in x.expected() for x in claims)
    *_, other = entries({**data, "needs": [need | {"extends": "base"}]})
    assert other.fault == "index.json, need 1: its set extends 'ext', not 'base'"


def test_verdicts_on_a_set() -> None:
    assert faults({**coverage("ext"), "verdict": "GAPS"}) == ["GAPS, but it has none"]
    with pytest.raises(InputError, match="verdict: 'PROVED' is none of COVERED, GAPS, UNKNOWN"):
        faults({**coverage("ext"), "verdict": "PROVED"})
    assert faults({**coverage("ext"), "verdict": "UNKNOWN"}) == []


def test_a_class_that_occurs_in_traffic_may_say_where() -> None:
    part = {"scenario": 1, "component": "behaviourPOV_1", "description": "", "condition": ""}
    more = {"verdict": "UNKNOWN", "gaps": [], "claim": "", "certificate": None, "reason": "", "none_for": []}
    seen = {**part, **more, "in_traffic": 2, "trace": "recording 01, vehicles 3 and 5, frames 1 to 9"}
    [found] = [x for x in entries({**coverage("ext"), "classes": [seen]}) if x.key[0] == "class"]
    assert (found.verdict, found.shows) == ("UNKNOWN", "nothing")


def test_fields_that_no_index_has() -> None:
    with pytest.raises(InputError, match="is none of an index"):
        index_fields({"schema": "roadproof/index/9"}, "index.json")
    with pytest.raises(InputError, match="names no set"):
        first_set(Fields({"sets": []}, "index.json"))
