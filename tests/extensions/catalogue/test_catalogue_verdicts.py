"""What a catalogue says of its tests, on answers that are put together here: one is good, another is not."""

from collections.abc import Mapping, Sequence
from types import SimpleNamespace
from typing import Any, cast

import pytest

from roadproof.evidence.subject import TestedSide
from roadproof.extensions.catalogue.catalogue_data import Figure, Relation, ShownTarget
from roadproof.extensions.catalogue.cataloguing import CatalogueAnswer
from roadproof.extensions.catalogue.concrete_answer import ConcreteAnswer
from roadproof.extensions.catalogue.entries import AbstractTest, ConcreteTest
from roadproof.extensions.catalogue.fact import CatalogueFact
from roadproof.extensions.catalogue.figures import figures, figures_of_set
from roadproof.extensions.catalogue.target_formulas import ENDANGERED, GAP, NO_CLASS, TargetFormulas
from roadproof.extensions.catalogue.targets import Targets, find_targets
from roadproof.extensions.catalogue.traces import _with_subject
from roadproof.extensions.surveys.coverage.answers import ClassAnswer
from roadproof.extensions.traffic.evaluate.decisions import Decision
from roadproof.library.bind import values_with
from roadproof.library.elaborate import read_claim
from roadproof.library.loading import bundled_library
from roadproof.reasons import ReasonKind
from roadproof.verdict import ExitCode, Verdict

LIBRARY = bundled_library()
HOME = LIBRARY.select()
ONE, FOUR = "scenario_1", "scenario_4"
WORDS = {ONE: "one", FOUR: "four", "class_4": "a class"}
TRUE = read_claim(HOME, "true")


@pytest.fixture
def asked() -> TargetFormulas:
    made = TargetFormulas(HOME, (1, 4), None, values_with(LIBRARY, {}))
    vars(made)["gaps"] = SimpleNamespace(titles={"gap_a": "a", "gap_b": "b", "gap_c": "c"})
    return made


def concrete(
    name: str, *shown: str, claims: tuple[str, ...] = (), begins: float = 0.0, **more: Any
) -> ConcreteAnswer:
    entry = ConcreteTest(name, f"{name}.json", claims=claims, copy_of=more.pop("copy_of", ""))
    of_pair = tuple(ShownTarget(x, ("SV", "POV"), "L", 0.0) for x in shown)
    return ConcreteAnswer(entry, claims, of_pair, {"v_lon(SV)": begins}, **more)


def fact(
    test: str, other: str, relation: Relation, also: Sequence[str] = (), drive: Any = None, **more: Any
) -> CatalogueFact:
    return CatalogueFact(test, other, relation, TRUE, also=tuple(also), drive=drive, **more)


def abstract(name: str, *claims: str) -> AbstractTest:
    return AbstractTest(name, TRUE, claims=claims)


def decision(
    side: TestedSide, scenario: str = ONE, driver: Any = "careful", vehicles: tuple[str, ...] = ("SV", "POV")
) -> Decision:
    return Decision(scenario, vehicles, driver, side, 1.0, 2.0, 3.0, 4.0, {"Ve0": 1.0})


def gap_class(verdict: Verdict) -> ClassAnswer:
    made = SimpleNamespace(verdict=verdict, reason="out of work")
    return cast(ClassAnswer, made)


def looked_at(
    asked: TargetFormulas,
    tests: Sequence[ConcreteAnswer] = (),
    formulas: Sequence[AbstractTest] = (),
    facts: Sequence[CatalogueFact] = (),
    near: float = 0.5,
    surveyed: Mapping[str, ClassAnswer | None] | None = None,
) -> Targets:
    return find_targets(asked, tests, formulas, facts, WORDS, near, surveyed)


def by_name(found: Targets) -> dict[str, tuple[tuple[str, ...], tuple[str, ...]]]:
    return {x.name: (x.tested, x.possible) for x in found.targets}


