"""Searches small countermodels that end in a loop or change right after an instant.

They range over the truth values that the claim's predicates can have together, a few instants long;
the prover's models cannot have this form. Refuting ones get numbers and are judged apart.
"""

from collections.abc import Iterator, Sequence
from fractions import Fraction
from itertools import islice, product
from typing import TypeAlias

from roadproof.engines.prove.countermodel import Trace, Values, realise
from roadproof.engines.prove.roads import open_quantifiers
from roadproof.engines.prove.search import Model
from roadproof.engines.prove.states import StateChecker
from roadproof.errors import RoadproofError
from roadproof.evidence.countermodel import Countermodel, Instant, Loop
from roadproof.evidence.periodic import judge_periodic
from roadproof.library.bind import without_empty_windows
from roadproof.library.specification import Query
from roadproof.logic import formula as f
from roadproof.logic.formula import Formula
from roadproof.logic.rewrite import bounds_of, intervals_of, with_values
from roadproof.runtime.budget import Budget, BudgetExceeded
from roadproof.runtime.records import dataclass
from roadproof.semantics.exact import TruthSet
from roadproof.semantics.exact.truth import from_switches

MOST_ATOMS = 3
INSTANTS = 3  # at most, before and in the loop
CANDIDATES = 1500  # traces that are tried for one unit of time
A_CANDIDATE = 1 / 2000  # units of work
PLACED = 12  # of those that refute, for which a road and places are looked for
Valuation: TypeAlias = tuple[bool, ...]
Pair: TypeAlias = tuple[Valuation, Valuation]


@dataclass(frozen=True)
class _LassoShape:
    """The truth values at and after each instant, ``step`` s apart; from instant ``again`` on they repeat."""

    states: tuple[Pair, ...]
    again: int
    step: Fraction

    @property
    def times(self) -> list[Fraction]:
        return [k * self.step for k in range(len(self.states))]

    @property
    def loop(self) -> Loop:
        start = self.again * self.step
        return Loop(start, len(self.states) * self.step - start)

    def truth(self, number: int) -> TruthSet:
        """Return when one predicate is true in the first round."""
        pairs = zip(self.times, self.states, strict=True)
        return from_switches((time, at[number], after[number]) for time, (at, after) in pairs)


def find_lasso(query: Query, goal: Formula, checker: StateChecker, meter: Budget) -> Countermodel | None:
    """Return a trace on which the claim is judged false; None, which shows nothing, where none was found.

    ``goal``: a part of the claim, abstracted. None where it has more than three predicates, speaks of one
    instant only, or quantifies over lanes. Raises ``BudgetExceeded``.
    """
    met = (x.name for x in f.subformulas(goal) if isinstance(x, f.Application))
    names = [name for name in dict.fromkeys(met) if name in checker.atoms.named]
    if f.is_state(goal) or open_quantifiers(goal) or not 0 < len(names) <= MOST_ATOMS:
        return None
    possible = [
        values
        for values in product((True, False), repeat=len(names))
        if checker.refute(dict(zip(names, values, strict=True)), meter) is None
    ]
    atoms = {x.name: x for x in f.subformulas(goal) if isinstance(x, f.Application) and x.name in names}
    plain = {name: with_values(atom, checker.defaults) for name, atom in atoms.items()}
    try:
        abstracted = without_empty_windows(with_values(goal, checker.defaults))
        placed = 0
        for shape in _shapes(possible, _steps(abstracted)):
            if meter.is_exhausted() or placed == PLACED:
                return None
            meter.spend(A_CANDIDATE)
            given: dict[Formula, TruthSet] = {plain[x]: shape.truth(k) for k, x in enumerate(names)}
            if not judge_periodic(abstracted, given, shape.loop).at(Fraction(0)):
                placed += 1
                countermodel = _realise(query, checker, names, shape)
                if countermodel is not None:
                    return countermodel
    except RoadproofError as error:
        if isinstance(error, BudgetExceeded):
            raise
    return None


def _steps(formula: Formula) -> list[Fraction]:
    """Return candidate distances of instants: a second, and bounds of the formula's intervals."""
    bounds = {x for window in intervals_of(formula) for x in bounds_of(window) if x}
    return list(dict.fromkeys([Fraction(1), *sorted(bounds)[:2], *(x / 2 for x in sorted(bounds)[:1])]))


def _shapes(possible: Sequence[Valuation], steps: Sequence[Fraction]) -> Iterator[_LassoShape]:
    """Yield shapes, shorter ones first, those without a change after an instant before others."""
    for step in steps:
        yield from islice(_shapes_of_step(possible, step), CANDIDATES)


def _shapes_of_step(possible: Sequence[Valuation], step: Fraction) -> Iterator[_LassoShape]:
    steady: list[Pair] = [(x, x) for x in possible]
    both: list[Pair] = [(x, y) for x in possible for y in possible]
    for pairs, longest in ((steady, INSTANTS), (both, INSTANTS - 1)):
        for count in range(1, longest + 1):
            for states in product(pairs, repeat=count):
                for again in range(count):
                    yield _LassoShape(states, again, step)


def _realise(
    query: Query, checker: StateChecker, names: Sequence[str], shape: _LassoShape
) -> Countermodel | None:
    """Return the shape as a judged countermodel on a road, or None."""
    moments = [x for pair in shape.states for x in pair]
    truths = [dict(zip(names, x, strict=True)) for x in moments]
    halves = [k * shape.step / 2 for k in range(len(moments))]
    signals = {time: checker.signals(x) for time, x in zip(halves, truths, strict=True)}
    lanes = {lane: f.Domain("lanes") for lane in query.lanes}
    model = Model({}, dict(zip(halves, truths, strict=True)), signals, lanes, {})

    def traces(_: Sequence[Fraction], states: Sequence[Values]) -> Iterator[Trace]:
        """Yield the one trace of the shape, with numbers from ``states``."""
        own = (x != y for x, y in shape.states)
        rows = zip(shape.times, states[::2], states[1::2], own, strict=True)
        instants = (Instant(time, at, {}, after if differs else None) for time, at, after, differs in rows)
        at, after = shape.states[-1]
        stays = at == after and shape.again == len(shape.states) - 1
        yield tuple(instants), "before", None if stays else shape.loop

    return realise(query, checker, model, traces)
