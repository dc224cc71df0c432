"""Random formulas with every operator, and random traces whose values are 1 or -1, by number."""

from fractions import Fraction
from random import Random

import numpy as np

from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.logic.formula import Formula
from roadproof.semantics.sampled import Batch

DT = Fraction(1)
NAMES = ("P", "Q", "R")
ATOMS = {name: f.Compare(t.Signal("s", name), ">", t.number(0)) for name in NAMES}
BINARY = (f.Until, f.Since, f.weak_until, f.release)
UNARY = (f.Eventually, f.Always, f.once, f.historically)
LONGEST = 9
TRACES = 4


def random_interval(dice: Random) -> f.Interval:
    low = dice.choice((0, 0, 1, 2))
    width = dice.choice((None, 0, 1, 2, 4))
    seconds = (0, 1)
    high = None if width is None else t.number(low + width, seconds)
    return f.Interval(t.number(low, seconds), high)


def random_formula(dice: Random, depth: int) -> Formula:
    """Return a formula of at most ``depth`` operators above each other."""
    if depth == 0 or dice.random() < 0.1:
        return ATOMS[dice.choice(NAMES)]
    one, other = (random_formula(dice, depth - 1) for _ in range(2))
    match dice.choice(("not", "and", "or", "binary", "binary", "unary", "unary", "unary")):
        case "not":
            return f.negation(one)
        case "and":
            return f.And((one, other))
        case "or":
            return f.Or((one, other))
        case "binary":
            return dice.choice(BINARY)(one, random_interval(dice), other)
        case _:
            return dice.choice(UNARY)(random_interval(dice), one)


def case(number: int) -> tuple[Formula, Batch]:
    """Return the formula and the traces of a number."""
    dice = Random(number)
    formula = random_formula(dice, dice.randint(1, 4))
    rng = np.random.default_rng(number)
    signals = {("s", name): rng.choice([-1.0, 1.0], (LONGEST, TRACES)) for name in NAMES}
    return formula, Batch(DT, rng.integers(1, LONGEST + 1, TRACES), signals)
