"""Vehicles whose way the reference line of their road does not follow: nothing is claimed of them.

Lengths along a line through a crossing, or far from it in a bend, are not those in the plane.
"""

from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from roadproof.errors import InputError
from roadproof.extensions.traffic.formats.plausible import SHARE
from roadproof.extensions.traffic.formats.recording import Bools, Floats, Recording, keep_vehicles, with_notes
from roadproof.extensions.traffic.formats.reliable import MOST_LEFT_OUT, first_names, left_out_note
from roadproof.reasons import ReasonKind

MOST_STRETCHED = 0.05
"""Above this share by which steps along the line are too long or short in the mean, a vehicle is left out."""
LEAST_WAY = 2.0
"""m: a shorter way says nothing of the line."""


def follows_line(centre: Floats, recording: Recording) -> Bools:
    """Return for each vehicle whether it heads along the line, with steps as long along it as in the plane.

    ``centre``: centres of the boxes in the plane (n, 2), a row for each of ``recording``. Each step counts:
    one that is too long does not make up for one that is too short.
    """
    fits = np.ones(recording.vehicles, np.bool_)
    slack = recording.slack
    away = np.zeros(len(recording.s), np.bool_) if slack is None else ~np.isfinite(slack.along)
    for v, (begin, end) in enumerate(pairwise(recording.start.tolist())):
        plane = np.hypot(*np.diff(centre[begin:end], axis=0).T)
        line = np.hypot(np.diff(recording.s[begin:end]), np.diff(recording.d[begin:end]))
        way = float(plane.sum())
        if way > LEAST_WAY:
            stretched = float(np.abs(line - plane).sum())
            turned = int(np.count_nonzero(away[begin:end]))
            fits[v] = stretched <= MOST_STRETCHED * way and turned <= SHARE * (end - begin)
    return fits


def leave_out_strays(recording: Recording, fits: Bools, strict: bool) -> Recording:
    """The recording of the vehicles that the line ``fits``, with a note that names the others.

    Raises ``InputError`` where more than half would be left out; if ``strict``, where one would.
    """
    ids = [int(x) for x in recording.vehicle_id[~fits]]
    if not ids:
        return recording
    if strict or len(ids) > MOST_LEFT_OUT * recording.vehicles:
        off = _off_text(ids, recording.vehicles)
        raise InputError(f"{recording.name}: {off}; evaluate a part of one road without crossings")
    note = left_out_note(ids, recording.vehicles, ReasonKind.OFF_LINE())
    return with_notes(keep_vehicles(recording, fits), [note])


def _off_text(ids: Sequence[int], of: int) -> str:
    return (
        f"the reference line of the road does not follow the way of {len(ids)} of {of} vehicles "
        f"({first_names(ids)}): lengths differ by more than {100 * MOST_STRETCHED:g} %, or they head more "
        "than 45 degrees away from it"
    )
