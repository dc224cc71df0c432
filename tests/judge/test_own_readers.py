"""Own signals and kinds of vehicles: all readers agree, on random formulas and random courses."""

from fractions import Fraction
from random import Random

import numpy as np
import pytest

from roadproof.engines.encode.build import NONE, ground
from roadproof.engines.encode.circuit import evaluate
from roadproof.engines.encode.custom_signals import own_columns
from roadproof.engines.encode.motion import Layout
from roadproof.engines.encode.unroll import Grid, unroll
from roadproof.engines.prove.prover import prove
from roadproof.evidence.refutation import Countermodel, Instant, when_true
from roadproof.library.elaborate import read_claim
from roadproof.library.loading import load_library
from roadproof.library.specification import Source
from roadproof.logic.custom_names import code_of
from roadproof.logic.formula import Formula
from roadproof.logic.rewrite import without_names
from roadproof.logic.show import as_syntax, text
from roadproof.recordings.evaluate.recheck import trace_of
from roadproof.semantics.exact.exact import judge
from roadproof.semantics.sampled.batch import Batch
from roadproof.semantics.sampled.compiled import compile
from roadproof.semantics.sampled.recursive import TraceReader
from roadproof.world.drive import Drive, Motion, Piece
from roadproof.world.models import load_vehicle
from roadproof.world.signals import KINDS, STARTING

DT, STEPS, TAIL = Fraction(1, 2), 5, 12
VEHICLES = ("SV", "POV")
HOME = load_library(
    [
        Source(
            "own.spec",
            """
            signal red: bool
            signal jerk(a: vehicle): m/s^3 in [-10, 10]
            signal gap(a: vehicle): m
            signal wild(a: vehicle): bool derived by jerk(a) > 3 m/s^3 and red
            signal less(a: vehicle): m derived by gap(a) - 1 m
            """,
        )
    ]
).select()


def written(dice: Random, depth: int) -> str:
    """A random formula about own signals and kinds, without operators that never end."""
    if depth == 0:
        a = dice.choice(VEHICLES)
        return dice.choice(
            [
                "red",
                f"wild({a})",
                f"jerk({a}) {dice.choice(['<', '<=', '>', '>='])} {dice.randint(-3, 3)} m/s^3",
                f"less({a}) > gap(POV)",
                f"jerk({a})*gap({a}) >= 2 m^2/s^3".replace("m^2/s^3", "m/s^3 * 1 m"),
                f"max(gap(SV), gap(POV)) <= {dice.randint(0, 3)} m",
                f"kind({a}) {dice.choice(['=', '!='])} {dice.choice(KINDS)}",
                "kind(SV) = kind(POV)",
            ]
        )
    low = dice.randint(0, 2)
    window = f"[{low * DT}, {(low + dice.randint(0, 2)) * DT}]".replace("/2", "*0.5")
    one, other = written(dice, depth - 1), written(dice, depth - 1)
    return dice.choice(
        [
            f"not ({one})",
            f"(({one}) and ({other}))",
            f"(({one}) or ({other}))",
            f"F{window} ({one})",
            f"G{window} ({one})",
            f"(({one}) U{window} ({other}))",
        ]
    )


def random_drive(dice: Random) -> Drive:
    """Two vehicles of some kind, own signals that are small whole numbers and change at samples."""
    still = (Piece(None, Fraction(0), Fraction(0)),)
    box = (Fraction(4), Fraction(2), Fraction(0), Fraction(3), Fraction(10), Fraction(0))
    signals = {("red", ""): (0, 1), **{(name, v): (-4, 4) for name in ("jerk", "gap") for v in VEHICLES}}
    return Drive(
        {name: Motion(*box, still, dice.choice(KINDS)) for name in VEHICLES},
        {
            key: tuple((k * DT, Fraction(dice.randint(*ends))) for k in range(STEPS + 1))
            for key, ends in signals.items()
        },
    )


def values_at(drive: Drive, step: int) -> dict[tuple[str, str], Fraction]:
    return {key: course[min(step, STEPS)][1] for key, course in drive.own.items()}


