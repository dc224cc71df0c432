"""Facts about motion are true on every drive; faults planted in them are not; nothing else can be assumed."""

import csv
import re
from fractions import Fraction
from pathlib import Path

import pytest

from roadproof.engines.prove.prover import prove
from roadproof.errors import InputError
from roadproof.library.assumption import ALL_SCHEMAS, SCHEMAS, Assumption, Axiom, claim_statement
from roadproof.library.elaborate import read_claim
from roadproof.library.motion import assumption, axiom_formula, split_claim, with_assumptions
from roadproof.logic import formula as f
from roadproof.logic import motion, show
from roadproof.logic import terms as t
from roadproof.logic.restore import as_syntax
from roadproof.verdict import Verdict
from spec.motions import ABOUT, AXIOMS, holds, random_drive, specification
from tables import read_table

DRIVES = [random_drive(seed) for seed in range(300)]


def formula(axiom: Axiom) -> f.Formula:
    return axiom_formula(specification, ABOUT, axiom)


@pytest.mark.parametrize("axiom", AXIOMS, ids=str)
def test_is_true_on_every_drive(axiom):
    assert all(holds(formula(axiom), drive) for drive in DRIVES)


@pytest.mark.parametrize("axiom", [x for x in AXIOMS if x.schema != "leaves"], ids=str)
def test_what_it_speaks_of_happens(axiom):
    """A fact that says nothing would be true, too: its premise holds, and does not hold for ever."""
    premise = formula(axiom).body.parts[0].body
    happens = f.Eventually(f.FOREVER, f.conjunction(premise, f.Eventually(f.FOREVER, f.negation(premise))))
    assert any(holds(happens, drive) for drive in DRIVES)


def test_every_schema_is_tried():
    assert {x.schema for x in AXIOMS} == {*SCHEMAS}


# --- planted faults ------------------------------------------------------------------------------

ME, YOU = (t.Signal("s", vehicle) for vehicle in ("SV", "POV"))
MY_SPEED, YOUR_SPEED = (t.Signal("v_lon", vehicle) for vehicle in ("SV", "POV"))
BEHIND, FAR_BEHIND = f.Compare(ME, "<=", YOU), f.Compare(ME, "<", YOU)
NOT_FASTER = f.Compare(MY_SPEED, "<=", YOUR_SPEED)


def always(premise, left, right, interval=f.FOREVER):
    """G (premise -> not (left U right))"""
    return f.Always(f.FOREVER, f.implication(premise, f.negation(f.Until(left, interval, right))))


def first(inside, outside):
    """G (inside -> G inside or inside U outside)"""
    kept = f.Always(f.FOREVER, inside)
    either = f.disjunction(kept, f.Until(inside, f.FOREVER, outside))
    return f.Always(f.FOREVER, f.implication(inside, either))


TWO, FIVE = (t.number(seconds, (0, 1)) for seconds in (2, 5))


def grown(metres, time=TWO):
    """SV gains at most 1 m/s on POV for 2 s, and is then at most so many metres ahead of where it was."""
    slow = f.Compare(MY_SPEED, "<=", t.Sum((YOUR_SPEED, t.number(1, (1, -1)))))
    more = f.Compare(ME, "<=", t.Sum((YOU, t.number(metres, (1, 0)))))
    return always(BEHIND, slow, f.negation(more), f.Interval(f.ZERO, time))


def more(left, right, by, seconds):
    """left <= right + by, of signals"""
    return f.Compare(left, "<=", t.Sum((right, t.number(by, (1, -seconds)))))


MINE, YOURS = (t.Signal("a_lon", vehicle) for vehicle in ("SV", "POV"))


def risen(metres, start=None, growth=1, time=TWO):
    """SV is 1 m/s faster at most, gains 1 m/s^2 at most for 2 s, and is then so many metres ahead at most."""
    begins = f.conjunction(BEHIND, start or more(MY_SPEED, YOUR_SPEED, 1, 1))
    slow = f.Always(f.Interval(f.ZERO, TWO), more(MINE, YOURS, growth, 2))
    ends = f.Always(f.Interval(time, time), more(ME, YOU, metres, 0))
    return f.Always(f.FOREVER, f.implication(f.conjunction(begins, slow), ends))


