"""The template values of plates: diagrams of two initial values in which collisions are unpreventable."""

from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction
from typing import NamedTuple

from roadproof.evidence.codec import read
from roadproof.extensions.drivers.manoeuvres import MANOEUVRES, InitialQuantity
from roadproof.extensions.drivers.models import MODELS
from roadproof.extensions.drivers.preventable.data import PlateData, PreventableData
from roadproof.extensions.drivers.preventable.report import measured
from roadproof.extensions.drivers.words import legend
from roadproof.extensions.pages.page.page_context import PageContext
from roadproof.extensions.pages.page.results import PageResult, Words
from roadproof.runtime.records import dataclass
from roadproof.world.units import UNITS

_WIDE, _HIGH, _LEFT, _BELOW = 300.0, 190.0, 34.0, 28.0  # of a plate in px, and the room for its numbers


def plate_values(result: PageResult, context: PageContext, words: Words) -> dict[str, object]:
    """Return the plates, in ``groups`` with equal fixed values."""
    index = read(PreventableData, result.data, result.name)
    quantities = MANOEUVRES[index.manoeuvre].quantities
    groups: dict[tuple[tuple[str, str], ...], list[PlateData]] = {}
    for x in index.plates:
        groups.setdefault(tuple(sorted(x.fixed.items())), []).append(x)
    shown = {index.along[0], index.across[0], *(name for x in index.plates for name in x.fixed)}
    return {
        "answer": index,
        "groups": [(dict(fixed), here) for fixed, here in groups.items()],
        "models": dict.fromkeys(x.model for x in index.plates),
        "plane": plane_of(index),
        "legend": legend([x for name, x in quantities.items() if name in shown]),
        "title_of": lambda model: MODELS[model].title if model in MODELS else model,
        "colour_of": _colour,
    }


def plane_of(index: PreventableData) -> "_Plane":
    """Return the plane of the two initial values that vary on the plates of an answer."""
    return _Plane(MANOEUVRES[index.manoeuvre].quantities, index.along, index.across)


def _colour(model: str) -> str:
    return MODELS[model].colour[1] if model in MODELS else "var(--faint)"


class _Span(NamedTuple):
    """A rectangle in a picture, in px."""

    x: float
    y: float
    width: float
    height: float


class _Area(NamedTuple):
    """The unpreventable area of a driver model: spans of lines, and the points of their first and
    last ends.
    """

    colour: str
    spans: Sequence[_Span]
    edges: Sequence[Sequence[str]]


class _PlateDrawing(NamedTuple):
    """The areas, and the numbers at the ends of the axes."""

    areas: Sequence[_Area]
    low: str
    high: str
    bottom: str
    top: str


@dataclass(frozen=True)
class _Plane:
    """The two initial values that vary: ``along`` a line from left to right, ``across`` lines upwards."""

    quantities: Mapping[str, InitialQuantity]
    along: Sequence[str]
    across: Sequence[str]

    def known(self, values: Mapping[str, str]) -> dict[str, str]:
        """Return the values of the manoeuvre's own quantities."""
        return {name: x for name, x in values.items() if name in self.quantities}

    def measured(self, name: str, value: str) -> str:
        """Return a value in the unit of its quantity."""
        return measured(self.quantities[name], Fraction(value)) if name in self.quantities else value

    def label(self, name: str) -> str:
        """Return the name of an axis with its unit."""
        return f"{name} [{self._unit(name)}]"

    def drawn(self, plates: Sequence[PlateData]) -> _PlateDrawing:
        """Return the drawing of plates over each other."""
        low, high = (float(Fraction(x)) for x in self.along[1:])
        rows = [float(Fraction(line.at)) for x in plates for line in x.lines] or [0.0, 1.0]
        frame = _Frame((low, high), (min(rows), max(rows)))
        ends = (self._number(self.along[0], low), self._number(self.along[0], high))
        return _PlateDrawing(
            [_area(x, frame) for x in plates], *ends, *(self._number(self.across[0], x) for x in frame.across)
        )

    def _unit(self, name: str) -> str:
        return self.quantities[name].unit if name in self.quantities else "unitless"

    def _number(self, name: str, value: float) -> str:
        return f"{value / float(UNITS[self._unit(name)][0]):.4g}"


@dataclass(frozen=True)
class _Frame:
    """The mapping of values to px: those along a line from left to right, those of lines upwards."""

    along: tuple[float, float]
    across: tuple[float, float]

    def x(self, value: float) -> float:
        low, high = self.along
        return round(_LEFT + (value - low) / (high - low) * (_WIDE - _LEFT), 2)

    def y(self, value: float) -> float:
        low, high = self.across
        return round((_HIGH - _BELOW) * (1 - (value - low) / (high - low or 1)), 2)

    def spans(self, plate: PlateData) -> Iterator[_Span]:
        """Yield the unpreventable spans of each line; thin ones where nothing is claimed between lines."""
        thick = 1.2 if plate.stepped else (_HIGH - _BELOW) / max(1, len(plate.lines) - 1)
        for line in plate.lines:
            middle = self.y(float(Fraction(line.at)))
            top, bottom = max(0.0, middle - thick / 2), min(_HIGH - _BELOW, middle + thick / 2)
            for begin, end in line.unpreventable:
                left = self.x(float(begin.near))
                width = max(0.4, self.x(float(end.near)) - left)
                yield _Span(left, round(top, 2), round(width, 2), round(bottom - top, 2))

    def edge(self, plate: PlateData, which: int) -> list[str]:
        """Return the first (0) or last (-1) ends of all lines, except those at an end of the range."""
        points = []
        for line in plate.lines:
            if line.unpreventable:
                value = float(line.unpreventable[which][which].near)
                if self.along[0] < value < self.along[1]:
                    points.append(f"{self.x(value)},{self.y(float(Fraction(line.at)))}")
        return points


def _area(plate: PlateData, frame: _Frame) -> _Area:
    edges = [] if plate.stepped else [frame.edge(plate, which) for which in (0, -1)]
    return _Area(_colour(plate.model), [*frame.spans(plate)], edges)
