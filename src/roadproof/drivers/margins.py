"""How far a state is from the boundary of a driver model: in metres of gap, in seconds of response.

The gap to the vehicle that would be hit, and the time that the model takes to respond, are each varied by
themselves; where the formula of the boundary changes is exact but for rounding to a hundredth.
"""

from collections.abc import Mapping, Sequence
from fractions import Fraction
from itertools import pairwise

from roadproof.drivers import stepped
from roadproof.drivers.manoeuvres import MANOEUVRES, ManoeuvreName
from roadproof.errors import InputError
from roadproof.logic import terms as t
from roadproof.logic.custom_names import own_of
from roadproof.logic.formula import Formula
from roadproof.logic.rewrite import map_terms, with_values
from roadproof.runtime.records import dataclass
from roadproof.semantics.exact.algebraic import approximate
from roadproof.semantics.exact.exact import truth_within
from roadproof.semantics.exact.polynomial import Polynomial, polynomial
from roadproof.semantics.exact.signals import LineSignals, unknown_at_instant
from roadproof.semantics.exact.truth import TruthSet

_DELAYS: Mapping[str, str] = {
    "careful": "cc_delay",
    "r157": "r157_delay",
    "eu1426": "eu1426_delay",
    "rss": "rho",
}
"""The parameter of each model that says how long it takes to respond."""
_FARTHEST, _LATEST = Fraction(200), Fraction(10)  # m of gap, s of response
_TRIED = tuple(map(Fraction, (0, 1, 2, 4, 8, 16, 32, 64)))  # m: gaps that are tried of a controller
_FINE = Fraction(1, 100)  # m
_WAITED = 60  # s
_PLACES = 2


@dataclass(frozen=True)
class State:
    """The vehicles at one instant: signals and sizes by name and vehicle (SI)."""

    signals: Mapping[tuple[t.SignalName, str], Fraction]
    sizes: Mapping[tuple[t.SizeName, str], Fraction]

    def along(self, moved: str = "", begin: Fraction = Fraction(0), own: Sequence[t.Own] = ()) -> LineSignals:
        """As signals; what runs is where the front of ``moved`` is, from ``begin`` on, or ``own`` signals."""
        courses: dict[t.Signal | t.Own, Polynomial] = {}
        courses |= {t.Signal(*key): polynomial(x) for key, x in self.signals.items()}
        courses |= {t.Signal("s", moved): polynomial(begin, Fraction(1))} if moved else {}
        courses |= {x: polynomial(Fraction(0), Fraction(1)) for x in own}
        return LineSignals(courses, {t.Size(*key): x for key, x in self.sizes.items()}, unknown_at_instant)

    def gap(self, behind: str, ahead: str) -> Fraction:
        """From the front of one vehicle to the rear of the other, along the road."""
        return self.signals["s", ahead] - self.sizes["length", ahead] - self.signals["s", behind]

    def beside(self, one: str, other: str) -> Fraction:
        """Between two vehicles across the road; negative where the boxes overlap."""
        left = self.signals["d", other] - self.sizes["width", other] - self.signals["d", one]
        right = self.signals["d", one] - self.sizes["width", one] - self.signals["d", other]
        return max(left, right)

    def start(self, manoeuvre: ManoeuvreName, vehicles: tuple[str, ...]) -> dict[str, float]:
        """As the sheets of UN R157 name it, in SI units."""
        return {name: round(float(x), 4) for name, x in self.values(manoeuvre, vehicles).items()}

    def values(self, manoeuvre: ManoeuvreName, vehicles: tuple[str, ...]) -> dict[str, Fraction]:
        """The initial values of a manoeuvre that say this state; ``length`` is that of a middling vehicle."""
        first, other, last = vehicles[0], vehicles[1], vehicles[-1]
        signals, speed = self.signals, self.signals["v_lon", first]
        box: tuple[t.SizeName, ...] = ("length", "width")
        length, width = ((self.sizes[x, first] + self.sizes[x, last]) / 2 for x in box)
        gap, nothing = self.gap(first, other), Fraction(0)
        match manoeuvre:
            case "cut-in":
                said = {"dV0": speed - signals["v_lon", other], "Vy": abs(signals["v_lat", other])}
                said |= {"dx0": gap, "dy0": self.beside(first, other)}
            case "cut-out":
                near = gap if speed else nothing
                said = {"Vf0": signals["v_lon", last], "Vy": abs(signals["v_lat", other])}
                said |= {"headway": near / speed if speed else nothing}
                said |= {"dx0_f": self.gap(first, last) - near - length}
            case "deceleration":
                said = {"dV0": speed - signals["v_lon", other], "Gx": -signals["a_lon", other], "dx0": gap}
        return {"Ve0": speed, **said, "length": length, "width": width}


