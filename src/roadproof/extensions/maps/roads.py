"""Roads of maps: what a file has to offer, and a stretch of it."""

from collections.abc import Iterable
from pathlib import Path

from roadproof.errors import UsageError
from roadproof.evidence.codec import write
from roadproof.evidence.drive_file import road_data
from roadproof.evidence.strict import JsonObject
from roadproof.extensions.maps import answer as map_data
from roadproof.extensions.maps.opendrive import read_map
from roadproof.extensions.maps.overview import MapStretch, describe, stretches_of
from roadproof.extensions.maps.picture import draw_stretches
from roadproof.extensions.maps.selection import LANELETS, read_selection
from roadproof.extensions.maps.stretch import select
from roadproof.runtime.files import write_atomic
from roadproof.runtime.version import VERSION
from roadproof.world.models import load_road
from roadproof.world.not_read import not_read_note
from roadproof.world.road import Road

PICTURES = (".svg", ".png")


def road(name_or_path: str | Path) -> Road:
    """A shipped road by name, or one from a file: TOML, or a map such as ``map.xodr#road=12,from=300``.

    Raises ``InputError``, ``UsageError``.
    """
    return load_road(name_or_path)


def stretches(
    map_file: str | Path, out: str | Path | None = None, strict: bool = False
) -> tuple[MapStretch, ...]:
    """The roads of a map in each direction, or the one stretch that is selected after ``#``.

    ``out``: a picture of them, .svg or .png; ``strict``: no part of the map may be left out. Raises
    ``InputError``, ``UsageError``; ``MissingSolverError`` for a picture without matplotlib.
    """
    path, selection = read_selection(str(map_file))
    if "#" in str(map_file):
        map_stretches: tuple[MapStretch, ...] = (describe(str(map_file), "", "", select(path, selection)),)
    else:
        map_stretches = all_stretches(path)
    omission_notes(map_file, map_stretches, strict)
    if out is not None:
        kind = Path(out).suffix
        if kind not in PICTURES:
            raise UsageError(f"out={out}: name a file that ends in {' or '.join(PICTURES)}")
        write_atomic(Path(out), draw_stretches(path.name, map_stretches)[kind[1:]])
    return map_stretches


def omission_notes(
    map_file: str | Path, map_stretches: Iterable[MapStretch], strict: bool = False
) -> tuple[str, ...]:
    """The note on parts of the map that were left out; if ``strict``, there may be none.

    Raises ``InputError``.
    """
    parts = dict.fromkeys(part for stretch in map_stretches for part in stretch.unread)
    return not_read_note(Path(str(map_file).partition("#")[0]), parts, strict)


def as_data(map_file: str | Path, map_stretches: tuple[MapStretch, ...]) -> JsonObject:
    """The stretches of a map as plain data."""
    data, left_out = tuple(map(_stretch_data, map_stretches)), omission_notes(map_file, map_stretches)
    return write(map_data.MapData(roadproof=VERSION, map=str(map_file), stretches=data, left_out=left_out))


def _stretch_data(stretch: MapStretch) -> map_data.StretchData:
    spans = tuple(
        map_data.ZoneSpanData(zone=x.zone, begin=float(x.begin), end=float(x.end)) for x in stretch.zones
    )
    lanelets = road_data(Road("", stretch.lanelets, frozenset())).lanelets
    return map_data.StretchData(
        select=stretch.select,
        name=stretch.name,
        length=float(stretch.length),
        direction=stretch.direction,
        lanes=stretch.lanes,
        zones=spans,
        radius=None if stretch.radius is None else float(stretch.radius),
        width_error=float(stretch.width_error),
        length_share=float(stretch.length_error.share),
        length_metres=float(stretch.length_error.metres),
        lanelets=lanelets,
        refused=stretch.refused or None,
    )


def all_stretches(path: Path) -> tuple[MapStretch, ...]:
    """Return the stretches of a file's map that can be selected. Raises ``InputError``."""
    if path.suffix not in LANELETS:
        return stretches_of(path, read_map(path))
    from roadproof.extensions.maps.lanelet_overview import ways_of

    return ways_of(path)
