"""Each formula of the page about encodings holds for what the encoder makes."""

import re
from collections.abc import Mapping
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import roadproof as rp
from roadproof.engines.encode.motion import ColumnLayout
from roadproof.engines.encode.problem import AnyOf, Inequality, Leaf, LimitKind, Problem, Row
from roadproof.engines.encode.unroll import Grid
from roadproof.engines.solve.big_m import encode_mixed
from roadproof.engines.solve.bounds import Affine, Bound, affine_bounds
from roadproof.extensions.encoding.encode import Encoding
from roadproof.world.models import load_road, load_vehicle
from roadproof.world.polynomial import Polynomial, variable
from roadproof.world.signals import SignalName

PAGE = Path(__file__).parents[3] / "docs/explanation/encoding.md"
FORMULAS: Mapping[str, str] = dict(re.findall(r"^(E\d+): (.+)$", PAGE.read_text("utf-8"), re.M))
CAR, INSIDE, REACH = load_vehicle("car"), Fraction(1, 100), Fraction(80)


@pytest.fixture(scope="module")
def encoding() -> Encoding:
    return rp.encode("F v_lon(POV) > v_lon(SV)")


class Series:
    """The columns of a signal as polynomials, by step."""

    def __init__(self, layout: ColumnLayout, vehicle: str, signal: SignalName) -> None:
        self.layout, self.vehicle, self.signal = layout, vehicle, signal

    def __getitem__(self, step: int) -> "Value":
        return Value(self.layout.state(self.vehicle, self.signal, step))


class Value:
    """A polynomial over columns with the arithmetic of the page."""

    def __init__(self, polynomial: Polynomial[int]) -> None:
        self.polynomial = polynomial

    def _other(self, other: Any) -> Polynomial[int]:
        return other.polynomial if isinstance(other, Value) else Polynomial({(): Fraction(other)})

    def __add__(self, other: Any) -> "Value":
        return Value(self.polynomial + self._other(other))

    def __sub__(self, other: Any) -> "Value":
        return Value(self.polynomial + self._other(other).scaled(Fraction(-1)))

    def __mul__(self, other: Any) -> "Value":
        return Value(self.polynomial * self._other(other))

    def __truediv__(self, other: Any) -> "Value":
        return Value(self.polynomial.scaled(1 / Fraction(other)))

    __radd__, __rmul__ = __add__, __mul__

    def __rsub__(self, other: Any) -> "Value":
        return Value(self._other(other)) - self


def sides_of(name: str, values: Mapping[str, Any]) -> list[Any]:
    """The sides of a formula of the page, evaluated."""
    texts = re.split(r"==|<=|>=", FORMULAS[name])
    return [eval(text, {"max": max}, dict(values)) for text in texts]


def between(row: Row) -> tuple[Polynomial[int], Fraction | None, Fraction | None]:
    return Polynomial({(k,): x for k, x in row.terms.items()}), row.low, row.high


def rows_of(problem: Problem, limit: LimitKind, step: int, vehicle: str) -> list[Row]:
    return [
        x
        for x in problem.rows
        if x.origin is not None
        and (x.origin.part, x.origin.step, x.origin.vehicles) == (limit, step, (vehicle,))
    ]


def scope(encoding: Encoding, vehicle: str, across: bool, step: int) -> dict[str, Any]:
    """The names of the page for one vehicle, along or across."""
    layout, dt = encoding.posed.layout, encoding.posed.question.grid.dt
    along: tuple[SignalName, ...] = ("s", "v_lon", "a_lon")
    sideways: tuple[SignalName, ...] = ("d", "v_lat", "a_lat")
    place, speed, rate = (Series(layout, vehicle, x) for x in (sideways if across else along))
    limits = CAR.a_lat if across else CAR.a_lon
    return {
        **{"s": place, "v": speed, "a": rate, "w": Series(layout, vehicle, "v_lat")},
        **{"dt": dt, "k": step, "share": CAR.lateral_share, "inside": INSIDE},
        **{"a_min": limits[0], "a_max": limits[1], "jump": CAR.jump_lat if across else CAR.jump_lon},
    }


def as_row(low: Any, middle: Any, high: Any) -> tuple[Any, ...]:
    """A chain of sides as the polynomial, without its constant, and its two bounds."""
    polynomial = middle.polynomial
    constant = polynomial.constant
    rest = Polynomial({m: x for m, x in polynomial.terms.items() if m and x})
    return (rest, *(None if x is None else Fraction(x) - constant for x in (low, high)))


@pytest.mark.parametrize("vehicle", ["POV", "SV"])
@pytest.mark.parametrize("across", [False, True])
def test_rows_of_motion(encoding: Encoding, vehicle: str, across: bool) -> None:
    problem, steps = encoding.posed.problem, encoding.posed.question.grid.steps
    for step in range(steps):
        names = scope(encoding, vehicle, across, step)
        left, right = sides_of("E4", names)
        moved = rows_of(problem, LimitKind.MOTION, step, vehicle)[across]
        assert between(moved) == as_row(0, left - right, 0)
        assert between(rows_of(problem, LimitKind.ACCELERATION, step, vehicle)[across]) == as_row(
            *sides_of("E5", names)
        )
        assert between(rows_of(problem, LimitKind.JUMP, step, vehicle)[across]) == as_row(
            *sides_of("E8", names)
        )
        change, share = sides_of("E1", names)
        assert change.polynomial == share.polynomial
        assert sides_of("E1", {**names, "k": steps - 1})[0].polynomial.terms
    assert not names["a"][steps].polynomial.terms


