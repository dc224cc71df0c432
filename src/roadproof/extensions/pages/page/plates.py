"""The template values of plates: diagrams of two initial values in which collisions are unpreventable."""

from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction
from typing import NamedTuple

from roadproof.evidence.codec import read
from roadproof.extensions.drivers.lines import PlateLine
from roadproof.extensions.drivers.manoeuvres import MANOEUVRES, InitialQuantity, ManoeuvreName
from roadproof.extensions.drivers.models import MODELS
from roadproof.extensions.drivers.preventable import areas
from roadproof.extensions.drivers.preventable.data import PlateData, PreventableData
from roadproof.extensions.drivers.preventable.own_tests import PlacedTest, placed_tests
from roadproof.extensions.drivers.preventable.report import measured
from roadproof.extensions.drivers.words import legend
from roadproof.extensions.pages.page.page_context import PageContext
from roadproof.extensions.pages.page.results import PageResult, Words
from roadproof.runtime.records import dataclass
from roadproof.world.units import UNITS

_WIDE, _HIGH, _LEFT, _BELOW = 290.0, 190.0, 48.0, 30.0  # of a plate in px, and the room for its numbers


def plate_values(result: PageResult, context: PageContext, words: Words) -> dict[str, object]:
    """Return the plates, in ``groups`` with equal fixed values."""
    index = read(PreventableData, result.data, result.name)
    quantities = MANOEUVRES[index.manoeuvre].quantities
    groups: dict[tuple[tuple[str, str], ...], list[PlateData]] = {}
    for x in index.plates:
        groups.setdefault(tuple(sorted(x.fixed.items())), []).append(x)
    tests = _tests_by_group(index, [{n: Fraction(x) for n, x in fixed} for fixed in groups])
    shown = {index.along[0], index.across[0], *(name for x in index.plates for name in x.fixed)}
    return {
        "answer": index,
        "groups": [(dict(fixed), here, tests.get(k, ())) for k, (fixed, here) in enumerate(groups.items())],
        "tested": {x.has_values for here in tests.values() for x in here},
        "models": dict.fromkeys(x.model for x in index.plates),
        "plane": plane_of(index),
        "legend": legend([x for name, x in quantities.items() if name in shown]),
        "title_of": _title,
        "stepped": {x.model for x in index.plates if x.stepped},
    }


def _tests_by_group(
    index: PreventableData, groups: Sequence[Mapping[str, Fraction]]
) -> dict[int, list[PlacedTest]]:
    """Return the tests of the reader on each group of plates, by its number."""
    (along, *ends), (across, low, high, _) = index.along, index.across
    ranges = {along: (Fraction(ends[0]), Fraction(ends[1])), across: (Fraction(low), Fraction(high))}
    by_group: dict[int, list[PlacedTest]] = {}
    if index.tests:
        for x in placed_tests(index.tests, MANOEUVRES[index.manoeuvre], groups, ranges):
            by_group.setdefault(x.plate, []).append(x)
    return by_group


def plane_of(index: PreventableData) -> "_Plane":
    """Return the plane of the two initial values that vary on the plates of an answer."""
    quantities = MANOEUVRES[index.manoeuvre].quantities
    return _Plane(quantities, index.along, index.across, index.manoeuvre, index.options)


def _colour(model: str) -> str:
    return MODELS[model].colour[1] if model in MODELS else "var(--faint)"


class _Mark(NamedTuple):
    """A judged drive: its place in px, its side, and words."""

    x: float
    y: float
    is_filled: bool
    text: str


class _Area(NamedTuple):
    """The unpreventable area of a driver model as points: areas, single spans, boundaries; and its drives."""

    colour: str
    areas: Sequence[str]
    spans: Sequence[str]
    edges: Sequence[str]
    marks: Sequence[_Mark]


