"""Replay: overlaps of boxes and breaches of limits, at their first instant."""

from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from random import Random

import numpy as np
import pytest

from judge.test_exact import motion
from planting import plant
from roadproof.engines.encode.build import NO_MARGIN, ground_atoms
from roadproof.engines.encode.motion import ColumnLayout, custom_signal_ranges
from roadproof.engines.encode.problem import evaluate
from roadproof.engines.encode.unroll import Grid, unroll
from roadproof.engines.prove.prover import prove
from roadproof.errors import UsageError
from roadproof.evidence.countermodel import Countermodel, Instant
from roadproof.evidence.drive_file import DriveFile, load_drive
from roadproof.evidence.refutation import when_true
from roadproof.extensions.pages.blame import Blame, blame
from roadproof.extensions.traffic.evaluate.recheck import trace_of
from roadproof.extensions.traffic.evaluate.recursive import TraceReader
from roadproof.library.bind import bind, values_with
from roadproof.library.elaborate import read_claim
from roadproof.library.loading import bundled_library, load_library
from roadproof.library.specification import Source
from roadproof.logic import formula as f
from roadproof.logic.custom_names import code_of
from roadproof.logic.formula import Formula, subformulas
from roadproof.logic.restore import as_syntax
from roadproof.logic.rewrite import without_names
from roadproof.logic.show import text
from roadproof.semantics.exact import replay
from roadproof.semantics.exact.algebraic import real_roots
from roadproof.semantics.exact.judging import Judgement, interval_seconds, judge
from roadproof.semantics.exact.replay import first_breach, first_overlap
from roadproof.semantics.exact.truth import (
    NEVER,
    TruthSet,
    always,
    complement,
    eventually,
    intersection,
    union,
    until,
)
from roadproof.semantics.sampled.batch import Batch
from roadproof.semantics.sampled.compiled import compile
from roadproof.world.drive import Drive, Motion, Piece
from roadproof.world.models import load_vehicle
from roadproof.world.motion import state_at
from roadproof.world.signals import KINDS, STARTING

ONE, TEN = Fraction(1), Fraction(10)


@dataclass(frozen=True)
class Car:
    v_lon: tuple = (Fraction(0), Fraction(50))
    v_lat: tuple = (Fraction(-2), Fraction(2))
    a_lon: tuple = (Fraction(-8), Fraction(4))
    a_lat: tuple = (Fraction(-2), Fraction(2))
    lateral_share: Fraction = Fraction(1, 10)


def test_states_are_exact():
    drive = Drive({"A": motion(1, 2, 3, 0, [(Fraction(1, 3), 3, 0)], last=(0, 6))})
    state = state_at(drive.vehicles["A"], Fraction(4, 3))
    assert (state.s, state.d) == (1 + 1 + Fraction(1, 6) + 4, 2 + 3)
    assert (state.v_lon, state.v_lat, state.a_lon, state.a_lat) == (4, 6, 0, 6)


def test_boxes_overlap_when_the_rear_one_catches_up():
    # The rear of B is at 14.5 m, A's front starts at 0 and gains 5 m/s: they touch at 2.9 s.
    drive = Drive({"A": motion(0, 2, 25), "B": motion(19, 2, 20)})
    found = first_overlap(drive, TEN)
    assert (found.first, found.second, found.time, found.after) == ("A", "B", Fraction(29, 10), True)
    assert "overlap from 2.9 s on" in str(found)
    assert first_overlap(drive, Fraction(29, 10)) is None  # touching is no overlap
    assert first_overlap(drive, Fraction(291, 100)) is not None
    assert first_overlap(drive, None) is not None


def test_boxes_beside_each_other_do_not_overlap():
    beside = Drive({"A": motion(0, 2, 25), "B": motion(19, 2 + Fraction(9, 5), 20)})
    assert first_overlap(beside, None) is None
    nearer = Drive({"A": motion(0, 2, 25), "B": motion(19, 2 + Fraction(179, 100), 20)})
    assert first_overlap(nearer, None).time == Fraction(29, 10)


def test_overlap_from_the_start_and_the_first_of_several():
    drive = Drive({"A": motion(0, 2), "B": motion(50, 2, -10), "C": motion(1, 3)})
    found = first_overlap(drive, TEN)
    assert (found.first, found.second, found.time, found.after) == ("A", "C", 0, False)


def test_an_irrational_overlap():
    # A gains t²/2 on the 1 m between the boxes.
    drive = Drive({"A": motion(0, 2, last=(1, 0)), "B": motion(Fraction(11, 2), 2)})
    assert first_overlap(drive, TEN).time == real_roots((-2, 0, 1))[1][0]


