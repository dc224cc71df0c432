"""Maps of measured lanelets (CommonRoad, Lanelet2): their ways, and the road that is beside one of them.

A way is a chain of lanelets that follow each other. Its road are these lanelets and their neighbours, lane
beside lane; ``road=K`` means the main way of carriageway K, ``way=ID`` that with lanelet ID. s is measured on
the middle of the way. Lanelets that lead away or come from aside are no part of the road; traffic that
crosses it is refused.
"""

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np

from roadproof.errors import InputError, UsageError
from roadproof.extensions.maps import commonroad, lanelet2
from roadproof.extensions.maps.lanelet_steps import MapLanelet, edges_along, lanelets_of
from roadproof.extensions.maps.lines import crossing, joined, reference_line, thinned
from roadproof.extensions.maps.network import Network, network_of, zones_of
from roadproof.extensions.maps.projections import UtmPoint
from roadproof.extensions.maps.selection import STEP, SelectedStretch, Selection, cut
from roadproof.extensions.maps.topology import Floats, chains_of, closure, length_of
from roadproof.world.lanelet_rules import check_lanelets
from roadproof.world.reference_line import ReferenceLine
from roadproof.world.road import Attribute, Lanelet, Zone

_SPACING, _ENDS = 2.0, 1.0
"""Metres between points of lines that may cross, and from their ends, where lanelets part or join."""
_COARSER = (2 * STEP, 4 * STEP, 8 * STEP)
"""How much (m) an edge may change on a lanelet where there are too many: the first that is enough."""
_MANY = 50
"""So many lanelets are enough: with more of them a search soon takes minutes."""


@dataclass(frozen=True)
class LaneletMap:
    """``left_out``: how many lanelets are no road, by their type. ``unread``: kinds of parts of the file."""

    path: Path
    network: Network
    left_out: tuple[tuple[str, int], ...] = ()
    unread: tuple[str, ...] = ()

    @cached_property
    def chains(self) -> tuple[tuple[str, ...], ...]:
        """All ways."""
        return chains_of(self.network.lanelets)

    @cached_property
    def across(self) -> dict[str, tuple[str, ...]]:
        """The lanelets beside each lanelet across the road, itself included."""
        lanelets = self.network.lanelets
        return closure(lanelets, ((x.id, other) for x in lanelets.values() for other in x.beside))

    @cached_property
    def middles(self) -> dict[str, Floats]:
        """The middle of each lanelet, with points some metres apart."""
        return {name: thinned(x.centre, _SPACING) for name, x in self.network.lanelets.items()}

    @cached_property
    def boxes(self) -> tuple[Floats, Floats]:
        """The least and the greatest x and y of the middle of each lanelet, in their order."""
        corners = [(x.min(axis=0), x.max(axis=0)) for x in self.middles.values()]
        return np.array([x for x, _ in corners]), np.array([x for _, x in corners])

    @cached_property
    def predecessors(self) -> dict[str, set[str]]:
        """The predecessors of each lanelet."""
        predecessors: dict[str, set[str]] = {x: set() for x in self.network.lanelets}
        for x in self.network.lanelets.values():
            for other in x.successors:
                predecessors[other].add(x.id)
        return predecessors

    @cached_property
    def chain_of(self) -> dict[str, int]:
        """The index in ``chains`` of each lanelet's chain."""
        return {name: k for k, chain in enumerate(self.chains) for name in chain}

    def branches(self, name: str) -> set[str]:
        """The lanelets that a lanelet parts from at its beginning, and those that it joins at its end."""
        lanelets = self.network.lanelets
        parting = {other for x in self.predecessors[name] for other in lanelets[x].successors}
        joining = {other for x in lanelets[name].successors for other in self.predecessors[x]}
        return (parting | joining) - {name}

    def near(self, line: Floats) -> list[str]:
        """Lanelets whose middles may cross a line."""
        low, high = self.boxes
        meet = ((low <= line.max(axis=0)) & (high >= line.min(axis=0))).all(axis=1)
        names = [*self.middles]
        return [names[k] for k in np.flatnonzero(meet)]

    def beside(self, way: tuple[str, ...]) -> tuple[str, ...]:
        """The lanelets of the road along a way."""
        return tuple(dict.fromkeys(other for name in way for other in self.across[name]))

    def metres(self, way: tuple[str, ...]) -> float:
        """The length of a way."""
        return length_of(self.network.lanelets, way)


def read_lanelets(path: Path, origin: UtmPoint | None = None) -> LaneletMap:
    """The map of a file, by its ending; ``origin`` as for ``lanelet2.read_map``. Raises ``InputError``."""
    if path.suffix == ".osm":
        content = lanelet2.read_map(path, origin)
        return LaneletMap(path, network_of(path, content.lanelets), content.others, content.unread)
    lanelets, ignored_parts = commonroad.read_map(path)
    return LaneletMap(path, network_of(path, lanelets), unread=ignored_parts)


def way_of(known: LaneletMap, selection: Selection) -> tuple[str, ...]:
    """The way that is selected. Raises ``InputError``, ``UsageError``."""
    path, main = known.path, known.network.main
    if selection.against is not None or len(selection.roads) > 1:
        raise UsageError(f"road {path}: lanes and route are for OpenDRIVE; name a way as {path}#way=ID")
    if selection.way is not None:
        for way in known.chains:
            if selection.way in way:
                return way
        raise InputError(f"{path}: there is no lanelet {selection.way}; roadproof road {path} lists the ways")
    if not selection.roads and len(main) > 1:
        problem = f"{len(main)} roads; name one as {path}#road=K, K from 1 to {len(main)}, or {path}#way=ID"
        raise InputError(f"{path}: {problem}; roadproof road {path} lists them")
    number = selection.roads[0] if selection.roads else "1"
    if not number.isdecimal() or not 0 < int(number) <= len(main):
        raise InputError(f"{path}: road={number}: a number from 1 to {len(main)} is needed, or way=ID")
    return main[int(number) - 1]


