"""The judge of countermodels: traces over points in time on a road of rectangles.

It uses the numbers and the road of the trace alone. It evaluates each comparison at each instant; lanes,
lanelets and time are treated as for drives, by the exact judge.
"""

from collections.abc import Mapping, Sequence
from fractions import Fraction
from functools import lru_cache

from roadproof.errors import RoadproofError
from roadproof.evidence.countermodel import NOWHERE, Countermodel, fault_of_states, read_trace
from roadproof.evidence.finding import Acceptance
from roadproof.evidence.periodic import judge_periodic
from roadproof.library.bind import bind, values_with, without_empty_windows
from roadproof.library.elaborate import read_claim
from roadproof.library.motion import under_limits
from roadproof.library.specification import Specification
from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.logic.formula import Formula
from roadproof.logic.node import memoised
from roadproof.logic.rewrite import leaves_of, map_terms, without_names
from roadproof.reasons import NO_REASON, Reason, ReasonKind
from roadproof.semantics.exact import TruthSet, judge
from roadproof.semantics.exact.signals import AbstractSignals
from roadproof.semantics.exact.truth import from_switches
from roadproof.world.lanelet_rules import check_lanelets, shared_boundaries


def fault_of(countermodel: Countermodel, claim: Formula, bounds: Mapping[str, str]) -> str | None:
    """Return why a countermodel does not refute a claim, after judging it; None if it does.

    ``bounds`` gives the declared bound of each parameter against 0 (``>``, ``>=`` or "").
    """
    for name, value in countermodel.parameters.items():
        if (bounds.get(name) and value < 0) or (bounds.get(name) == ">" and value == 0):
            return f"{name}={value}, but it is declared {name} {bounds[name]} 0"
    fault = fault_of_states(countermodel)
    if fault is not None:
        return fault
    try:
        if countermodel.road is not None:
            check_lanelets(countermodel.road.lanelets, "its road")
            if countermodel.road.adjacent != shared_boundaries(countermodel.road.lanelets):
                return "its road's lanes are not beside those with which they share a boundary"
        if when_true(claim, countermodel).at(Fraction(0)):
            return "the claim is true on it"
    except RoadproofError as error:
        return str(error)
    return None


def when_true(formula: Formula, trace: Countermodel) -> TruthSet:
    """Return the set of times at which a formula is true on a trace.

    Raises ``InputError`` and ``UsageError`` if the trace lacks a lane, a value or a signal of the formula.
    """
    bare = without_empty_windows(
        bind(with_trace_values(formula, trace), trace.road or NOWHERE, {}, trace.parameters)
    )
    times = [instant.time for instant in trace.instants]
    comparisons: dict[Formula, TruthSet] = {}
    for part in f.subformulas(bare):
        if isinstance(part, f.Compare):
            truths = [_holds(part, instant.values) for instant in trace.instants]
            comparisons[part] = _truth_set(times, truths, _after(part, truths, trace))
    if trace.loop is not None:
        return judge_periodic(bare, comparisons, trace.loop)
    return judge(bare, None, comparisons).truth(bare)


def with_trace_values(formula: Formula, trace: Countermodel) -> Formula:
    """Return the formula with definitions expanded and variables replaced by their values."""
    first = trace.instants[0].values
    return map_terms(without_names(formula), lambda term: _with_variables(term, first))


def _with_variables(term: t.Term, values: Mapping[str, Fraction]) -> t.Term:
    def leaf(old: t.Leaf) -> t.Term:
        if isinstance(old, t.Variable) and old.name in values:
            return t.Number(values[old.name], old.dimension)
        return old

    return t.replace_leaves(term, leaf)


def _holds(part: f.Compare, values: Mapping[str, Fraction]) -> bool:
    """Return whether a comparison holds in a state."""
    names = sorted(dict.fromkeys(_state_names(part).values()))
    return _holds_at(part, tuple((name, values[name]) for name in names if name in values))


@lru_cache(maxsize=10_000)
def _holds_at(part: f.Compare, values_by_name: tuple[tuple[str, Fraction], ...]) -> bool:
    """Return whether a comparison holds for these values of its signals and sizes, exactly."""
    named, values = _state_names(part), dict(values_by_name)
    signals: dict[t.Signal | t.CustomSignal, tuple[tuple[Fraction, Fraction], ...]] = {
        leaf: ((Fraction(0), values[name]),)
        for leaf, name in named.items()
        if isinstance(leaf, t.Signal | t.CustomSignal) and name in values
    }
    sizes = {
        leaf: values[name] for leaf, name in named.items() if isinstance(leaf, t.Size) and name in values
    }
    return judge(part, AbstractSignals(signals, sizes)).holds


@memoised
def _state_names(part: f.Compare) -> Mapping[t.Leaf, str]:
    """Return the names of the signals and sizes of a comparison, as states have them."""
    leaves = {*leaves_of(part)}
    named: dict[t.Leaf, str] = {
        leaf: f"{leaf.name}({leaf.vehicle})" for leaf in leaves if isinstance(leaf, t.Signal | t.Size)
    }
    return named | {leaf: leaf.text for leaf in leaves if isinstance(leaf, t.CustomSignal)}


def _after(part: f.Compare, truths: Sequence[bool], trace: Countermodel) -> list[bool]:
    """Return whether a comparison holds after each instant, up to the next."""
    unchanged = truths if trace.interpolation == "before" else [*truths[1:], truths[-1]]
    return [
        usual if instant.after is None else _holds(part, instant.after)
        for instant, usual in zip(trace.instants, unchanged, strict=True)
    ]


def _truth_set(times: Sequence[Fraction], values: Sequence[bool], after: Sequence[bool]) -> TruthSet:
    """Return the truth set from truth at instants and between them."""
    return from_switches(zip(times, values, after, strict=True))


def judge_trace(
    content: object, specification: Specification, claim: str, where: str, assuming: Sequence[str] = ()
) -> tuple[Acceptance, Reason]:
    """Return whether a trace refutes a claim under assumptions, and the reason if not.

    ``content``: the parsed JSON of the trace; ``assuming``: the assumptions as text.
    """
    try:
        query = under_limits(specification, read_claim(specification, claim), assuming)
        trace = read_trace(content, where)
        values_with(specification.library, trace.parameters)
        fault = fault_of(trace, query.formula, specification.library.bounds)
    except RoadproofError as error:
        return Acceptance.UNREADABLE, ReasonKind.TOLD(error)
    return (Acceptance.REJECTED, ReasonKind.NOT_REFUTED(fault)) if fault else (Acceptance.ACCEPTED, NO_REASON)