# --- what is tested --------------------------------------------------------------------------------


def test_a_target_is_tested_by_each_test_that_shows_it_and_by_no_other(asked: TargetFormulas) -> None:
    found = looked_at(asked, [concrete("a", ONE), concrete("b", FOUR, ONE), concrete("c", ENDANGERED)])
    assert by_name(found) == {ONE: (("a", "b"), ()), FOUR: (("b",), ()), "class_4": ((), ())}
    assert [x.name for x in found.missing] == ["class_4"]
    claims = looked_at(asked, [concrete("a", FOUR, claims=(ONE,))])
    assert by_name(claims)[ONE] == ((), ())


@pytest.mark.parametrize(
    ("facts", "sure", "possible"),
    [
        ((fact("t", "", "runs"), fact("t", ONE, "implies")), ("t",), ()),
        ((fact("t", ONE, "implies"),), (), ()),
        ((fact("t", "", "runs", [ONE]),), (), ("t",)),
        ((fact("t", "", "runs"), fact("t", ONE, "shows")), (), ("t",)),
        ((fact("t", "", "runs"), fact("t", FOUR, "shows", [ONE])), (), ("t",)),
        ((fact("t", "", "runs", [ONE]), fact("t", ONE, "implies")), ("t",), ()),
        ((fact("t", "", "runs"), fact("t", ONE, "open")), (), ()),
        ((fact("t", "", "runs"), fact("t", ONE, "excludes")), (), ()),
        ((fact("t", "", "open"), fact("u", "", "runs"), fact("t", ONE, "implies")), (), ()),
        ((fact("t", "", "runs"), fact("t", "u", "implies", [ONE])), (), ()),
    ],
)
def test_a_formula_tests_what_it_implies_where_it_can_be_run(
    facts: tuple[CatalogueFact, ...], sure: tuple[str, ...], possible: tuple[str, ...], asked: TargetFormulas
) -> None:
    found = looked_at(asked, formulas=[abstract("t", ONE), abstract("u", ONE)], facts=facts)
    assert by_name(found)[ONE] == (sure, possible)
    assert (ONE in {x.name for x in found.missing}) is (not sure)


def test_how_tests_begin_is_between_the_least_and_the_greatest(asked: TargetFormulas) -> None:
    found = looked_at(
        asked, [concrete(x, ONE, begins=v) for x, v in (("a", 4), ("b", 2), ("c", 9), ("d", 5))]
    )
    assert found.targets[0].covered == {"v_lon(SV)": (2, 9)}
    assert found.targets[1].covered == {}


# --- remarks ---------------------------------------------------------------------------------------


def remarks(found: Targets, kind: str) -> dict[tuple[str, ...], str]:
    return {x.tests: x.told for x in getattr(found, kind)}


def test_a_claim_is_a_fault_where_another_scenario_is_shown(asked: TargetFormulas) -> None:
    tests = [
        concrete("right", ONE, claims=(ONE,)),
        concrete("wrong", FOUR, claims=(ONE,)),
        concrete("half", ONE, claims=(ONE, FOUR)),
        concrete("none", claims=(ONE,), others=("rho",)),
        concrete("left", ONE, claims=("scenario_2",)),
        concrete("unknown", ONE, claims=("class_9",)),
        concrete("number", ONE, claims=("scenario_777",)),
    ]
    told = remarks(looked_at(asked, tests), "faults")
    assert {x for (x,) in told} == {"wrong", "half", "none", "left", "unknown", "number"}
    assert told["wrong",] == f"claims {ONE}, and shows {FOUR}"
    assert told["half",] == f"claims {FOUR}, and shows {ONE}"
    assert "shows no scenario; its file has other values of rho" in told["none",]
    assert "add it with --among" in told["left",]
    assert "classes need a run without --no-classes" in told["unknown",]
    assert "no class of that name" in told["number",]


