"""What --junit and --sarif say against the exit code: outcomes of all kinds, mixed by a seeded generator."""

import json
import random
import xml.etree.ElementTree as xml
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import product
from pathlib import Path
from types import SimpleNamespace
from typing import Any, ClassVar

import pytest

from roadproof.evidence.finding import NO_EVIDENCE, Acceptance, Finding, exit_code
from roadproof.frontends.api.ci import BuildResult
from roadproof.frontends.report.ci.cases import Case, State
from roadproof.frontends.report.ci.junit import as_junit
from roadproof.frontends.report.ci.questions import finding_cases, recording_cases
from roadproof.reasons import NO_REASON, Why
from roadproof.verdict import ExitCode, Verdict
from roadproof.verdict import exit_code as code_of

UNKNOWN, PROVED, REFUTED = Verdict.UNKNOWN, Verdict.PROVED, Verdict.REFUTED


def suites_of(text: str) -> xml.Element:
    return xml.fromstring(text.encode())


def agree(text: str, sarif: str, code: ExitCode) -> None:
    """Both say what the exit code says, and count their own cases."""
    root = suites_of(text)
    for element, cases in ((root, root.iter("testcase")), *((x, x.iter("testcase")) for x in root)):
        listed = list(cases)
        failed, undecided = (sum(x.find(tag) is not None for x in listed) for tag in ("failure", "error"))
        counts = tuple(int(str(element.get(name))) for name in ("tests", "failures", "errors"))
        assert counts == (len(listed), failed, undecided)
    failures, errors = int(str(root.get("failures"))), int(str(root.get("errors")))
    run = json.loads(sarif)["runs"][0]
    levels = [x["level"] for x in run["results"]]
    assert (levels.count("error"), levels.count("warning")) == (failures, errors)
    [invocation] = run["invocations"]
    assert invocation["exitCode"] == code
    assert invocation["executionSuccessful"] is (code not in (ExitCode.OUR_FAULT, ExitCode.CROSSCHECK_FAILED))
    assert (code == ExitCode.AS_EXPECTED) == (failures == errors == 0)
    if code == ExitCode.UNKNOWN:
        assert errors
    elif code != ExitCode.AS_EXPECTED:
        assert failures


@dataclass(frozen=True)
class Built(BuildResult):
    """An answer with these cases and this exit code."""

    made: tuple[Case, ...]
    code: ExitCode
    command: ClassVar[str] = "check"

    def cases(self) -> Iterable[Case]:
        return self.made

    @property
    def exit_code(self) -> ExitCode:
        return self.code


STATES: tuple[State, ...] = ("passed", "failed", "undecided")


@pytest.mark.parametrize("code", [ExitCode(x) for x in (0, 3, 10, 20, 30)])
@pytest.mark.parametrize("length", range(4))
def test_no_exit_code_is_without_its_case(code: ExitCode, length: int) -> None:
    """Whatever the parts are: an answer as a whole may be wrong where each of them is right."""
    for states in product(STATES, repeat=length):
        if code is ExitCode.AS_EXPECTED and {*states} - {"passed"}:
            continue  # a part that fails and an exit code of 0 are a fault of the question
        rules = {"passed": None, "failed": REFUTED, "undecided": UNKNOWN}
        made = (Case(suite=x, name=f"{k}", state=x, rule=rules[x]) for k, x in enumerate(states))
        built = Built(tuple(made), code)
        agree(built.to_junit(), built.to_sarif(), code)


def test_suites_are_whole_whatever_the_order() -> None:
    cases = [Case(suite=x, name=f"{k}", state="passed") for k, x in enumerate("abacab")]
    root = suites_of(as_junit("roadproof", cases))
    assert [(x.get("name"), [y.get("name") for y in x]) for x in root] == [
        ("a", ["0", "2", "4"]),
        ("b", ["1", "5"]),
        ("c", ["3"]),
    ]


KINDS = ("certificate", "drive", NO_EVIDENCE)


def findings(chosen: Sequence[tuple[Acceptance, str]]) -> list[Finding]:
    found = []
    for k, (outcome, kind) in enumerate(chosen):
        reason = NO_REASON if outcome is Acceptance.ACCEPTED else Why.TOLD("why")
        found.append(Finding(f"file-{k}.json", kind, outcome, reason, label=f"P{k}"))  # type: ignore[arg-type]
    return found


@pytest.mark.parametrize("strict", [False, True])
def test_findings_of_every_mixture(strict: bool) -> None:
    each = [*product(Acceptance, KINDS)]
    chooser = random.Random(39)
    mixtures = [[], *([x] for x in each), *product(each, repeat=2)]
    mixtures += [[chooser.choice(each) for _ in range(chooser.randint(3, 6))] for _ in range(300)]
    for mixture in mixtures:
        found = findings(mixture)
        code = exit_code(found, strict)
        cases = tuple(finding_cases(found, strict))
        assert len(cases) == len(found)
        for case, finding in zip(cases, found, strict=True):
            if finding.outcome in (Acceptance.REJECTED, Acceptance.UNREADABLE, Acceptance.FAULT):
                assert case.state == "failed" or (finding.kind == NO_EVIDENCE and case.state == "undecided")
            if finding.outcome is Acceptance.UNDECIDED:
                assert case.state == "undecided"
        built = Built(cases, code)
        agree(built.to_junit(), built.to_sarif(), code)


