"""Matrices by columns are those of ``scipy.sparse``, whose import takes longer than most searches."""

from random import Random
from typing import Any

import numpy as np
import pytest
from scipy.sparse import coo_array, csc_matrix, diags_array

from roadproof.engines.solve.sparse import Columns, Triplets

COLUMNS = 7


def triplets(dice: Random, rows: int) -> Triplets:
    made = Triplets()
    for _ in range(rows):
        columns = dice.sample(range(COLUMNS), dice.randint(0, 4))
        made.add([(c, dice.choice([0.0, 1.0, -1.0, dice.gauss(0, 3)])) for c in columns], dice.gauss(0, 1))
    return made


def same(ours: Columns, theirs: Any) -> bool:
    expected = csc_matrix(theirs)
    expected.sum_duplicates()
    pairs = ((getattr(ours, name), getattr(expected, name)) for name in ("data", "indices", "indptr"))
    return ours.shape == expected.shape and all(np.array_equal(a, b) for a, b in pairs)


def by_scipy(given: Triplets) -> Any:
    places = given.rows, given.columns
    return coo_array((given.values, places), shape=(len(given.right), COLUMNS)).tocsc()


@pytest.mark.parametrize("seed", range(60))
def test_matrices_are_those_of_scipy_to_the_last_bit(seed: int) -> None:
    dice = Random(seed)
    one, other = triplets(dice, dice.randint(1, 12)), triplets(dice, dice.randint(0, 12))
    both = Triplets()
    for part in (one, other):
        for row, right in enumerate(part.right):
            both.add([(c, x) for r, c, x in zip(*part.arrays(), strict=True) if r == row], right)
    assert same(one.stacked(other, COLUMNS), by_scipy(both))
    weights, matrix = np.array([dice.random() for _ in one.right]), by_scipy(one)
    assert same(one.squared(weights, COLUMNS), matrix.T @ diags_array(weights) @ matrix)
    expected = matrix.T @ (weights * np.array(one.right))
    assert np.array_equal(one.weighted(weights, COLUMNS), expected)


def test_entries_at_the_same_place_are_added() -> None:
    made = Triplets()
    made.add([(1, 2.0), (1, 3.0), (0, 1.0)], 0.0)
    found = made.stacked(Triplets(), 2)
    assert [*found.data] == [1.0, 5.0]
    assert [*found.indices] == [0, 0]
    assert [*found.indptr] == [0, 1, 2]


def test_there_may_be_no_entries() -> None:
    nothing = Triplets()
    assert nothing.squared(np.zeros(0), 3).shape == (3, 3)
    assert [*nothing.weighted(np.zeros(0), 2)] == [0.0, 0.0]
    assert [*nothing.stacked(nothing, 1).indptr] == [0, 0]
