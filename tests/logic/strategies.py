"""Random syntax trees as the parser returns them, and random formulas as the elaborator returns them."""

from fractions import Fraction
from functools import cache
from typing import Any

from hypothesis import strategies as st

from roadproof.library.elaborate import read_claim
from roadproof.library.loading import bundled_library
from roadproof.logic import formula as f
from roadproof.logic import syntax
from roadproof.logic import terms as t
from roadproof.logic.formula import Formula

NAMES = ["a", "b", "s", "m", "SV", "POV2", "L", "x_1", "Gx", "notes", "scenario_4", "scenario_{i-8}"]
UNITS = ["", "s", "ms", "m", "m/s", "km/h", "m/s^2", "unitless"]

names = st.sampled_from(NAMES)
plain_names = st.sampled_from([n for n in NAMES if "{" not in n])
decimals = st.builds(lambda n, k: Fraction(n, 10**k), st.integers(0, 10**6), st.integers(0, 8))


_binary = ["+", "-", "*", "/", "<", "<=", ">", ">=", "=", "!=", "->", "<->"]
_shapes = ["binary", "binary", "power", "prefix", "chain", "F", "G", "U", "quantified", "call"]


@st.composite
def expressions(draw: st.DrawFn, depth: int = 4) -> syntax.Expression:
    """A tree at most ``depth`` operators deep, of any sorts and dimensions."""
    shape = draw(st.sampled_from(["leaf", *_shapes])) if depth else "leaf"
    inner = expressions(depth - 1)
    match shape:
        case "binary":
            return syntax.Binary(draw(st.sampled_from(_binary)), draw(inner), draw(inner))  # type: ignore[arg-type]
        case "power":
            return syntax.Binary("^", draw(inner), syntax.Literal_(Fraction(draw(st.integers(0, 8)))))
        case "prefix":
            return syntax.Prefix(draw(st.sampled_from(["not", "-"])), draw(inner))  # type: ignore[arg-type]
        case "chain":
            parts = draw(st.lists(inner, min_size=2, max_size=3))
            return syntax.Chain(draw(st.sampled_from(["and", "or"])), tuple(parts))  # type: ignore[arg-type]
        case "F" | "G" | "U":
            left = draw(inner) if shape == "U" else None
            return syntax.Temporal(shape, draw(_bounds(depth - 1)), left, draw(inner))
        case "quantified":
            kind = draw(st.sampled_from(["some", "every"]))
            return syntax.Quantified(kind, draw(plain_names), draw(_domains()), draw(inner))  # type: ignore[arg-type]
        case "call":
            name = draw(st.sampled_from([*NAMES, "accel@ext", "max"]))
            return syntax.Call(name, tuple(draw(st.lists(inner, max_size=3))))
        case _:
            return draw(_leaves())


@st.composite
def _leaves(draw: st.DrawFn) -> syntax.Expression:
    match draw(st.sampled_from(["number", "truth", "name"])):
        case "number":
            return syntax.Literal_(draw(decimals), draw(st.sampled_from(UNITS)))
        case "truth":
            return syntax.Literal_(draw(st.booleans()))
        case _:
            return syntax.Name(draw(names))


@st.composite
def _bounds(draw: st.DrawFn, depth: int) -> syntax.Bounds | None:
    if draw(st.booleans()):
        return None
    return syntax.Bounds(draw(expressions(depth)), draw(st.none() | expressions(depth)))


@st.composite
def _domains(draw: st.DrawFn) -> syntax.Name | syntax.Call | syntax.Group:
    members = tuple(syntax.Name(n) for n in draw(st.lists(plain_names, min_size=1, max_size=3)))
    match draw(st.sampled_from(["name", "call", "group"])):
        case "name":
            return members[0]
        case "call":
            return syntax.Call(draw(st.sampled_from(["lanelets", "zone"])), members[:1])
        case _:
            return syntax.Group(members)


# --- formulas over SV, POV and L ------------------------------------------------------------------

METRES, SPEED, ACCELERATION, SECONDS, PLAIN = (1, 0), (1, -1), (1, -2), (0, 1), (0, 0)
_vehicles = st.sampled_from(["SV", "POV"])
_fractions = st.builds(Fraction, st.integers(-40, 40), st.sampled_from([1, 2, 3, 5, 7, 10]))
_positive = st.builds(Fraction, st.integers(1, 40), st.sampled_from([1, 2, 3, 5]))


def _leaf(dimension: t.Dimension) -> st.SearchStrategy[t.Term]:
    choices: list[st.SearchStrategy[Any]] = [st.builds(t.Number, _fractions, st.just(dimension))]
    signals = [n for n, d in t.SIGNAL_DIMENSIONS.items() if d == dimension]
    if signals:
        choices.append(st.builds(t.Signal, st.sampled_from(signals), _vehicles))
    if dimension == METRES:
        choices.append(st.builds(t.Size, st.sampled_from(["length", "width"]), _vehicles))
    parameters = {SECONDS: ["rho", "minSafe"], ACCELERATION: ["a_max", "b_min"]}.get(dimension, [])
    if parameters:
        choices.append(st.builds(t.Parameter, st.sampled_from(parameters), st.just(dimension)))
    return st.one_of(choices)