def risen_within(metres, growth=1):
    """The same at all times up to 2 s."""
    begins = f.conjunction(BEHIND, more(MY_SPEED, YOUR_SPEED, 1, 1))
    ahead = f.negation(more(ME, YOU, metres, 0))
    return always(begins, more(MINE, YOURS, growth, 2), ahead, f.Interval(f.ZERO, TWO))


FAULTS = {
    "after-twice, half the growth": risen(3),
    "after-twice, without what the rate is at first": risen(4, f.TRUE),
    "after-twice, growth without its square": risen(2 + Fraction(1, 2)),
    "after-twice, later": risen(4, time=FIVE),
    "after-twice, faster at first": risen(4, more(YOUR_SPEED, MY_SPEED, 1, 1)),
    "within-twice, half the growth": risen_within(3),
    "within-twice, a growth below zero for all of the time": risen_within(0, -1),
    "at-most, wrong sign": always(
        BEHIND, f.disjunction(BEHIND, f.Compare(YOUR_SPEED, "<=", MY_SPEED)), f.negation(BEHIND)
    ),
    "at-most, whatever the rate": always(BEHIND, f.TRUE, f.negation(BEHIND)),
    "at-most, rate of another": always(
        BEHIND,
        f.disjunction(BEHIND, f.Compare(t.Signal("v_lat", "SV"), "<=", t.Signal("v_lat", "POV"))),
        f.negation(BEHIND),
    ),
    "at-most, without its premise": always(f.TRUE, f.disjunction(BEHIND, NOT_FASTER), f.negation(BEHIND)),
    "at-most, strict in the end": always(BEHIND, f.disjunction(BEHIND, NOT_FASTER), f.negation(FAR_BEHIND)),
    "below, closed": always(BEHIND, NOT_FASTER, f.negation(FAR_BEHIND)),
    "below, where it is not reached": always(
        FAR_BEHIND, f.disjunction(FAR_BEHIND, NOT_FASTER), f.negation(FAR_BEHIND)
    ),
    "below, not slower": always(FAR_BEHIND, f.Compare(MY_SPEED, ">=", YOUR_SPEED), f.negation(FAR_BEHIND)),
    "meets, beyond": first(FAR_BEHIND, f.negation(BEHIND)),
    "meets, closed": first(BEHIND, f.negation(BEHIND)),
    "meets, of accelerations": first(
        f.Compare(t.Signal("a_lon", "SV"), "<", f.ZERO),
        f.conjunction(
            f.Compare(t.Signal("a_lon", "SV"), "<=", f.ZERO), f.Compare(t.Signal("a_lon", "SV"), ">=", f.ZERO)
        ),
    ),
    "leaves, closed": first(
        f.negation(read_claim(specification, "atLane(SV,L)").formula),
        read_claim(specification, "atLane(SV,L)").formula,
    ),
    "leaves, never": f.Always(
        f.FOREVER,
        f.implication(
            read_claim(specification, "atLane(SV,L)").formula,
            f.Always(f.FOREVER, read_claim(specification, "atLane(SV,L)").formula),
        ),
    ),
    "within, half": grown(1),
    "within, longer": grown(2, FIVE),
    "within, a rate below zero for all of the time": always(
        BEHIND,
        f.Compare(MY_SPEED, "<=", t.Sum((YOUR_SPEED, t.number(-1, (1, -1))))),
        f.negation(f.Compare(ME, "<=", t.Sum((YOU, t.number(-2, (1, 0)))))),
        f.Interval(f.ZERO, TWO),
    ),
    "after, at once": f.Always(
        f.FOREVER,
        f.implication(
            f.conjunction(BEHIND, f.Compare(MY_SPEED, "<=", t.Sum((YOUR_SPEED, t.number(-1, (1, -1)))))),
            f.Always(
                f.Interval(TWO, TWO),
                f.Compare(ME, "<=", t.Sum((YOU, t.number(-2, (1, 0))))),
            ),
        ),
    ),
}


@pytest.mark.parametrize("fault", FAULTS)
def test_a_fault_in_a_schema_is_noticed(fault):
    assert not all(holds(FAULTS[fault], drive) for drive in DRIVES)


