"""The map that the road of a drive is from, which exports in its format have in place of a road of theirs."""

from pathlib import Path

from roadproof.errors import InputError
from roadproof.extensions.exchange.export.subject import ExportSubject
from roadproof.world.models import load_road
from roadproof.world.road import Road


def map_path(road: Road, ending: str) -> Path | None:
    """The map with this ending that a road is from, None where there is none."""
    path = Path((road.map or "").partition("#")[0])
    return path if path.suffix == ending else None


def checked_map(subject: ExportSubject, ending: str) -> Path | None:
    """Return the map of a drive.

    Raises ``InputError`` where the map cannot be read, or does not have the road of the drive.
    """
    road = subject.file.road
    path = map_path(road, ending)
    if path is not None and load_road(str(road.map)) != road:
        raise InputError(
            f"{road.map}: the map has another road than drive {subject.name}; find the drive again"
        )
    return path
