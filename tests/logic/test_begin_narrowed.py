"""What is let go of a formula leaves something that implies it."""

from itertools import product

from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.logic.formula import Compare, Formula
from roadproof.logic.initial_conditions import compared, narrowed

A, B, C = (Compare(t.Signal("s", x), ">", t.number(0, (1, 0))) for x in ("A", "B", "C"))
LATER = f.Application("later", (), f.Not(f.And((A, f.Or((B, f.Not(C)))))))
FORMULAS: tuple[Formula, ...] = (
    A,
    f.Not(A),
    f.Or((A, B)),
    f.And((f.Not(A), f.Or((B, C)))),
    LATER,
    f.Not(LATER),
)


def holds(formula: Formula, true: dict[Formula, bool]) -> bool:
    match formula:
        case f.And(parts):
            return all(holds(x, true) for x in parts)
        case f.Or(parts):
            return any(holds(x, true) for x in parts)
        case f.Not(body) | f.Application(_, _, body):
            return holds(body, true) != isinstance(formula, f.Not)
        case f.Truth(value):
            return value
        case _:
            return true[formula]


def test_what_is_left_implies_the_formula_and_does_not_speak_of_it() -> None:
    for formula, values in product(FORMULAS, product((False, True), repeat=3)):
        true: dict[Formula, bool] = dict(zip((A, B, C), values, strict=True))
        left = narrowed(formula, {A})
        assert A not in set(compared(left))
        assert not holds(left, true) or holds(formula, true)


def test_what_need_not_be_let_go_stays() -> None:
    true: dict[Formula, bool] = {A: True, B: True, C: False}
    assert holds(narrowed(f.Or((A, B)), {A}), true)
    assert not holds(narrowed(A, {A}), true)
    assert narrowed(f.Or((A, B)), {C}) == f.Or((A, B))