@pytest.mark.parametrize(
    ("state", "rule", "time", "after"),
    [
        ({"v_lon": 49, "last": (1, 0)}, "v_lon <= 50", 1, True),
        ({"v_lon": 4, "last": (-2, 0)}, "v_lon >= 0", 2, True),
        ({"v_lon": 20, "pieces": [(2, 0, 0), (1, 5, 0)]}, "a_lon <= 4", 2, False),
        ({"v_lon": 20, "pieces": [(2, 0, 0), (1, -9, 0)]}, "a_lon >= -8", 2, False),
        ({"v_lon": 30, "pieces": [(1, 0, 0), (1, 0, 3)]}, "a_lat <= 2", 1, False),
        ({"v_lon": 30, "last": (0, 1)}, "v_lat <= 2", 2, True),
        ({"v_lon": 30, "last": (0, -1)}, "v_lat >= -2", 2, True),
        ({"v_lon": 10, "v_lat": 1, "last": (-1, 0)}, "lateral_share|heading", 0, True),
        ({"v_lon": 10, "v_lat": -1, "last": (-1, 0)}, "lateral_share|heading", 0, True),
        ({"v_lon": 5, "v_lat": 1}, "heading", 0, False),
    ],
)
def test_a_breach_is_found_at_its_first_instant(state, rule, time, after):
    drive = Drive({"A": motion(**state)})
    found = first_breach(drive, {"A": Car()}, TEN)
    assert any(part in found.rule for part in rule.split("|"))
    assert (found.vehicle, found.time, found.after) == ("A", time, after)
    if after:
        assert first_breach(drive, {"A": Car()}, Fraction(time)) is None


HALF_A_ROOT = real_roots((1, -4, 2))[0][0]
"""1 - √2/2, the first root of 1 - 4·t + 2·t²."""


@pytest.mark.parametrize(
    ("state", "rule", "time"),
    [
        # 1 - 4·t + 2·t² for 2 s, then 1 again; with 2 its least is 0, which is no reversing.
        ({"v_lon": 1, "pieces": [(2, -4, 0, 4)]}, "v_lon >= 0", HALF_A_ROOT),
        ({"v_lon": 2, "pieces": [(2, -4, 0, 4)]}, None, None),
        # 48 + 4·t - 2·t² is 50 at its greatest; with 49 it passes 50 before it is 51.
        ({"v_lon": 48, "pieces": [(2, 4, 0, -4)]}, None, None),
        ({"v_lon": 49, "pieces": [(2, 4, 0, -4)]}, "v_lon <= 50", HALF_A_ROOT),
        # An acceleration that comes up to its limit where it jumps back; and two that pass it inside a piece.
        ({"v_lon": 20, "pieces": [(2, 0, 0, 2)]}, None, None),
        ({"v_lon": 20, "pieces": [(2, 0, 0, 3)]}, "a_lon <= 4", Fraction(4, 3)),
        ({"v_lon": 40, "pieces": [(3, 0, 0, -3)]}, "a_lon >= -8", Fraction(8, 3)),
        # |v_lat| = 1/2 is too much below 5 m/s, which 6 - 4·t + 2·t² is in the middle alone.
        ({"v_lon": 6, "v_lat": "1/2", "pieces": [(2, -4, 0, 4)]}, "heading", HALF_A_ROOT),
        ({"v_lon": 7, "v_lat": "1/2", "pieces": [(2, -4, 0, 4)]}, None, None),
    ],
)
def test_limits_hold_inside_pieces_with_jerk(state, rule, time):
    """At the samples none of these breaks anything."""
    found = first_breach(Drive({"A": motion(**state)}), {"A": Car()}, None)
    if rule is None:
        assert found is None
    else:
        assert (rule in found.rule, found.time, found.after) == (True, time, True)


def test_boxes_that_meet_under_jerk():
    """A gains t³/6 on the 1 m between the boxes, and is 0.33 m into B when its acceleration jumps to none."""
    pieces = [(2, 0, 0, 1)]
    drive = Drive({"A": motion(0, 2, pieces=pieces), "B": motion(Fraction(11, 2), 2)})
    assert first_overlap(drive, TEN).time == real_roots((-6, 0, 0, 1))[0][0]
    farther = Drive({"A": motion(0, 2, last=(0, 0), pieces=[(2, 0, 0, 1)]), "B": motion(6, 2, 2)})
    assert first_overlap(farther, None) is None  # 1.5 m are never gained: A is no faster than B in the end


def test_reversing_is_a_breach_even_where_the_range_allows_it():
    roomy = Car(v_lon=(Fraction(-5), Fraction(50)))
    assert "no reversing" in first_breach(Drive({"A": motion(v_lon=-1)}), {"A": roomy}, ONE).rule