def test_the_faults_are_written_like_the_schemas():
    kept = f.disjunction(BEHIND, NOT_FASTER)
    assert always(BEHIND, kept, f.negation(BEHIND)) == motion.at_most(ME, YOU)
    assert always(FAR_BEHIND, NOT_FASTER, f.negation(FAR_BEHIND)) == motion.below(ME, YOU)
    one = t.number(1, (1, -1))
    assert grown(2) == motion.within(ME, YOU, one, TWO)
    assert risen(4) == motion.after_twice(ME, YOU, one, t.number(1, (1, -2)), TWO)
    assert risen_within(4) == motion.within_twice(ME, YOU, one, t.number(1, (1, -2)), TWO)


# --- what cannot be assumed ----------------------------------------------------------------------

REFUSED = read_table(__file__, "refused")


@pytest.mark.parametrize(("schema", "arguments", "why"), REFUSED)
def test_refuses_what_is_no_fact_about_motion(schema, arguments, why):
    with pytest.raises(InputError) as refused:
        formula(Axiom(schema, arguments))
    assert why in str(refused.value)


@pytest.mark.parametrize(
    "said",
    read_table(__file__, "refuses_what_is_no_limit_in_evidence"),
)
def test_refuses_what_is_no_limit_in_evidence(said):
    with pytest.raises(InputError):
        assumption(specification, ABOUT, Assumption(said))


def test_facts_about_motion_are_used_only_where_the_claim_says_so():
    with pytest.raises(InputError, match="does not say that it assumes motion"):
        assumption(specification, ABOUT, Assumption((), (AXIOMS[0],)))
    assert assumption(specification, ABOUT, Assumption()) == f.TRUE


def test_what_is_assumed_is_read_as_it_is_written():
    said, claim = split_claim("assuming motion,\n a_lon(SV) <= 3.0 m/s^2: given v: m/s: v_lon(SV) <= v")
    assert claim.strip() == "given v: m/s: v_lon(SV) <= v"
    assert claim.splitlines()[1].index("given") == len(" a_lon(SV) <= 3.0 m/s^2: ")
    found = with_assumptions(specification, read_claim(specification, claim), said)
    assert found.texts == ("motion", "a_lon(SV) <= 3 m/s^2")
    assert split_claim(claim_statement(found.texts, claim.strip()))[0] == found.texts
    assert split_claim("danger(SV,POV)") == ((), "danger(SV,POV)")


# --- the page ------------------------------------------------------------------------------------

DATA = Path(__file__).parents[2] / "docs" / "data"
ROWS = [
    row
    for name in ("motion", "inductions")
    for row in csv.DictReader((DATA / f"{name}.csv").open("r", -1, "utf-8"))
]
TERMS = {
    "x": "s(SV)", "x'": "v_lon(SV)", "x''": "a_lon(SV)",
    "y": "s(POV)", "y'": "v_lon(POV)", "y''": "a_lon(POV)",
    "p": "(s(SV) < s(POV))", "v": "(3 m/s)", "d": "(4 s)", "a": "(1 s)", "b": "(2 s)",
}  # fmt: skip
LETTERS = {"left": "x", "right": "y", "inside": "p", "time": "d", "low": "a", "high": "b", "growth": "r"}


def test_every_schema_is_on_the_page() -> None:
    assert [row["schema"].strip("`") for row in ROWS] == [*ALL_SCHEMAS]


@pytest.mark.parametrize("row", ROWS, ids=lambda row: row["schema"])
def test_a_schema_says_what_the_page_says(row: dict[str, str]) -> None:
    """An instance of the page's formula is proved equivalent to the one that proofs use."""
    name = row["schema"].strip("`")
    twice = "growth" in ALL_SCHEMAS[name]
    terms = {**TERMS, "r": "(2 m/s^2)" if twice else "(2 m/s)"}
    letters = {**LETTERS, "speed": "v" if twice else "r"}
    axiom = Axiom(name, tuple(terms[letters[x]] for x in ALL_SCHEMAS[name]))
    said = re.sub(r"(?<![\w'])([xy]'{0,2}|[pvrdab])(?![\w'])", lambda m: terms[m[1]], row["says"].strip("`"))
    claim = f"({said}) <-> ({show.text(as_syntax(formula(axiom)))})"
    assert prove(specification, read_claim(specification, claim)).verdict is Verdict.PROVED
