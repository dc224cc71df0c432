"""Recordings as NGSIM's files have them: in feet, from the left edge of the section, with Lane_ID."""

from collections.abc import Callable
from pathlib import Path

import numpy as np

from roadproof.extensions.traffic.formats.recording import Recording

HEADER = (
    "Vehicle_ID,Frame_ID,Total_Frames,Global_Time,Local_X,Local_Y,Global_X,Global_Y,v_Length,v_Width,v_Class,"
    "v_Vel,v_Acc,Lane_ID,Preceding,Following,Space_Headway,Time_Headway"
)
LANE = 3.5
"""m; the right edge of the last lane through the section is d = 0, as on the reference roads."""
CLASSES = {"Motorcycle": 1, "Car": 2, "Truck": 3}
PLACES = {"us-101": (6451137.6, 1873345.0), "i-80": (6042814.3, 2133542.0)}
THROUGH = {"us-101": 5, "i-80": 6}
ZERO = 1_118_846_979_700
"""Global_Time of frame 0, in ms."""


def lane_through(count: int) -> Callable[[float, float], int]:
    """Lane_ID by s and d, 1 for the leftmost of so many lanes."""
    return lambda s, d: count - int(min(max(d, 0.0), count * LANE - 1e-9) // LANE)


def lane_of_ramps(s: float, d: float) -> int:
    """On US-101: right of the lanes 7 up to 300 m, 6 up to 600 m, 8 from there."""
    if d > 0:
        return lane_through(5)(s, d)
    return 7 if s < 300 else 6 if s < 600 else 8


def ngsim_text(
    recording: Recording,
    lane_of: Callable[[float, float], int] = lane_of_ramps,
    place: str = "us-101",
    zero: int = ZERO,
) -> str:
    """The file of a place and time; d is measured as on the reference roads."""
    edge, lines = THROUGH[place] * LANE, [HEADER]
    for v, row in enumerate(recording.start[:-1].tolist()):
        count = int(recording.start[v + 1]) - row
        length, width = float(recording.length[v]), float(recording.width[v])
        for k in range(count):
            s, d, v_lon, a_lon = (float(getattr(recording, x)[row + k]) for x in ("s", "d", "v_lon", "a_lon"))
            frame, middle = int(recording.first_frame[v]) + k, d - width / 2
            cells = [recording.vehicle_id[v], frame, count, zero + 100 * frame]
            cells += [*np.round(feet(edge - middle, s), 5), *PLACES[place], *np.round(feet(length, width), 5)]
            cells += [CLASSES[str(recording.kind[v])], *np.round(feet(v_lon, a_lon), 5)]
            lines.append(",".join(map(str, [*cells, lane_of(s, middle), 0, 0, 0, 0])))
    return "\n".join(lines) + "\n"


def feet(*metres: float) -> list[float]:
    return [x / 0.3048 for x in metres]


def write_ngsim(folder: Path, text: str, name: str = "trajectories-0750am-0805am") -> Path:
    path = folder / f"{name}.csv"
    path.write_text(text)
    return path


def together(parts: dict[str, list[str]]) -> str:
    """The file of data.gov: texts by place, with a column Location and zones that freeways do not have."""
    lines = [HEADER.replace("v_Length", "v_length").replace(",Preceding", ",O_Zone,Preceding") + ",Location"]
    for place, texts in parts.items():
        for text in texts:
            for line in text.splitlines()[1:]:
                cells = line.split(",")
                lines.append(",".join([*cells[:14], "", *cells[14:], place]))
    return "\n".join(lines) + "\n"