def stretch_of(known: LaneletMap, selection: Selection) -> SelectedStretch:
    """The stretch that is selected. Raises ``InputError``, ``UsageError``."""
    way = way_of(known, selection)
    where = f"{known.path}, way of lanelet {way[0]}"
    lanelets = known.network.lanelets
    if way[0] in lanelets[way[-1]].successors:
        raise InputError(
            f"{where}: lanelet {way[-1]} leads back to {way[0]}: a ring road is not supported, only traffic "
            "along one road; cut the file"
        )
    line = reference_line(joined([lanelets[x].centre for x in way]))
    measured = _map_lanelets(known, way, line, where)
    whole_road = lanelets_of(measured, way, selection.step or STEP, where)
    lanelets_in_span = cut(known.path, whole_road, selection.span)
    for step in _COARSER if selection.step is None and len(lanelets_in_span) > _MANY else ():
        coarser = lanelets_of(measured, way, step, where)
        fewer = cut(known.path, coarser, selection.span)
        if not _keeps_rules(fewer, where):
            break
        whole_road, lanelets_in_span = coarser, fewer
        if len(lanelets_in_span) <= _MANY:
            break
    _refuse_crossing(known, way, line, lanelets_in_span)
    check_lanelets(tuple(lanelets_in_span), where)
    return SelectedStretch(tuple(lanelets_in_span), line, whole_road.width_error, known.unread)


def _keeps_rules(lanelets: list[Lanelet], where: str) -> bool:
    """Return whether lanelets of a lane still meet, though their edges are coarser."""
    try:
        check_lanelets(tuple(lanelets), where)
    except InputError:
        return False
    return True


def _map_lanelets(
    known: LaneletMap, way: tuple[str, ...], line: ReferenceLine, where: str
) -> tuple[MapLanelet, ...]:
    """The lanelets of the road along a way, each with its lane."""
    network, names = known.network, known.beside(way)
    attributes, zones = _kinds(known, way)
    lanes: dict[str, str] = {}
    for number in dict.fromkeys(known.chain_of[name] for name in names):
        chain = known.chains[number]
        for k, name in enumerate(chain):
            goes_on = k and chain[k - 1] in lanes and attributes.get(chain[k - 1]) == attributes.get(name)
            if name in attributes:
                lanes[name] = lanes[chain[k - 1]] if goes_on else name
    begins = _begins(known, way)
    lengths = dict.fromkeys(lanes.values(), 0.0)
    for name, lane in lanes.items():
        lengths[lane] += network.lanelets[name].length
    return tuple(
        MapLanelet(
            x,
            lanes[x],
            attributes[x],
            zones[x],
            edges_along(line, network.lanelets[x].right, begins[x], f"{where}: right bound of lanelet {x}"),
            edges_along(line, network.lanelets[x].left, begins[x], f"{where}: left bound of lanelet {x}"),
            lengths[lanes[x]],
            frozenset(known.branches(x)),
        )
        for x in names
    )


def _begins(known: LaneletMap, way: tuple[str, ...]) -> dict[str, float]:
    """Return where (m) along a way each lanelet of its road begins to be beside it."""
    begins: dict[str, float] = {}
    begin = 0.0
    for name in way:
        begins |= {other: begin for other in known.across[name] if other not in begins}
        begin += known.network.lanelets[name].length
    return begins


def _kinds(known: LaneletMap, way: tuple[str, ...]) -> tuple[dict[str, Attribute], dict[str, Zone]]:
    """Attributes and zones: on a way that is not the main one of its carriageway as types say, else main."""
    network, names = known.network, known.beside(way)
    if way in network.main:
        return {x: network.attributes[x] for x in names}, {x: network.zones[x] for x in names}
    attributes: dict[str, Attribute] = {x: network.lanelets[x].attribute or "main" for x in names}
    if "main" not in attributes.values():
        attributes = dict.fromkeys(names, "main")
    across = {name: network.lanelets[name] for name in names}
    return attributes, zones_of(across, attributes)


def _refuse_crossing(
    known: LaneletMap, way: tuple[str, ...], line: ReferenceLine, selected: list[Lanelet]
) -> None:
    """Raises ``InputError`` where a lanelet of the map crosses the part of the road that is selected."""
    lanelets, ours = known.network.lanelets, set(known.beside(way))
    ends = [float(s) for x in selected for s in x.s if s is not None]
    joining = {other for x in ours for other in known.predecessors[x]}
    parting = {other for x in ours for other in lanelets[x].successors}
    roads = [joined([known.middles[name] for name in way])]
    roads += [known.middles[x] for x in sorted(ours - set(way))]
    for road in roads:
        for name in known.near(road):
            if name in ours or name in joining or name in parting:
                continue
            met = crossing(road, known.middles[name], _ENDS)
            s = line.locate(*met)[0] if met else None
            if s is not None and min(ends) <= s <= max(ends):
                rule = "only traffic along one road is supported; cut a part with from=M and to=M"
                problem = f"lanelet {name} crosses it at s = {s:.0f} m: {rule}"
                raise InputError(f"{known.path}, way of lanelet {way[0]}: {problem}")