@dataclass(frozen=True)
class Margin:
    """How far from the boundary; None where no value that was looked at is on the other side."""

    metres: float | None
    seconds: float | None


@dataclass(frozen=True)
class Boundary:
    """That a collision is unpreventable for a model, as a formula about a state.

    ``at_values``: at the values of parameters; ``delayed``: with the time that the model takes to respond as
    a signal of its own, which is ``delay`` (s) at these values.
    """

    at_values: Formula
    delayed: Formula
    delay: Fraction


def boundary_of(formula: Formula, model: str, values: Mapping[str, Fraction]) -> Boundary:
    """The boundary of a model with a formula, whose parameters are left as they are; ``values`` (SI)."""
    name = _DELAYS[model]
    others = {key: x for key, x in values.items() if key != name}
    delayed = with_values(_varying(formula, name), others)
    return Boundary(with_values(formula, values), delayed, values[name])


def holds_in(formula: Formula, state: State) -> bool:
    """Whether a formula about a state, without parameters, holds in this one; exact."""
    return truth_within(formula, state.along(), Fraction(0), Fraction(1)).at(Fraction(0))


def margin(state: State, boundary: Boundary, vehicles: tuple[str, ...]) -> Margin:
    """How far a state is from the boundary. Ends of what was looked at, as a gap of 0, are no changes."""
    last = vehicles[-1]
    room = state.gap(vehicles[-2], last)  # less is no such manoeuvre
    shifted = state.along(last, state.signals["s", last] - room)
    farthest = max(room, Fraction(0)) + _FARTHEST
    gaps = _inside(truth_within(boundary.at_values, shifted, Fraction(0), farthest), farthest)
    latest = boundary.delay + _LATEST
    responding = state.along(own=own_of([boundary.delayed]))
    delays = _inside(truth_within(boundary.delayed, responding, Fraction(0), latest), latest)
    return Margin(_distance(gaps, room), _distance(delays, boundary.delay))


def _inside(truth: TruthSet, last: Fraction) -> tuple[float, ...]:
    """Where it changes between 0 and ``last``, both without."""
    return tuple(approximate(cut.point) for cut in truth.cuts if Fraction(0) < cut.point and cut.point < last)


def _distance(ends: Sequence[float], here: Fraction) -> float | None:
    """How far it is to the nearest place at which the formula changes."""
    found = min((abs(end - float(here)) for end in ends), default=None)
    return None if found is None else round(found, _PLACES)


def _varying(formula: Formula, name: str) -> Formula:
    """The formula with a parameter as a signal of its own."""

    def change(leaf: t.Leaf) -> t.Term:
        return (
            t.Own(name, "", leaf.dimension) if isinstance(leaf, t.Parameter) and leaf.name == name else leaf
        )

    return map_terms(formula, lambda term: t.replace_leaves(term, change))


# --- controllers ---------------------------------------------------------------------------------


def controller_hits(
    state: State, manoeuvre: ManoeuvreName, vehicles: tuple[str, ...], more: Fraction = Fraction(0)
) -> bool:
    """Whether the fuzzy safety model collides from this state on, with so much ``more`` gap (m).

    Raises ``InputError`` where SV would have to look too often.
    """
    kind = MANOEUVRES[manoeuvre]
    values = state.values(manoeuvre, vehicles)
    if values.get("dy0", Fraction(0)) > _WAITED * values.get("Vy", Fraction(1)):
        raise InputError(
            f"POV would be in the way only after more than {_WAITED} s: that long is not looked at"
        )
    return stepped.course_of(kind, {**values, kind.line: values[kind.line] + more}, False).touches


def controller_margin(
    state: State, manoeuvre: ManoeuvreName, vehicles: tuple[str, ...], hit: bool
) -> float | None:
    """How far it is to the nearest gap with the other answer, tried 1, 2, 4 … 64 m away."""
    room = state.gap(vehicles[-2], vehicles[-1])

    def changes(more: Fraction) -> bool:
        return room + more >= 0 and controller_hits(state, manoeuvre, vehicles, more) is not hit

    for before, after in pairwise(_TRIED):
        for way in (-1, 1):
            if changes(way * after):
                same, other = before, after
                while other - same > _FINE:
                    middle = (same + other) / 2
                    same, other = (same, middle) if changes(way * middle) else (middle, other)
                return round(float(other), _PLACES)
    return None
