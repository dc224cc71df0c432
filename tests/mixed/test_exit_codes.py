"""Exit codes and verdicts of whole answers, of parts in every mixture: one doubt among many is a doubt."""

import random
from collections.abc import Sequence
from fractions import Fraction
from itertools import product
from types import SimpleNamespace
from typing import Any

import pytest

import roadproof as rp
from roadproof.errors import UsageError
from roadproof.evidence.finding import Acceptance
from roadproof.evidence.kernels import KernelVerdict
from roadproof.extensions.assurance.assuring import AssuranceReport
from roadproof.extensions.catalogue.cataloguing import CatalogueAnswer
from roadproof.extensions.drivers.lines import SIDES, PlateLine, end_of, sides_in
from roadproof.extensions.drivers.preventable.view import PlateResult, Shown
from roadproof.extensions.drivers.preventing import Plates
from roadproof.extensions.pages.reporting import Page
from roadproof.extensions.surveys.classifying import Classifications
from roadproof.extensions.surveys.coverage.answers import ClassAnswer, is_covered, verdict_on, with_counts
from roadproof.extensions.surveys.covering import CODES, Coverages
from roadproof.extensions.surveys.explore.values import ExplorationResult, SweepBoundary
from roadproof.extensions.surveys.extremes.extreme import Extreme
from roadproof.extensions.surveys.extremes.points import PointFinding
from roadproof.extensions.traffic.evaluating import Evaluation
from roadproof.extensions.traffic.monitoring import MonitorAnswer
from roadproof.frontends.api.comparing import ComparisonAnswer
from roadproof.frontends.api.drives import Witnesses
from roadproof.frontends.api.ordering import Orders
from roadproof.frontends.api.proofs import Proofs
from roadproof.frontends.api.question_answers import QuestionAnswers
from roadproof.frontends.api.relations import Overlaps
from roadproof.reasons import ReasonKind
from roadproof.verdict import ExitCode, Verdict

V = Verdict
DRIVE: Any = object()
CERTIFICATE: Any = object()
CHOOSER = random.Random(39)


def of(**fields: Any) -> Any:
    return SimpleNamespace(**fields)


def code_of(kind: type, **fields: Any) -> int:
    """The exit code of an answer with these fields."""
    return int(kind.exit_code.fget(of(**fields)))  # type: ignore[attr-defined]


def mixtures(values: Sequence[Any], most: int = 4) -> list[tuple[Any, ...]]:
    """Every sequence of up to two, and some longer ones."""
    found = [x for length in (1, 2) for x in product(values, repeat=length)]
    return found + [tuple(CHOOSER.choices(values, k=CHOOSER.randint(3, most))) for _ in range(60)]


def gravest(codes: Sequence[int]) -> int:
    return max(codes, default=0)


DOUBTS = {V.UNKNOWN: 20, V.CROSSCHECK_FAILED: 30}
CLAIMS = {**dict.fromkeys((V.REFUTED, V.VACUOUS, V.PROVED_BOUNDED), 10), V.PROVED: 0, **DOUBTS}


def test_claims_and_what_a_kernel_says_of_their_proofs() -> None:
    kernels = {None: 0, **{ExitCode(x): x for x in (0, 20, 30)}}
    for mixed, kernel in product(mixtures([*CLAIMS]), kernels):
        answers = [of(verdict=x, expected=V.PROVED) for x in mixed]
        said = None if kernel is None else of(exit_code=kernel)
        expected = gravest([*(CLAIMS[x] for x in mixed), kernels[kernel]])
        assert code_of(Proofs, answers=answers, kernel=said) == expected


def test_drives() -> None:
    codes = {V.WITNESSED: 0, V.IMPOSSIBLE: 10, V.NONE_WITHIN: 10, V.UNKNOWN: 20}
    for mixed in mixtures([*codes]):
        assert code_of(Witnesses, outcomes=[of(verdict=x) for x in mixed]) == gravest(
            [codes[x] for x in mixed]
        )


def test_pairs_and_other_studies() -> None:
    """A pair with a drive, with a proof, or without either within limits: all are answers."""
    codes = {V.WITNESSED: 0, V.IMPOSSIBLE: 0, V.NONE_WITHIN: 0, V.UNKNOWN: 20}
    for mixed in mixtures([*codes]):
        expected = gravest([codes[x] for x in mixed])
        assert code_of(Overlaps, pairs=[of(verdict=x) for x in mixed]) == expected
        assert code_of(QuestionAnswers, verdicts=dict(enumerate(mixed))) == expected


def test_implications_in_doubt_are_unknown() -> None:
    order = of(
        proved=[of(above="1", below="2")],
        missing=[("2", "1", (0,))],
        doubts=[of(above="1", below="3"), of(above="3", below="1")],
    )
    verdicts = Orders.verdicts.fget(of(view=order))  # type: ignore[attr-defined]
    assert verdicts == {
        "1 -> 2": V.PROVED,
        "2 -> 1": V.REFUTED,
        "1 -> 3": V.UNKNOWN,
        "3 -> 1": V.UNKNOWN,
    }


