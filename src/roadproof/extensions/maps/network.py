"""Lanelets of a measured road: which form a lane, which lanes lie beside each other, and their zones.

Paper, appendix *Road Network*: a lane is the closure of a lanelet under predecessors and successors
with the same attribute. A lanelet beside a merge lane is in the merge zone, one beside a departure
lane in the depart zone, every other one on the main road. A file NAME_zones.toml may say otherwise.
"""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import cast, get_args

from roadproof.errors import InputError
from roadproof.extensions.maps.topology import (
    MeasuredLanelet,
    attributes_of,
    carriageways_of,
    chains_of,
    closure,
    main_way,
)
from roadproof.world.models import read_toml, require_one_of
from roadproof.world.road import Attribute, Zone

ZONES_ENDING = "_zones.toml"
LONGEST = 100_000.0
"""m: no lanelet is longer."""


@dataclass(frozen=True)
class LaneletAttributes:
    """Attributes and zones of lanelets by id, as a user states them."""

    attributes: Mapping[str, Attribute] = field(default_factory=dict)
    zones: Mapping[str, Zone] = field(default_factory=dict)


@dataclass(frozen=True)
class MeasuredLane:
    """Lanelets in driving direction; ``carriageway`` counts from 1, lanes of one are connected."""

    name: str
    lanelets: tuple[str, ...]
    carriageway: int


@dataclass(frozen=True)
class Network:
    """Lanelets with what they are; ``beside``: unordered pairs of names of adjacent lanes.

    ``main``: for each carriageway, in order, the way that s is measured on. ``notes`` list what was inferred.
    """

    lanelets: Mapping[str, MeasuredLanelet]
    attributes: Mapping[str, Attribute]
    zones: Mapping[str, Zone]
    lanes: tuple[MeasuredLane, ...]
    beside: frozenset[frozenset[str]]
    main: tuple[tuple[str, ...], ...]
    notes: tuple[str, ...]


def network_of(path: Path, lanelets: Mapping[str, MeasuredLanelet]) -> Network:
    """The network of the lanelets of ``path``, with zones from the file beside it. Raises ``InputError``."""
    overrides = _read_zones_file(path.with_name(f"{path.stem}{ZONES_ENDING}"), lanelets)
    for lanelet in lanelets.values():
        if not lanelet.length < LONGEST:
            length = f"lanelet {lanelet.id} is {lanelet.length:g} m long"
            raise InputError(f"{path}: {length}; at most {LONGEST:g} m")
    inferred = attributes_of(lanelets)
    attributes = {
        name: overrides.attributes.get(name, attribute) for name, (attribute, _) in inferred.items()
    }
    ways = carriageways_of(lanelets)
    lanes = _lanes(lanelets, attributes, ways)
    zones = {**zones_of(lanelets, attributes), **overrides.zones}
    chains = chains_of(lanelets)
    main = tuple(main_way(lanelets, [chain for chain in chains if chain[0] in way]) for way in ways)
    reasons = {name: reason for name, (_, reason) in inferred.items() if name not in overrides.attributes}
    notes = (
        *_common_bound_notes(lanelets),
        *_inference_notes(lanes, attributes, reasons),
        *_override_notes(overrides),
    )
    return Network(lanelets, attributes, zones, lanes, _beside(lanelets, lanes), main, notes)


def _read_zones_file(path: Path, lanelets: Mapping[str, MeasuredLanelet]) -> LaneletAttributes:
    """Return the content of a file NAME_zones.toml, empty where there is no file.

    It has ``[[lanelet]]`` with ``id`` and ``zone``, ``attribute`` or both. Raises ``InputError``.
    """
    if not path.is_file():
        return LaneletAttributes()
    content = read_toml(path)
    entries = content.get("lanelet")
    if set(content) != {"lanelet"} or not isinstance(entries, list) or not entries:
        raise InputError(f"{path}: write [[lanelet]] with id and zone, attribute or both; nothing else")
    attributes: dict[str, Attribute] = {}
    zones: dict[str, Zone] = {}
    for k, entry in enumerate(entries, start=1):
        where = f"{path}, lanelet {k}"
        if not isinstance(entry, dict) or not {"id"} < set(entry) <= {"id", "zone", "attribute"}:
            raise InputError(f"{where}: an entry has id and zone, attribute or both")
        number, zone, attribute = map(entry.get, ("id", "zone", "attribute"))
        name = str(number)
        if name not in lanelets:
            raise InputError(f"{where}: id={name}: there is no such lanelet")
        if name in attributes or name in zones:
            raise InputError(f"{where}: id={name}: this lanelet has an entry already")
        if "zone" in entry:
            require_one_of(where, "zone", zone, get_args(Zone))
            zones[name] = cast(Zone, zone)
        if "attribute" in entry:
            require_one_of(where, "attribute", attribute, get_args(Attribute))
            attributes[name] = cast(Attribute, attribute)
    return LaneletAttributes(attributes, zones)


