"""Drives in simulated traffic: only what the samples confirm is called planted, and why others are not."""

from dataclasses import replace
from fractions import Fraction as F

import pytest

from roadproof.errors import UsageError
from roadproof.evidence.drive_file import DriveFile
from roadproof.library.loading import bundled_library
from roadproof.recordings.formats.recording import Recording
from roadproof.recordings.simulate.planting import (
    PLANTED_COLUMNS,
    lane_width,
    plant_drives,
    plantable,
    rows_of,
)
from roadproof.recordings.simulate.synthetic import simulate
from roadproof.recordings.simulate.traffic import Traffic
from roadproof.world.drive import Drive
from roadproof.world.road import Lanelet, Road, pairs
from traffic.drives import braking, cut_in, cut_out, motion

ROAD = Road(
    "two lanes",
    tuple(
        Lanelet(f"m{k}", f"main-{k}", "main", "main", (None, None), (F(7 * (k - 1), 2), F(7 * k, 2)))
        for k in (1, 2)
    ),
    pairs([("main-1", "main-2")]),
)


def drive_file(drive: Drive, scenario: int, lane: str = "main-1") -> DriveFile:
    names = ", ".join(sorted(drive.vehicles, key=lambda name: (name != "SV", name)))
    claim = f"scenario_{scenario}({names}, L)"
    return DriveFile(scenario, "base", claim, F(6), {"L": lane}, {"minDanger": F(3, 5)}, {}, ROAD, drive)


@pytest.fixture(scope="module")
def recording() -> Recording:
    return simulate(Traffic(seconds=22, lane_width=3.5, lanes=2), seed=8)


@pytest.mark.parametrize(("drive", "scenario"), [(cut_in(), 1), (braking(), 4), (cut_out(), 2)])
def test_both_directions_get_a_drive(recording: Recording, drive: Drive, scenario: int) -> None:
    merged, truths, left_out = plant_drives(recording, [drive_file(drive, scenario)], bundled_library())
    assert left_out == []
    ways = {int(merged.direction[merged.vehicle_id == x.sv][0]) for x in truths}
    assert ways == {1, 2}
    for truth in truths:
        assert (truth.scenario, truth.set_name, truth.min_danger) == (scenario, "base", F(3, 5))
        assert (truth.pov2 is not None) == (scenario == 2)
        first = merged.first_frame[merged.vehicle_id == truth.sv][0]
        assert truth.start_frame == first < truth.end_frame
        roles = {"SV": truth.sv, "POV": truth.pov, "POV1": truth.pov, "POV2": truth.pov2}
        row = {name: merged.start[:-1][merged.vehicle_id == roles[name]] for name in drive.vehicles}
        from_behind = sorted(drive.vehicles, key=lambda name: drive.vehicles[name].s)
        assert from_behind == sorted(drive.vehicles, key=lambda name: merged.s[row[name]][0])
    row = next(rows_of(truths))
    assert len(row) == len(PLANTED_COLUMNS)
    assert row[7:10] == ["0.6", "base", scenario]
    assert row[10].endswith("lane keep")


@pytest.mark.parametrize(
    ("file", "reason"),
    [
        (drive_file(cut_in(), 4), "before the scenario is complete"),  # it is no deceleration
        (drive_file(braking(), 4, "main-2"), "is not the one that an evaluation takes"),
        (
            drive_file(Drive({"SV": motion(5, F(13, 5), 25), "POV": motion(150, F(13, 5), 25)}), 4),
            "no danger",
        ),
    ],
)
def test_what_samples_do_not_confirm_is_not_planted(
    recording: Recording, file: DriveFile, reason: str
) -> None:
    merged, truths, left_out = plant_drives(recording, [file], bundled_library())
    assert merged is recording
    assert truths == []
    assert len(left_out) == 1
    assert reason in left_out[0]


def test_one_refused_drive_does_not_stop_the_others(recording: Recording) -> None:
    files = [drive_file(cut_in(), 4), drive_file(braking(), 4)]
    _, truths, left_out = plant_drives(recording, files, bundled_library())
    assert len(left_out) == 1
    assert {x.scenario for x in truths} == {4}


def test_roads_that_do_not_fit(recording: Recording) -> None:
    file = drive_file(braking(), 4)
    third = Lanelet("m3", "main-3", "main", "main", (None, None), (F(7), F(21, 2)))
    wide = replace(file, road=Road("three", (*ROAD.lanelets, third), ROAD.adjacent))
    with pytest.raises(UsageError, match="has 3 lanes, the recording 2"):
        plant_drives(recording, [wide], bundled_library())
    narrow = Lanelet("n", "main-3", "main", "main", (None, None), (F(7), F(10)))
    with pytest.raises(UsageError, match=r"are 3, 3.5 m wide"):
        lane_width([replace(file, road=Road("odd", (*ROAD.lanelets, narrow), ROAD.adjacent))])
    assert lane_width([file]) == 3.5
    assert plantable(file) == ""
    assert "no scenario" in plantable(replace(file, scenario=None))
    short = Lanelet("s", "main-3", "main", "main", (F(0), None), (F(7), F(21, 2)))
    merging = Lanelet("s", "merge-1", "merge", "main", (None, None), (F(7), F(21, 2)))
    for other in (short, merging):
        road = Road("x", (other,), pairs([]))
        assert "more than a straight main road" in plantable(replace(file, road=road))
