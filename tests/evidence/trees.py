"""Trees for small programs: right ones, and wrong ones that each rule of the checker has to refuse."""

from dataclasses import replace

from roadproof.evidence.program import (
    CaseSplit,
    ColumnSplit,
    Disjunction,
    DisjunctiveProgram,
    Fact,
    Linear,
    WeightedSum,
)

# Between 0 and 3 are x and y, and x*y = 6; x + y >= 7 or x >= 4 is impossible there.
PROGRAM = DisjunctiveProgram(
    1,
    ((0, 3), (0, 3)),
    ((0, 1),),
    (Linear(((2, 1),), -6),),
    (),
    (Linear(((0, 1), (1, 1)), -7), Linear(((0, 1),), -4), Disjunction((0, 1))),
)
LEAVES = (WeightedSum(((Fact("node", 0), 1),)), WeightedSum(((Fact("node", 1), 1),)))


def with_sum(constant: int, strict: bool = False) -> DisjunctiveProgram:
    """x + y is at least, or above, minus the constant."""
    first = Linear(((0, 1), (1, 1)), constant, strict)
    return replace(PROGRAM, nodes=(first, *PROGRAM.nodes[1:]))


def alone(*rows: Linear, node: Linear, product: tuple[int, int] = (0, 1)) -> DisjunctiveProgram:
    """The box with these equations and one inequality."""
    return replace(PROGRAM, products=(product,), equal=rows, nodes=(node,))


# x is at least 1 where x*y >= 3 and y <= 3; it is not above 1. x^2 >= 4 leaves x = 2 and more.
CORNER = alone(Linear(((2, 1),), -3), node=Linear(((0, -3),), 2))
SQUARE = alone(node=Linear(((2, -1), (0, 2)), -2), product=(0, 0))
BY_CORNER = WeightedSum(((Fact("equal", 0), 1), (Fact("corner", 0, (0, 1)), 1), (Fact("node", 0), 1)))
BY_TANGENT = WeightedSum(((Fact("tangent", 0, (1, 0)), 1), (Fact("node", 0), 1)))
RIGHT = {
    "cases": (PROGRAM, CaseSplit(2, LEAVES)),
    "strict": (with_sum(-6, strict=True), CaseSplit(2, LEAVES)),
    "cut": (PROGRAM, ColumnSplit(0, 1, CaseSplit(2, LEAVES), CaseSplit(2, LEAVES))),
    "corner": (CORNER, BY_CORNER),
    "tangent": (SQUARE, BY_TANGENT),
    "half": (replace(PROGRAM, scale=2, box=((0, 6), (0, 6))), CaseSplit(2, LEAVES)),
    "half, corner": (
        replace(CORNER, scale=2, box=((0, 6), (0, 6))),
        WeightedSum(((Fact("equal", 0), 4), (Fact("corner", 0, (0, 1)), 1), (Fact("node", 0), 4))),
    ),
}
WRONG = {
    "a part is missing": (PROGRAM, CaseSplit(2, LEAVES[:1])),
    "the first part has a solution": (with_sum(-5), CaseSplit(2, LEAVES)),
    "the second part has a solution": (
        replace(PROGRAM, nodes=(PROGRAM.nodes[0], Linear(((0, 1),), -2), PROGRAM.nodes[2])),
        CaseSplit(2, LEAVES),
    ),
    "it is not known": (PROGRAM, LEAVES[0]),
    "no disjunction": (PROGRAM, CaseSplit(0, ())),
    "not known disjunction": (replace(PROGRAM, nodes=(*PROGRAM.nodes, Linear((), 0))), CaseSplit(2, LEAVES)),
    "negative": (with_sum(0), CaseSplit(2, (WeightedSum(((Fact("node", 0), -1),)), LEAVES[1]))),
    "nothing": (PROGRAM, WeightedSum(())),
    "no such equation": (PROGRAM, WeightedSum(((Fact("equal", 1), 1),))),
    "on the boundary": (with_sum(-6), CaseSplit(2, LEAVES)),
    "strict times 0": (
        alone(Linear((), 0), node=Linear(((0, 1),), 1, strict=True)),
        WeightedSum(((Fact("node", 0), 0), (Fact("equal", 0), 1))),
    ),
    "another corner": (replace(CORNER, nodes=(Linear(((0, -3),), 3),)), BY_CORNER),
    "sign of a corner": (
        alone(Linear(((2, -1),), 3), node=Linear(((0, 3),), -4)),
        WeightedSum(((Fact("equal", 0), 1), (Fact("corner", 0, (0, 1)), 1), (Fact("node", 0), 1))),
    ),
    "tangent of a product": (replace(SQUARE, products=((0, 1),)), BY_TANGENT),
    "tangent elsewhere": (replace(SQUARE, nodes=(Linear(((2, -1), (0, 2)), -1),)), BY_TANGENT),
    "negative tangent": (
        alone(node=Linear(((2, 1), (0, -2)), -2), product=(0, 0)),
        WeightedSum(((Fact("tangent", 0, (1, 0)), -1), (Fact("node", 0), 1))),
    ),
    "a half is left out": (PROGRAM, ColumnSplit(0, 1, CaseSplit(2, LEAVES), WeightedSum(()))),
}
