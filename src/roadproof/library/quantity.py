"""Terms with their dimensions."""

from dataclasses import dataclass

from roadproof.errors import Position, TextError
from roadproof.logic import terms as t
from roadproof.world.units import SI, Dimension

SECONDS: Dimension = (0, 1)


@dataclass(frozen=True)
class Quantity:
    """A term with its dimension; ``dimension`` None fits every dimension (the literal 0)."""

    term: t.Term
    dimension: Dimension | None


def same_dimension(left: Quantity, right: Quantity, what: str, at: Position) -> Dimension | None:
    """The dimension that both have; ``what`` is done with them. Raises ``TextError`` where they differ."""
    if left.dimension is None or right.dimension is None or left.dimension == right.dimension:
        return right.dimension if left.dimension is None else left.dimension
    plain = t.constant_value(right.term) is not None or t.constant_value(left.term) is not None
    missing = plain and (0, 0) in (left.dimension, right.dimension)
    other = left.dimension if right.dimension == (0, 0) else right.dimension
    raise TextError(
        f"{unit_name(left.dimension)} and {unit_name(right.dimension)} cannot be {what}",
        at,
        f"The number has no unit: write it with {unit_name(other)}." if missing else "",
    )


def unit_name(dimension: Dimension | None) -> str:
    """A dimension as a unit: (1, -2) is m/s^2."""
    if dimension is None or dimension == (0, 0):
        return "no unit"
    return SI.get(dimension) or f"m^{dimension[0]}*s^{dimension[1]}"


def product_dimension(left: Quantity, right: Quantity, sign: int) -> Dimension | None:
    """The dimension of a product (``sign`` 1) or a quotient (-1); None where one has none."""
    if left.dimension is None or right.dimension is None:
        return None
    return (
        left.dimension[0] + sign * right.dimension[0],
        left.dimension[1] + sign * right.dimension[1],
    )
