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

import roadproof as rp
from roadproof.evidence.finding import NO_EVIDENCE, Acceptance, Finding, exit_code
from roadproof.extensions.assurance.build_results.junit import as_junit
from roadproof.extensions.catalogue.cases import test_location as location_of
from roadproof.extensions.traffic.report.cases import recording_cases
from roadproof.frontends.api.build_result import BuildResult
from roadproof.frontends.report.cases import Case, State
from roadproof.frontends.report.question_cases import finding_cases
from roadproof.reasons import NO_REASON, ReasonKind
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


@pytest.mark.parametrize("wanted", [(), ("junit",), ("sarif",), ("junit", "sarif")])
def test_files_of_build_results_are_written_where_they_are_named(
    wanted: tuple[str, ...], tmp_path: Path
) -> None:
    from argparse import Namespace

    from roadproof.frontends.cli.options import write_build_results

    built = Built((Case(suite="a", name="b", state="failed", rule=REFUTED),), ExitCode.UNEXPECTED)
    files = {x: tmp_path / x if x in wanted else None for x in ("junit", "sarif")}
    write_build_results(Namespace(**files), built)
    assert {x.name for x in tmp_path.iterdir()} == {*wanted}
    content = {"junit": built.to_junit(), "sarif": built.to_sarif()}
    assert all((tmp_path / x).read_text("utf-8") == content[x] for x in wanted)


def test_cases_of_one_name_are_told_apart_by_their_suites() -> None:
    made = [Case(suite=x, name="P1", state="failed", rule=REFUTED) for x in ("base", "ext", "base")]
    results = json.loads(Built(tuple(made), ExitCode.UNEXPECTED).to_sarif())["runs"][0]["results"]
    first, second, third = (x["partialFingerprints"]["case/v1"] for x in results)
    assert first == third != second


KINDS = ("certificate", "drive", NO_EVIDENCE)


def findings(chosen: Sequence[tuple[Acceptance, str]]) -> list[Finding]:
    found = []
    for k, (outcome, kind) in enumerate(chosen):
        reason = NO_REASON if outcome is Acceptance.ACCEPTED else ReasonKind.TOLD("why")
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


@pytest.mark.parametrize(("outcome", "code"), [*zip(Acceptance, (20, 10, 20, 3, 70), strict=True)])
def test_an_answer_without_evidence_is_a_doubt_unless_it_is_worse(outcome: Acceptance, code: int) -> None:
    for strict, count in product((False, True), (1, 2)):
        assert exit_code(findings([(outcome, NO_EVIDENCE)] * count), strict) == code


def test_recordings_that_are_read_lost_skipped_or_contradictory() -> None:
    for lost, failed, broken in product(([], ["a"]), ({}, {"b": "damaged"}, {"a": "lost"}), ([], ["a fact"])):
        cases = list(recording_cases(["a", "b", "c"], failed, lost, broken, Path("nowhere")))
        states = {x.name: x.state for x in cases}
        expected = {x: "undecided" if x in lost else "skipped" if x in failed else "passed" for x in "abc"}
        assert states == {**expected, **dict.fromkeys(broken, "failed")}
        code = ExitCode.CROSSCHECK_FAILED if broken else ExitCode.UNKNOWN if lost else ExitCode.AS_EXPECTED
        built = Built(tuple(cases), code)
        agree(built.to_junit(), built.to_sarif(), code)
        told = [
            x.get("name")
            for x in suites_of(built.to_junit()).iter("testcase")
            if x.find("skipped") is not None
        ]
        assert told == [x for x in "abc" if states.get(x) == "skipped"]


# --- claims, drives, plates: one that passed beside one that did not ---------------------------------------


def verdict_cases(verdicts: Sequence[tuple[Verdict, Verdict]]) -> list[State]:
    from roadproof.frontends.report.cases import state_of

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
    from roadproof.extensions.drivers.preventable.cases import plate_cases
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
    from roadproof.frontends.report.question_cases import search_cases
    from roadproof.library.elaborate import read_claim
    from roadproof.library.loading import bundled_library

    home = bundled_library().select()
    query = read_claim(home, "danger(SV,POV)")
    verdicts = (Verdict.WITNESSED, Verdict.IMPOSSIBLE, Verdict.NONE_WITHIN, UNKNOWN)
    fields: dict[str, Any] = {"query": query, "scenario": None, "set_name": "base", "reason": NO_REASON}
    of = {"cost": answer(seconds=0.0), "task": answer(specification=home)}
    searches = [(answer(**fields, **of, verdict=x), None) for x in verdicts]
    assert [x.state for x in search_cases(searches)] == ["passed", "failed", "failed", "undecided"]


