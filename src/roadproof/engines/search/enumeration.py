"""Samples many short drives against a claim and judges promising ones exactly.

The monitor ranks all of them in floating point; the judge decides. The rows are the same in every run.
"""

from collections.abc import Callable, Iterator
from dataclasses import replace
from fractions import Fraction
from functools import cached_property
from typing import Literal, TypeAlias

import numpy as np

from roadproof.engines.search.patterns import PIECES, Menu, Patterns, Shares, spread
from roadproof.engines.search.question import SearchProblem, pose
from roadproof.engines.setting import Setting
from roadproof.errors import InputError, UsageError
from roadproof.evidence.drive_file import DriveFile
from roadproof.evidence.judged import JudgedDrive
from roadproof.library.bind import used_values
from roadproof.library.compose import negation
from roadproof.library.specification import Query, Specification
from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.logic.custom_names import custom_signals_of
from roadproof.logic.formula import Formula
from roadproof.logic.initial_conditions import forced_values, top_level_conjuncts
from roadproof.logic.rewrite import bounds_of, intervals_of, leaves_of, terms_of, with_values
from roadproof.runtime.budget import Budget
from roadproof.runtime.records import dataclass
from roadproof.semantics.exact.judging import judge
from roadproof.semantics.exact.replay import first_breach, first_overlap
from roadproof.semantics.sampled.compiled import compile
from roadproof.world.drive import Drive, Motion, Piece
from roadproof.world.vehicle import Range, Vehicle

Within: TypeAlias = Literal["model", "forward", "claim"]
ROWS = 2048  # drives in one round
LOOKS = 60_000  # samples of one round, at most
JUDGED = 24  # drives of one round that are judged because the monitor says so
BLIND = 64  # drives that are judged whatever it says: it sees samples only
LARGE = 40  # parts of a formula, above which no drive is judged blindly
KEPT = 96  # rows from which the next round begins
FAST, HARD = Fraction(60), Fraction(10)  # m/s and m/s^2, where no model limits a vehicle
SPEEDS = tuple(map(Fraction, (0, 0, -5, -10, 5, 10, 20, 30, 40)))
CRUISING = tuple(map(Fraction, (15, 20, 24, 28, 32, 36)))
TYPICAL_PLACES = tuple(map(Fraction, (0, 0, 6, -6, 10, -10, 20, -20, 40, -40, 70, -70, 110, -110)))


def short_refuting_drive(
    specification: Specification,
    claim: Query,
    within: Within,
    rounds: int = 1,
    clock: Budget | None = None,
) -> JudgedDrive | None:
    """Return a judged drive on which ``claim`` is false at time 0; None, which shows nothing, if not found.

    ``within``: ``model`` keeps the limits of the usual models, ``forward`` and ``claim`` only those that the
    claim states: in the first no vehicle reverses, in the second boxes may overlap, too. After the first of
    ``rounds``, each samples around the drives that came nearest. None also for claims about no vehicle or
    about custom signals, or with open numbers. Raises ``BudgetExceeded`` when the ``clock`` has run out.
    """
    search = _short_drive_search(specification, claim, within)
    try:
        return None if search is None else replace(search, clock=clock).run(rounds)
    except (InputError, UsageError):
        return None


def short_satisfying_drive(
    specification: Specification,
    question: SearchProblem,
    keeps: Callable[[Drive], bool],
    clock: Budget | None = None,
) -> JudgedDrive | None:
    """Return a judged short drive on which the formula of ``question`` holds, or None.

    ``keeps``: whether a drive qualifies; ``clock`` as in ``short_refuting_drive``.
    """
    if not question.vehicles or custom_signals_of([question.query.formula]):
        return None
    bound = tuple(question.bound(lanes) for lanes in question.lanes)
    try:
        return _ShortDriveSearch(specification, question, bound, "model", keeps, clock).run(1)
    except (InputError, UsageError):
        return None


def _short_drive_search(
    specification: Specification, claim: Query, within: Within
) -> "_ShortDriveSearch | None":
    if not claim.vehicles or custom_signals_of([claim.formula]):
        return None
    against = negation(claim)
    setting = Setting(values=forced_values(claim.formula), horizon=Fraction(9))
    try:
        question = pose(specification.library, against, setting)
        bound = [question.bound(lanes) for lanes in question.lanes]
    except (InputError, UsageError):
        return None
    return _ShortDriveSearch(specification, question, tuple(bound), within)


