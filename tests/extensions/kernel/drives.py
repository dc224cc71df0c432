"""Random formulas and drives with a derivation, as terms of Coq."""

from dataclasses import replace
from fractions import Fraction

from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from extensions.kernel import raw
from judge.cases import (
    comparisons,
    drives,
    formulas,
    halves,
    jerk_comparisons,
    jerk_drives,
    numbers,
    operators,
)
from roadproof.evidence.drive_file import DriveFile
from roadproof.extensions.kernel.coq import ready
from roadproof.extensions.kernel.derivation import coq_derivation
from roadproof.extensions.kernel.derivations.derive import derive
from roadproof.extensions.kernel.derivations.parts import NoDerivationError
from roadproof.extensions.kernel.drive import DriveStatement
from roadproof.extensions.kernel.world import world_lines
from roadproof.library.bind import bind
from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.logic.custom_names import is_kind, signal_is_true
from roadproof.semantics.exact import judge
from roadproof.world.drive import Drive
from roadproof.world.road import Lanelet, Road, adjacency
from roadproof.world.signals import KINDS

ROAD = Road(
    "three",
    (
        Lanelet("x1", "x", "main", "main", (None, Fraction(3)), (Fraction(-1), Fraction(2))),
        Lanelet("x2", "x", "merge", "merge", (Fraction(3), Fraction(9)), (Fraction(-1), Fraction(2))),
        Lanelet("y1", "y", "main", "main", (Fraction(1), None), (Fraction(2), Fraction(4))),
        Lanelet("z1", "z", "depart", "departure", (Fraction(0), Fraction(5)), (Fraction(4), Fraction(6))),
    ),
    adjacency([("x", "y"), ("y", "z")]),
)
LANES = {"L": "y"}
HEAD = """\
From Coq Require Import QArith String List.
From Roadproof Require Import Meaning Drive Shown.
Import ListNotations.
Open Scope string_scope.
Open Scope Q_scope.
"""

inside = st.builds(f.Occupies, st.sampled_from("AB"), st.just("l"))
within = st.builds(
    lambda kind, vehicle: kind("m", f.Domain("lanelets", "l"), f.Occupies(vehicle, "m")),
    st.sampled_from([f.Some, f.Every]),
    st.sampled_from("AB"),
)


def quantified(domains, atoms):
    return st.builds(
        lambda kind, where, body: kind("l", where, body),
        st.sampled_from([f.Some, f.Every]),
        st.sampled_from(domains),
        formulas(st.one_of(comparisons, atoms, atoms), leaves=3, past=False),
    )


of_road = st.one_of(
    quantified([f.Domain("zone", "main"), f.Domain("zone", "merge"), f.Domain("lanelets", "L")], inside),
    quantified([f.Domain("lanes"), f.Domain("adjacent", "L")], within),
)
asked = formulas(st.one_of(comparisons, of_road), leaves=4, past=False)


# Signals of a specification, of vehicles and of none, and kinds, on drives with jerk.
LOADS = {x: t.CustomSignal("load", x, (0, 0), Fraction(-2), Fraction(3)) for x in "AB"}
RED = t.CustomSignal("red", "", truth=True)
loads = st.sampled_from([*LOADS.values()])
steps_of = lambda values: st.builds(  # noqa: E731
    lambda first, more: ((Fraction(0), first), *sorted((k, x) for k, x in more.items() if k)),
    values,
    st.dictionaries(halves, values, max_size=2),
)
own_drives = st.builds(
    lambda drive, a, b, red, kinds: Drive(
        {name: replace(x, kind=kind) for (name, x), kind in zip(drive.vehicles.items(), kinds, strict=True)},
        {("load", "A"): a, ("load", "B"): b, ("red", ""): red},
    ),
    jerk_drives,
    *(steps_of(st.integers(-4, 6).map(lambda n: Fraction(n, 2))) for _ in LOADS),
    steps_of(st.sampled_from([Fraction(0), Fraction(1)])),
    st.tuples(*[st.sampled_from(KINDS)] * 2),
)
own_comparisons = st.one_of(
    st.builds(f.Compare, loads, operators, st.one_of(numbers, st.just(t.Signal("v_lon", "A")))),
    st.builds(lambda x, y, op: f.Compare(t.subtract(x, y), op, t.number(0)), loads, loads, operators),
    st.sampled_from([signal_is_true(RED), f.Not(signal_is_true(RED))]),
    st.builds(is_kind, st.sampled_from("AB"), st.sampled_from(KINDS), st.booleans()),
    jerk_comparisons,
)
own_asked = formulas(own_comparisons, leaves=4, past=False)


def cases(count, asked=asked, drives=drives):
    """Pairs of a formula that is true and a drive, the same in every run."""
    found = []

    @settings(
        max_examples=count,
        derandomize=True,
        database=None,
        deadline=None,
        suppress_health_check=list(HealthCheck),
    )
    @given(asked, drives)
    def collect(formula, drive):
        bound = bind(formula, ROAD, LANES, {})
        found.append((formula if judge(bound, drive).holds else f.Not(formula), drive))

    collect()
    return found


def derived(formula, drive):
    """The derivation, None where there is none for an irrational instant."""
    try:
        return derive(formula, drive, ROAD, LANES, {})
    except NoDerivationError:
        return None


def example(name, formula, drive, derivation, answer):
    """That Coq's checker answers so."""
    file = DriveFile(None, "base", "", Fraction(0), LANES, {}, {}, ROAD, drive, overlaps_allowed=True)
    lines = [
        f"Definition {name} : drive :=",
        *world_lines(DriveStatement(file, formula, {}, {}, {}).world),
        ".",
        f"Example {name}_is : accepts {name} [] {raw.formula(formula)}",
        *coq_derivation(derivation),
        f"= {str(answer).lower()}.",
        "Proof. vm_compute. reflexivity. Qed.",
    ]
    return "\n".join(lines) + "\n"


def agrees_with_the_judge(given, least):
    """What the judge says of a formula Coq's checker accepts, and not of its negation."""
    asked = [(x, drive, made) for x, drive in given if (made := derived(x, drive)) is not None]
    assert len(asked) >= least
    out = [HEAD]
    for number, (formula, drive, derivation) in enumerate(asked):
        out.append(example(f"yes_{number}", formula, drive, derivation, True))
        out.append(example(f"no_{number}", f.Not(formula), drive, derivation, False))
    with ready() as coq:
        ran = coq.run("".join(out))
    assert (ran.code, ran.errors) == (0, "")