@pytest.mark.parametrize(
    ("test", "told"),
    [
        (concrete("t"), "shows no scenario"),
        (concrete("t", ENDANGERED), "shows no scenario, though danger comes"),
        (concrete("t", ENDANGERED, GAP, "gap_a"), "(gap_a)"),
        (concrete("t", copy_of="u"), None),
        (concrete("t", ONE), None),
        (concrete("t", ONE, fault="it is torn"), "cannot be read: it is torn"),
        (concrete("t", ONE, rejected="it is false"), "its file is rejected: it is false"),
    ],
)
def test_a_test_that_shows_nothing_is_a_fault(
    test: ConcreteAnswer, told: str | None, asked: TargetFormulas
) -> None:
    found = remarks(looked_at(asked, [test, concrete("u", FOUR)]), "faults")
    assert list(found) == ([("t",)] if told else [])
    assert told is None or told in found["t",]


def test_a_gap_is_something_where_gaps_are_to_be_tested(asked: TargetFormulas) -> None:
    tests = [concrete("t", ENDANGERED, GAP, "gap_a")]
    surveyed = {"gap_a": None, "gap_b": gap_class(Verdict.WITNESSED), "gap_c": gap_class(Verdict.UNKNOWN)}
    assert remarks(looked_at(asked, tests, surveyed=surveyed), "faults") == {}
    assert remarks(looked_at(asked, tests), "faults").keys() == {("t",)}


@pytest.mark.parametrize(
    ("facts", "fault", "doubt"),
    [
        ((fact("t", "", "empty"),), "can never be run", ""),
        ((fact("t", "", "open", reason=ReasonKind.NO_DRIVE()),), "no drive of it", "can be run is in doubt"),
        ((fact("t", "", "runs", [ONE]),), "", ""),
        ((fact("t", "", "runs"), fact("t", ONE, "implies")), "", ""),
        ((fact("t", "", "runs"), fact("t", ONE, "shows")), "", ""),
        ((fact("t", "", "runs"), fact("t", ONE, "excludes")), "which it excludes", ""),
        (
            (fact("t", "", "runs"), fact("t", ONE, "open", reason=ReasonKind.NO_DRIVE())),
            "",
            "can show scenario_1",
        ),
        (
            (fact("t", "", "runs"), fact("t", FOUR, "open", reason=ReasonKind.NO_DRIVE())),
            "no drive of it shows",
            "",
        ),
        ((fact("t", "", "runs"),), "no drive of it shows", ""),
    ],
)
def test_what_a_formula_claims_is_shown_or_told(
    facts: tuple[CatalogueFact, ...], fault: str, doubt: str, asked: TargetFormulas
) -> None:
    found = looked_at(asked, formulas=[abstract("t", ONE)], facts=facts)
    faults, doubts = remarks(found, "faults"), remarks(found, "doubts")
    assert (len(faults), len(doubts)) == (bool(fault), bool(doubt))
    assert not fault or fault in faults["t",]
    assert not doubt or doubt in doubts["t",]


@pytest.mark.parametrize(
    ("facts", "told"),
    [
        ((fact("t", "", "runs"), fact("t", ONE, "excludes")), True),
        ((fact("t", "", "runs"), fact("t", ONE, "open")), False),
        ((fact("t", "", "runs"), fact("t", ONE, "shows")), False),
        ((fact("t", "", "runs"), fact("t", ONE, "implies")), False),
        ((fact("t", "", "open"),), False),
    ],
)
def test_a_formula_without_claims_that_shows_nothing_is_a_fault(
    facts: tuple[CatalogueFact, ...], told: bool, asked: TargetFormulas
) -> None:
    found = remarks(looked_at(asked, formulas=[abstract("t")], facts=facts), "faults")
    assert found == ({("t",): "shows no scenario"} if told else {})


def test_an_end_of_a_range_that_is_open_is_a_doubt(asked: TargetFormulas) -> None:
    left = fact("", ONE, "open", reason=ReasonKind.NO_DRIVE())
    assert "how far its drives go" in remarks(looked_at(asked, facts=[left]), "doubts")[ONE,]


