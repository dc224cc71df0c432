"""What a formula says of the instant that it begins with."""

from collections.abc import Iterator, Mapping

from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.logic.formula import Formula, Interval
from roadproof.logic.rewrite import terms_of
from roadproof.logic.terms import constant_value

_OPPOSITE: Mapping[f.Comparison, f.Comparison] = {"<": ">=", "<=": ">", ">": "<=", ">=": "<"}


def conjuncts(formula: Formula, positive: bool = True) -> Iterator[Formula]:
    """What ``formula`` (else its negation) joins by ``and``, through the names of definitions.

    ``formula`` has no quantifiers: it is bound to a road.
    """
    match formula:
        case f.And(parts) | f.Or(parts) if isinstance(formula, f.And) == positive:
            for part in parts:
                yield from conjuncts(part, positive)
        case f.Not(body):
            yield from conjuncts(body, not positive)
        case f.Named(_, _, body):
            yield from conjuncts(body, positive)
        case _:
            yield formula if positive else f.negation(formula)


def demands(formula: Formula) -> Formula:
    """A formula about one instant, without names, that is true at 0 wherever the bound ``formula`` is.

    What it says of later times only, and of own signals, is left out.
    """
    known: dict[tuple[Formula, bool], Formula] = {}

    def visit(current: Formula, positive: bool) -> Formula:
        key = (current, positive)
        if key not in known:
            known[key] = _demands(current, positive)
        return known[key]

    def _demands(current: Formula, positive: bool) -> Formula:
        match current:
            case f.And(parts) | f.Or(parts):
                below = [visit(part, positive) for part in parts]
                both = isinstance(current, f.And) == positive
                return f.conjunction(*below) if both else f.disjunction(*below)
            case f.Not(body):
                return visit(body, not positive)
            case f.Named(_, _, body):
                return visit(body, positive)
            case f.Always(interval, body) if positive and _has_now(interval):
                return visit(body, True)
            case f.Eventually(interval, body) if not positive and _has_now(interval):
                return visit(body, False)
            case f.Until(left, interval, right) if _has_now(interval):
                now = visit(right, positive)
                return f.disjunction(visit(left, True), now) if positive else now
            case f.Compare(left, op, right) if not _has_own(current):
                return current if positive else f.Compare(left, _OPPOSITE[op], right)
            case f.Truth():
                return current if positive else f.negation(current)
            case _:
                return f.TRUE

    return visit(formula, True)


def _has_now(interval: Interval) -> bool:
    return constant_value(interval.low) == 0


def _has_own(part: f.Compare) -> bool:
    return any(isinstance(leaf, t.Own) for side in terms_of(part) for leaf in t.leaves(side))
