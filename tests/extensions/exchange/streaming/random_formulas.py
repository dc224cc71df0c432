"""Random formulas with nested temporal operators, the same for the same seed."""

import numpy as np

from extensions.traffic.monitoring.cases import IN_LANE, ON_MAIN, interval
from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.logic.formula import Formula

_OPS = ("<", "<=", ">", ">=")
_X = t.Signal("s", "SV")
_Y = t.Signal("v_lon", "POV")
_TERMS: tuple[t.Term, ...] = (
    _X,
    _Y,
    t.Size("length", "SV"),
    t.number(0),
    t.subtract(_X, _Y),
    t.Sum((_X, t.Product((t.number(3), _Y)), t.Power(_X, 2))),
    t.Maximum((t.number(0), t.Quotient(t.Power(_Y, 3), t.Size("length", "SV")))),
    t.Minimum((_X, _Y, t.subtract(t.number(1), _Y))),
)


def random_formula(rng: np.random.Generator, depth: int, ends: bool = False) -> Formula:
    """A formula with about ``depth`` operators above each other; ``ends``: within bounds of time."""
    kind = rng.integers(0, 3) if depth == 0 else rng.integers(0, 15)
    if kind == 0:
        return IN_LANE if rng.random() < 0.5 else ON_MAIN
    if kind <= 2:
        left, right = (_TERMS[k] for k in rng.integers(0, len(_TERMS), 2))
        if rng.random() < 0.1:
            left, right = t.Inverse(left), t.Inverse(right)
        return f.Compare(left, _OPS[rng.integers(0, 4)], right)
    inner = [random_formula(rng, depth - 1, ends or kind >= 12) for _ in range(2)]
    if kind == 3:
        return f.Not(inner[0])
    if kind <= 5:
        return f.And(tuple(inner)) if kind == 4 else f.Or(tuple(inner))
    low = int(rng.integers(0, 3))
    width = [None, 0, int(rng.integers(1, 5)), int(rng.integers(5, 80))][
        rng.choice(4, p=[0.4, 0.1, 0.4, 0.1])
    ]
    if kind == 12:
        return f.Since(inner[0], interval(low, width), inner[1])
    if kind >= 13:
        return (f.once if kind == 13 else f.historically)(interval(low, width), inner[0])
    if ends and width is None:
        width = 3
    if kind <= 7:
        return f.Until(inner[0], interval(low, width), inner[1])
    return (f.Eventually if kind <= 9 else f.Always)(interval(low, width), inner[0])
