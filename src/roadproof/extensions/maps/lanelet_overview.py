"""The overview of a map of measured lanelets: its main ways, and others that are not adjacent to them."""

from fractions import Fraction
from pathlib import Path

from roadproof.errors import InputError
from roadproof.extensions.maps.lanelet_map import LaneletMap, read_lanelets, stretch_of
from roadproof.extensions.maps.overview import MapStretch, describe
from roadproof.extensions.maps.selection import Selection


def ways_of(path: Path) -> tuple[MapStretch, ...]:
    """Every carriageway of a map, then the ways beside none of them, then what is left out as no road."""
    known = read_lanelets(path)
    main = known.network.main
    stretches = [
        _describe_way(known, way, Selection((str(k),)), f"road={k}") for k, way in enumerate(main, 1)
    ]
    seen = {x for way in main for x in known.beside(way)}
    for way in known.chains:
        if not seen.issuperset(way):
            seen.update(known.beside(way))
            stretches.append(_describe_way(known, way, Selection(way=way[0]), f"way={way[0]}"))
    if known.left_out:
        counts = ", ".join(f"{count} of type {kind}" for kind, count in known.left_out)
        stretches.append(
            MapStretch(str(path), "lanelets", Fraction(0), refused=f"left out as no roads: {counts}")
        )
    return tuple(stretches)


def _describe_way(known: LaneletMap, way: tuple[str, ...], selection: Selection, select: str) -> MapStretch:
    name = f"lanelets {way[0]} to {way[-1]}" if len(way) > 1 else f"lanelet {way[0]}"
    try:
        return describe(f"{known.path}#{select}", name, "", stretch_of(known, selection))
    except InputError as error:
        length = Fraction(round(known.metres(way)))
        return MapStretch(f"{known.path}#{select}", name, length, refused=str(error))