def test_a_scenario_that_holds_in_no_class_is_a_contradiction(asked: TargetFormulas) -> None:
    tests = [concrete("a", ONE), concrete("b", ONE, NO_CLASS)]
    found = looked_at(asked, tests, facts=[fact("t", "", "runs", [NO_CLASS]), fact("u", "", "runs", [ONE])])
    assert [x.tests for x in found.contradictions] == [("b",), ("t",)]


# --- gaps ------------------------------------------------------------------------------------------


def test_each_class_of_gaps_is_tested_missing_empty_or_open(asked: TargetFormulas) -> None:
    surveyed = {
        "gap_a": None,
        "gap_b": gap_class(Verdict.IMPOSSIBLE),
        "gap_c": gap_class(Verdict.UNKNOWN),
    }
    found = looked_at(asked, [concrete("t", ENDANGERED, GAP, "gap_a")], surveyed=surveyed)
    gaps = found.gaps
    assert (gaps.required, gaps.total) == (True, 3)
    assert [(x.name, x.tested) for x in gaps.targets] == [("gap_a", ("t",)), ("gap_c", ())]
    assert [x.name for x in gaps.empty] == ["gap_b"]
    assert dict(gaps.open) == {"gap_c": "out of work"}
    assert gaps.missing == ()
    assert remarks(found, "doubts").keys() == {("gap_c",)}
    there = {**surveyed, "gap_c": gap_class(Verdict.WITNESSED)}
    assert [x.name for x in looked_at(asked, surveyed=there).gaps.missing] == ["gap_a", "gap_c"]


def test_an_open_class_that_a_test_shows_is_not_open(asked: TargetFormulas) -> None:
    surveyed = dict.fromkeys(("gap_a", "gap_b", "gap_c"), gap_class(Verdict.UNKNOWN))
    found = looked_at(asked, [concrete("t", ENDANGERED, GAP, "gap_a")], surveyed=surveyed)
    assert {*found.gaps.open} == {"gap_b", "gap_c"}


@pytest.mark.parametrize("shown", ["tested", "possible"])
def test_an_empty_class_that_is_shown_is_a_contradiction(shown: str, asked: TargetFormulas) -> None:
    tests = [concrete("t", ENDANGERED, GAP, "gap_a")] if shown == "tested" else []
    facts = [fact("t", "", "runs", ["gap_a"])] if shown == "possible" else []
    surveyed = {"gap_a": gap_class(Verdict.IMPOSSIBLE), "gap_b": None, "gap_c": None}
    found = looked_at(asked, tests, facts=facts, surveyed=surveyed)
    assert [x.tests for x in found.contradictions] == [("t",)]


def test_gaps_that_are_not_asked_for_are_those_that_are_shown(asked: TargetFormulas) -> None:
    found = looked_at(asked, [concrete("t", GAP, "gap_b", claims=("gap_c",))])
    assert ([x.name for x in found.gaps.targets], found.gaps.total) == (["gap_b", "gap_c"], 3)
    assert found.gaps.missing == ()
    assert looked_at(asked, [concrete("t", ONE)]).gaps.total == 0
    of_formula = looked_at(asked, facts=[fact("t", "", "runs", ["gap_a"])]).gaps
    assert [(x.name, x.possible) for x in of_formula.targets] == [("gap_a", ("t",))]


# --- tests that say the same -----------------------------------------------------------------------


