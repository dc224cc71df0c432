"""Formulas built with operators read as the same query as their text."""

import copy
import pickle
from collections.abc import Callable
from decimal import Decimal
from fractions import Fraction

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import roadproof as rp
from examples import some
from roadproof.frontends.api.phrases import Phrase
from roadproof.logic import formula as f
from roadproof.logic.formula import Formula
from roadproof.logic.parse import parse_claim
from roadproof.logic.rewrite import rename
from roadproof.logic.show import decimal, text

SV, POV, L = rp.SV, rp.POV, rp.L
HOME = rp.load()

# A formula or a term as Python makes it, and as a text with all parentheses.
Pair = tuple[Phrase, str]


def numbers(unit: str) -> st.SearchStrategy[tuple[object, str]]:
    """Numbers in all their forms, each with the text of it."""
    decimals = st.decimals(-99, 99, places=2)
    fractions = st.fractions(-9, 9, max_denominator=7)
    return (
        st.one_of(
            decimals.map(lambda x: (f"{x} {unit}", f"({x} {unit})")),
            st.integers(-99, 99).map(lambda x: (f"{x} {unit}", f"({x} {unit})")),
        )
        if unit
        else st.one_of(
            decimals.map(lambda x: (float(x), f"({x})")),
            decimals.map(lambda x: (x, f"({x})")),
            st.integers(-99, 99).map(lambda x: (x, f"({x})")),
            fractions.map(lambda x: (x, f"({'-' * (x < 0)}{decimal(abs(x)) or f'({abs(x)})'})")),
        )
    )


def joined(op: str, make: Callable[..., Phrase]) -> Callable[[tuple[Pair, Pair]], Pair]:
    return lambda two: (make(two[0][0], two[1][0]), f"(({two[0][1]}) {op} ({two[1][1]}))")


SPEEDS: st.SearchStrategy[Pair] = st.recursive(
    st.sampled_from([(SV.v_lon, "v_lon(SV)"), (POV.v_lon, "v_lon(POV)"), (abs(SV.v_lat), "abs(v_lat(SV))")]),
    lambda inner: st.one_of(
        st.tuples(inner, inner).map(joined("+", lambda a, b: a + b)),
        st.tuples(inner, inner).map(joined("-", lambda a, b: a - b)),
        inner.map(lambda x: (-x[0], f"(-({x[1]}))")),
        st.tuples(numbers(""), inner).map(lambda x: (x[0][0] * x[1][0], f"({x[0][1]} * ({x[1][1]}))")),
        st.tuples(inner, numbers("m/s")).map(lambda x: (x[0][0] + x[1][0], f"(({x[0][1]}) + {x[1][1]})")),
        st.tuples(numbers("km/h"), inner).map(lambda x: (x[0][0] - x[1][0], f"({x[0][1]} - ({x[1][1]}))")),
        inner.map(lambda x: (x[0] / 4, f"(({x[1]}) / 4)")),
    ),
    max_leaves=4,
)
COMPARISONS = {
    "<": lambda a, b: a < b,
    "<=": lambda a, b: a <= b,
    ">": lambda a, b: a > b,
    ">=": lambda a, b: a >= b,
    "=": lambda a, b: a == b,
    "!=": lambda a, b: a != b,
}
FACTS: st.SearchStrategy[Pair] = st.one_of(
    st.sampled_from([(HOME.danger(SV, POV), "danger(SV, POV)"), (HOME.laneKeep(SV, L), "laneKeep(SV, L)")]),
    st.tuples(st.sampled_from([*COMPARISONS]), SPEEDS, SPEEDS).map(
        lambda x: (COMPARISONS[x[0]](x[1][0], x[2][0]), f"({x[1][1]}) {x[0]} ({x[2][1]})")
    ),
)
WITHIN = st.sampled_from(
    [(None, ""), ((0, "3 s"), "[0, 3 s]"), ((0.5, 2), "[0.5, 2]"), (("600 ms", None), "[600 ms, inf]")]
)
NAMES = st.integers(100, 10**9).map(lambda k: f"K{k}")
FORMULAS: st.SearchStrategy[Pair] = st.recursive(
    FACTS,
    lambda inner: st.one_of(
        st.tuples(inner, inner).map(joined("and", lambda a, b: a & b)),
        st.tuples(inner, inner).map(joined("or", lambda a, b: a | b)),
        st.tuples(inner, inner).map(joined("->", lambda a, b: a >> b)),
        st.tuples(inner, inner).map(joined("<->", lambda a, b: a.equivalent_to(b))),
        inner.map(lambda x: (~x[0], f"(not ({x[1]}))")),
        st.tuples(inner, WITHIN).map(lambda x: (rp.F(x[0][0], x[1][0]), f"(F{x[1][1]} ({x[0][1]}))")),
        st.tuples(inner, WITHIN).map(lambda x: (rp.G(x[0][0], x[1][0]), f"(G{x[1][1]} ({x[0][1]}))")),
        st.tuples(inner, inner, WITHIN).map(
            lambda x: (rp.U(x[0][0], x[1][0], x[2][0]), f"(({x[0][1]}) U{x[2][1]} ({x[1][1]}))")
        ),
        st.tuples(inner, NAMES).map(
            lambda x: (
                rp.some(rp.lanes, lambda K: HOME.laneKeep(POV, K) & x[0][0], name=x[1]),
                f"(some {x[1]} in lanes: (laneKeep(POV, {x[1]}) and ({x[0][1]})))",
            )
        ),
        st.tuples(inner, NAMES).map(
            lambda x: (
                rp.every(rp.adjacent_lanes(L), lambda K: ~HOME.laneKeep(POV, K) | x[0][0], name=x[1]),
                f"(every {x[1]} in adjacentLanes(L): ((not laneKeep(POV, {x[1]})) or ({x[0][1]})))",
            )
        ),
    ),
    max_leaves=5,
)


