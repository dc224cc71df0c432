"""No verdict and no exit code depends on words: reasons, labels and messages are replaced by others.

Each command is asked with its own words, then with random ones in all reasons, labels, notes and remarks.
"""

import json
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from random import Random
from typing import Any

import pytest

import roadproof as rp
from extensions.catalogue.test_catalogue_verdicts import (
    FOUR,
    GOOD,
    ONE,
    OPEN,
    SHOWN,
    abstract,
    answer,
    asked,
    concrete,
    fact,
    looked_at,
)
from extensions.pages.report.test_page import HEADED, catalogue_of
from extensions.pages.report.test_page import concrete as concrete_data
from roadproof.errors import InputError
from roadproof.evidence.finding import Finding
from roadproof.extensions.catalogue.target_formulas import NO_CLASS, TargetFormulas
from roadproof.extensions.pages.page.open_points import catalogue_points
from roadproof.extensions.pages.page.results import PageResult
from roadproof.extensions.pages.page.summary import Overview, overview
from roadproof.reasons import Reason, ReasonKind

_ = asked  # a fixture
ROOT = Path(__file__).parents[2]
PHRASES = (
    *("shows no scenario", "cannot be read", "PROVED", "REFUTED", "unknown", "base", "ext", "careful: x"),
    *("declared parameters", "with rho=1", "collisions allowed", "UNKNOWN", "no drive was found", "stale"),
    *("it is not there", "P1 scenario 4 ext", "test CUT-1", "accepted", "rejected", "0 of 9", "gap_a", "{}"),
)
FIELDS = (
    *("reason", "label", "told", "words", "title", "note", "notes", "remark", "detail", "checked"),
    *("unchecked", "description", "titles", "doc"),
)
"""Fields of answers that hold words for people."""


def words(random: Random) -> str:
    return " ".join(random.choice(PHRASES) for _ in range(random.randint(1, 4)))


@contextmanager
def reworded(seed: int) -> Iterator[None]:
    """All reasons and all labels and checks of findings have random words while this lasts."""
    random = Random(seed)
    start = Finding.__init__

    def reason(cls: type[Reason], kind: ReasonKind, *values: object) -> Reason:
        is_empty = kind is ReasonKind.NONE or (kind is ReasonKind.TOLD and not str(values[0]))
        made = str.__new__(cls, "" if is_empty else words(random))
        made.kind, made.values = kind, values
        return made

    def finding(self: Finding, *given: Any, **named: Any) -> None:
        start(self, *given, **named)
        vars(self)["label"] = words(random) if self.label else ""
        for name in ("checked", "unchecked"):
            vars(self)[name] = tuple(words(random) for _ in getattr(self, name))

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Reason, "__new__", reason)
        patch.setattr(Finding, "__init__", finding)
        yield


def with_other_words(data: Any, random: Random) -> Any:
    """Plain data with other words in the fields that hold any."""
    if isinstance(data, dict):
        return {
            name: other(x, random) if name in FIELDS else with_other_words(x, random)
            for name, x in data.items()
        }
    return [with_other_words(x, random) for x in data] if isinstance(data, list) else data


def other(value: Any, random: Random) -> Any:
    if isinstance(value, str):
        return words(random) if value else ""
    if isinstance(value, list):
        return [other(x, random) for x in value]
    return value


# --- catalogue -------------------------------------------------------------------------------------


def catalogues(asked: TargetFormulas) -> Iterator[object]:
    """Verdicts and exit codes of catalogues of all kinds."""
    reason = ReasonKind.NO_DRIVE()
    for tests in ([GOOD], [GOOD, SHOWN], [GOOD, ("b", (NO_CLASS,))], [("a", (ONE,)), ("b", ())]):
        for facts in (
            (),
            (fact("t", "", "open", reason=reason),),
            (fact("t", "", "runs"), fact("t", ONE, "open", reason=reason)),
            (fact("t", "", "runs"), fact("t", FOUR, "implies")),
        ):
            made = [concrete(name, *shown, notes=("odd",)) for name, shown in tests]
            surveyed = OPEN if SHOWN in tests else None
            found = looked_at(asked, made, [abstract("t", ONE)], facts, surveyed=surveyed)
            told = answer(found)
            counts = (len(found.faults), len(found.doubts), len(found.contradictions))
            yield told.verdicts, told.exit_code, counts


@pytest.mark.parametrize("seed", range(100))
def test_a_catalogue(seed: int, asked: TargetFormulas) -> None:
    before = [*catalogues(asked)]
    assert len({x[1] for x in before}) == 3
    with reworded(seed):
        assert [*catalogues(asked)] == before


# --- the summary of a page -------------------------------------------------------------------------