@pytest.mark.parametrize(
    ("others", "near", "alike"),
    [
        ([("b", (ONE,), 0.5, ())], 0.5, [("a", "b")]),
        ([("b", (ONE,), 0.51, ())], 0.5, []),
        ([("b", (FOUR,), 0.0, ())], 0.5, []),
        ([("b", (ONE,), 0.0, ("preventable",))], 0.5, []),
        ([("b", (ONE,), 0.4, ()), ("c", (ONE,), 0.8, ())], 0.5, [("a", "b")]),
        ([("b", (ONE,), 0.8, ()), ("c", (ONE,), 1.2, ())], 0.5, [("b", "c")]),
    ],
)
def test_tests_are_alike_where_they_show_the_same_and_begin_near(
    others: Sequence[tuple[str, tuple[str, ...], float, tuple[TestedSide, ...]]],
    near: float,
    alike: list[tuple[str, ...]],
    asked: TargetFormulas,
) -> None:
    tests = [concrete("a", ONE)]
    for name, shown, begins, sides in others:
        decided = tuple(decision(x) for x in sides)
        tests.append(concrete(name, *shown, begins=begins, decisions=decided))
    assert [x.tests for x in looked_at(asked, tests, near=near).alike] == alike


def test_a_copy_and_a_test_that_cannot_be_read_are_like_none(asked: TargetFormulas) -> None:
    tests = [concrete("a", ONE), concrete("b", ONE, copy_of="a"), concrete("c", ONE, fault="torn")]
    assert looked_at(asked, tests).alike == ()
    assert len(looked_at(asked, [*tests, concrete("d", ONE, copy_of="gone")]).alike) == 1


@pytest.mark.parametrize(
    ("pairs", "told"),
    [
        ((("t", "u"),), {("t", "u"): "every drive of the first is one of the second"}),
        ((("u", "t"),), {("u", "t"): "every drive of the first is one of the second"}),
        ((("t", "u"), ("u", "t")), {("t", "u"): "have the same drives"}),
        ((("t", ONE),), {}),
    ],
)
def test_formulas_that_imply_each_other_are_told(
    pairs: tuple[tuple[str, str], ...], told: dict[tuple[str, ...], str], asked: TargetFormulas
) -> None:
    facts = [fact(*pair, "implies") for pair in pairs] + [fact("t", "u", "excludes")]
    found = remarks(looked_at(asked, formulas=[abstract("t", ONE), abstract("u", ONE)], facts=facts), "alike")
    assert found.keys() == told.keys()
    assert all(told[x] in found[x] for x in told)


# --- figures, verdicts and exit codes --------------------------------------------------------------


def test_figures_count_targets_that_are_tested(asked: TargetFormulas) -> None:
    surveyed = {"gap_a": None, "gap_b": gap_class(Verdict.IMPOSSIBLE), "gap_c": gap_class(Verdict.WITNESSED)}
    facts = [fact("u", "", "runs", [FOUR])]
    found = looked_at(asked, [concrete("t", ONE, "class_4", GAP, "gap_a")], facts=facts, surveyed=surveyed)
    assert figures("base", found.targets, found.gaps) == (
        Figure("base", "scenarios", "", 1, 2),
        Figure("base", "classes", "", 1, 1),
        Figure("base", "classes of gaps", "", 1, 2),
    )
    assert len(figures("base", found.targets, looked_at(asked).gaps)) == 2


@pytest.mark.parametrize(
    ("facts", "count"),
    [
        ((), 0),
        ((fact("t", "", "runs"), fact("t", f"{ONE}@base", "implies")), 1),
        ((fact("t", f"{ONE}@base", "implies"),), 0),
        ((fact("t", "", "runs"), fact("t", f"{ONE}@ext", "implies")), 0),
        ((fact("t", "", "runs"), fact("t", f"{ONE}@base", "shows")), 0),
        ((fact("t", "", "runs"), fact("t", ONE, "implies")), 0),
    ],
)
def test_in_another_set_counts_what_is_shown_or_implied_there(
    facts: tuple[CatalogueFact, ...], count: int, asked: TargetFormulas
) -> None:
    assert figures_of_set(asked, [], facts) == (Figure("base", "scenarios", "", count, 2),)
    [both] = figures_of_set(asked, [concrete("a", FOUR)], facts)
    assert both.tested == count + 1


