"""A highD recording small enough to check by hand, as text that tests may spoil."""

from pathlib import Path

from roadproof.extensions.traffic.formats.highd_columns import (
    RECORDING_COLUMNS,
    SAMPLE_COLUMNS,
    VEHICLE_COLUMNS,
)

Files = dict[str, list[list[str]]]
"""Rows of cells by file name, header first."""

LAYOUTS = {
    "2+2": ("8.51;12.59;16.43", "21.00;24.96;28.80"),
    "3+2": ("4.40;8.51;12.59;16.43", "21.00;24.96;28.80"),
}


def tiny_files(layout: str = "2+2") -> Files:
    """Three vehicles: 1 drives up (towards -x), 2 and 3 down (towards +x); 3 is a truck that drifts right."""
    upper, lower = LAYOUTS[layout]
    first = 2 if layout == "2+2" else 3  # laneId of the band that holds vehicle 1
    below = len(upper.split(";")) + 2
    recording = f"1,25,2,-1.00,9.2017,Tue,08:38,0.16,14.5,0.4,3,2,1,{upper},{lower}"
    vehicles = [
        "1,4.50,1.80,1,4,4,Car,1,3.90,-32.60,-32.50,-32.55,-1,-1,-1,0",
        "2,4.00,2.00,2,4,3,Car,2,2.40,30.00,30.00,30.00,-1,-1,-1,0",
        "3,12.00,2.50,1,3,3,Truck,2,1.60,20.00,20.00,20.00,-1,-1,-1,1",
    ]
    rest = "0,0,0,0,0,0,0,0,0,0,0,0,0,0"
    samples = [
        f"1,1,300.00,9.51,4.50,1.80,-32.50,0.10,-1.00,0.20,{rest},{first}",
        f"2,1,298.70,9.51,4.50,1.80,-32.53,0.10,-1.00,0.20,{rest},{first}",
        f"3,1,297.40,9.52,4.50,1.80,-32.57,0.10,-1.00,0.20,{rest},{first}",
        f"4,1,296.10,9.52,4.50,1.80,-32.60,0.10,-1.00,0.20,{rest},{first}",
        f"2,2,10.00,26.00,4.00,2.00,30.00,-0.25,0.50,-0.75,{rest},{below + 1}",
        f"3,2,11.20,25.99,4.00,2.00,30.00,-0.25,0.50,-0.75,{rest},{below + 1}",
        f"4,2,12.40,25.98,4.00,2.00,30.00,-0.25,0.50,-0.75,{rest},{below + 1}",
        f"1,3,50.00,22.46,12.00,2.50,20.00,1.00,0.00,0.00,{rest},{below}",
        f"2,3,50.80,22.50,12.00,2.50,20.00,1.00,0.00,0.00,{rest},{below}",
        f"3,3,51.60,22.54,12.00,2.50,20.00,1.00,0.00,0.00,{rest},{below}",
    ]
    return {
        "01_recordingMeta.csv": [list(RECORDING_COLUMNS), recording.split(",")],
        "01_tracksMeta.csv": [list(VEHICLE_COLUMNS), *(row.split(",") for row in vehicles)],
        "01_tracks.csv": [list(SAMPLE_COLUMNS), *(row.split(",") for row in samples)],
    }


def write_files(files: Files, folder: Path) -> Path:
    """Write the rows as the files of one recording; returns ``folder``."""
    folder.mkdir(parents=True, exist_ok=True)
    for name, rows in files.items():
        (folder / name).write_text("".join(",".join(row) + "\n" for row in rows))
    return folder
