"""Initial values of cut-ins, cut-outs and decelerations, as the sheets of UN R157 name them, the states of
vehicles that they say, and where a formula about the first instant is true along a line of them: exactly.

The judge reads signals as polynomials in time. Along a line an initial value runs, so the set of instants is
the set of values at which the formula is true, with algebraic ends.
"""

from collections.abc import Mapping, Sequence
from dataclasses import field, fields
from fractions import Fraction
from functools import cached_property
from types import MappingProxyType
from typing import Any, Literal, TypeAlias

from roadproof.errors import UsageError
from roadproof.extensions.drivers.judging import truth_within
from roadproof.library.scenarios import PAIR, SUBJECT, TRIPLE
from roadproof.library.specification import unknown_name
from roadproof.logic.formula import Formula
from roadproof.logic.terms import CustomSignal, Signal, SignalName, Size, SizeName
from roadproof.runtime.records import dataclass
from roadproof.semantics.exact.polynomial import TimePolynomial, polynomial
from roadproof.semantics.exact.signals import LineSignals
from roadproof.semantics.exact.truth import NEVER, TruthSet
from roadproof.world.signals import SIGNALS, STARTING

KMH = Fraction(5, 18)
OTHER, FIRST, SECOND = PAIR[1], *TRIPLE[1:]
_NONE = Fraction(0)
BESIDE = Fraction("1.6")  # m between vehicles in the middles of lanes beside each other

ManoeuvreName: TypeAlias = Literal["cut-in", "cut-out", "deceleration"]
Course: TypeAlias = Literal[ManoeuvreName, "gradual-deceleration"]
"""A manoeuvre as formulas about driver models name it."""
# Initial values by name, SI units.
Values: TypeAlias = Mapping[str, Fraction]


@dataclass(frozen=True)
class InitialQuantity:
    """An initial value: its unit, the value where none is given (SI), and what it is.

    It is at least 0, or above that where ``is_open``. ``is_optional``: where none is given there is none.
    """

    name: str
    unit: str
    value: Fraction
    doc: str
    is_open: bool = False
    is_optional: bool = False

    def check(self, value: Fraction) -> None:
        """Raises ``UsageError`` for a value that no vehicle has."""
        if value < 0 or (self.is_open and value == 0):
            raise UsageError(
                f"{self.name}={value} (SI): {self.doc} has to be {'>' if self.is_open else '>='} 0"
            )


def initial_value(
    unit: str, value: Fraction, doc: str, is_open: bool = False, is_optional: bool = False
) -> Any:
    """A field that is an initial value, as ``InitialQuantity`` has it."""
    metadata = {"of": (unit, value, doc, is_open, is_optional)}
    return field(metadata=metadata, default=None) if is_optional else field(metadata=metadata)


@dataclass(frozen=True, kw_only=True)
class _Start:
    """Initial values of any manoeuvre (SI)."""

    Ve0: Fraction = initial_value("km/h", 60 * KMH, "the speed of SV")
    length: Fraction = initial_value("m", Fraction("4.3"), "the length of every vehicle", True)
    width: Fraction = initial_value("m", Fraction("1.9"), "the width of every vehicle", True)

    @property
    def lane(self) -> Fraction:
        """Lanes as wide as puts the vehicles into their middles."""
        return self.width + BESIDE

    @property
    def middle(self) -> Fraction:
        """Return where the left side of a vehicle in the middle of the lane of SV is."""
        return (self.lane + self.width) / 2


@dataclass(frozen=True, kw_only=True)
class CutIn(_Start):
    """Initial values of a cut-in."""

    dV0: Fraction = initial_value("km/h", 20 * KMH, "how much faster SV is than POV, Ve0-Vo0")
    Vy: Fraction = initial_value("m/s", Fraction(1), "the lateral speed of POV", True)
    dx0: Fraction = initial_value("m", Fraction(20), "the gap along the road")
    dy0: Fraction = initial_value("m", BESIDE, "the gap across the road")

    @property
    def lane(self) -> Fraction:
        return self.width + self.dy0