FAST, FALSE = "v_lon(SV) > 30 m/s -> v_lon(SV) > 20 m/s", "v_lon(SV) > 20 m/s -> v_lon(SV) > 30 m/s"


def test_claims_that_are_expected_to_be_false() -> None:
    for what, expect in product(((FAST,), (FALSE,), (FAST, FALSE)), ("PROVED", "REFUTED")):
        found = rp.prove(*what, expect=expect, drive=False, jobs=1)
        right = {FAST: "PROVED", FALSE: "REFUTED"}
        states = ["passed" if right[x] == expect else "failed" for x in what]
        assert [x.state for x in found.cases()] == states
        messages = [x.message for x in found.cases()]
        assert [f", expected {expect}" in x for x in messages] == [x == "failed" for x in states]
        agree(found.to_junit(), found.to_sarif(), found.exit_code)
        assert found.exit_code == (10 if "failed" in states else 0)


def test_claims_and_classes_of_coverage() -> None:
    """A claim that is refuted passes, since the classes say why; a class with a drive is a gap."""
    from roadproof.extensions.surveys.coverage.cases import coverage_cases
    from roadproof.library.elaborate import read_claim
    from roadproof.library.loading import bundled_library

    home = bundled_library().select()
    query = read_claim(home, "danger(SV,POV)")
    claims = {PROVED: "passed", REFUTED: "passed", UNKNOWN: "undecided"}
    classes = {
        Verdict.WITNESSED: ("failed", Verdict.GAPS),
        Verdict.IMPOSSIBLE: ("passed", Verdict.IMPOSSIBLE),
        UNKNOWN: ("undecided", UNKNOWN),
        Verdict.CROSSCHECK_FAILED: ("failed", Verdict.CROSSCHECK_FAILED),
    }
    for claim, gap in product(claims, classes):
        survey = answer(
            claims=[answer(claim=query, verdict=claim, reason=NO_REASON)],
            classes=[answer(part=None, verdict=gap, reason=NO_REASON)],
        )
        one, other = coverage_cases(survey, home, {})
        assert (one.state, one.rule) == (claims[claim], claim)
        assert (other.state, other.rule) == classes[gap]


def test_tests_and_targets_of_a_catalogue() -> None:
    from roadproof.extensions.catalogue.cases import catalogue_cases

    remark = {name: [answer(tests=(name,), told=name)] for name in ("doubt", "fault", "contradiction")}
    targets = [answer(name=x, words=x) for x in ("tested", "missing")]
    gaps = [answer(name=x, words=x) for x in ("gap", "open gap", "missing gap")]
    for asked in (False, True):
        found = answer(
            doubts=remark["doubt"],
            faults=remark["fault"],
            contradictions=remark["contradiction"],
            targets=targets,
            missing=[targets[1], *([gaps[2]] if asked else [])],
            gaps=answer(required=asked, targets=gaps, open={"open gap": "late"} if asked else {}),
        )
        cases = [*catalogue_cases(["doubt", "fault", "contradiction", "good"], found)]
        states = {x.name: x.state for x in cases}
        expected = {"doubt": "undecided", "fault": "failed", "contradiction": "failed", "good": "passed"}
        expected |= {"tested": "passed", "missing": "failed"}
        if asked:
            expected |= {"gap": "passed", "open gap": "undecided", "missing gap": "failed"}
        assert states == expected


def test_where_a_test_is_written(tmp_path: Path) -> None:
    path = tmp_path / "catalogue.toml"
    path.write_text('[[test]]\ntitle = "after A-1"\nid = "A-10"\n[[test]]\n   id = \'A-1\'\n')
    places = {name: str(location_of(str(path), name)) for name in ("A-1", "A-10", "A")}
    assert places == {"A-1": f"{path}:5:4", "A-10": f"{path}:3:1", "A": f"{path}:1:1"}


