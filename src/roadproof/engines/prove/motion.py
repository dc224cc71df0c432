"""Chooses facts about motion that may help to prove a claim: instances of schemas, by its comparisons.

They are only chosen here. ``library.motion`` makes the formula of each from its schema and arguments, for
the prover as for whoever checks a certificate.
"""

import math
from collections import deque
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from itertools import product
from typing import assert_never

from roadproof.engines.prove.prover import ProverResult, prove
from roadproof.engines.prove.unknown import StopPoint
from roadproof.errors import InputError
from roadproof.evidence.atoms import is_atom, up_to_variables
from roadproof.library.assumption import Assumption, Axiom, limits_in
from roadproof.library.motion import axiom_formula, under_limits
from roadproof.library.specification import Query, Specification
from roadproof.logic import formula as f
from roadproof.logic import motion
from roadproof.logic import terms as t
from roadproof.logic.formula import Formula
from roadproof.logic.restore import as_syntax, term_as_syntax
from roadproof.logic.rewrite import intervals_of, signals_of, without_names
from roadproof.logic.show import text
from roadproof.logic.terms import SignalName, Term
from roadproof.runtime.budget import Effort
from roadproof.runtime.records import dataclass
from roadproof.runtime.timing import now, seconds_since
from roadproof.verdict import Verdict

MOST = 120  # instances that are tried at once
# Units of work without any, and then for each choice, in turns.
QUICK = 0.5
TURNS = (1.0, 4.0, 16.0, math.inf)
Sides = tuple[Term, Term]
Moving = tuple[tuple[t.Signal, Fraction], ...]


def prove_for_motions(
    specification: Specification, query: Query, assumed: Sequence[str], effort: Effort
) -> ProverResult:
    """Decide whether ``query`` holds on all motions: first with few facts about them, then with more.

    Returns PROVED, VACUOUS or UNKNOWN; counterexamples are searched among drives.
    Raises ``BudgetExceeded``, ``InputError``.
    """
    started, effort = now(), effort.with_clock_started()
    meter = effort.meter()
    none, *choices = axiom_choices(specification, under_limits(specification, query, assumed))
    others = [x for x in choices if x] or [none]
    result = None
    for axioms, units in dict.fromkeys([(none, QUICK), *((x, y) for y in TURNS for x in others)]):
        part = effort.with_units(min(units, max(1.0, meter.left())))
        result = prove(specification, query, part, Assumption(tuple(assumed), axioms))
        meter.spend(result.work)
        if result.verdict is Verdict.PROVED and not axioms and limits_in(assumed):
            bare = Assumption(tuple(assumed), (), limits_in(assumed))
            plain = prove(specification, query, effort.with_units(QUICK), bare)
            meter.spend(plain.work)
            result = plain if plain.holds else result
        if result.verdict is not Verdict.UNKNOWN or meter.is_exhausted():
            break
    assert result is not None, "something is always tried"
    if result.verdict is Verdict.UNKNOWN and result.stop is StopPoint.FACTS and meter.left() <= 0:
        result = replace(result, stop=StopPoint.WORK, reason=meter.reason())
    return replace(result, seconds=seconds_since(started), work=meter.spent)


def axiom_choices(specification: Specification, query: Query) -> list[tuple[Axiom, ...]]:
    """Return sets of motion axioms to try, in order; ``query`` includes its limits.

    First none. Then one kind each, since most proofs need no other, kinds with few instances first: double
    integration, meeting instants, growth in bounded time, invariance without growth, first exit instants.
    Then all together; last also rates absent from the claim, and comparisons hidden in predicates.
    """
    atoms = list(_outermost_parts(query.formula, is_atom))
    simple = [x for x in atoms if _comparison(x) is not None]
    sides = list(dict.fromkeys(_comparison_sides(simple)))
    hidden = [x for x in dict.fromkeys(_comparison_sides(atoms)) if x not in sides]
    spoken = {*signals_of([query.formula])}
    left = [x for x in [*atoms, *_largest_states(query.formula)] if _comparison(x) is None]
    persistence, met = _persistence_axioms(sides, spoken), _meeting_axioms(sides)
    grown, twice = _growth_axioms(query.formula, sides), _double_growth_axioms(query.formula, sides)
    kinds = [twice, met, grown, persistence, _first_instant_axioms(list(dict.fromkeys(left)))]
    valid = [_valid_axioms(specification, query, list(x)) for x in kinds]
    together = tuple(x for kind in valid for x in kind)
    rates = [x for x in map(_rates, [*sides, *hidden]) if x is not None]
    more = [
        *together,
        *_persistence_axioms([*rates, *sides]),
        *_persistence_axioms(hidden, spoken),
        *_meeting_axioms(hidden),
    ]
    deep = _valid_axioms(
        specification, query, [*more, *_growth_axioms(query.formula, hidden), *_persistence_axioms(hidden)]
    )
    return [(), *valid, together[:MOST], deep]