@dataclass(frozen=True, kw_only=True)
class CutOut(_Start):
    """Initial values of a cut-out."""

    Vf0: Fraction = initial_value("km/h", _NONE, "the speed of the vehicle in front of the one that cuts out")
    Vy: Fraction = initial_value("m/s", Fraction(1), "the lateral speed of POV", True)
    headway: Fraction = initial_value("s", Fraction(2), "the time headway at which SV follows")
    dx0_f: Fraction = initial_value(
        "m", Fraction(30), "the gap from the vehicle that cuts out to the one in front"
    )

    @property
    def first(self) -> Fraction:
        """Return where the front of the vehicle that cuts out is, from that of SV."""
        return self.headway * self.Ve0 + self.length

    @property
    def second(self) -> Fraction:
        """Return where the front of the vehicle is that the cut-out reveals."""
        return self.first + self.dx0_f + self.length


@dataclass(frozen=True, kw_only=True)
class Deceleration(_Start):
    """Initial values of a deceleration."""

    Gx: Fraction = initial_value("m/s^2", Fraction(6), "how hard POV brakes", True)
    dx0: Fraction = initial_value("m", Fraction(20), "the gap along the road")
    dV0: Fraction = initial_value("km/h", _NONE, "how much faster SV is than POV")
    dGdt: Fraction | None = initial_value(
        "m/s^3", _NONE, "how fast POV's braking grows (left out: it is there at once)", True, True
    )


Start: TypeAlias = CutIn | CutOut | Deceleration


@dataclass(frozen=True)
class Manoeuvre:
    """``line``: the value that is solved for; ``across``: the other side of a plane; with their ranges (SI).

    ``sheet``: the values that plates differ in where nothing else is asked for.
    """

    name: ManoeuvreName
    vehicles: tuple[str, ...]
    start: type[Start]
    line: str
    along: tuple[Fraction, Fraction]
    across: str
    range: tuple[Fraction, Fraction]
    sheet: Mapping[str, tuple[Fraction, ...]]

    @cached_property
    def quantities(self) -> Mapping[str, InitialQuantity]:
        """The initial values by name: the speed of SV first, the sizes of vehicles last."""
        ordered = sorted(fields(self.start), key=lambda x: (x.name in ("length", "width"), x.name != "Ve0"))
        return MappingProxyType({x.name: InitialQuantity(x.name, *x.metadata["of"]) for x in ordered})

    def values(self, given: Values) -> dict[str, Fraction]:
        """All initial values. Raises ``UsageError`` for unknown names, and for what no vehicle can have."""
        for name in given:
            if name not in self.quantities:
                raise UsageError(
                    f"{name}: {unknown_name('initial value of a ' + self.name, name, self.quantities)}"
                )
        values = {
            name: given.get(name, x.value)
            for name, x in self.quantities.items()
            if name in given or not x.is_optional
        }
        for name, value in values.items():
            self.quantities[name].check(value)
        if "dV0" in given and values["dV0"] > values["Ve0"]:
            raise UsageError(
                f"dV0={values['dV0']} (SI): SV cannot be more than Ve0={values['Ve0']} faster than POV"
            )
        return values


CUT_IN = Manoeuvre(
    "cut-in",
    PAIR,
    CutIn,
    "dx0",
    (_NONE, Fraction(120)),
    "dV0",
    (_NONE, 130 * KMH),
    {"Ve0": (60 * KMH, 90 * KMH, 130 * KMH), "Vy": (Fraction(1, 2), Fraction(1), Fraction(3, 2))},
)
CUT_OUT = Manoeuvre(
    "cut-out",
    TRIPLE,
    CutOut,
    "dx0_f",
    (_NONE, Fraction(150)),
    "Vy",
    (Fraction(1, 10), Fraction(3)),
    {"Ve0": (60 * KMH, 90 * KMH, 110 * KMH, 130 * KMH)},
)
DECELERATION = Manoeuvre(
    "deceleration",
    PAIR,
    Deceleration,
    "dx0",
    (_NONE, Fraction(80)),
    "Gx",
    (Fraction("0.1"), Fraction("9.81")),
    {"Ve0": (30 * KMH, 60 * KMH, 90 * KMH, 130 * KMH)},
)
MANOEUVRES: Mapping[ManoeuvreName, Manoeuvre] = MappingProxyType(
    {x.name: x for x in (CUT_IN, CUT_OUT, DECELERATION)}
)


def start_of(manoeuvre: Manoeuvre, values: Values) -> Start:
    """All initial values of a manoeuvre, typed."""
    return manoeuvre.start(**{name: values[name] for name in manoeuvre.quantities if name in values})