@pytest.mark.parametrize("vehicle", ["POV", "SV"])
def test_rows_of_the_lateral_share(encoding: Encoding, vehicle: str) -> None:
    for step in range(encoding.posed.question.grid.steps + 1):
        rows = rows_of(encoding.posed.problem, LimitKind.LATERAL_SHARE, step, vehicle)
        for row, name in zip(rows, ("E6", "E7"), strict=True):
            middle, low = sides_of(name, scope(encoding, vehicle, False, step))
            assert between(row) == as_row(low, middle, None)


def test_bounds_of_columns() -> None:
    posed = rp.encode("F v_lon(POV) > v_lon(SV)", drives="all").posed
    road = load_road("main-2")
    right, left = min(x.d[0] for x in road.lanelets), max(x.d[1] for x in road.lanelets)
    for number, column in enumerate(posed.problem.columns):
        start = Fraction(0) if column.of.vehicle == posed.layout.vehicles[0] else REACH
        names = {
            **{"k": column.of.step, "dt": posed.question.grid.dt, "s_min": -start, "s_max": start},
            **{
                "v_min": CAR.v_lon[0],
                "v_max": CAR.v_lon[1],
                "right": right,
                "left": left,
                "width": CAR.width,
            },
            **{"s": {column.of.step: number}, "d": {column.of.step: number}},
        }
        match column.of.signal:
            case "s":
                assert sides_of("E2", names) == [column.low, number, column.high]
            case "d":
                assert sides_of("E3", names) == [column.low, number, column.high]
            case _:
                continue


def test_squares_and_products() -> None:
    rng = np.random.default_rng(3)
    for x, y, p in rng.uniform(-40, 40, (200, 3)):
        values = {"x": x, "y": y, "p": p, "l": min(x, y), "u": max(x, y)}
        square, tangent = sides_of("E9", values)
        assert square >= tangent - 1e-9
        inner = (x + y) / 2
        square, secant = sides_of("E10", {**values, "x": inner})
        assert square <= secant + 1e-9
        product, squares = sides_of("E11", values)
        assert product == pytest.approx(squares)


@pytest.mark.parametrize(("sign", "name"), [(1, "E9"), (-1, "E10")])
def test_the_inner_side_has_these_bounds(sign: int, name: str) -> None:
    """x^2 - 4 >= 0 becomes a tangent in the middle of the box, 4 - x^2 >= 0 the secant."""
    box = [(1.0, 5.0)]
    square = (variable(0) * variable(0)).scaled(Fraction(sign))
    inequality = Inequality(square + Polynomial({(): Fraction(-4 * sign)}), False)
    leaf = affine_bounds(inequality, box, "inner")
    assert isinstance(leaf, Leaf)
    for x in (1.0, 2.0, 4.5):
        bound = sides_of(name, {"x": x, "p": 3.0, "l": 1.0, "u": 5.0})[1]
        assert leaf.content.affine.value([x]) == pytest.approx(sign * (bound - 4))


def test_choices_and_big_m() -> None:
    """(x >= 1 or y >= 2) or else both below: the rows of the program are those of the page."""
    conditions = [Bound(Affine(((0, 1.0),), -1.0), 0.1), Bound(Affine(((1, 1.0),), -2.0), 0.1)]
    parts = [
        Leaf(Inequality(variable(k) + Polynomial({(): Fraction(-1 - k)}), False, Fraction(1, 10)))
        for k in (0, 1)
    ]
    problem = Problem((), (), AnyOf(tuple(parts)))
    box = [(-3.0, 3.0), (-4.0, 3.0)]
    program = encode_mixed(problem, box).program
    rows: list[dict[int, float]] = [{} for _ in program.low]
    for row, column, value in zip(program.rows, program.columns, program.values, strict=True):
        rows[row][int(column)] = float(value)
    assert sides_of("E12", {"z_1": 1, "z_2": 1, "z": 1}) == [2, 1]
    assert (rows[0], program.low[0]) == ({2: 1.0, 3: 1.0}, 1.0)
    for k, bound in enumerate(conditions):
        least = bound.affine.range(box)[0]
        m = sides_of("E14", {"m": 0, "margin": bound.margin, "f_min": least})[1]
        row, low = rows[k + 1], program.low[k + 1]
        for value, choice in ((0.0, 0), (1.5, 1), (3.0, 0)):
            f = bound.affine.value([value] * 2)
            left, right = sides_of("E13", {"f": f, "m": m, "z": choice, "margin": bound.margin})
            assert row[k] * value + row[2 + k] * choice - low == pytest.approx(left - right)


def test_every_formula_is_checked() -> None:
    """All that are on the page are named by a test above."""
    source = Path(__file__).read_text("utf-8")
    assert [x for x in FORMULAS if source.count(f'"{x}"') == 0] == []
    assert [*FORMULAS] == [f"E{k}" for k in range(1, 15)]


def test_sizes() -> None:
    for steps, vehicles in ((3, 1), (5, 2)):
        formula = "F v_lon(SV) > 20 m/s" if vehicles == 1 else "F v_lon(SV) > v_lon(POV)"
        posed = rp.encode(formula, horizon=steps, dt=1).posed
        assert posed.question.grid == Grid(Fraction(1), steps)
        assert len(posed.problem.columns) == 4 * vehicles * (steps + 1)
        assert len(posed.problem.rows) == vehicles * (8 * steps + 2)