def test_two_formulas() -> None:
    for relation in ("equivalent", "stronger", "weaker", "incomparable", "unknown"):
        assert code_of(ComparisonAnswer, relation=relation) == (20 if relation == "unknown" else 0)


def test_a_formula_on_a_trace() -> None:
    codes = {"true": 0, "false": 10, "undecided": 20}
    assert {x: code_of(MonitorAnswer, verdict=x) for x in codes} == codes


# --- coverage ----------------------------------------------------------------------------------------


def test_coverage_by_a_set_that_is_no_wider_is_refused_before_any_search(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def decide(*_: object) -> None:
        raise AssertionError("a search was begun")

    monkeypatch.setattr(Coverages, "decide", decide)
    with pytest.raises(UsageError, match="--wider base does not extend --set ext"):
        rp.coverage(rp.load("ext"), wider="base")


def test_covered_is_every_claim_proved() -> None:
    for mixed in mixtures([V.PROVED, V.REFUTED, V.UNKNOWN, V.VACUOUS]):
        assert is_covered([of(verdict=x) for x in mixed]) is ({*mixed} == {V.PROVED})


def test_the_verdict_on_a_set() -> None:
    classes = {"gap": (V.WITNESSED, [DRIVE]), "empty": (V.IMPOSSIBLE, []), "doubt": (V.UNKNOWN, [])}
    classes["wrong"] = (V.CROSSCHECK_FAILED, [])
    traffics = {"none": None, "quiet": of(missed=()), "missed": of(missed=(DRIVE,))}
    every = product(mixtures([V.PROVED, V.UNKNOWN], 3), [(), *mixtures([*classes], 3)], traffics)
    for claims, kinds, traffic in every:
        made: Any = [of(verdict=classes[x][0], gaps=classes[x][1]) for x in kinds]
        proved = {*claims} == {V.PROVED}
        found = verdict_on([of(verdict=x) for x in claims], made, traffics[traffic])
        if "wrong" in kinds or (proved and traffic == "missed"):
            expected = V.CROSSCHECK_FAILED
        elif proved:
            expected = V.COVERED
        else:
            expected = V.GAPS if "gap" in kinds else V.UNKNOWN
        assert found is expected
    assert {x: int(code) for x, code in CODES.items()} == {
        V.COVERED: 0,
        V.GAPS: 10,
        V.UNKNOWN: 20,
        V.CROSSCHECK_FAILED: 30,
    }


def test_a_class_that_traffic_shows() -> None:
    def trace(*keys: str, alone: bool = False) -> Any:
        from roadproof.extensions.surveys.coverage.answers import GapTrace

        return GapTrace("01", 1, 2, (3, 4), True, keys, alone)

    traces = (trace("a"), trace("b"), trace("a", "b"), trace("c", alone=True))
    traffic: Any = of(missed=traces)
    counts = {"a": 2, "b": 2, "c": 1, "": 1, "d": 0}
    for key, verdict in product(counts, (V.WITNESSED, V.IMPOSSIBLE, V.UNKNOWN)):
        part: Any = None if not key else of(key=key)
        found = with_counts(ClassAnswer(part, verdict=verdict), traffic)
        assert found.in_traffic == counts[key]
        contradicts = verdict is V.IMPOSSIBLE and counts[key]
        assert found.verdict is (V.CROSSCHECK_FAILED if contradicts else verdict)
        assert bool(found.trace) == bool(counts[key])


# --- classes, catalogues, recordings, plates, pages, cases ------------------------------------------------


def test_classes() -> None:
    examples = {V.WITNESSED: 0, V.NONE_WITHIN: 10, V.IMPOSSIBLE: 10, V.UNKNOWN: 20}
    decisions = {V.PROVED: 0, V.VACUOUS: 0, V.REFUTED: 10, V.UNKNOWN: 20}
    for some, claims in product(mixtures([*examples], 3), mixtures([*decisions], 3)[::5]):
        for doubts, broken in product((0, 1), (None, False, True)):
            classified = of(
                doubts=[DRIVE] * doubts,
                examples=[of(verdict=x) for x in some],
                decisions=[of(verdict=x, holds=x in (V.PROVED, V.VACUOUS)) for x in claims],
            )
            codes = [*(examples[x] for x in some), *(decisions[x] for x in claims), 20 * doubts]
            shares = None if broken is None else of(broken=["a situation"] * broken)
            found = code_of(Classifications, view=classified, shares=shares)
            assert found == gravest([*codes, 30 * bool(broken)])


def test_catalogues() -> None:
    names = ("contradictions", "doubts", "missing", "faults")
    for chosen in product((0, 1), repeat=4):
        said = dict(zip(names, chosen, strict=True))
        tested = of(**{name: [DRIVE] * x for name, x in said.items()})
        wrong = said["missing"] or said["faults"]
        expected = 30 if said["contradictions"] else 20 if said["doubts"] else 10 if wrong else 0
        assert code_of(CatalogueAnswer, tested=tested) == expected


def test_recordings() -> None:
    for broken, denied, lost in product((0, 1), repeat=3):
        fields = {"totals": of(broken=["fact"] * broken), "denied": ["answer"] * denied}
        found = code_of(Evaluation, **fields, outcome=of(lost=["01"] * lost))
        assert found == (30 if broken or denied else 20 if lost else 0)


def shown(side: Any, drive: Any = None, is_there: bool = True) -> Shown:
    return Shown(side, {}, drive, ReasonKind.NO_DRIVE(), is_there=is_there)


def test_plates() -> None:
    """A side that no line has needs no drive; a plate without lines is one whose process died."""
    for drives, there in product(product((None, DRIVE), repeat=2), product((False, True), repeat=2)):
        sides = [shown(*x) for x in zip(SIDES, drives, there, strict=True)]
        plate = PlateResult("p", "careful", {}, shown=tuple(sides))
        lacking = any(x.is_there and x.drive is None for x in sides)
        assert plate.verdict is (V.UNKNOWN if lacking else V.WITNESSED), (drives, there)
    assert PlateResult("p", "careful", {}).verdict is V.UNKNOWN


def test_sides_of_a_plate() -> None:
    """Which sides a plate has more than single places of, as its lines say."""
    zero, half, one = Fraction(0), Fraction(1, 2), Fraction(1)
    mixed = PlateLine(zero, ((end_of(zero), end_of(half)),))
    free, full = PlateLine(zero, ()), PlateLine(zero, ((end_of(zero), end_of(one)),))
    for lines in ((mixed,), (free,), (full,), (mixed, free), ()):
        wanted = {"preventable"} if any(x is not full for x in lines) else set()
        wanted |= {"unpreventable"} if any(x is not free for x in lines) else set()
        assert sides_in(lines, (zero, one), is_stepped=False) == wanted


def test_plates_and_what_coq_says_of_their_boundaries(monkeypatch: pytest.MonkeyPatch) -> None:
    words = {
        x: 0 if x is KernelVerdict.ACCEPTED else 20 if x is KernelVerdict.UNKNOWN else 30
        for x in KernelVerdict
    }
    for verdicts, said in product(
        mixtures([V.WITNESSED, V.PROVED, V.UNKNOWN], 3)[:12], mixtures([*words], 3)
    ):
        plates = object.__new__(Plates)
        object.__setattr__(plates, "boundaries", [of(verdict=x) for x in said])
        monkeypatch.setattr(Plates, "verdicts", dict(enumerate(verdicts)))
        expected = gravest([20 * (V.UNKNOWN in verdicts), *(words[x] for x in said)])
        assert plates.exit_code == expected


def test_pages_say_how_many_claims_are_not_accepted() -> None:
    codes = dict(zip(Acceptance, (0, 10, 20, 3, 70), strict=True))
    for mixed in [(), *mixtures([*Acceptance])]:
        found = [of(outcome=x) for x in mixed]
        assert code_of(Page, _findings=found) == gravest([codes[x] for x in mixed])


def test_assurance_cases() -> None:
    from roadproof.extensions.assurance.case.states import ElementState

    for state in ElementState:
        for codes in mixtures([ExitCode.UNEXPECTED, ExitCode.BAD_INPUT], 3):
            solutions = {k: of(exit_code=x, state=ElementState.BROKEN) for k, x in enumerate(codes)}
            solutions["open"] = of(exit_code=ExitCode.OUR_FAULT, state=ElementState.UNDECIDED)
            broken, holds = ElementState.BROKEN, ElementState.HOLDS
            expected = max(codes) if state is broken else 0 if state is holds else 20
            assert code_of(AssuranceReport, state=state, solutions=solutions) == expected


# --- what is said of parts -----------------------------------------------------------------------------


def point(verdict: Verdict) -> PointFinding:
    return PointFinding((), DRIVE, verdict=verdict)  # type: ignore[arg-type]


def test_an_exploration_is_decided_where_both_sides_of_every_bracket_are() -> None:
    held, none, open_ = point(V.WITNESSED), point(V.NONE_WITHIN), point(V.UNKNOWN)
    for places in product((held, none, open_), (none, open_), (held, open_), (none, open_, None)):
        grid, missed, best, beyond = places
        explored = ExplorationResult(
            (grid,), (SweepBoundary(held, missed, None),), (Extreme(DRIVE, (), best, beyond, None, 1),)
        )
        listed = [grid, held, missed, best, *([] if beyond is None else [beyond])]
        assert sorted(explored.verdicts) == sorted(x.verdict for x in listed)
        assert (V.UNKNOWN in explored.verdicts) is (open_ in places)
