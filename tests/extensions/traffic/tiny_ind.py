"""Recordings in inD's format: those of exiD without lanelets, and road users that are no vehicles."""

from pathlib import Path

from extensions.traffic.planar import Bend, straight
from extensions.traffic.planar_exid import SAMPLES, write_exid
from roadproof.extensions.traffic.formats.recording import Recording
from roadproof.world.road import Road

COLUMNS = SAMPLES.partition(",traveledDistance")[0]


def write_ind(
    recording: Recording, road: Road, folder: Path, bend: Bend = straight, map_text: str = ""
) -> Path:
    """The files of recording 07 and ``maps/location3.osm``; the path of the samples."""
    path = write_exid(recording, road, folder, bend, map_text)
    rows = [line.split(",")[: len(COLUMNS.split(","))] for line in path.read_text().splitlines()]
    path.write_text("".join(",".join(row) + "\n" for row in rows))
    return path


def add_track(
    folder: Path, number: int, kind: str, size: tuple[float, float], rows: list[list[float]]
) -> None:
    """A track of (length, width): rows have x, y, heading (degrees), and velocities in x and y."""
    length, width = size
    with (folder / "07_tracksMeta.csv").open("a") as meta:
        meta.write(f"7,{number},0,{len(rows) - 1},{len(rows)},{width},{length},{kind}\n")
    with (folder / "07_tracks.csv").open("a") as tracks:
        for k, (x, y, heading, vx, vy) in enumerate(rows):
            speed = (vx**2 + vy**2) ** 0.5
            cells = [7, number, k, k, x, y, heading, width, length, vx, vy, 0, 0, speed, 0, 0, 0]
            tracks.write(",".join(map(str, cells)) + "\n")
