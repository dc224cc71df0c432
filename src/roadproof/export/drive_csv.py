"""A drive as CSV: one row a sample and vehicle, decimals in SI units."""

import csv
import io
from fractions import Fraction

from roadproof.evidence.drive_file import DriveFile
from roadproof.signals import RECORDED, SIZES
from roadproof.world.motion import state_at

HEADER = ("time", "vehicle", *RECORDED, *SIZES)


def csv_of(file: DriveFile, dt: Fraction = Fraction(1, 25)) -> str:
    """The drive of a drive file (``roadproof/drive/1``) sampled every ``dt`` seconds up to its horizon."""
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(HEADER)
    for k in range(int(file.horizon / dt) + 1):
        for name, motion in file.drive.vehicles.items():
            state = state_at(motion, k * dt)
            signals = [getattr(state, signal) for signal in RECORDED]
            sizes = [getattr(motion, size) for size in SIZES]
            writer.writerow([f"{float(k * dt):.3f}", name, *(f"{float(x):.6g}" for x in (*signals, *sizes))])
    return out.getvalue()