def level(formula: Formula) -> Formula:
    """``formula`` but for what operators may write otherwise: chains inside each other, bound names."""

    def change(current: Formula) -> Formula:
        match current:
            case f.And(parts) | f.Or(parts):
                kind = type(current)
                return kind(tuple(y for x in parts for y in (x.parts if isinstance(x, kind) else (x,))))
            case f.Some(variable, domain, body) | f.Every(variable, domain, body):
                depth = sum(isinstance(x, f.Some | f.Every) for x in f.subformulas(body))
                return type(current)(f"bound{depth}", domain, rename(body, variable, f"bound{depth}"))
            case _:
                return current

    return f.transform(formula, change)


@settings(max_examples=some(100), deadline=None)
@given(FORMULAS)
def test_operators_and_text_are_one_formula(pair: Pair) -> None:
    built, written = pair
    assert level(HOME.read(built).formula) == level(HOME.read(written).formula)
    assert text(parse_claim(str(built))) == str(built)


def test_a_third_reads_back_as_it_is_written() -> None:
    built = SV.v_lon < -(Fraction(1, 3) * SV.v_lon)
    assert str(built) == "v_lon(SV) < -(1/3*v_lon(SV))"
    assert text(parse_claim(str(built))) == str(built)


@pytest.mark.parametrize(
    ("built", "written"),
    [
        (SV.v_lon > "30 km/h", "v_lon(SV) > 30 km/h"),
        (SV.v_lon > "-30 km/h", "v_lon(SV) > -30 km/h"),
        (SV.a_lon < "-3.5 m/s^2", "a_lon(SV) < -3.5 m/s^2"),
        (SV.v_lon * -3.5 > 0, "v_lon(SV)*-3.5 > 0"),
        (rp.parameter("rho") - "-3.5 s" < 0, "rho - -3.5 s < 0"),
        (SV.v_lon * 0.1 > 0, "v_lon(SV)*0.1 > 0"),
        (SV.v_lon * 1e-7 > 0, "v_lon(SV)*0.0000001 > 0"),
        (SV.v_lon * Decimal("0.10") > 0, "v_lon(SV)*0.1 > 0"),
        (SV.v_lon * Fraction(1, 3) > 0, "v_lon(SV)*(1/3) > 0"),
        (SV.v_lon * Fraction(-1, 3) > 0, "v_lon(SV)*-(1/3) > 0"),
        (2 * SV.v_lon - "1 m/s" == POV.v_lon / 3, "2*v_lon(SV) - 1 m/s = v_lon(POV)/3"),
        ("30 km/h" + SV.v_lon != POV.v_lon, "30 km/h + v_lon(SV) != v_lon(POV)"),
        ((SV.s - POV.s) ** 2 < 4 * SV.length**2, "(s(SV) - s(POV))^2 < 4*length(SV)^2"),
        (
            abs(SV.d - POV.d) <= rp.call("max", SV.width, POV.width),
            "abs(d(SV) - d(POV)) <= max(width(SV), width(POV))",
        ),
        (rp.F(SV.s > POV.s, within=(0, rp.parameter("minDanger"))), "F[0, minDanger] s(SV) > s(POV)"),
        (rp.F(True) & False, "F true and false"),
        (rp.call("decel@ext", POV, SV, L), "decel@ext(POV, SV, L)"),
        (
            rp.some(rp.zone("main"), lambda x: rp.call("occ", SV, x)),
            "some x in zone(main): occ(SV, x)",
        ),
        (
            rp.every(rp.lanelets(L), lambda x: ~rp.call("occ", SV, x)),
            "every x in lanelets(L): not occ(SV, x)",
        ),
        (
            HOME.danger(rp.vehicle("A"), rp.vehicle("B")) >> HOME.danger(rp.vehicle("B"), rp.vehicle("A")),
            "given A, B: vehicle: danger(A, B) -> danger(B, A)",
        ),
        (
            HOME.laneKeep(rp.vehicle("A"), rp.lane("K")),
            "given A: vehicle; K: lane: laneKeep(A, K)",
        ),
    ],
    ids=str,
)
def test_what_is_built_is_written_so(built: Phrase, written: str) -> None:
    assert str(built) == written
    assert repr(built) == f"<formula {written}>"
    assert HOME.read(built).formula == HOME.read(written).formula


# --- names that are bound ---------------------------------------------------------------------------


