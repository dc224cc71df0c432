"""What is known of the roads of recordings before anything is asked: lanes, lanelets, zones, and why."""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from roadproof.recordings.formats.recording import Recording
from roadproof.recordings.formats.sources import find_sources


@dataclass(frozen=True)
class RecordedRoad:
    """The lanes of a recording; for each its name, direction and lanelets, each with id, attribute and zone.

    ``notes``: what was inferred, and all that is odd in the recording.
    """

    recording: str
    format: str
    rate: int
    vehicles: int
    lanes: tuple[tuple[str, int, tuple[tuple[str, str, str], ...]], ...]
    notes: tuple[str, ...]

    def __str__(self) -> str:
        head = f"{self.recording}: {self.format}, {self.rate} Hz, {self.vehicles} vehicles"
        return "\n".join([head, *self._lanes(), *(f"  note: {note}" for note in self.notes)])

    def _lanes(self) -> Iterator[str]:
        for name, direction, lanelets in self.lanes:
            attributes = " and ".join(dict.fromkeys(attribute for _, attribute, _ in lanelets))
            parts = ", ".join(f"{lanelet} in zone {zone}" for lanelet, _, zone in lanelets)
            yield f"  {attributes} lane {name}, direction {direction}: {parts}"


def roads(path: str | Path) -> tuple[RecordedRoad, ...]:
    """The roads of the recordings of ``path``, each read and checked as a whole. Raises ``InputError``."""
    return tuple(_road(source.format.name, source.read()) for source in find_sources(Path(path)))


def _road(format_name: str, recording: Recording) -> RecordedRoad:
    lanes = []
    for lane in recording.lanes:
        ours = tuple((x.id, str(x.attribute), str(x.zone)) for x in recording.lanelets if x.lane == lane.name)
        lanes.append((lane.name, lane.direction, ours or ((lane.name, "main", "main"),)))
    return RecordedRoad(
        recording.name, format_name, recording.rate, recording.vehicles, tuple(lanes), recording.notes
    )
