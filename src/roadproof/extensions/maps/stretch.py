"""Stretches of maps as roads."""

from roadproof.extensions.maps.selection import read_selection, select
from roadproof.world.lanelet_rules import shared_boundaries
from roadproof.world.road import Road


def road_of(text: str) -> Road:
    """Return the stretch of a map that a text such as ``map.xodr#road=1`` selects.

    Raises ``InputError``; ``UsageError`` for a stretch that is not well said.
    """
    path, selection = read_selection(text)
    found = select(path, selection)
    beside = shared_boundaries(found.lanelets)
    return Road(path.stem, found.lanelets, beside, found.line, text, found.unread)