def _meeting_axioms(sides: Sequence[Sides]) -> Iterator[Axiom]:
    for pair in sides:
        yield Axiom("meets", _texts(*pair))


def _largest_states(formula: Formula) -> Iterator[Formula]:
    """Yield the largest parts about one instant, without leading negations, each once."""
    return _outermost_parts(formula, lambda part: f.is_state(part) and not isinstance(part, f.Not))


def _outermost_parts(formula: Formula, condition: Callable[[Formula], bool]) -> Iterator[Formula]:
    seen: set[Formula] = set()
    waiting = deque([formula])
    while waiting:
        part = waiting.popleft()
        meets = condition(part)
        key = up_to_variables(part) if meets else part
        if key in seen:
            continue
        seen.add(key)
        if meets:
            yield part
        else:
            waiting.extend(f.children(part))


def _comparison(atom: Formula) -> f.Compare | None:
    """Return the comparison of a predicate that compares just two terms, else None."""
    match without_names(atom):
        case f.Compare() as made:
            return made
        case f.Not(f.Compare() as made):
            return made
        case _:  # open: formulas of another shape compare more than two terms
            return None


def _valid_axioms(specification: Specification, query: Query, axioms: Sequence[Axiom]) -> tuple[Axiom, ...]:
    """Return the axioms that can be stated: not those about bound lanes, or about signals that may jump."""
    valid: dict[Axiom, None] = {}
    for axiom in axioms:
        try:
            axiom_formula(specification, query, axiom)
        except InputError:
            continue
        valid[axiom] = None
    return tuple(valid)[:MOST]


def _texts(*terms: Term) -> tuple[str, ...]:
    return tuple(text(term_as_syntax(term)) for term in terms)


def _comparison_sides(atoms: Sequence[Formula]) -> Iterator[Sides]:
    """Yield both sides of every comparison in ``atoms``, each way round."""
    for part in (x for atom in atoms for x in f.subformulas(without_names(atom))):
        if isinstance(part, f.Compare) and not (motion.is_rigid(part.left) and motion.is_rigid(part.right)):
            smaller = part.op in ("<", "<=")
            one, other = (part.left, part.right) if smaller else (part.right, part.left)
            yield one, other
            yield other, one


def _signal_names(sides: Sides) -> set[SignalName]:
    return {leaf.name for side in sides for leaf in t.leaves(side) if isinstance(leaf, t.Signal)}


def _rates(sides: Sides) -> Sides | None:
    try:
        return motion.rates(*sides)
    except ValueError:
        return None


def _persistence_axioms(
    sides: Sequence[Sides], spoken: Collection[SignalName] | None = None
) -> Iterator[Axiom]:
    """Yield axioms that a term whose rate is not positive stays; if given, only for ``spoken`` rates."""
    for pair in sides:
        rates = _rates(pair)
        if rates is not None and (spoken is None or _signal_names(rates) <= {*spoken}):
            yield Axiom("at-most", _texts(*pair))
            yield Axiom("below", _texts(*pair))


def _first_instant_axioms(atoms: Sequence[Formula]) -> Iterator[Axiom]:
    """Yield axioms that leaving a predicate, or its negation, has a first instant outside."""
    for atom in atoms:
        for inside in (atom, f.negation(atom)):
            yield Axiom("leaves", (text(as_syntax(inside)),))


# --- growth in bounded time ----------------------------------------------------------------------


@dataclass(frozen=True)
class _Affine:
    """The sum Σ coefficient · signal + a rigid rest."""

    moving: tuple[tuple[t.Signal, Fraction], ...]
    rest: tuple[Term, ...]


def _affine(term: Term, factor: Fraction = Fraction(1)) -> _Affine | None:
    """Return ``factor · term`` as an affine form, where its signals have numeric coefficients."""
    if motion.is_rigid(term):
        return _Affine((), (_scaled(term, factor),))
    match term:
        case t.Signal():
            return _Affine(((term, factor),), ())
        case t.Sum(summands):
            return _total([_affine(x, factor) for x in summands])
        case t.Product(factors):
            numbers = [t.constant_value(x) for x in factors]
            open_ = [x for x, value in zip(factors, numbers, strict=True) if value is None]
            if len(open_) == 1:
                for value in numbers:
                    factor *= 1 if value is None else value
                return _affine(open_[0], factor)
        case t.CustomSignal() | t.Quotient() | t.Power() | t.Maximum() | t.Minimum() | t.Inverse():
            pass
        case t.Number() | t.Parameter() | t.Variable() | t.Size():
            pass
        case _:
            assert_never(term)
    return None


