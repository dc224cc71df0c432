"""The reference line of a road in OpenDRIVE: a line, or cubics through given points."""

import math
from collections.abc import Iterator
from fractions import Fraction
from itertools import pairwise

from roadproof.extensions.maps.xml_writer import Element, element
from roadproof.frontends.report.numbers import decimal
from roadproof.world.reference_line import ReferenceLine

_SPACING = 5
"""Metres between the points of a line, at most."""


def straight(low: Fraction, high: Fraction, d: Fraction) -> Element:
    """The line at d, where x = s and y = d."""
    line = element("geometry", element("line"), s="0", x=decimal(low), y=decimal(d), hdg="0")
    line.set("length", decimal(high - low))
    return element("planView", line)


def along(line: ReferenceLine, low: Fraction, high: Fraction) -> Element:
    """The line from ``low`` to ``high``, as cubics that have its places and directions at their ends."""
    return element("planView", *_cubics(line, low, high))


def _cubics(line: ReferenceLine, low: Fraction, high: Fraction) -> Iterator[Element]:
    inner = {x.begin for x in line.bends() if low < x.begin < high}
    for begin, end in pairwise(_evenly_spaced([low, *sorted(inner), high])):
        one, other = line.pose(float(begin)), line.pose(float(end))
        cos, sin = math.cos(one.heading), math.sin(one.heading)
        x, y = other.x - one.x, other.y - one.y
        u, v, turned = x * cos + y * sin, y * cos - x * sin, other.heading - one.heading
        length = float(end - begin)
        ahead, aside = length * math.cos(turned), length * math.sin(turned)
        coefficients = {
            **{"aU": 0.0, "bU": length, "cU": 3 * u - 2 * length - ahead, "dU": length + ahead - 2 * u},
            **{"aV": 0.0, "bV": 0.0, "cV": 3 * v - aside, "dV": aside - 2 * v},
        }
        cubic = element("paramPoly3", **{name: decimal(value) for name, value in coefficients.items()})
        cubic.set("pRange", "normalized")
        place = {"s": float(begin - low), "x": one.x, "y": one.y, "hdg": one.heading, "length": length}
        yield element("geometry", cubic, **{name: decimal(value) for name, value in place.items()})


def _evenly_spaced(places: list[Fraction]) -> Iterator[Fraction]:
    """Places, and as many between them as needed."""
    for low, high in pairwise(places):
        count = max(math.ceil((high - low) / _SPACING), 1)
        yield from (low + (high - low) * k / count for k in range(count))
    yield places[-1]