def answer(found: Targets) -> CatalogueAnswer:
    made = object.__new__(CatalogueAnswer)
    vars(made)["view"] = SimpleNamespace(tested=found)
    return made


GOOD = ("a", (ONE, FOUR, "class_4"))
OPEN = {"gap_a": None, "gap_b": None, "gap_c": gap_class(Verdict.UNKNOWN)}
SHOWN = ("b", (ENDANGERED, GAP, "gap_a", "gap_b"))


@pytest.mark.parametrize(
    ("tests", "surveyed", "code"),
    [
        ([GOOD], None, ExitCode.AS_EXPECTED),
        ([("a", (ONE, FOUR))], None, ExitCode.UNEXPECTED),
        ([GOOD, ("b", ())], None, ExitCode.UNEXPECTED),
        ([GOOD, SHOWN], OPEN, ExitCode.UNKNOWN),
        ([GOOD, ("b", ()), SHOWN], OPEN, ExitCode.UNKNOWN),
        ([GOOD, ("b", (NO_CLASS,)), SHOWN], OPEN, ExitCode.CROSSCHECK_FAILED),
        ([GOOD, SHOWN], {**OPEN, "gap_c": gap_class(Verdict.IMPOSSIBLE)}, ExitCode.AS_EXPECTED),
        ([GOOD, SHOWN], {**OPEN, "gap_c": gap_class(Verdict.WITNESSED)}, ExitCode.UNEXPECTED),
        ([GOOD, SHOWN], {**OPEN, "gap_a": gap_class(Verdict.IMPOSSIBLE)}, ExitCode.CROSSCHECK_FAILED),
    ],
)
def test_exit_codes(
    tests: Sequence[tuple[str, tuple[str, ...]]],
    surveyed: Mapping[str, ClassAnswer | None] | None,
    code: ExitCode,
    asked: TargetFormulas,
) -> None:
    found = looked_at(asked, [concrete(name, *shown) for name, shown in tests], surveyed=surveyed)
    assert answer(found).exit_code is code


def test_each_target_has_the_verdict_of_its_kind(asked: TargetFormulas) -> None:
    surveyed = {
        "gap_a": None,
        "gap_b": gap_class(Verdict.IMPOSSIBLE),
        "gap_c": gap_class(Verdict.UNKNOWN),
    }
    tests = [concrete("a", ONE), concrete("b", ENDANGERED, GAP, "gap_a")]
    facts = [fact("t", "", "runs", [FOUR])]
    found = answer(looked_at(asked, tests, facts=facts, surveyed=surveyed)).verdicts
    assert found == {
        ONE: Verdict.COVERED,
        FOUR: Verdict.GAPS,
        "class_4": Verdict.GAPS,
        "gap_a": Verdict.COVERED,
        "gap_b": Verdict.IMPOSSIBLE,
        "gap_c": Verdict.UNKNOWN,
    }
    there = {**surveyed, "gap_c": gap_class(Verdict.WITNESSED)}
    assert answer(looked_at(asked, tests, surveyed=there)).verdicts["gap_c"] is Verdict.GAPS
    assert {*answer(looked_at(asked, tests)).verdicts} == {*WORDS}


@pytest.mark.parametrize(
    ("roles", "ids", "expected"),
    [
        ({}, "12", {"SV": "2", "POV": "1"}),
        ({}, "123", {"SV": "2", "POV1": "1", "POV2": "3"}),
        ({}, "1234", {"SV": "2"}),
        ({"POV": "3"}, "123", {"SV": "2", "POV": "3"}),
        ({"POV": "2"}, "12", {"POV": "2"}),
        ({}, "13", {}),
    ],
)
def test_the_subject_of_a_planning_problem_is_sv_where_it_has_no_role(
    roles: Mapping[str, str], ids: str, expected: Mapping[str, str]
) -> None:
    assert _with_subject(roles, [*ids], "2") == expected