def test_a_quiet_drive_breaks_nothing():
    drive = Drive({"A": motion(0, 2, 25, 0, [(2, 1, Fraction(1, 2)), (2, 1, Fraction(-1, 2))])})
    assert first_breach(drive, {"A": Car()}, None) is None


def test_wrong_questions():
    drive = Drive({"A": motion(), "B": motion(20)})
    with pytest.raises(UsageError, match="vehicle=B has no limits"):
        first_breach(drive, {"A": Car()}, ONE)
    with pytest.raises(UsageError, match="horizon=-1"):
        first_overlap(drive, -ONE)
    with pytest.raises(UsageError, match="time=-1"):
        state_at(drive.vehicles["A"], -ONE)


def horizon_is_kept():
    """What begins at the horizon is found, and what begins after it is not."""
    together = Drive({"A": motion(0, 2), "B": motion(1, 2)})
    meeting = Drive({"A": motion(0, 2, 25), "B": motion(19, 2, 20)})  # just after 2.9 s
    hard = Drive({"A": motion(0, 2, 25, 0, [(1, 0, 0)], last=(5, 0))})  # from 1 s on
    found = [first_overlap(together, Fraction(0)), first_breach(hard, {"A": Car()}, ONE)]
    missed = [first_overlap(meeting, Fraction(29, 10)), first_breach(hard, {"A": Car()}, Fraction(99, 100))]
    return None not in found and missed == [None, None]


@pytest.mark.parametrize(
    ("right", "wrong"),
    [
        ("begin > Cut(horizon, False)", "begin >= Cut(horizon, False)"),
        ("begin > Cut(horizon, False)", "begin > Cut(horizon, True)"),
        ("begin > Cut(horizon, False)", "begin.point > 2 * horizon"),
    ],
)
def test_faults_at_the_horizon_are_caught(right, wrong, monkeypatch):
    assert horizon_is_kept()
    plant(monkeypatch, replay, "_first", right, wrong)
    assert not horizon_is_kept()


# --- Why a formula is true or false: what is named is enough, whatever all else were ----------------

EXAMPLES = Path(__file__).parents[2] / "examples"
DRIVES = (
    "traffic/drives/scenario-01-base.json",
    "traffic/drives/scenario-04-base.json",
    "catalogue/tests/drives/both-change-fast.json",
)
HOME = bundled_library().select()
MOMENTS = (Fraction(0), Fraction(3, 2), Fraction(14, 5))


def judged(file: DriveFile, text: str) -> Judgement:
    formula = read_claim(HOME, text).formula
    lanes = {"L": file.lanes["L"]}
    return judge(bind(formula, file.road, lanes, values_with(HOME.library, {})), file.drive)


def possible(judgement: Judgement, known: Blame, formula: Formula) -> tuple[TruthSet, TruthSet]:
    """When a formula must, and when it may be true, where comparisons are known only at some instants."""
    match formula:
        case f.Truth():
            return judgement.truth(formula), judgement.truth(formula)
        case f.Compare():
            truth, at = judgement.truth(formula), known.get(formula, NEVER)
            return intersection([truth, at]), union([truth, complement(at)])
        case f.Not(body):
            least, most = possible(judgement, known, body)
            return complement(most), complement(least)
        case f.Application(_, _, body):
            return possible(judgement, known, body)
        case f.And(parts) | f.Or(parts):
            join = intersection if isinstance(formula, f.And) else union
            every = [possible(judgement, known, part) for part in parts]
            return join([x for x, _ in every]), join([x for _, x in every])
        case f.Eventually(interval, body) | f.Always(interval, body):
            reach = eventually if isinstance(formula, f.Eventually) else always
            least, most = possible(judgement, known, body)
            return reach(*interval_seconds(interval), least), reach(*interval_seconds(interval), most)
        case f.Until(left, interval, right):
            first, then = possible(judgement, known, left), possible(judgement, known, right)
            return (
                until(first[0], *interval_seconds(interval), then[0]),
                until(first[1], *interval_seconds(interval), then[1]),
            )
    raise AssertionError(formula)


@pytest.mark.parametrize("drive", DRIVES)
@pytest.mark.parametrize(
    "text",
    [
        *(f"scenario_{n}(SV,POV,L)" for n in (1, 3, 4, 6, 7)),
        "(v_lon(SV) > 27 m/s or not danger(SV,POV)) U[1 s, 3 s] (danger(SV,POV) and F[0, 1 s] atLane(POV,L))",
        "G (F[1 s, 2 s] rssViolation(SV,POV) or G[0, 1 s] not (aheadOf(SV,POV) U danger(SV,POV)))",
    ],
)
def test_what_is_named_is_enough(drive: str, text: str) -> None:
    judgement = judged(load_drive(EXAMPLES / drive), text)
    asked = 0
    for part in list(subformulas(judgement.formula))[:24]:
        for at in MOMENTS:
            found = blame(judgement, part, at)
            known = {x: instants for x, instants in found.items() if isinstance(x, f.Compare)}
            least, most = possible(judgement, known, part)
            assert least.at(at) if judgement.truth(part).at(at) else not most.at(at), (part, at)
            asked += 1
    assert asked >= 24