ANSWERS = {
    "catalogue": {"schema": "roadproof/catalogue/1", **HEADED}
    | catalogue_of(
        tests=[concrete_data(id="a", file="a.json", shown=[])],
        figures=[{"set_name": "base", "kind": "scenarios", "sector": "", "tested": 3, "total": 4}],
        faults=[{"tests": ["a"], "told": "shows no scenario"}],
        not_tested=["scenario_1"],
        notes=["odd"],
    ),
    "overlap": {
        "verdicts": [
            {"a": 1, "b": 2, "verdict": "IMPOSSIBLE", "reason": ""},
            {"a": 1, "b": 3, "verdict": "UNKNOWN", "reason": "no answer within 9 units of work"},
        ]
    },
    "trace": {
        "requirements": [
            {"id": "A", "title": "first", "state": "proved", "links": [{"state": "proved", "reason": ""}]},
            {"id": "B", "title": "second", "state": "stale", "links": [{"state": "stale", "reason": "x"}]},
        ]
    },
    "verdicts": {
        "verdicts": [
            {"property": "claim", "claim": "true", "verdict": "REFUTED", "expected": "PROVED", "reason": "x"},
            {"property": "claim", "claim": "true", "verdict": "PROVED", "expected": "PROVED", "reason": ""},
        ]
    },
    "coverage": {"classes": [{"title": "a gap", "verdict": "WITNESSED", "description": "d", "words": "w"}]},
}


def summary(kind: str, data: dict[str, Any]) -> tuple[object, ...]:
    result = PageResult(f"{kind}.json", kind, data)
    points = catalogue_points(result) if kind == "catalogue" else ()
    found: Overview = overview(result, kind, "asked", 0, points)
    expected = [x.expected for x in found.statements]
    return found.verdicts, found.rank, found.rejected, [x.verdict for x in found.points], expected


@pytest.mark.parametrize("kind", ANSWERS)
def test_a_summary(kind: str) -> None:
    before = summary(kind, ANSWERS[kind])
    assert before[0] or before[3]
    for seed in range(60):
        assert summary(kind, with_other_words(ANSWERS[kind], Random(seed))) == before


# --- check, trace and assurance --------------------------------------------------------------------

CASE = """\
[case]
title = "A case"

[[goal]]
id = "G1"
text = "It holds."
supported_by = ["Sn1", "Sn2"]

[[solution]]
id = "Sn1"
text = "Proofs."
files = ["proofs"]
expect = "PROVED"

[[solution]]
id = "Sn2"
text = "A drive."
files = ["drives"]
expect = "WITNESSED"
"""
REQUIREMENTS = """\
[trace]
evidence = ["proofs", "drives"]

[[requirement]]
id = "LEAD"
text = "first"
claims = ["P4 scenario 3 base", "P4 scenario 11 base"]

[[requirement]]
id = "BRAKE"
text = "second"
scenarios = [4]
tests = ["brake"]

[[requirement]]
id = "NONE"
text = "third"
plates = ["careful-Vy-1"]
"""
DAMAGES = {"none": 0, "proof": 10, "torn": 3, "drive": 10, "gone": 0}
"""What is damaged, with the exit code of ``check``."""


@pytest.fixture
def home(tmp_path: Path) -> Path:
    for name in ("P4-scenario-03-base.json", "P4-scenario-11-base.json"):
        (tmp_path / "proofs").mkdir(exist_ok=True)
        shutil.copy(ROOT / "proofs" / name, tmp_path / "proofs" / name)
    (tmp_path / "drives").mkdir()
    drive = ROOT / "examples" / "traffic" / "drives" / "scenario-04-base.json"
    shutil.copy(drive, tmp_path / "drives" / "brake.json")
    (tmp_path / "requirements.toml").write_text(REQUIREMENTS, "utf-8")
    (tmp_path / "case.toml").write_text(CASE, "utf-8")
    return tmp_path


def damage(home: Path, what: str) -> None:
    proof, drive = home / "proofs" / "P4-scenario-03-base.json", home / "drives" / "brake.json"
    match what:
        case "proof":
            content = json.loads(proof.read_text("utf-8"))
            content["queries"][0]["smtlib"].insert(1, "(assert false)")
            proof.write_text(json.dumps(content), "utf-8")
        case "torn":
            proof.write_text("{", "utf-8")
        case "drive":
            text = drive.read_text("utf-8")
            drive.write_text(text.replace('"formula": "scenario_4', '"formula": "not scenario_4'), "utf-8")
        case "gone":
            shutil.rmtree(home / "drives")


def outcomes(home: Path) -> dict[str, Any]:
    """The verdicts and exit codes of all three commands."""
    found: dict[str, Any] = {}
    folders = [x for x in (home / "proofs", home / "drives") if x.is_dir()]
    checked = rp.check(*folders, jobs=1)
    found["check"] = [(x.where, x.outcome, x.verdict) for x in checked.findings], checked.exit_code
    traced = rp.requirements(home / "requirements.toml", jobs=1)
    links = [(x.id, y.state) for x in traced.answer.requirements for y in x.links]
    found["trace"] = links, traced.states, traced.exit_code
    try:
        case = rp.assurance(home / "case.toml", jobs=1)
        found["assurance"] = case.states, case.exit_code
    except InputError:
        found["assurance"] = "refused"
    return found


@pytest.mark.parametrize("what", DAMAGES)
def test_check_trace_and_assurance(what: str, home: Path) -> None:
    damage(home, what)
    before = outcomes(home)
    assert before["check"][1] == DAMAGES[what]
    for seed in range(4):
        with reworded(seed):
            assert outcomes(home) == before, seed
