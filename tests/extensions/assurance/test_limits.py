"""Limits of each kind of evidence, from files as commands write them."""

import json
import pickle
from collections.abc import Mapping
from pathlib import Path

import pytest

import roadproof as rp
from roadproof.evidence.finding import Acceptance, Finding, LimitRemark, RemarkKind, parameter_remark
from roadproof.extensions.assurance.case.limits import limits_of


def told(*files: Path) -> dict[str, tuple[str, ...]]:
    return {x.name: x.texts for x in limits_of(files, ())}


def written(path: Path, content: Mapping[str, object]) -> Path:
    path.write_text(json.dumps(content), "utf-8")
    return path


def test_motion_declared_values_and_bounds_of_a_certificate(tmp_path: Path) -> None:
    claim = "assuming motion, a_lon(SV) <= 2 m/s^2: v_lon(SV) <= 20 m/s -> G[0, 2 s] v_lon(SV) <= 24 m/s"
    rp.prove(claim, out=tmp_path / "motion", jobs=1)
    found = told(*(tmp_path / "motion").glob("claim-*.json"))
    assert found["premises"] == ("motion", "a_lon(SV) <= 2 m/s^2")
    rp.prove("danger(SV,POV) -> rho >= 0.5 s", declared=True, out=tmp_path / "declared", jobs=1)
    found = told(*(tmp_path / "declared").glob("claim-*.json"))
    assert any(x.startswith("rho = ") for x in (*found.get("premises", ()), *found.get("parameters", ())))


def test_limits_of_answers(tmp_path: Path) -> None:
    results = {
        "schema": "roadproof/traffic-results/5",
        "failed": {"07": "no lanes"},
        "notes": {"08": ["two vehicles overlap"]},
    }
    assert told(written(tmp_path / "results.json", results)) == {
        "recordings": ("07 left out: no lanes", "08: two vehicles overlap")
    }
    answer = {
        "schema": "roadproof/witness/1",
        "options": {"speed": "total"},
        "signals": {"red": "constant"},
        "length_error": {"per_cent": 0.5, "metres": 2.0},
        "prevention": {"of": "scenarios", "side": "preventable", "driver": "careful"},
        "verdicts": [
            {
                "verdict": "NONE-WITHIN",
                "reason": "none",
                "limits": {"horizon": "6", "vehicles": {"SV": "car"}},
            },
            {"verdict": "UNKNOWN", "reason": "out of\nwork"},
            {"verdict": "WITNESSED", "reason": "natural"},
        ],
    }
    assert told(written(tmp_path / "answer.json", answer)) == {
        "readings": ("speed=total",),
        "custom signals": ("red: constant",),
        "prevention": ("only scenarios that are preventable for driver model careful",),
        "roads": ("lengths in lanes differ by up to per_cent=0.5, metres=2.0",),
        "within limits": ("NONE-WITHIN: horizon 6; vehicles SV=car", "UNKNOWN: out of work"),
    }


def test_bounded_answers_of_an_index_say_that_it_states_no_limits(tmp_path: Path) -> None:
    index = {"schema": "roadproof/index/1", "claims": [{"verdict": "PROVED-BOUNDED"}]}
    [line] = told(written(tmp_path / "index.json", index))["within limits"]
    assert line == "PROVED-BOUNDED: this file states no limits, unlike that of --json"


@pytest.mark.parametrize(
    ("checked", "unchecked", "expected"),
    [
        (parameter_remark([]), "limits of vehicles", {"parameters", "not checked"}),
        (parameter_remark(["rho=1"]), "", {"parameters"}),
        (
            LimitRemark(RemarkKind.COLLISIONS, "collisions allowed: boxes overlap", "allowed"),
            "",
            {"collisions"},
        ),
        ("dense, unbounded time", "", set()),
        ("declared parameters", "", set()),
        ("with rho=1", "", set()),
        ("collisions allowed: boxes overlap", "", set()),
    ],
)
def test_limits_of_findings_go_by_the_kind_of_a_remark_and_not_by_its_words(
    checked: str, unchecked: str, expected: set[str]
) -> None:
    words = (unchecked,) if unchecked else ()
    finding = Finding("x", "drive", Acceptance.ACCEPTED, checked=(checked,), unchecked=words)
    assert {x.name for x in limits_of([], [finding])} == expected


def test_a_remark_keeps_its_kind_and_limit_between_processes() -> None:
    for remark in (parameter_remark(["rho=1"]), LimitRemark(RemarkKind.COLLISIONS, "words", "allowed")):
        again = pickle.loads(pickle.dumps(remark))
        assert (str(again), again.kind, again.limit) == (str(remark), remark.kind, remark.limit)


@pytest.mark.parametrize("collisions", [False, True])
def test_limits_of_a_drive_that_is_checked(collisions: bool, tmp_path: Path) -> None:
    """Boxes overlap at once; or SV drives up to POV, and they overlap after the search ends."""
    query = "s(SV) = s(POV) and d(SV) = d(POV)"
    if not collisions:
        query = "s(SV) < s(POV) and G (d(SV) = d(POV) and v_lon(SV) > v_lon(POV) + 2 m/s)"
    found = rp.witness(query, collisions=collisions, jobs=1)
    assert found.drives
    found.save(tmp_path, pictures=False)
    limits = {x.name: x.texts for x in limits_of([], rp.check(tmp_path, jobs=1).findings)}
    assert limits["parameters"] == ("declared parameters",)
    [told] = limits["collisions"]
    assert told == "allowed" if collisions else told.startswith("boxes apart up to 6 s; after that")


def test_how_far_a_search_looked_is_a_limit() -> None:
    searched = ("no drive on road main-2", "SV=car with v_lon=15..20")
    finding = Finding("x", "certificate", Acceptance.ACCEPTED, verdict="NONE-WITHIN", checked=searched)
    [limit] = limits_of([], [finding])
    assert limit.name == "within limits"
    assert limit.texts == tuple(f"NONE-WITHIN: {x}" for x in searched)


def test_files_that_are_no_evidence_have_no_limits(tmp_path: Path) -> None:
    (tmp_path / "a.json").write_text("{", "utf-8")
    (tmp_path / "b.json").write_text("[]", "utf-8")
    assert told(tmp_path / "a.json", tmp_path / "b.json", tmp_path / "missing.json") == {}
