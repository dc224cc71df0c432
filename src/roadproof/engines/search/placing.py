"""Puts a known drive on other roads: same motions, other zones, judged again."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from fractions import Fraction
from itertools import combinations, pairwise, product
from typing import get_args

from roadproof.engines.search.usual_road import zones_of
from roadproof.evidence.drive_file import DriveFile
from roadproof.evidence.judged import JudgedDrive, RejectedError
from roadproof.library.bind import bind, used_values, values_with
from roadproof.library.specification import Library, Query
from roadproof.logic import formula as f
from roadproof.logic.formula import is_state
from roadproof.logic.parts import parts_of
from roadproof.semantics.exact.judging import LazyJudge
from roadproof.world.drive import Drive
from roadproof.world.models import load_road, names_of
from roadproof.world.road import Lanelet, Road, Zone


def place_on_known_roads(
    file: DriveFile,
    query: Query,
    library: Library,
    roads: Sequence[Road] | None = None,
    judge: LazyJudge | None = None,
) -> JudgedDrive | None:
    """Return the motions of ``file`` on a road on which they satisfy ``query``, judged; None without one.

    Tried are the drive's own road and the reference roads with the zones of ``query``, unmoved and moved so
    that a zone begins or ends under a vehicle at time 0; with ``roads`` only these. ``judge``: a judge of the
    drive whose cache is reused.
    """
    chosen = _roads(file, zones_of(query.formula)) if roads is None else with_moved(roads, file.drive)
    return place_on_roads(file, query, library, chosen, judge)


def place_on_roads(
    file: DriveFile, query: Query, library: Library, roads: Iterable[Road], judge: LazyJudge | None = None
) -> JudgedDrive | None:
    """Return the motions of ``file`` on the first of ``roads`` on which they satisfy ``query``, judged."""
    values = values_with(library, file.values)
    now = f.conjunction(*(part for part in parts_of(query.formula) if is_state(part)))
    judge = judge or LazyJudge.on(file.drive)  # of all roads: what they have in common is judged once
    for road in roads:
        if not set(file.lanes.values()) <= set(road.lanes):
            continue
        if not all(judge.holds(bind(x, road, file.lanes, values)) for x in (now, query.formula)):
            continue
        judged = judge_as(replace(file, road=road), query, library)
        if judged is not None:
            return judged
    return None


def judge_as(file: DriveFile, query: Query, library: Library) -> JudgedDrive | None:
    """Return the drive at its place as one that satisfies ``query``; None where the judge rejects that.

    Its file states the value of each parameter of ``query``, so it has the same meaning everywhere.
    """
    stated = used_values(library, query.formula, values_with(library, file.values))
    here = replace(file, formula=query.text, scenario=None, values={**file.values, **stated})
    try:
        return JudgedDrive(here, library)
    except RejectedError:
        return None


def _roads(file: DriveFile, zones: frozenset[str]) -> Iterator[Road]:
    if zones <= {lanelet.zone for lanelet in file.road.lanelets}:
        yield file.road
    for name in names_of("roads"):
        road = load_road(name)
        has = {lanelet.zone for lanelet in road.lanelets}
        if zones <= has:
            yield road
            if len(has) > 1:
                yield from _moved_under(road, file.drive)


def with_moved(roads: Sequence[Road], drive: Drive) -> Iterator[Road]:
    """Yield roads as they are, and moved along so that a zone begins or ends under a vehicle at time 0."""
    for road in roads:
        yield road
        yield from _moved_under(road, drive)


def _moved_under(road: Road, drive: Drive) -> Iterator[Road]:
    ends = sorted({end for lanelet in road.lanelets for end in lanelet.s if end is not None})
    for motion in drive.vehicles.values():
        for end in ends:
            yield moved_road(road, motion.s - motion.length / 2 - end)


def moved_road(road: Road, by: Fraction) -> Road:
    """Return ``road`` with everything ``by`` metres further along; its name says so."""

    def move(lanelet: Lanelet) -> Lanelet:
        low, high = (None if end is None else end + by for end in lanelet.s)
        return replace(lanelet, s=(low, high))

    return Road(f"{road.name} moved by {by} m", tuple(map(move, road.lanelets)), road.adjacent)


def with_patched_zones(road: Road, drive: Drive) -> Iterator[Road]:
    """Yield ``road`` with new zones that begin and end across it under the vehicles at time 0; lanes stay.

    Tried are ends under the same part of every vehicle, then any two ends: vehicles may be side by side.
    """
    shares = (Fraction(1, 2), Fraction(1, 4), Fraction(3, 4))
    choices = [sorted({motion.s - x * motion.length for motion in drive.vehicles.values()}) for x in shares]
    choices.append(sorted({end for ends in choices for end in ends}))
    for ends in choices:
        for count in (0, 1, 2):
            for cuts in combinations(ends, count):
                for zones in product(get_args(Zone), repeat=count + 1):
                    if all(a != b for a, b in pairwise(zones)):
                        yield with_zones(road, cuts, zones)


def with_zones(road: Road, cuts: Sequence[Fraction], zones: Sequence[Zone]) -> Road:
    """Return ``road`` cut across at ``cuts`` (m, rising), with ``zones`` from the first piece to the last."""
    bounds = [None, *cuts, None]

    def pieces(lanelet: Lanelet) -> Iterator[Lanelet]:
        """Yield the pieces of a lanelet between the cuts."""
        for k, zone in enumerate(zones):
            low = max((x for x in (lanelet.s[0], bounds[k]) if x is not None), default=None)
            high = min((x for x in (lanelet.s[1], bounds[k + 1]) if x is not None), default=None)
            if low is None or high is None or low < high:
                yield replace(lanelet, id=f"{lanelet.id}-{k + 1}", zone=zone, s=(low, high))

    zone_names = ", ".join(zones)
    return Road(
        f"{road.name} with zones {zone_names}",
        tuple(x for y in road.lanelets for x in pieces(y)),
        road.adjacent,
    )
