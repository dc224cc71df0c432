"""The TOML file of a road."""

from __future__ import annotations

import json
from fractions import Fraction
from typing import TYPE_CHECKING

from roadproof.errors import InputError
from roadproof.frontends.report.numbers import decimal
from roadproof.world.lanelet_rules import check_lanelets, shared_boundaries

if TYPE_CHECKING:
    from roadproof.world.road import Lanelet, Road


def road_toml(road: Road, s: Fraction = Fraction(0), d: Fraction = Fraction(0)) -> str:
    """The text of a file that ``world.models.load_road`` reads as ``road``, moved by ``s`` and ``d`` m.

    Raises ``InputError`` for what such a file cannot say: lanes that are adjacent without a shared boundary
    or have one and are not adjacent, and lanes that are no chain of lanelets.
    """
    where = f"road {road.name}"
    check_lanelets(road.lanelets, where)
    other = shared_boundaries(road.lanelets) ^ road.adjacent
    if other:
        names = " and ".join(sorted(min(other, key=sorted)))
        raise InputError(f"{where}: lanes {names} share a boundary or are adjacent, but not both")
    return "\n".join([f"name = {_text(road.name)}\n", *(_lanelet(x, s, d) for x in road.lanelets)])


def _lanelet(lanelet: Lanelet, s: Fraction, d: Fraction) -> str:
    texts = {name: _text(getattr(lanelet, name)) for name in ("id", "lane", "zone", "attribute")}
    low = "-inf" if lanelet.s[0] is None else _number(lanelet.s[0] + s)
    high = "inf" if lanelet.s[1] is None else _number(lanelet.s[1] + s)
    ranges = {"s": (low, high), "d": tuple(_number(x + d) for x in lanelet.d)}
    lines = [f"{name} = {text}" for name, text in texts.items()]
    lines += [f"{name} = [{', '.join(both)}]" for name, both in ranges.items()]
    return "[[lanelet]]\n" + "\n".join(lines) + "\n"


def _text(text: str) -> str:
    """A basic string of TOML, whose escapes are those of JSON."""
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")


def _number(value: Fraction) -> str:
    """Exactly: a decimal, or a ratio as text where there is none."""
    text = decimal(value)
    return text if Fraction(text) == value else _text(str(value))
