"""The areas of a plate: where a collision is unpreventable, and where SV has passed, as far as lines decide.

Points are (along, across) in SI units. An area is between lines beside each other that have as many spans;
it ends with these lines, and nothing is shaded beyond them.
"""

import math
from collections.abc import Iterator, Mapping, Sequence
from itertools import groupby
from typing import TypeAlias

from roadproof.extensions.drivers.lines import PlateLine
from roadproof.extensions.drivers.manoeuvres import CUT_IN, ManoeuvreName

Point: TypeAlias = tuple[float, float]
Outline: TypeAlias = Sequence[Point]
Range: TypeAlias = tuple[float, float]
_NEAR = 1e-6
"""The rounding of ends."""


def unpreventable_areas(lines: Sequence[PlateLine]) -> Iterator[Outline]:
    """Yield the outlines of the areas between lines, or a span of a line that has none beside it."""
    for run in _runs(lines):
        for which in range(len(run[0].spans)):
            yield _outline([(float(x.at), x.spans[which][0].near, x.spans[which][1].near) for x in run])


def boundaries(lines: Sequence[PlateLine], along: Range) -> Iterator[Outline]:
    """Yield the boundaries of the areas: ends of spans from line to line, except at an end of the range."""
    for run in _runs(lines):
        for which in range(len(run[0].spans)):
            for end in (0, 1):
                points = [(x.spans[which][end].near, float(x.at)) for x in run]
                for is_inside, group in groupby(points, lambda x: _is_inside(x[0], along)):
                    if is_inside:
                        yield [*group]


def passed_areas(plates: Sequence[Sequence[PlateLine]], along: Range) -> Iterator[Outline]:
    """Yield the areas left of the first span of each line, on all of some plates with the same lines.

    There SV has passed before POV is in its way, if ``tells_passed``.
    """
    rows = [(float(x[0].at), min(map(_first, x))) for x in zip(*plates, strict=True)]
    for begins, group in groupby(rows, lambda x: along[0] + _NEAR < x[1]):
        if begins:
            yield _outline([(at, along[0], first) for at, first in group])


def _first(line: PlateLine) -> float:
    """Return where the first span of a line begins; below every range where it has none."""
    return line.spans[0][0].near if line.spans else -math.inf


def _is_inside(place: float, along: Range) -> bool:
    return along[0] + _NEAR < place < along[1] - _NEAR


def tells_passed(manoeuvre: ManoeuvreName, is_stepped: bool, options: Mapping[str, str]) -> bool:
    """Return whether the places of a line before its first span are those where SV has passed.

    It is so in a cut-in whose driver does not wait for a time to collision: when it brakes does not depend
    on the gap. A controller that is stepped looks at single places.
    """
    return manoeuvre == CUT_IN.name and not is_stepped and options.get("cc_gate", "none") == "none"


def is_empty(lines: Sequence[PlateLine]) -> bool:
    """Return whether no line has a span: a collision is preventable on all of them."""
    return not any(x.spans for x in lines)


def is_full(lines: Sequence[PlateLine], along: Range) -> bool:
    """Return whether each line is one span: a collision is unpreventable on all of them."""
    return all(
        len(x.spans) == 1
        and x.spans[0][0].near <= along[0] + _NEAR
        and x.spans[0][1].near >= along[1] - _NEAR
        for x in lines
    )


def side_of_all(lines: Sequence[PlateLine], along: Range) -> str:
    """Return the side that all places of all lines are on; empty where there are both, or no lines."""
    if not lines:
        return ""
    if is_empty(lines):
        return "preventable"
    return "unpreventable" if is_full(lines, along) else ""


def _runs(lines: Sequence[PlateLine]) -> Iterator[list[PlateLine]]:
    """Yield lines beside each other that have as many spans."""
    for count, group in groupby(lines, lambda x: len(x.spans)):
        if count:
            yield [*group]


def _outline(rows: Sequence[tuple[float, float, float]]) -> Outline:
    """Return the outline of rows (across, from, to)."""
    return [*((low, at) for at, low, _ in rows), *((high, at) for at, _, high in reversed(rows))]