class _PlateDrawing(NamedTuple):
    """The areas, where SV has passed, notes on models that are the same everywhere, numbers of the axes."""

    areas: Sequence[_Area]
    passed: Sequence[str]
    notes: Sequence[str]
    tests: Sequence[_Mark]
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
    manoeuvre: ManoeuvreName
    options: Mapping[str, str]

    @staticmethod
    def colour_of(model: str) -> str:
        """Return the colour of a driver model."""
        return _colour(model)

    @staticmethod
    def title_of(model: str) -> str:
        """Return the title of a driver model."""
        return _title(model)

    def known(self, values: Mapping[str, str]) -> dict[str, str]:
        """Return the values of the manoeuvre's own quantities."""
        return {name: x for name, x in values.items() if name in self.quantities}

    def measured(self, name: str, value: str) -> str:
        """Return a value in the unit of its quantity."""
        return measured(self.quantities[name], Fraction(value)) if name in self.quantities else value

    def label(self, name: str) -> str:
        """Return the name of an axis with its unit."""
        return f"{name} [{self._unit(name)}]"

    def drawn(self, plates: Sequence[PlateData], tests: Sequence[PlacedTest] = ()) -> _PlateDrawing:
        """Return the drawing of plates over each other, with tests of the reader."""
        low, high = (float(Fraction(x)) for x in self.along[1:])
        lines = {x.name: [line.drawn for line in x.lines] for x in plates}
        rows = [float(line.at) for x in lines.values() for line in x] or [0.0, 1.0]
        frame = _Frame((low, high), (min(rows), max(rows)))
        ends = (self._number(self.along[0], low), self._number(self.along[0], high))
        passing = [lines[x.name] for x in plates if x.lines and self._tells_passed(x)]
        return _PlateDrawing(
            [self._area(x, lines[x.name], frame) for x in plates],
            [frame.points(x) for x in areas.passed_areas(passing, frame.along) if len(x) > 2],
            [*_notes(plates, lines, frame.along)],
            [*self._test_marks(tests, frame)],
            *ends,
            *(self._number(self.across[0], x) for x in frame.across),
        )

    def _area(self, plate: PlateData, lines: Sequence[PlateLine], frame: "_Frame") -> _Area:
        """Return the areas of a plate; of a stepped one single spans, between which nothing is claimed."""
        if plate.stepped:
            ends = [[(a.near, float(x.at)), (b.near, float(x.at))] for x in lines for a, b in x.spans]
            return _Area(_colour(plate.model), [], [*map(frame.points, ends)], [], self._marks(plate, frame))
        outlines = [*areas.unpreventable_areas(lines)]
        return _Area(
            _colour(plate.model),
            [frame.points(x) for x in outlines if len(x) > 2],
            [frame.points(x) for x in outlines if len(x) == 2],
            [frame.points(x) for x in areas.boundaries(lines, frame.along)],
            self._marks(plate, frame),
        )

    def _marks(self, plate: PlateData, frame: "_Frame") -> list[_Mark]:
        marks = []
        for x in plate.shown:
            if x.drive is None or not {self.along[0], self.across[0]} <= x.at.keys():
                continue
            place, row = (float(Fraction(x.at[name])) for name in (self.along[0], self.across[0]))
            text = ", ".join(f"{name} {self.measured(name, x.at[name])}" for name in self.known(x.at))
            text = f"{x.side}, {_title(plate.model)}: a judged drive at {text}"
            marks.append(_Mark(frame.x(place), frame.y(row), x.side == "unpreventable", text))
        return marks

    def _test_marks(self, tests: Sequence[PlacedTest], frame: "_Frame") -> Iterator[_Mark]:
        """Yield the tests of the reader; those with the values of the plate are filled."""
        for x in tests:
            values = x.test.values
            text = ", ".join(f"{name} {self.measured(name, str(v))}" for name, v in values.items())
            text = f"{x.test.name}: {text}{'' if x.has_values else '; the plate has other values'}"
            place, row = (float(values[name]) for name in (self.along[0], self.across[0]))
            yield _Mark(frame.x(place), frame.y(row), x.has_values, text)

    def _tells_passed(self, plate: PlateData) -> bool:
        return areas.tells_passed(self.manoeuvre, bool(plate.stepped), self.options)

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

    def points(self, points: areas.Outline) -> str:
        """Return points in px, as SVG has them."""
        return " ".join(f"{self.x(x)},{self.y(y)}" for x, y in points)


def _title(model: str) -> str:
    return MODELS[model].title if model in MODELS else model


def _notes(
    plates: Sequence[PlateData], lines: Mapping[str, Sequence[PlateLine]], along: areas.Range
) -> Iterator[str]:
    """Yield a note for each model that has the same answer on the whole plate, or none."""
    for x in plates:
        side = areas.side_of_all(lines[x.name], along)
        if side:
            yield f"{_title(x.model)}: {side} {'at all places looked at' if x.stepped else 'on all lines'}"
        elif not x.lines:
            yield f"{_title(x.model)}: not decided"
