"""Stretches of maps of any format, and as roads."""

from pathlib import Path

from roadproof.extensions.maps.opendrive import read_map
from roadproof.extensions.maps.selection import (
    LANELETS,
    SelectedStretch,
    Selection,
    read_selection,
    stretch_of,
)
from roadproof.world.lanelet_rules import shared_boundaries
from roadproof.world.road import Road


def select(path: Path, selection: Selection, origin: tuple[float, float] | None = None) -> SelectedStretch:
    """The stretch of a map. Raises ``InputError`` that names the file, the element and the rule.

    ``origin``: the point in UTM (m) from which places count in Lanelet2, instead of the middle of the map.
    """
    if path.suffix in LANELETS:  # such maps need numpy
        from roadproof.extensions.maps import lanelet_map

        return lanelet_map.stretch_of(lanelet_map.read_lanelets(path, origin), selection)
    return stretch_of(path, read_map(path), selection)


def road_of(text: str) -> Road:
    """Return the stretch of a map that a text such as ``map.xodr#road=1`` selects.

    Raises ``InputError``; ``UsageError`` for a stretch that is not well said.
    """
    path, selection = read_selection(text)
    selected = select(path, selection)
    beside = shared_boundaries(selected.lanelets)
    return Road(path.stem, selected.lanelets, beside, selected.line, text, selected.unread)