def test_nothing_accepted_is_never_0() -> None:
    for strict, kind in product((False, True), KINDS):
        for count in range(3):
            found = findings([(Acceptance.ACCEPTED, kind)] * count)
            expected = ExitCode.UNKNOWN if not count or kind == NO_EVIDENCE else ExitCode.AS_EXPECTED
            assert exit_code(found, strict) is expected
            if count:
                assert {x.state for x in finding_cases(found, strict)} == {
                    "undecided" if expected is ExitCode.UNKNOWN else "passed"
                }
    one_without = findings([(Acceptance.ACCEPTED, "drive"), (Acceptance.ACCEPTED, NO_EVIDENCE)])
    assert [exit_code(one_without, x) for x in (False, True)] == [0, 20]
    assert [[y.state for y in finding_cases(one_without, x)] for x in (False, True)] == [
        ["passed", "passed"],
        ["passed", "undecided"],
    ]


@pytest.mark.parametrize(("outcome", "code"), [*zip(Acceptance, (0, 10, 20, 3, 70), strict=True)])
def test_each_outcome_beside_an_accepted_one(outcome: Acceptance, code: int) -> None:
    for kinds in ([outcome, Acceptance.ACCEPTED], [Acceptance.ACCEPTED, outcome]):
        assert exit_code(findings([(x, "certificate") for x in kinds])) == code


def test_recordings_that_are_read_lost_skipped_or_contradictory() -> None:
    for lost, failed, broken in product(([], ["a"]), ({}, {"b": "damaged"}, {"a": "lost"}), ([], ["a fact"])):
        cases = list(recording_cases(["a", "b", "c"], failed, lost, broken, Path("nowhere")))
        states = {x.name: x.state for x in cases}
        expected = {x: "undecided" if x in lost else "failed" if x in failed else "passed" for x in "abc"}
        assert states == {**expected, **dict.fromkeys(broken, "failed")}


# --- claims, drives, plates: one that passed beside one that did not ---------------------------------------


def verdict_cases(verdicts: Sequence[tuple[Verdict, Verdict]]) -> list[State]:
    from roadproof.frontends.report.ci.cases import state_of

    return [state_of(verdict, (expected,)) for verdict, expected in verdicts]


def test_the_state_of_a_verdict_is_what_its_exit_code_alone_says() -> None:
    states: dict[ExitCode, State] = {
        ExitCode.AS_EXPECTED: "passed",
        ExitCode.UNEXPECTED: "failed",
        ExitCode.UNKNOWN: "undecided",
        ExitCode.CROSSCHECK_FAILED: "failed",
    }
    for verdict, expected in product(Verdict, Verdict):
        if verdict is expected and verdict in (UNKNOWN, Verdict.CROSSCHECK_FAILED):
            continue  # nobody expects a doubt
        assert verdict_cases([(verdict, expected)]) == [states[code_of([(verdict, expected)])]]


def answer(**fields: Any) -> Any:
    return SimpleNamespace(**fields)


def test_plates_and_lemmas_beside_each_other() -> None:
    from roadproof.frontends.report.ci.questions import plate_cases
    from roadproof.library.loading import bundled_library
    from roadproof.logic.parse import parse_claim

    home = bundled_library().select()
    tree = parse_claim("danger(SV,POV)")
    for plate, lemma in product((Verdict.WITNESSED, UNKNOWN), (PROVED, REFUTED, UNKNOWN)):
        plates = [answer(name="plate", verdict=plate, reason=NO_REASON, shown=())]
        lemmas = [answer(lemma=answer(name="lemma", tree=tree), verdict=lemma, reason=NO_REASON)]
        cases = list(plate_cases(plates, lemmas, home, {}))
        assert [x.state for x in cases] == [
            *verdict_cases([(plate, Verdict.WITNESSED)]),
            *verdict_cases([(lemma, PROVED)]),
        ]
        assert [x.rule for x in cases] == [plate, lemma]


def test_drives_that_were_found_and_that_were_not() -> None:
    from roadproof.frontends.report.ci.questions import search_cases
    from roadproof.library.elaborate import read_claim
    from roadproof.library.loading import bundled_library

    home = bundled_library().select()
    query = read_claim(home, "danger(SV,POV)")
    verdicts = (Verdict.WITNESSED, Verdict.IMPOSSIBLE, Verdict.NONE_WITHIN, UNKNOWN)
    fields: dict[str, Any] = {"query": query, "scenario": None, "set_name": "base", "reason": NO_REASON}
    searches = [(answer(**fields, verdict=x, seconds={}), home, None) for x in verdicts]
    assert [x.state for x in search_cases(searches)] == ["passed", "failed", "failed", "undecided"]
