"""When a comparison is true, 1/x with 1/0 = ∞ included (paper, appendix *Robust Semantics*)."""

from collections.abc import Mapping

from roadproof.logic.formula import MIRRORED, Comparison
from roadproof.logic.terms import Inverse, Term
from roadproof.semantics.exact import piecewise
from roadproof.semantics.exact.piecewise import Pieces, where_sign
from roadproof.semantics.exact.polynomial import ONE, multiply
from roadproof.semantics.exact.signals import Courses
from roadproof.semantics.exact.truth import TruthSet, intersection, union

# The signs of left - right for which ``left op right`` is true.
TRUE_SIGNS: Mapping[Comparison, frozenset[int]] = {
    "<": frozenset({-1}),
    "<=": frozenset({-1, 0}),
    ">": frozenset({1}),
    ">=": frozenset({0, 1}),
}
POSITIVE, ZERO, NEGATIVE = frozenset({1}), frozenset({0}), frozenset({-1})
NONZERO = POSITIVE | NEGATIVE


def compare_truth(courses: Courses, left: Term, op: Comparison, right: Term) -> TruthSet:
    """When ``left op right`` holds; ∞ >= ∞ is true and ∞ > ∞ false."""
    match left, right:
        case Inverse(x), Inverse(y):
            return _two_inverses(courses.of(x), op, courses.of(y))
        case Inverse(x), _:
            return _one_inverse(courses.of(x), op, courses.of(right))
        case _, Inverse(y):
            return _one_inverse(courses.of(y), MIRRORED[op], courses.of(left))
        case _:
            return where_sign(piecewise.subtract(courses.of(left), courses.of(right)), TRUE_SIGNS[op])


def _one_inverse(x: Pieces, op: Comparison, y: Pieces) -> TruthSet:
    """1/x op y: where x > 0 as 1 op x·y, where x < 0 as x·y op 1, and ∞ op y where x = 0."""
    product = piecewise.combine(multiply, x, y)
    difference = piecewise.subtract(piecewise.constant(ONE), product)
    return union(
        [
            intersection([where_sign(x, POSITIVE), where_sign(difference, TRUE_SIGNS[op])]),
            intersection([where_sign(x, NEGATIVE), where_sign(difference, TRUE_SIGNS[MIRRORED[op]])]),
            *([where_sign(x, ZERO)] if 1 in TRUE_SIGNS[op] else []),
        ]
    )


def _two_inverses(x: Pieces, op: Comparison, y: Pieces) -> TruthSet:
    """1/x op 1/y: as y op x where the signs agree, as x op y where they differ, ∞ where one is 0."""
    difference = piecewise.subtract(y, x)
    agree = union([_both(x, POSITIVE, y, POSITIVE), _both(x, NEGATIVE, y, NEGATIVE)])
    differ = union([_both(x, POSITIVE, y, NEGATIVE), _both(x, NEGATIVE, y, POSITIVE)])
    cases = [
        intersection([agree, where_sign(difference, TRUE_SIGNS[op])]),
        intersection([differ, where_sign(difference, TRUE_SIGNS[MIRRORED[op]])]),
    ]
    if 1 in TRUE_SIGNS[op]:
        cases.append(_both(x, ZERO, y, NONZERO))
    if 0 in TRUE_SIGNS[op]:
        cases.append(_both(x, ZERO, y, ZERO))
    if -1 in TRUE_SIGNS[op]:
        cases.append(_both(x, NONZERO, y, ZERO))
    return union(cases)


def _both(x: Pieces, x_signs: frozenset[int], y: Pieces, y_signs: frozenset[int]) -> TruthSet:
    return intersection([where_sign(x, x_signs), where_sign(y, y_signs)])
