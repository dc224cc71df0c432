"""Linear constraints against z3: what follows is found, and its multipliers add up to something absurd."""

import random
from contextlib import ExitStack
from fractions import Fraction

import pytest
import z3

from roadproof.evidence.kernel.linear import GOAL, Linear
from roadproof.evidence.times import Moment


def moment(r):
    names = sorted(r.sample("abcde", r.randint(1, 3)))
    factors = [Fraction(r.choice([-2, -1, -1, 1, 1, 3])) / r.choice([1, 1, 2]) for _ in names]
    return Moment(tuple(zip(names, factors, strict=True)), Fraction(r.randint(-3, 3)))


def term(x):
    parts = (z3.RealVal(str(q)) * z3.Real(n) for n, q in x.parts)
    return sum(parts, z3.RealVal(str(x.constant)))


def holds(strict, x):
    return term(x) > 0 if strict else term(x) >= 0


def is_absurd(witness, constraints):
    total, strict = Moment(), False
    for number, factor in witness:
        assert factor > 0
        is_strict, x = constraints[number]
        total += Moment(tuple((n, factor * q) for n, q in x.parts), factor * x.constant)
        strict |= is_strict
    return not total.parts and (total.constant < 0 or (strict and total.constant == 0))


@pytest.mark.parametrize("seed", range(6))
def test_what_follows_is_found_with_multipliers(seed):
    r, found = random.Random(seed), 0
    for _ in range(10):
        linear, solver, constraints = Linear(), z3.Solver(), {}
        with ExitStack() as added:
            for number in range(r.randint(3, 10)):
                strict, x = r.random() < 0.4, moment(r)
                constraints[number] = (strict, x)
                solver.push()
                solver.add(holds(strict, x))
                inside = ExitStack()
                inside.enter_context(linear.taken_back())
                witness = linear.add(number, strict, x)
                assert (witness is not None) == (solver.check() == z3.unsat)
                if witness is not None:
                    assert is_absurd(witness, constraints)
                    inside.close()
                    solver.pop()
                    del constraints[number]
                    continue
                added.push(inside)
                for _ in range(4):
                    goal, above = moment(r), r.random() < 0.4
                    witness = linear.entails(goal, above)
                    solver.push()
                    solver.add(z3.Not(holds(above, goal)))
                    assert (witness is not None) == (solver.check() == z3.unsat)
                    solver.pop()
                    if witness is not None:
                        found += 1
                        assert is_absurd(witness, {**constraints, GOAL: (not above, Moment() - goal)})
    assert found > 3
