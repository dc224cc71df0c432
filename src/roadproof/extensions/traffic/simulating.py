"""Traffic that is simulated in the shape of recordings."""

from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Unpack

from roadproof.errors import UsageError
from roadproof.extensions.traffic.formats.table import Frame, frame_of
from roadproof.extensions.traffic.formats.write_highd import write_highd
from roadproof.extensions.traffic.keywords import SimulateKeywords
from roadproof.extensions.traffic.settings import Simulate
from roadproof.extensions.traffic.simulate.simulate import markings_of
from roadproof.extensions.traffic.simulate.simulate import simulate as simulate_one
from roadproof.extensions.traffic.simulate.traffic import Traffic, road_of
from roadproof.frontends.report.samples import road_toml
from roadproof.frontends.report.sheet import csv_text
from roadproof.frontends.settings.option import takes
from roadproof.runtime import pool
from roadproof.runtime.files import write_whole
from roadproof.runtime.records import dataclass

if TYPE_CHECKING:
    from roadproof.evidence.drive_file import DriveFile
    from roadproof.extensions.traffic.simulate.planting import Truth


@dataclass(frozen=True)
class Simulation:
    """Recordings that were written to ``folder``; ``planted``: which drive was woven in where.

    ``left_out``: drives that could not be planted, and why.
    """

    folder: Path
    recordings: int
    planted: "tuple[Truth, ...]" = ()
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
    given = Simulate.of(options)
    drives: tuple[DriveFile, ...] = tuple(vars(x).get("file", x) for x in given.plant)
    traffic = Traffic(
        seconds=given.seconds,
        lanes=given.lanes,
        flow=given.flow,
        truck_share=given.truck_share,
        section=given.section,
        ramp=given.ramp,
        ramp_flow=given.ramp_flow,
    )
    if given.seed < 0:
        raise UsageError(f"seed={given.seed}: a seed is 0 or more")
    if not 1 <= given.recordings <= 999:
        raise UsageError(f"recordings={given.recordings}: write 1 to 999")
    if drives and given.ramp != "none":
        raise UsageError(f"ramp={given.ramp}: drives are planted on main roads only; omit ramp or plant")
    if drives:
        from roadproof.extensions.traffic.simulate.planting import lane_width  # loads the judge

        traffic = replace(traffic, lane_width=lane_width(drives))
    folder = Path(out)
    make = partial(_make_one, folder, traffic, given.seed, drives)
    numbers = range(1, given.recordings + 1)
    done = pool.in_order(pool.work(make, numbers, given.jobs, None, None, "recordings", fresh=True))
    truths: list[Truth] = []
    left_out: dict[str, None] = {}
    for number, (made, missing) in enumerate(done, 1):
        if given.tell is not None:
            given.tell(f"[{number}/{given.recordings}] recording {number:02d}")
        truths += made
        left_out |= dict.fromkeys(missing)
    if drives:
        from roadproof.extensions.traffic.simulate.planting import PLANTED_COLUMNS, rows_of

        table = csv_text(PLANTED_COLUMNS, rows_of(truths))
        write_whole(folder / "planted.csv", table.encode())
    return Simulation(folder, given.recordings, tuple(truths), tuple(left_out))


def _make_one(
    out: Path, traffic: Traffic, seed: int, drives: "tuple[DriveFile, ...]", number: int
) -> "tuple[list[Truth], list[str]]":
    """Simulate, plant and write one recording; what was planted, and what could not be."""
    recording = simulate_one(traffic, seed, number)
    truths: list[Truth] = []
    left_out: list[str] = []
    if drives:
        from roadproof.extensions.traffic.simulate.planting import plant_drives
        from roadproof.library.loading import bundled_library

        recording, truths, left_out = plant_drives(recording, drives, bundled_library())
    write_highd(recording, out)
    if traffic.ramp != "none":
        road = road_of(traffic, markings_of(traffic)[1])
        write_whole(out / f"{recording.name}_road.toml", road_toml(road).encode())
    return truths, left_out