def _total(parts: Sequence[_Affine | None]) -> _Affine | None:
    moving: dict[t.Signal, Fraction] = {}
    rest: list[Term] = []
    for part in parts:
        if part is None:
            return None
        rest += part.rest
        for signal, factor in part.moving:
            moving[signal] = moving.get(signal, Fraction(0)) + factor
    nonzero = sorted(((x, k) for x, k in moving.items() if k), key=lambda x: (x[0].name, x[0].vehicle))
    return _Affine(tuple(nonzero), tuple(rest))


def _scaled(term: Term, factor: Fraction) -> Term:
    match term:
        case t.Number(value, dimension):
            return t.number(value * factor, dimension)
        case t.Product((t.Number(value, (0, 0)), other)):
            return _scaled(other, value * factor)
        case _:  # open: terms of another shape get a factor in front
            pass
    return term if factor == 1 else t.negate(term) if factor == -1 else t.Product((t.number(factor), term))


def _growth_axioms(formula: Formula, sides: Sequence[Sides]) -> Iterator[Axiom]:
    """Yield growth from each bound of a combination, at each bound of its rate, for each duration."""
    bounds = _bounds_by_combination(sides)
    times = _times(formula)
    for moving, known in bounds.items():
        faster = _rate_of(moving)
        if faster is None:
            continue
        for start in known:
            for speed in (x for x in _bounds_of_combination(faster, bounds) if t.constant_value(x) != 0):
                for duration in times:
                    arguments = _texts(*_two_sides(moving, start), speed, duration)
                    yield Axiom("within", arguments)
                    yield Axiom("after", arguments)


def _double_growth_axioms(formula: Formula, sides: Sequence[Sides]) -> Iterator[Axiom]:
    """Yield growth from bounds of a combination and its rate, at each bound of its second rate."""
    bounds = _bounds_by_combination(sides)
    times = _times(formula)
    for moving, known in bounds.items():
        faster = _rate_of(moving)
        second = None if faster is None else _rate_of(faster)
        if faster is None or second is None:
            continue
        for start, speed in product(known, _bounds_of_combination(faster, bounds)):
            for growth, duration in product(_bounds_of_combination(second, bounds), times):
                arguments = _texts(*_two_sides(moving, start), speed, growth, duration)
                yield Axiom("after-twice", arguments)
                yield Axiom("within-twice", arguments)


def _bounds_by_combination(sides: Sequence[Sides]) -> dict[Moving, dict[Term, None]]:
    """Return the upper bounds that comparisons give for each combination of signals."""
    bounds: dict[Moving, dict[Term, None]] = {}
    for left, right in sides:
        both = _total([_affine(left), _affine(right, Fraction(-1))])
        if both is not None and both.moving:
            bounds.setdefault(both.moving, {})[_sum([_scaled(x, Fraction(-1)) for x in both.rest])] = None
    return bounds


def _bounds_of_combination(moving: Moving, bounds: Mapping[Moving, Collection[Term]]) -> list[Term]:
    """Return bounds of a combination; where it has none, sums of bounds of its signals."""
    known = bounds.get(moving)
    if known:
        return list(known)
    single = [
        [_scaled(x, abs(k)) for x in bounds.get(((signal, Fraction(1 if k > 0 else -1)),), ())]
        for signal, k in moving
    ]
    return [_sum(chosen) for chosen in product(*single)]


def _rate_of(moving: Moving) -> Moving | None:
    """Return the rate of a combination of signals; None where one of them has none."""
    if not all(signal.name in motion.RATES for signal, _ in moving):
        return None
    return tuple((t.Signal(motion.RATES[x.name], x.vehicle), k) for x, k in moving)


def _times(formula: Formula) -> list[Term]:
    bounds = [x for interval in intervals_of(formula) for x in (interval.low, interval.high) if x is not None]
    return [x for x in dict.fromkeys(bounds) if t.constant_value(x) != 0]


def _sum(terms: Sequence[Term]) -> Term:
    return motion.add(*terms) if terms else t.number(0)


def _two_sides(moving: tuple[tuple[t.Signal, Fraction], ...], start: Term) -> Sides:
    """Return Σ coefficient · signal <= start as two sides, without minus signs where possible."""
    left = [_scaled_signal(x, k) for x, k in moving if k > 0]
    right = [_scaled_signal(x, -k) for x, k in moving if k < 0]
    if left:
        return motion.add(*left), motion.add(*right, start)
    return _scaled(start, Fraction(-1)), motion.add(*right)


def _scaled_signal(signal: t.Signal, factor: Fraction) -> Term:
    return signal if factor == 1 else t.Product((t.number(factor), signal))