def test_a_bound_name_captures_nothing() -> None:
    nested = rp.some(rp.lanes, lambda K: rp.some(rp.adjacent_lanes(K), lambda K2: HOME.laneKeep(SV, K)))
    assert str(nested) == "some K in lanes: some K2 in adjacentLanes(K): laneKeep(SV, K)"

    def beside(place: Phrase) -> Phrase:
        return rp.some(rp.adjacent_lanes(place), lambda K: HOME.laneKeep(POV, K) & HOME.laneKeep(SV, place))

    assert str(rp.some(rp.lanes, lambda K: beside(K))) == (
        "some K2 in lanes: some K in adjacentLanes(K2): laneKeep(POV, K) and laneKeep(SV, K2)"
    )
    free = rp.some(rp.lanes, lambda L: HOME.laneKeep(SV, L) & HOME.laneKeep(POV, rp.L))
    assert str(free) == "some L2 in lanes: laneKeep(SV, L2) and laneKeep(POV, L)"
    assert HOME.read(free).lanes == ("L",)
    named = rp.some(rp.lanes, lambda x: HOME.laneKeep(SV, x), name="M")
    assert str(named) == "some M in lanes: laneKeep(SV, M)"


# --- mistakes ---------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("make", "told"),
    [
        (lambda: 3 < SV.v_lon < 4, "has no truth value: write & | ~ for and, or, not, and no chains"),
        (lambda: (SV.v_lon > 3) and (POV.v_lon > 3), "v_lon(SV) > 3 has no truth value: write & | ~"),
        (lambda: not SV.v_lon > 3, "has no truth value"),
        (lambda: bool(SV), "SV has no truth value"),
        (lambda: SV.v_lon in (POV.v_lon,), "has no truth value"),
        (
            lambda: rp.call("danger", "SV", POV),
            "'SV' is no term: give a number, '30 km/h', a name such as SV",
        ),
        (lambda: SV.v_lon > "30 kmh", "'30 kmh' is no term"),
        (lambda: SV.v_lon > None, "None is no term"),  # type: ignore[operator]
        (
            lambda: rp.some(SV.v_lon > 3, lambda K: K),
            "is not a domain: give lanes, lanelets(L), zone('main')",
        ),
    ],
)
def test_mistakes_come_with_advice(make: Callable[[], object], told: str) -> None:
    with pytest.raises(rp.UsageError) as raised:
        make()
    assert told in str(raised.value)


def test_numbers_that_are_none() -> None:
    with pytest.raises(rp.InputError, match="the number must be finite"):
        _ = SV.v_lon > float("inf")


def test_mistakes_of_meaning_have_a_caret() -> None:
    with pytest.raises(rp.TextError) as raised:
        HOME.read(SV.s > "3 s")
    assert str(raised.value).splitlines()[1:3] == ["  s(SV) > 3 s", "  ^"]


def test_a_vehicle_has_signals_only() -> None:
    with pytest.raises(AttributeError, match="v_long: a vehicle has s, d, v_lon, v_lat, a_lon, a_lat, j_lon"):
        SV.v_long  # noqa: B018
    with pytest.raises(AttributeError):
        (SV.v_lon + 1).v_lon  # noqa: B018


def test_it_can_be_copied_and_sent() -> None:
    for other in (copy.deepcopy(SV.v_lon > 3), pickle.loads(pickle.dumps(SV.v_lon > 3))):
        assert str(other) == "v_lon(SV) > 3"
    assert len({str(SV), str(SV)}) == 1
    assert hash(SV.v_lon) == hash(rp.call("v_lon", SV))


def test_a_quantifier_is_written_in_the_order_of_its_text_too() -> None:
    formula = rp.call("atLane", SV, rp.lane("M"))
    for quantifier, word in ((rp.every, "every"), (rp.some, "some")):
        expected = f"{word} M in lanes: atLane(SV, M)"
        assert str(quantifier("M", rp.lanes, formula)) == expected
        assert str(quantifier("M", rp.lanes, lambda K: rp.call("atLane", SV, K))) == expected
        assert str(quantifier(rp.lanes, lambda M: rp.call("atLane", SV, M))) == expected
    with_other_lane = rp.every("M", rp.lanes, formula | rp.call("atLane", POV, rp.lane("N")))
    assert str(with_other_lane) == "given N: lane: every M in lanes: atLane(SV, M) or atLane(POV, N)"


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("M", rp.lanes, 3), "needs a domain and a function"),
        (("M", rp.lanes), "needs a domain and a function"),
        ((rp.lanes, 3), "needs a domain and a function"),
        ((rp.lanes, SV), "needs a domain and a function"),
        (("M", lambda M: M, SV), "needs a domain and a function"),
        (("M N", rp.lanes, SV), "'M N' is not a name"),
        (("M", SV.v_lon > "3 m/s", SV), "is not a domain"),
    ],
)
def test_a_quantifier_names_what_is_wrong(arguments: tuple[object, ...], message: str) -> None:
    with pytest.raises(rp.UsageError, match=message):
        rp.every(*arguments)  # type: ignore[arg-type]
