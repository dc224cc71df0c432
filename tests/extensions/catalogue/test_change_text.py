"""The change that is named makes the comparison true, and a tenth less of it does not."""

import re
from fractions import Fraction
from random import Random

import pytest

from roadproof.extensions.catalogue.change_text import change_text
from roadproof.logic import formula as f
from roadproof.logic import terms as t

POV, SV = t.Signal("s", "POV"), t.Signal("s", "SV")
SPEED = t.Signal("v_lon", "SV")
LENGTH = t.Size("length", "POV")
SIDES = (
    (t.subtract(POV, SV), t.Sum((LENGTH, t.Product((t.number(Fraction(3, 2)), SPEED))))),
    (t.subtract(t.subtract(SV, LENGTH), POV), t.Maximum((t.number(0), t.Power(SPEED, 2)))),
    (SPEED, t.number(20)),
    (t.number(5), t.Signal("d", "POV")),
)
GREATER = {"ahead": 1, "left": 1, "faster": 1, "back": -1, "right": -1, "slower": -1}
SAID = re.compile(r"(\w+) would have to be at least (\S+) (m|m/s) (?:further )?(\w+) then")


def value_of(term: t.Term, values: dict[t.Signal | t.Size, Fraction]) -> Fraction:
    parts = [value_of(x, values) for x in t.children(term)]
    match term:
        case t.Number(number, _):
            return number
        case t.Sum():
            return sum(parts, Fraction(0))
        case t.Product():
            return parts[0] * parts[1]
        case t.Power():
            return Fraction(parts[0] ** 2)
        case t.Maximum():
            return max(parts)
    return values[term]  # type: ignore[index]


def holds(comparison: f.Compare, values: dict[t.Signal | t.Size, Fraction]) -> bool:
    x, y = value_of(comparison.left, values), value_of(comparison.right, values)
    return {"<": x < y, "<=": x <= y, ">": x > y, ">=": x >= y}[comparison.op]


@pytest.mark.parametrize("seed", range(200))
def test_the_change_is_enough_and_a_tenth_less_is_not(seed: int) -> None:
    dice = Random(seed)
    left, right = dice.choice(SIDES)
    leaves = {x: Fraction(dice.randint(1, 900), 10) for x in (*t.leaves(left), *t.leaves(right))}
    values = {x: y for x, y in leaves.items() if isinstance(x, t.Signal | t.Size)}
    strict = dice.choice((True, False))
    below: f.Comparison = "<" if strict else "<="
    above: f.Comparison = ">" if strict else ">="
    one, other = f.Compare(left, below, right), f.Compare(left, above, right)
    comparison = other if holds(one, values) else one
    told = change_text(comparison, comparison.op, values)
    said = SAID.fullmatch(told)
    assert said is not None, told
    vehicle, amount, unit, direction = said.groups()
    name = {"m/s": "v_lon"}.get(unit, "d" if direction in ("left", "right") else "s")
    signal = next(x for x in values if isinstance(x, t.Signal) and (x.name, x.vehicle) == (name, vehicle))
    change = Fraction(amount) * GREATER[direction]
    assert holds(comparison, {**values, signal: values[signal] + change * Fraction(1001, 1000)})
    assert not holds(comparison, {**values, signal: values[signal] + change * Fraction(9, 10)})


def test_without_such_a_signal_nothing_is_named() -> None:
    squared = f.Compare(t.Power(SPEED, 2), ">", t.number(900))
    assert change_text(squared, ">", {SPEED: Fraction(20)}) == ""