def is_possible(values: Values) -> bool:
    """Return whether no vehicle would have to go backwards."""
    return "dV0" not in values or values["dV0"] <= values["Ve0"]


def along_line(manoeuvre: Manoeuvre, values: Values) -> LineSignals:
    """The states along the line through ``values``: every signal is an affine function of what runs."""
    begin = signals_of(manoeuvre, {**values, manoeuvre.line: Fraction(0)})
    one = signals_of(manoeuvre, {**values, manoeuvre.line: Fraction(1)})
    signals: dict[Signal | CustomSignal, TimePolynomial] = {
        Signal(*key): polynomial(value, one[key] - value) for key, value in begin.items()
    }
    box: tuple[SizeName, ...] = ("length", "width")
    sizes = {Size(x, name): values[x] for name in manoeuvre.vehicles for x in box}
    return LineSignals(signals, sizes, lambda what: UsageError(f"the initial values do not define {what}"))


def signals_of(manoeuvre: Manoeuvre, values: Values) -> dict[tuple[SignalName, str], Fraction]:
    """The state at time 0.

    The front of SV is at s = 0, SV in the middle of its lane, POV ahead of it or in the lane to its left.
    """
    start = start_of(manoeuvre, values)
    ego, still = start.Ve0, 0 * start.Ve0
    middle = still + start.middle
    signals = _vehicle(SUBJECT, still, middle, ego)
    match start:
        case CutIn():
            place, speed = start.dx0 + start.length, ego - start.dV0
            return signals | _vehicle(OTHER, place, middle + start.lane, speed, -start.Vy)
        case CutOut():
            signals |= _vehicle(FIRST, start.first, middle, ego, start.Vy)
            return signals | _vehicle(SECOND, start.second, middle, start.Vf0)
        case Deceleration():
            place, speed = start.dx0 + start.length, ego - start.dV0
            return signals | _vehicle(OTHER, place, middle, speed, braking=start.Gx)


def _vehicle(
    name: str,
    place: Fraction,
    left: Fraction,
    speed: Fraction,
    lateral: Fraction = _NONE,
    braking: Fraction = _NONE,
) -> dict[tuple[SignalName, str], Fraction]:
    known: dict[str, Fraction] = dict(zip(STARTING, (place, left, speed, lateral), strict=True))
    known |= {"a_lon": -braking}
    return {(signal, name): known.get(signal, _NONE) + 0 * speed for signal in SIGNALS}


def spread(low: Fraction, high: Fraction, count: int) -> Sequence[Fraction]:
    """``count`` values from ``low`` to ``high``, both with them."""
    return tuple(low + (high - low) * k / max(1, count - 1) for k in range(count))


@dataclass(frozen=True)
class Plane:
    """Initial values of a manoeuvre: ``fixed``, and two that vary in ranges (SI), in so many lines.

    The lines run along ``manoeuvre.line``, one for each value of ``manoeuvre.across``.
    """

    manoeuvre: Manoeuvre
    fixed: Values
    along: tuple[Fraction, Fraction]
    across: tuple[Fraction, Fraction]
    lines: int = 100

    @property
    def rows(self) -> Sequence[Fraction]:
        """The values of the other side."""
        return spread(*self.across, self.lines)

    def values(self, row: Fraction, place: Fraction | None = None) -> dict[str, Fraction]:
        """All initial values at a row, and at a place on its line (its beginning where None)."""
        here = {self.manoeuvre.across: row, self.manoeuvre.line: self.along[0] if place is None else place}
        return self.manoeuvre.values({**self.fixed, **here})


def plane_of(
    manoeuvre: Manoeuvre,
    fixed: Values,
    along: tuple[Fraction, Fraction],
    across: tuple[Fraction, Fraction],
    lines: int,
) -> Plane:
    """The plane of a plate: up to where POV would go backwards. Raises ``UsageError``."""
    low, high = across
    if manoeuvre.across == "dV0":
        high = min(high, manoeuvre.values(fixed)["Ve0"])
    return Plane(manoeuvre, fixed, along, (low, high), lines)


def line(plane: Plane, formula: Formula, row: Fraction) -> TruthSet:
    """Return the places of a row's line where a bound formula is true; none where a vehicle would reverse."""
    values = plane.values(row)
    if not is_possible(values):
        return NEVER
    signals = along_line(plane.manoeuvre, values)
    return truth_within(formula, signals, *plane.along)
