"""Judged drives of all eight scenarios, woven into traffic, written, read and found again.

The drive files are made by ``roadproof witness`` for the formulas that they name: a trace ends with its last
danger, so where a vehicle changes lanes there is danger after that too.
"""

from fractions import Fraction
from pathlib import Path

import pytest

from roadproof.evidence.drive_file import load_drive
from roadproof.recordings.evaluate.evaluate import Findings, evaluate_recording
from roadproof.recordings.evaluate.questions import ask, default_settings
from roadproof.recordings.formats.highd import read_highd
from roadproof.recordings.formats.overlaps import find_overlaps
from roadproof.recordings.formats.write_highd import write_highd
from roadproof.recordings.simulate.plant import Place, PlantedDrive, plant
from roadproof.recordings.simulate.synthetic import simulate
from roadproof.recordings.simulate.traffic import Traffic

DRIVES = Path(__file__).parent / "planted"
SCENARIOS = range(1, 9)


@pytest.fixture(scope="module", params=[1, 2])
def found(
    request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory
) -> tuple[Findings, dict[int, PlantedDrive]]:
    """All drives one after the other in one recording that went through its files."""
    recording = simulate(Traffic(seconds=70, flow=1000, lane_width=3.5), seed=12)
    right = min(x.d[0] for x in recording.lanes if x.direction == request.param and x.d)
    truths = {}
    for number in SCENARIOS:
        drive = load_drive(DRIVES / f"scenario-{number:02d}.json").drive
        rear = min(float(m.s - m.length) for m in drive.vehicles.values())
        begin = (-415.0 if request.param == 1 else 5.0) - rear
        place = Place(request.param, 25 + 200 * (number - 1), Fraction(7), begin, right)
        recording, truths[number] = plant(recording, drive, place)
    assert list(find_overlaps(recording)) == []
    folder = tmp_path_factory.mktemp("planted")
    write_highd(recording, folder)
    return evaluate_recording(read_highd(folder, "01"), ask(default_settings(), 25)), truths


@pytest.mark.parametrize("number", SCENARIOS)
@pytest.mark.parametrize("set_name", ["base", "extA", "ext"])
def test_planted_scenario_is_found(
    number: int, set_name: str, found: tuple[Findings, dict[int, PlantedDrive]]
) -> None:
    findings, truths = found
    truth = truths[number]
    who = truth.vehicles
    names = (who["SV"], who.get("POV", who.get("POV1")), who.get("POV2"))
    starts = {
        m.start_frame
        for m in findings.matches
        if (m.sv, m.pov, m.pov2) == names and (m.scenario, m.set_name, m.min_danger) == (number, set_name, 1)
    }
    assert starts == {truth.first_frame}