@dataclass(frozen=True)
class _ShortDriveSearch:
    specification: Specification
    question: SearchProblem
    formulas: tuple[Formula, ...]
    within: Within
    keeps: Callable[[Drive], bool] | None = None
    clock: Budget | None = None

    def run(self, rounds: int) -> JudgedDrive | None:
        """Judge some drives blindly, then the monitor's choice, in rounds around the best so far."""
        patterns = self.patterns()
        grid = self.question.grid
        count = max(BLIND, min(ROWS, LOOKS // (grid.steps + 1)))
        rows = spread(0, count, patterns.columns)
        size = max(sum(1 for _ in f.subformulas(x)) for x in self.formulas)
        if size <= LARGE:
            for row in rows[:BLIND]:
                for number in range(len(self.formulas)):
                    judged = self._judged(patterns, row, number)
                    if judged is not None:
                        return judged
        monitor = compile(dict(enumerate(self.formulas)))
        for turn in range(1, rounds + 1):
            if self.clock is not None:
                self.clock.seconds_left()
            batch = patterns.batch(rows, grid.dt, grid.steps)
            answers = monitor.evaluate(batch, "clip").answers
            for number in range(len(self.formulas)):
                for row in rows[answers[number].true][:JUDGED]:
                    judged = self._judged(patterns, row, number)
                    if judged is not None:
                        return judged
            if turn < rounds:
                margins = monitor.measure(batch, "clip").margins
                best = np.max([np.nan_to_num(x.low, nan=-np.inf) for x in margins.values()], axis=0)
                rows = _around(rows[np.argsort(-best, kind="stable")[:KEPT]], count, turn)
        return None

    def patterns(self) -> Patterns:
        """Return the building blocks of short drives."""
        menus = {name: self._menu(name, model) for name, model in self.question.vehicles.items()}
        return Patterns(menus, self._durations())

    def _judged(self, patterns: Patterns, row: Shares, number: int) -> JudgedDrive | None:
        if self.clock is not None:
            self.clock.seconds_left()
        drive = patterns.drive([float(x) for x in row])
        if not self._refutes(drive, number):
            return None
        for name in drive.vehicles:
            simpler = (replace(drive, vehicles={**drive.vehicles, name: x}) for x in _simpler(drive, name))
            drive = next((x for x in simpler if self._refutes(x, number)), drive)
        question, specification = self.question, self.specification
        file = DriveFile(
            None,
            specification.set_name,
            question.query.text,
            question.grid.horizon,
            question.lanes[number],
            used_values(specification.library, question.query.formula, question.values),
            specification.options,
            question.road,
            drive,
            overlaps_allowed=self.within == "claim",
        )
        return JudgedDrive(file, specification.library)

    def _refutes(self, drive: Drive, number: int) -> bool:
        return judge(self.formulas[number], drive).holds and self._keeps_limits(drive)

    def _keeps_limits(self, drive: Drive) -> bool:
        if self.keeps is not None:
            return self.keeps(drive)
        if self.within == "claim":
            return True
        if self.within == "model":
            breach = first_breach(drive, self.question.vehicles, None, self.question.road.line)
            return breach is None and first_overlap(drive, self.question.grid.horizon) is None
        return judge(_forward(drive), drive).holds and (
            first_overlap(drive, self.question.grid.horizon) is None
        )

    # --- what drives are made of --------------------------------------------------------------

    def _menu(self, name: str, model: Vehicle) -> Menu:
        free = self.within != "model"
        slowest = -FAST if self.within == "claim" else Fraction(0)
        speed = self._range(name, "v_lon", (slowest, FAST) if free else model.v_lon)
        acceleration = self._range(name, "a_lon", (-HARD, HARD) if free else model.a_lon)
        slow, fast = speed
        usual = list(SPEEDS if free else CRUISING)
        speeds = _within_range([*usual, *self._numbers((1, -1))], speed) or (slow, fast)
        hard, fierce = acceleration
        mild = [Fraction(0), Fraction(0), Fraction(1), Fraction(-1), hard, fierce, hard / 2, fierce / 2]
        accelerations = _within_range([*mild, *self._numbers((1, -2))], acceleration) or (hard, fierce)
        still = hard <= 0 <= fierce
        last = (*(Fraction(0),) * 4 * still, *(accelerations if self.within == "claim" or not still else ()))
        last = last if self.keeps is None else (Fraction(0),)
        edges = sorted({edge for x in self.question.road.lanelets for edge in x.d})
        middles = [(x.d[0] + x.d[1] + model.width) / 2 for x in self.question.road.lanelets]
        sides = tuple(dict.fromkeys([*middles, *(x + model.width / 2 for x in edges[1:-1])]))
        width = max(x.d[1] - x.d[0] for x in self.question.road.lanelets)
        places = (*TYPICAL_PLACES, *self._numbers((1, 0)))
        along = (speed, acceleration, speeds, accelerations, last, places)
        beside, drifts = self._across(name)
        return Menu(model, *along, (*middles, *sides, *beside), width, drifts)

    def _across(self, name: str) -> tuple[tuple[Fraction, ...], tuple[Fraction, ...]]:
        """Places and speeds across the road at the start that the claim compares with."""
        still = (Fraction(0),)
        if self.within != "claim":
            return (), still
        places = self._numbers((1, 0), "d", name)
        drifts = self._numbers((1, -1), "v_lat", name)
        return places, (*still * (len(drifts) or 1), *drifts)

    def _range(self, name: str, signal: t.SignalName, usual: Range) -> Range:
        """The values of a signal that the claim's own limits leave."""
        low, high = usual
        for part in top_level_conjuncts(self.question.query.formula):
            lasting = isinstance(part, f.Always) and part.interval == f.FOREVER
            inner = part.body if lasting and isinstance(part, f.Always) else f.TRUE
            if not isinstance(inner, f.Compare) or inner.left != t.Signal(signal, name):
                continue
            number = t.constant_value(inner.right)
            if number is not None and inner.op in ("<=", "<"):
                high = min(high, number)
            elif number is not None:
                low = max(low, number)
        return (low, high) if low < high else (high, high)

    @cached_property
    def _formula(self) -> Formula:
        return with_values(self.question.query.formula, self.question.values)

    def _numbers(self, dimension: t.Dimension, *of: str) -> tuple[Fraction, ...]:
        """The numbers of this dimension that the formula compares with, and some beside them.

        ``of``: a signal and a vehicle, where only what is compared with it is wanted.
        """
        judged: dict[Fraction, None] = {}
        for part in f.subformulas(self._formula):
            if not isinstance(part, f.Compare) or (of and not _speaks_of(part, *of)):
                continue
            for side in terms_of(part):
                number = t.constant_value(side)
                if number is not None and _measures(side, dimension):
                    judged |= dict.fromkeys((number, number - 1, number + 1))
        return tuple(judged)[:12]

    def _durations(self) -> tuple[Fraction, ...]:
        bounds = [x for interval in intervals_of(self._formula) for x in bounds_of(interval) if x]
        usual = (*map(Fraction, (1, 2, 3)), *dict.fromkeys(x for x in bounds if 0 < x <= 6))[:8]
        if self.keeps is None:
            return usual
        most = self.question.grid.horizon / PIECES
        return tuple(x for x in usual if x <= most) or (most,)


def _speaks_of(part: Formula, signal: str, vehicle: str) -> bool:
    return any(isinstance(x, t.Signal) and (x.name, x.vehicle) == (signal, vehicle) for x in leaves_of(part))


def _measures(term: t.Term, dimension: t.Dimension) -> bool:
    return any(isinstance(x, t.Number) and x.dimension == dimension for x in t.leaves(term))


def _forward(drive: Drive) -> Formula:
    """Return the formula that no vehicle ever reverses."""
    standing = t.Number(Fraction(0), t.SIGNAL_DIMENSIONS["v_lon"])
    speeds = (f.Compare(t.Signal("v_lon", name), ">=", standing) for name in drive.vehicles)
    return f.Always(f.FOREVER, f.conjunction(*speeds))


def _within_range(values: list[Fraction], ends: Range) -> tuple[Fraction, ...]:
    return tuple(x for x in values if ends[0] <= x <= ends[1])


def _simpler(drive: Drive, name: str) -> Iterator[Motion]:
    """Motions of a vehicle that are easier to read, the simplest first: one piece, or none across."""
    motion = drive.vehicles[name]
    straight = tuple(replace(x, a_lat=Fraction(0)) for x in motion.pieces)
    for acceleration in dict.fromkeys((Fraction(0), straight[0].a_lon)):
        yield replace(motion, pieces=(Piece(None, acceleration, Fraction(0)),))
    yield replace(motion, pieces=(straight[0], Piece(None, Fraction(0), Fraction(0))))
    yield replace(motion, pieces=straight)


def _around(rows: Shares, count: int, turn: int) -> Shares:
    """Rows that each share about two thirds of their columns with one of ``rows``."""
    parents = np.resize(np.arange(len(rows)), count)
    fresh = spread(turn * ROWS, count, 2 * rows.shape[1])
    inherited = fresh[:, rows.shape[1] :] < 2 / 3
    return np.where(inherited, rows[parents], fresh[:, : rows.shape[1]])