def _common_bound_notes(lanelets: Mapping[str, MeasuredLanelet]) -> Iterator[str]:
    """A note on neighbours that are known by a common bound alone."""
    pairs = dict.fromkeys(frozenset((x.id, other)) for x in lanelets.values() for other in x.by_bound)
    if pairs:
        named = ", ".join(" and ".join(sorted(pair)) for pair in [*pairs][:6])
        more = ", …" if len(pairs) > 6 else ""
        yield f"lanelets {named}{more} lie side by side by a common bound; the file does not say so"


def _inference_notes(
    lanes: Iterable[MeasuredLane], attributes: Mapping[str, Attribute], reasons: Mapping[str, str]
) -> Iterator[str]:
    for lane in lanes:
        why = {reasons.get(name, "") for name in lane.lanelets} - {""}
        if why:
            named = ", ".join(lane.lanelets)
            noun = "lanelet" if len(lane.lanelets) == 1 else "lanelets"
            kind = attributes[lane.name]
            yield f"{kind} lane {lane.name} ({noun} {named}) inferred, since it {' and '.join(sorted(why))}"


def _override_notes(overrides: LaneletAttributes) -> Iterator[str]:
    for name in dict.fromkeys((*overrides.attributes, *overrides.zones)):
        parts = [f"attribute {overrides.attributes[name]}"] if name in overrides.attributes else []
        parts += [f"zone {overrides.zones[name]}"] if name in overrides.zones else []
        yield f"lanelet {name}: {' and '.join(parts)}, as said in its {ZONES_ENDING.lstrip('_')}"


def _lanes(
    lanelets: Mapping[str, MeasuredLanelet],
    attributes: Mapping[str, Attribute],
    ways: tuple[tuple[str, ...], ...],
) -> tuple[MeasuredLane, ...]:
    """The lanes, each named after its first lanelet, in the order of the file."""
    along = closure(
        lanelets,
        (
            (x.id, other)
            for x in lanelets.values()
            for other in x.successors
            if attributes[x.id] == attributes[other]
        ),
    )
    number = {name: k for k, way in enumerate(ways, start=1) for name in way}
    lanes = []
    for members in dict.fromkeys(along.values()):
        ordered = _in_order(lanelets, members)
        lanes.append(MeasuredLane(ordered[0], ordered, number[ordered[0]]))
    return tuple(lanes)


def _beside(
    lanelets: Mapping[str, MeasuredLanelet], lanes: Iterable[MeasuredLane]
) -> frozenset[frozenset[str]]:
    lane_of = {x: lane.name for lane in lanes for x in lane.lanelets}
    touching = ((lane_of[x.id], lane_of[other]) for x in lanelets.values() for other in x.beside)
    return frozenset(frozenset(pair) for pair in touching if pair[0] != pair[1])


def zones_of(lanelets: Mapping[str, MeasuredLanelet], attributes: Mapping[str, Attribute]) -> dict[str, Zone]:
    """Zones by the attributes of the lanelets across the road."""
    return zones_beside(attributes, ((x.id, other) for x in lanelets.values() for other in x.beside))


def zones_beside(attributes: Mapping[str, Attribute], beside: Iterable[tuple[str, str]]) -> dict[str, Zone]:
    """The zone of each lanelet, from the attributes of those that are side by side with it, one by one."""
    across = closure(attributes, beside)
    zones: dict[str, Zone] = {}
    for name, section in across.items():
        present = {attributes[x] for x in section}
        zones[name] = "merge" if "merge" in present else "depart" if "departure" in present else "main"
    return zones


def _in_order(lanelets: Mapping[str, MeasuredLanelet], members: tuple[str, ...]) -> tuple[str, ...]:
    """Return lanelets from the one without a predecessor on; in file order where a lane is a ring or
    branches.
    """
    followers = {other for name in members for other in lanelets[name].successors}
    current = next((name for name in members if name not in followers), members[0])
    ordered = [current]
    while True:
        following = (x for x in lanelets[current].successors if x in members and x not in ordered)
        next_lanelet = next(following, None)
        if next_lanelet is None:
            break
        ordered.append(next_lanelet)
        current = next_lanelet
    return (*ordered, *(name for name in members if name not in ordered))
