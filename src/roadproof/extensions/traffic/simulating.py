"""Traffic that is simulated in the shape of recordings."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Unpack

from roadproof.errors import UsageError
from roadproof.extensions.traffic.formats.table import Frame, frame_of
from roadproof.extensions.traffic.formats.write_highd import write_highd
from roadproof.extensions.traffic.settings import Simulate
from roadproof.extensions.traffic.simulate.simulate import markings_of
from roadproof.extensions.traffic.simulate.simulate import simulate as simulate_one
from roadproof.extensions.traffic.simulate.traffic import TrafficSettings
from roadproof.frontends.settings.option import takes
from roadproof.runtime import pool
from roadproof.runtime.files import write_atomic
from roadproof.runtime.records import dataclass

if TYPE_CHECKING:
    from roadproof.evidence.drive_file import DriveFile
    from roadproof.extensions.traffic.keywords import SimulateKeywords
    from roadproof.extensions.traffic.simulate.planting import PlantedRow


@dataclass(frozen=True)
class Simulation:
    """Recordings that were written to ``folder``; ``planted``: which drive was woven in where.

    ``left_out``: drives that could not be planted, and why.
    """

    folder: Path
    recordings: int
    planted: tuple[PlantedRow, ...] = ()
    left_out: tuple[str, ...] = ()

    def to_frame(self) -> Frame:
        """A row for each planted drive, as in planted.csv."""
        from roadproof.extensions.traffic.simulate.planting import PLANTED_COLUMNS, rows_of

        rows = rows_of(self.planted)
        return frame_of([dict(zip(PLANTED_COLUMNS, row, strict=True)) for row in rows])


@takes(Simulate)
def simulate(out: str | Path, **options: Unpack[SimulateKeywords]) -> Simulation:
    """Write simulated traffic in highD's format; the same numbers give the same files.

    ``lanes`` each way, ``flow`` in vehicles an hour and way, ``section`` in m. ``ramp``: the lower
    carriageway has an on-ramp ("merge") or an off-ramp ("depart") of ``ramp_flow`` vehicles an hour, which
    XX_road.toml describes. ``plant``: drives that are woven in where there is no ramp (``witness`` finds
    some). Raises ``InputError``, ``UsageError``.
    """
    settings = Simulate.of(options)
    drives: tuple[DriveFile, ...] = tuple(vars(x).get("file", x) for x in settings.plant)
    traffic = TrafficSettings(
        seconds=settings.seconds,
        lanes=settings.lanes,
        flow=settings.flow,
        truck_share=settings.truck_share,
        section=settings.section,
        ramp=settings.ramp,
        ramp_flow=settings.ramp_flow,
    )
    if settings.seed < 0:
        raise UsageError(f"seed={settings.seed}: a seed is 0 or more")
    if not 1 <= settings.recordings <= 999:
        raise UsageError(f"recordings={settings.recordings}: write 1 to 999")
    if drives and settings.ramp != "none":
        raise UsageError(f"ramp={settings.ramp}: drives are planted on main roads only; omit ramp or plant")
    if drives:
        from roadproof.extensions.traffic.simulate.planting import lane_width  # loads the judge

        traffic = replace(traffic, lane_width=lane_width(drives))
    folder = Path(out)
    make = partial(_make_one, folder, traffic, settings.seed, drives)
    numbers = range(1, settings.recordings + 1)
    done = pool.in_order(pool.work(make, numbers, settings.jobs, None, None, "recordings", fresh=True))
    truths: list[PlantedRow] = []
    left_out: dict[str, None] = {}
    for number, (made, missing) in enumerate(done, 1):
        if settings.tell is not None:
            settings.tell(f"[{number}/{settings.recordings}] recording {number:02d}")
        truths += made
        left_out |= dict.fromkeys(missing)
    if drives:
        from roadproof.extensions.traffic.simulate.planting import PLANTED_COLUMNS, rows_of
        from roadproof.frontends.report.csv_table import csv_text

        table = csv_text(PLANTED_COLUMNS, rows_of(truths))
        write_atomic(folder / "planted.csv", table.encode())
    return Simulation(folder, settings.recordings, tuple(truths), tuple(left_out))


def _make_one(
    out: Path, traffic: TrafficSettings, seed: int, drives: tuple[DriveFile, ...], number: int
) -> tuple[list[PlantedRow], list[str]]:
    """Simulate, plant and write one recording; what was planted, and what could not be."""
    recording = simulate_one(traffic, seed, number)
    truths: list[PlantedRow] = []
    left_out: list[str] = []
    if drives:
        from roadproof.extensions.traffic.simulate.planting import plant_drives
        from roadproof.library.loading import bundled_library

        recording, truths, left_out = plant_drives(recording, drives, bundled_library())
    write_highd(recording, out)
    if traffic.ramp != "none":
        from roadproof.extensions.traffic.road_file import road_toml
        from roadproof.extensions.traffic.simulate.ramp_road import road_of

        road = road_of(traffic, markings_of(traffic)[1])
        write_atomic(out / f"{recording.name}_road.toml", road_toml(road).encode())
    return truths, left_out