@st.composite
def terms(draw: st.DrawFn, dimension: t.Dimension, depth: int = 2) -> t.Term:
    """A term of ``dimension`` at most ``depth`` operators deep, as the elaborator makes them."""
    shapes = ["leaf", "sum", "difference", "minus", "product", "quotient", "max", "min"]
    shape = draw(st.sampled_from([*shapes, "way", "braking"] if dimension == METRES else shapes))
    if depth == 0 or shape == "leaf":
        return draw(_leaf(dimension))
    inner = terms(SPEED if shape in ("way", "braking") else dimension, depth - 1)
    first = draw(inner)
    match shape:
        case "sum":
            return t.Sum((first, draw(inner)))
        case "difference":
            return t.subtract(first, draw(inner))
        case "minus":
            return t.negate(first)
        case "product":
            return t.Product((draw(_leaf(PLAIN)), first))
        case "quotient":
            return t.Quotient(first, t.number(draw(_positive)))
        case "max":
            return t.Maximum((first, *draw(st.lists(inner, max_size=2))))
        case "min":
            return t.Minimum((first, *draw(st.lists(inner, max_size=2))))
        case "way":
            return t.Product((first, draw(_leaf(SECONDS))))
        case _:
            braking = t.Product((t.number(2), t.Parameter("b_min", ACCELERATION)))
            return t.Quotient(t.Power(first, 2), braking)


@st.composite
def _comparisons(draw: st.DrawFn) -> Formula:
    sides = terms(draw(st.sampled_from([METRES, SPEED])))
    left, right = draw(sides), draw(sides)
    operator = draw(st.sampled_from(["<", "<=", ">", ">=", "=", "!=", "inverse"]))
    if operator == "=":
        return f.And((f.Compare(left, "<=", right), f.Compare(left, ">=", right)))
    if operator == "!=":
        return f.Or((f.Compare(left, "<", right), f.Compare(left, ">", right)))
    if operator == "inverse":
        return f.Compare(t.Inverse(left), ">=", t.Inverse(right))
    return f.Compare(left, operator, right)


@st.composite
def _occupancies(draw: st.DrawFn) -> Formula:
    domains = [f.Domain("lanelets", "L"), f.Domain("zone", "main"), f.Domain("zone", "merge")]
    quantifier = draw(st.sampled_from([f.Some, f.Every]))
    return quantifier("k", draw(st.sampled_from(domains)), f.Occupies(draw(_vehicles), "k"))


@st.composite
def _intervals(draw: st.DrawFn) -> f.Interval:
    low, length = draw(_positive), draw(_positive)
    match draw(st.sampled_from(["forever", "bounded", "symbolic", "unbounded"])):
        case "forever":
            return f.FOREVER
        case "bounded":
            return f.Interval(t.number(low, SECONDS), t.number(low + length, SECONDS))
        case "symbolic":
            return f.Interval(f.ZERO, t.Parameter("minDanger", SECONDS))
        case _:
            return f.Interval(t.number(low, SECONDS), None)


CALLS = ("danger(SV,POV)", "inAdjLanes(POV,SV,L)", "scenario_4(SV,POV,L)", "accel@base(POV,SV,L)")


@cache
def _called(text: str) -> Formula:
    return read_claim(bundled_library().select("ext"), text).formula


@st.composite
def formulas(draw: st.DrawFn, depth: int = 3) -> Formula:
    """A formula without constants inside, over definitions in spec set ``ext``."""
    shapes = ["comparison", "occupancy", "call"]
    deeper = ["not", "and", "or", "U", "S", "F", "G", "O", "H", "some"]
    inner = formulas(depth - 1)
    match draw(st.sampled_from([*shapes, *deeper] if depth else shapes)):
        case "comparison":
            return draw(_comparisons())
        case "occupancy":
            return draw(_occupancies())
        case "call":
            return _called(draw(st.sampled_from(CALLS)))
        case "not":
            return f.negation(draw(inner))
        case "and":
            return f.And(tuple(draw(st.lists(inner, min_size=2, max_size=3))))
        case "or":
            return f.Or(tuple(draw(st.lists(inner, min_size=2, max_size=3))))
        case "U":
            return f.Until(draw(inner), draw(_intervals()), draw(inner))
        case "S":
            return f.Since(draw(inner), draw(_intervals()), draw(inner))
        case "O":
            return f.once(draw(_intervals()), draw(inner))
        case "H":
            return f.historically(draw(_intervals()), draw(inner))
        case "F":
            return f.Eventually(draw(_intervals()), draw(inner))
        case "G":
            return f.Always(draw(_intervals()), draw(inner))
        case _:
            return f.Some("M", f.Domain("adjacent", "L"), draw(inner))