def test_one_reason_is_enough_for_one_instant() -> None:
    """Of two parts that are false the first is named, and of a window its first false stretch."""
    judgement = judged(load_drive(EXAMPLES / DRIVES[1]), "s(SV) < 0 m and v_lon(SV) < 0 m/s")
    assert isinstance(judgement.formula, f.And)
    first, second = judgement.formula.parts
    fast = judged(load_drive(EXAMPLES / DRIVES[1]), "F[0, 2 s] not s(SV) < 0 m")
    assert set(blame(judgement)) in ({judgement.formula, first}, {judgement.formula, second})
    [instants] = [str(x) for part, x in blame(fast).items() if isinstance(part, f.Compare)]
    assert instants.startswith(("[0", "(0"))


def test_only_judged_parts_are_explained() -> None:
    judgement = judged(load_drive(EXAMPLES / DRIVES[1]), "danger(SV,POV)")
    with pytest.raises(UsageError, match="no judged part"):
        blame(judgement, f.TRUE)


# --- Custom signals and kinds of vehicles: all readers agree, on random formulas and random courses ----

DT, STEPS, TAIL = Fraction(1, 2), 5, 12
VEHICLES = ("SV", "POV")
OWN = load_library(
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
    """A random formula about custom signals and kinds, without operators that never end."""
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
    """Two vehicles of some kind, custom signals that are small whole numbers and change at samples."""
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
    return {key: course[min(step, STEPS)][1] for key, course in drive.custom_signals.items()}


def batch_of(drive: Drive) -> Batch:
    samples = [values_at(drive, k) for k in range(STEPS + TAIL)]
    signals = {key: np.array([float(x[key]) for x in samples])[:, None] for key in drive.custom_signals}
    kinds = {("kind", v): np.array([float(code_of(m.kind))]) for v, m in drive.vehicles.items() if m.kind}
    return Batch(DT, np.array([STEPS + TAIL]), signals, kinds)


def encoded(formula: Formula, drive: Drive) -> bool:
    vehicles = {v: load_vehicle("car") for v in VEHICLES}
    vehicles = {v: type(x)(**{**vars(x), "kind": drive.vehicles[v].kind}) for v, x in vehicles.items()}
    layout = ColumnLayout(VEHICLES, Grid(DT, STEPS), custom_signal_ranges(formula))
    columns = {}
    for own in layout.custom_signals:
        for k in range(STEPS + 1):
            key = own.signal.name, own.signal.vehicle
            columns[layout.custom_signal_column(key[1], key[0], k)] = values_at(drive, k)[key]
    circuit = ground_atoms(
        unroll(formula, layout.grid), vehicles, layout, NO_MARGIN, last_sample_persists=False
    )

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
    query = read_claim(OWN, written(dice, dice.randint(1, 3)))
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
    again = read_claim(OWN, text(as_syntax(formula, expand=True))).formula
    assert without_names(again) == without_names(formula)


@pytest.mark.parametrize("seed", [0, 3, 5, 11])
def test_what_is_proved_is_true_on_drives_and_the_opposite_of_what_is_refuted(seed: int) -> None:
    dice = Random(seed)
    one = written(dice, 1)
    for claim, holds in ((f"({one}) or not ({one})", True), (f"({one}) and not ({one})", False)):
        query = read_claim(OWN, claim)
        assert prove(OWN, query).holds is holds
        assert judge(query.formula, random_drive(dice)).holds is holds


def test_columns_are_looked_up_where_they_stand() -> None:
    formula = read_claim(OWN, "red and jerk(SV) > 0 and gap(POV) < gap(SV)").formula
    layout = ColumnLayout(VEHICLES, Grid(DT, STEPS), custom_signal_ranges(formula))
    first = len(VEHICLES) * len(STARTING) * (STEPS + 1)
    columns = list(layout.custom_signal_unknowns())
    for own in layout.custom_signals:
        for k in range(STEPS + 1):
            place = layout.custom_signal_column(own.signal.vehicle, own.signal.name, k) - first
            of = columns[place].of
            assert (of.vehicle, of.signal, of.step) == (own.signal.vehicle, own.signal.name, k)
            assert (columns[place].low, columns[place].high) == own.range
