"""Roads of maps: what a file has to offer, and a stretch of it."""

from collections.abc import Iterable
from pathlib import Path

from roadproof.errors import UsageError
from roadproof.evidence.codec import write
from roadproof.evidence.drive_file import road_said
from roadproof.evidence.strict import JsonObject
from roadproof.extensions.maps import answer as kept
from roadproof.extensions.maps.opendrive import read_map
from roadproof.extensions.maps.overview import MapStretch, describe, stretches_of
from roadproof.extensions.maps.picture import draw_stretches
from roadproof.extensions.maps.selection import LANELETS, read_selection
from roadproof.extensions.maps.stretch import select
from roadproof.runtime.files import write_whole
from roadproof.runtime.version import VERSION
from roadproof.world.models import load_road
from roadproof.world.road import Road
from roadproof.world.unread import unread_note

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
        found: tuple[MapStretch, ...] = (describe(str(map_file), "", "", select(path, selection)),)
    else:
        found = all_stretches(path)
    left_out_of(map_file, found, strict)
    if out is not None:
        kind = Path(out).suffix
        if kind not in PICTURES:
            raise UsageError(f"out={out}: name a file that ends in {' or '.join(PICTURES)}")
        write_whole(Path(out), draw_stretches(path.name, found)[kind[1:]])
    return found


def left_out_of(map_file: str | Path, found: Iterable[MapStretch], strict: bool = False) -> tuple[str, ...]:
    """The note on parts of the map that were left out; if ``strict``, there may be none.

    Raises ``InputError``.
    """
    parts = dict.fromkeys(part for stretch in found for part in stretch.unread)
    return unread_note(Path(str(map_file).partition("#")[0]), parts, strict)


def as_data(map_file: str | Path, found: tuple[MapStretch, ...]) -> JsonObject:
    """The stretches of a map as plain data."""
    said, left_out = tuple(map(_said, found)), left_out_of(map_file, found)
    return write(kept.Answer(roadproof=VERSION, map=str(map_file), stretches=said, left_out=left_out))


def _said(stretch: MapStretch) -> kept.Stretch:
    spans = tuple(kept.Span(zone=x.zone, begin=float(x.begin), end=float(x.end)) for x in stretch.zones)
    lanelets = road_said(Road("", stretch.lanelets, frozenset())).lanelets
    return kept.Stretch(
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
    """What can be selected of the map of a file. Raises ``InputError``."""
    if path.suffix not in LANELETS:
        return stretches_of(path, read_map(path))
    from roadproof.extensions.maps.lanelet_overview import ways_of

    return ways_of(path)