def batch_of(drive: Drive) -> Batch:
    samples = [values_at(drive, k) for k in range(STEPS + TAIL)]
    signals = {key: np.array([float(x[key]) for x in samples])[:, None] for key in drive.own}
    kinds = {("kind", v): np.array([float(code_of(m.kind))]) for v, m in drive.vehicles.items() if m.kind}
    return Batch(DT, np.array([STEPS + TAIL]), signals, kinds)


def encoded(formula: Formula, drive: Drive) -> bool:
    vehicles = {v: load_vehicle("car") for v in VEHICLES}
    vehicles = {v: type(x)(**{**vars(x), "kind": drive.vehicles[v].kind}) for v, x in vehicles.items()}
    layout = Layout(VEHICLES, Grid(DT, STEPS), own_columns(formula))
    columns = {}
    for own in layout.own:
        for k in range(STEPS + 1):
            key = own.signal.name, own.signal.vehicle
            columns[layout.own_column(key[1], key[0], k)] = values_at(drive, k)[key]
    circuit = ground(unroll(formula, layout.grid), vehicles, layout, NONE, lasting=False)

    def holds(inequality) -> bool:
        value = inequality.polynomial.value(columns.__getitem__)
        return value > 0 if inequality.strict else value >= 0

    return evaluate(circuit, holds)


def traced(formula: Formula, drive: Drive) -> bool:
    fixed = {f"kind({v})": Fraction(code_of(m.kind)) for v, m in drive.vehicles.items() if m.kind}
    instants = tuple(
        Instant(
            k * DT,
            {**fixed, **{f"{n}({v})" if v else n: x for (n, v), x in values_at(drive, k).items()}},
            {},
        )
        for k in range(STEPS + 1)
    )
    return when_true(formula, Countermodel(instants, {}, "before")).at(Fraction(0))


@pytest.mark.parametrize("seed", range(40))
def test_all_readers_agree(seed: int) -> None:
    dice = Random(seed)
    query = read_claim(HOME, written(dice, dice.randint(1, 3)))
    formula, drive = query.formula, random_drive(dice)
    exact = judge(formula, drive).holds
    batch = batch_of(drive)
    monitor = compile({"asked": formula})
    answer = monitor.evaluate(batch).answers["asked"]
    assert (bool(answer.true[0]), bool(answer.false[0])) == (exact, not exact)
    assert TraceReader(trace_of(batch)).holds(formula, 0, "strong") == exact
    margin = monitor.measure(batch).margins["asked"]
    assert (margin.low[0] >= 0) if exact else (margin.high[0] <= 0)
    assert encoded(formula, drive) == exact
    assert traced(formula, drive) == exact
    again = read_claim(HOME, text(as_syntax(formula, expand=True))).formula
    assert without_names(again) == without_names(formula)


@pytest.mark.parametrize("seed", [0, 3, 5, 11])
def test_what_is_proved_is_true_on_drives_and_the_opposite_of_what_is_refuted(seed: int) -> None:
    dice = Random(seed)
    one = written(dice, 1)
    for claim, holds in ((f"({one}) or not ({one})", True), (f"({one}) and not ({one})", False)):
        query = read_claim(HOME, claim)
        assert prove(HOME, query).holds is holds
        assert judge(query.formula, random_drive(dice)).holds is holds


def test_columns_are_looked_up_where_they_stand() -> None:
    formula = read_claim(HOME, "red and jerk(SV) > 0 and gap(POV) < gap(SV)").formula
    layout = Layout(VEHICLES, Grid(DT, STEPS), own_columns(formula))
    first = len(VEHICLES) * len(STARTING) * (STEPS + 1)
    columns = list(layout.own_unknowns())
    for own in layout.own:
        for k in range(STEPS + 1):
            place = layout.own_column(own.signal.vehicle, own.signal.name, k) - first
            of = columns[place].of
            assert (of.vehicle, of.signal, of.step) == (own.signal.vehicle, own.signal.name, k)
            assert (columns[place].low, columns[place].high) == own.range