def test_definitions_of_the_user_come_first() -> None:
    from roadproof.frontends.report.cases import named_definitions
    from roadproof.logic.parse import parse_claim

    home = rp.load(specs=["def mine(a, b: vehicle) := danger(a, b)\n"]).specification
    named = named_definitions(home, parse_claim("danger(SV,POV) and mine(SV,POV)"))
    assert named[0][0] == "mine"
    assert {x for x, _ in named} > {"mine", "danger"}


def test_links_of_requirements() -> None:
    from roadproof.extensions.assurance.answers.trace import LinkState
    from roadproof.extensions.assurance.build_results.requirements import requirement_cases

    place = answer(file="requirements.toml", line=3, column=1)
    for state, outcome in product(LinkState, Acceptance):
        link = answer(kind="claim", target="P4", state=state, reason=NO_REASON, changes=(), evidence=())
        fields: dict[str, Any] = {"place": place, "text": "", "title": ""}
        one = answer(id="A", links=(link,), parents=("P",), state=state, **fields)
        bare = answer(id="B", links=(), parents=(), state=LinkState.MISSING, **fields)
        whole = answer(id="P", links=(), parents=(), state=state, **fields)
        beside = answer(where="a.json", label="", outcome=outcome, reason=NO_REASON)
        cases = [*requirement_cases(answer(requirements=(one, bare, whole), unlinked=(beside,)))]
        shown = "passed" if state.is_shown else "undecided" if state is LinkState.UNKNOWN else "failed"
        rest = {Acceptance.ACCEPTED: [], Acceptance.UNDECIDED: ["undecided"]}.get(outcome, ["failed"])
        assert [x.state for x in cases] == [shown, "failed", *rest]


def test_requirements_of_every_mixture() -> None:
    """Requirements with links, parts and evidence beside them: files and exit code say one thing."""
    from roadproof.extensions.assurance.answers.trace import LinkState, TraceData
    from roadproof.extensions.assurance.build_results.requirements import requirement_cases
    from roadproof.extensions.assurance.requirements.states import worst

    place = answer(file="requirements.toml", line=3, column=1)
    fields: dict[str, Any] = {"place": place, "text": "", "title": ""}
    chooser, codes = random.Random(39), set()

    def link(state: LinkState) -> Any:
        return answer(kind="claim", target="P4", state=state, reason=NO_REASON, changes=(), evidence=())

    shown = [x for x in LinkState if x.is_shown]
    for round_ in range(1500):
        states = [*LinkState] if round_ % 3 else [*shown, chooser.choice([*LinkState])]
        parts = []
        for k in range(chooser.randint(1, 3)):
            links = tuple(
                link(chooser.choice(states))
                for _ in range(chooser.choice((0, 1, 1, 2, 3)) or round_ % 3 == 0)
            )
            state = worst(x.state for x in links) if links else LinkState.MISSING
            parts.append(answer(id=f"R{k}", links=links, parents=("P",), state=state, **fields))
        whole = answer(id="P", links=(), parents=(), state=worst(x.state for x in parts), **fields)
        outcomes = chooser.choices([Acceptance.ACCEPTED, *Acceptance], k=chooser.randint(0, 2))
        beside = tuple(answer(where="a.json", label="", outcome=x, reason=NO_REASON) for x in outcomes)
        given = answer(requirements=(whole, *parts), unlinked=beside)
        code = TraceData.exit_code.fget(given)  # type: ignore[attr-defined]
        codes.add(code)
        built = Built(tuple(requirement_cases(given)), code)
        agree(built.to_junit(), built.to_sarif(), code)
    assert codes == {ExitCode.AS_EXPECTED, ExitCode.UNEXPECTED, ExitCode.UNKNOWN}


@pytest.mark.parametrize(
    ("beside", "code"),
    [
        ((), ExitCode.UNKNOWN),
        ((Acceptance.ACCEPTED,), ExitCode.UNKNOWN),
        ((Acceptance.REJECTED,), ExitCode.UNEXPECTED),
    ],
)
def test_no_requirement_is_no_success(beside: tuple[Acceptance, ...], code: ExitCode) -> None:
    from roadproof.extensions.assurance.answers.trace import TraceData

    given = answer(requirements=(), unlinked=tuple(answer(outcome=x) for x in beside))
    assert TraceData.exit_code.fget(given) is code  # type: ignore[attr-defined]
