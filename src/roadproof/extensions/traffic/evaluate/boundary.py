"""Matches on measured roads that depend on differences smaller than the error of the projection.

A match is sure where its formula holds however each comparison of places comes out that is nearer to its
boundary than places may be off there: such a comparison counts as false where the formula needs it, and as
true where the formula needs that it is false. The other way round, a formula may hold. Comparisons are taken
one by one at every sample, as if each could be off by itself, so a match that is called sure is, and one that
may not hold does not; others may be either. Velocities, and which lanelets a box is in, are taken as they
are, and so is where a trace starts and ends.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from typing import Generic

import numpy as np

from roadproof.extensions.traffic.evaluate.traces import LaneAtom, blocks, gather, rows_of
from roadproof.extensions.traffic.formats.recording import Bools, Floats, Integers, Recording, Slack
from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.logic.formula import Compare, Formula
from roadproof.logic.rewrite import signals_of, terms_of, without_names
from roadproof.semantics.sampled.answers import Convention, Key
from roadproof.semantics.sampled.arithmetic import COMPARISONS, margin_program
from roadproof.semantics.sampled.batch import Array, Batch
from roadproof.semantics.sampled.compiled import Monitor, compile
from roadproof.semantics.sampled.robustness import observe_margins

PLACES = ("s", "d")
_CELLS = 200_000
"""So many samples of traces are looked at together."""


@dataclass(frozen=True)
class TraceQuestions(Generic[Key]):
    """Formulas asked of traces: vehicles and lanes by name as for ``gather``, an entry a trace."""

    formulas: Mapping[Key, Formula]
    vehicles: Mapping[str, Integers]
    low: Integers
    high: Integers
    lanes: Mapping[str, Integers]
    atoms: Mapping[Formula, LaneAtom]
    convention: Convention

    def choose(self, index: Integers | Bools) -> "TraceQuestions[Key]":
        """The questions to some of the traces."""
        vehicles, lanes = ({k: x[index] for k, x in each.items()} for each in (self.vehicles, self.lanes))
        low, high = self.low[index], self.high[index]
        return TraceQuestions(self.formulas, vehicles, low, high, lanes, self.atoms, self.convention)


@dataclass(frozen=True)
class TruthBounds:
    """The truth of a formula under errors of places, for each trace: for all errors, and for some."""

    surely: Bools
    perhaps: Bools


def truth_bounds(
    recording: Recording, slack: Slack, questions: TraceQuestions[Key]
) -> dict[Key, TruthBounds]:
    """The bounds of each formula, where places are off by no more than ``slack``."""
    count = len(questions.low)
    bounds = {key: TruthBounds(*np.zeros((2, count), np.bool_)) for key in questions.formulas}
    if not count or not bounds:
        return bounds
    bounded = _BoundedFormulas()
    parts = {
        (key, helps): bounded.visit(without_names(formula), helps)
        for key, formula in questions.formulas.items()
        for helps in (True, False)
    }
    monitor = compile(parts)
    for index in blocks(questions.low, questions.high, _CELLS):
        true = _bounds_in_block(recording, slack, questions.choose(index), bounded, monitor)
        for key, bound in bounds.items():
            bound.surely[index], bound.perhaps[index] = true[key, True], true[key, False]
    return bounds


def _bounds_in_block(
    recording: Recording,
    slack: Slack,
    questions: TraceQuestions[Key],
    bounded: "_BoundedFormulas",
    monitor: Monitor[tuple[Key, bool]],
) -> Mapping[tuple[Key, bool], Bools]:
    signals = signals_of(questions.formulas.values())
    batch = gather(
        recording,
        questions.vehicles,
        questions.low,
        questions.high,
        signals,
        questions.lanes,
        questions.atoms,
    )
    comparisons = tuple(bounded.comparisons)
    margins = observe_margins(comparisons, margin_program(comparisons), batch, slice(0, batch.traces))
    rows = {
        name: rows_of(recording, v, questions.low, questions.high) for name, v in questions.vehicles.items()
    }
    given: dict[Formula, Array] = dict(batch.given)
    for compare in comparisons:
        off = _place_error(compare, slack, rows)
        for sign, atom in zip((-1.0, 1.0), bounded.comparisons[compare], strict=True):
            with np.errstate(invalid="ignore"):  # an endless margin that is endlessly off is not known
                shifted = np.nan_to_num(margins[compare] + sign * off, nan=sign * np.inf)
            relation = COMPARISONS[">" if compare.op in ("<", ">") else ">="]
            given[atom] = relation(shifted, 0.0)
    return monitor.holds(
        Batch(batch.dt, batch.lengths, batch.signals, batch.sizes, given), questions.convention
    )


@dataclass
class _BoundedFormulas:
    """Formulas with two atoms for each comparison of places: that it surely holds, and that it may.

    The first stands where truth of the comparison helps the formula, the second where it hurts.
    """

    comparisons: dict[Compare, tuple[Formula, Formula]] = field(default_factory=dict)
    known: dict[tuple[Formula, bool], Formula] = field(default_factory=dict)

    def visit(self, formula: Formula, helps: bool) -> Formula:
        """The formula that holds only if this one surely does, if it ``helps``; else if this one may."""
        key = (formula, helps)
        if key not in self.known:
            self.known[key] = self._made(formula, helps)
        return self.known[key]

    def _made(self, formula: Formula, helps: bool) -> Formula:
        match formula:
            case Compare():
                if not any(_is_place(leaf) for term in terms_of(formula) for leaf in t.leaves(term)):
                    return formula
                name = f"comparison {len(self.comparisons)}"
                # An atom that only the batch decides; no lanelet has such a name.
                atoms = (f.Occupies(name, "surely"), f.Occupies(name, "perhaps"))
                return self.comparisons.setdefault(formula, atoms)[0 if helps else 1]
            case f.Not(body):
                return f.Not(self.visit(body, not helps))
            case f.Some() | f.Every():
                return formula
            case (
                f.Truth()
                | f.Occupies()
                | f.And()
                | f.Or()
                | f.Until()
                | f.Since()
                | f.Eventually()
                | f.Always()
                | f.Application()
            ):
                parts = tuple(self.visit(child, helps) for child in f.children(formula))
                return f.with_children(formula, parts)


def _is_place(leaf: t.Leaf) -> bool:
    return isinstance(leaf, t.Signal) and leaf.name in PLACES


def _place_error(compare: Compare, slack: Slack, rows: Mapping[str, Integers]) -> Floats:
    """Return by how much both sides together may be off, for each sample of each trace.

    That is what each box is off by, and between boxes what the road turns there, times how far beside the
    line they are: so much longer or shorter is the way there than the line (``Slack``). Endless where
    places are not added and multiplied by numbers only.
    """
    shares = _coefficients(t.subtract(compare.left, compare.right))
    shape = next(iter(rows.values())).shape
    if shares is None:
        return np.full(shape, np.inf)
    off = np.zeros(shape)
    along, across = (
        {leaf.vehicle: abs(float(c)) for leaf, c in shares.items() if leaf.name == name and c}
        for name in PLACES
    )
    for each, ends in ((along, slack.along), (across, slack.across)):
        for vehicle, share in each.items():
            off += share * ends[rows[vehicle]]
    if len(along) > 1:
        turn = np.stack([slack.turn[rows[vehicle]] for vehicle in along])
        beside = np.stack([slack.off[rows[vehicle]] for vehicle in along])
        off += max(along.values()) * np.ptp(turn, axis=0) * beside.max(axis=0)
    return off


def _coefficients(term: t.Term) -> dict[t.Signal, Fraction] | None:
    """Return the coefficient of each place in a linear term; None for a term that is not linear in places."""
    if not any(_is_place(leaf) for leaf in t.leaves(term)):
        return {}
    match term:
        case t.Signal():
            return {term: Fraction(1)}
        case t.Sum(parts):
            total: dict[t.Signal, Fraction] = {}
            for part in parts:
                shares = _coefficients(part)
                if shares is None:
                    return None
                for signal, share in shares.items():
                    total[signal] = total.get(signal, Fraction(0)) + share
            return total
        case t.Product(factors):
            numbers = [t.constant_value(x) for x in factors]
            others = [x for x, value in zip(factors, numbers, strict=True) if value is None]
            inner = _coefficients(others[0]) if len(others) == 1 else None
            if inner is None:
                return None
            factor = Fraction(1)
            for value in numbers:
                factor *= Fraction(1) if value is None else value
            return {signal: share * factor for signal, share in inner.items()}
        case t.Quotient() | t.Power() | t.Maximum() | t.Minimum() | t.Inverse() | t.CustomSignal():
            return None
        case t.Number() | t.Parameter() | t.Variable() | t.Size():
            return None
