"""All 24 scenarios on a motorway with a bend of 400 m and ramps, and drives on roads of random bends."""

import random
from dataclasses import replace
from fractions import Fraction as F
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest

import roadproof as rp
from extensions.exchange.exporting.integration import integrated
from extensions.exchange.exporting.shipped_drives import shipped_drives
from roadproof.evidence.drive_file import DriveFile
from roadproof.evidence.judged import judge_file
from roadproof.extensions.exchange.export.points import centre
from roadproof.extensions.exchange.exporting import ExportedDrive, Exports
from roadproof.library.loading import bundled_library
from roadproof.world.curves import Spiral
from roadproof.world.motion import state_at
from roadproof.world.reference_line import Part, ReferenceLine

MAP = Path(__file__).parents[4] / "examples/maps/motorway.xodr"


def longer(file: DriveFile) -> DriveFile:
    """A second more, as danger that begins at the end of a trace is undecided."""
    return replace(file, horizon=file.horizon + 1)


@pytest.fixture(scope="module")
def exports(tmp_path_factory: pytest.TempPathFactory) -> tuple[dict[str, DriveFile], Exports]:
    """A drive for each scenario, found on the motorway and exported, with its name there."""
    found = rp.witness(road=f"{MAP}#lanes=right", pictures=False)
    assert {*found.verdicts.values()} == {rp.Verdict.WITNESSED}
    files = [longer(x.file) for x in found.drives]
    folder = tmp_path_factory.mktemp("motorway")
    made = rp.export(files, to="openscenario,commonroad", out=folder)
    return {f"scenario-{x.scenario:02d}-base": x for x in files}, made


def trace_of(exported: ExportedDrive) -> str:
    """The trace as ``monitor`` takes it."""
    ids = ",".join(map(str, exported.ids.values()))
    return str(exported.files[0]) + (f":{ids}" if exported.format == "commonroad" else "")


def test_all_scenarios_are_read_again_with_the_same_verdicts(
    exports: tuple[dict[str, DriveFile], Exports],
) -> None:
    files, made = exports
    assert len(made.drives) == 48
    verdicts = {}
    for exported in made.drives:
        scenario = files[exported.name].scenario
        assert scenario is not None
        verdicts[exported.name, exported.format] = rp.monitor(scenario, trace_of(exported)).verdict
    assert set(verdicts.values()) == {"true"}
    assert (made.folder / "openscenario" / MAP.name).read_bytes() == MAP.read_bytes()


def test_all_vehicles_are_where_an_integration_has_them(
    exports: tuple[dict[str, DriveFile], Exports],
) -> None:
    """Within 1 cm, and speeds within 0.02 m/s of the way that is driven in a twenty-fifth of a second."""
    files, made = exports
    far, fast = 0.0, 0.0
    for exported in (x for x in made.drives if x.format == "commonroad"):
        root, vehicles = ElementTree.parse(exported.files[0]), files[exported.name].drive.vehicles
        for name, number in exported.ids.items():
            node = root.find(f"dynamicObstacle[@id='{number}']")
            assert node is not None
            states = [*node.findall("initialState"), *node.findall("trajectory/state")]
            told = np.array(
                [[float(x.findtext(f"position/point/{axis}", "")) for axis in "xy"] for x in states]
            )
            speeds = np.array(
                [[float(x.findtext(f"{y}/exact", "")) for y in ("velocity", "velocityY")] for x in states]
            )
            motion = vehicles[name]
            there = [
                centre(state_at(motion, F(k, 25)), motion.length, motion.width) for k in range(len(states))
            ]
            s, d = np.array([[float(x) for x in place] for place in there]).T
            x, y, _ = integrated(s, d)
            far = max(far, float(np.hypot(told[:, 0] - x, told[:, 1] - y).max()))
            way = np.hypot(np.diff(x), np.diff(y)) * 25
            speed = np.hypot(*speeds.T)
            fast = max(fast, float(np.abs((speed[1:] + speed[:-1]) / 2 - way).max()))
    assert far < 0.01
    assert fast < 0.02


def bent(seed: random.Random) -> ReferenceLine:
    """A line of random clothoids of 300 m radius or more, from s = -400 m to 1200 m."""
    parts: list[Part] = []
    s, heading, curvature = F(-400), F(seed.randint(-3, 3)), F(0)
    x, y = 100.0, -50.0
    while s < 1200:
        length, after = F(seed.randint(60, 200)), F(seed.randint(-10, 10), 3000)
        part = Part(
            s, length, F(round(x * 1000), 1000), F(round(y * 1000), 1000), heading, Spiral(curvature, after)
        )
        parts.append(part)
        end = part.pose(float(part.end))
        x, y, heading, curvature, s = end.x, end.y, F(end.heading), after, part.end
    return ReferenceLine(tuple(parts))


@pytest.mark.parametrize("number", range(12))
def test_a_drive_has_the_same_verdict_on_every_road_with_the_same_lanelets(
    number: int, tmp_path: Path
) -> None:
    """By the judge, and by the monitor of an exported file."""
    seed, library = random.Random(number), bundled_library()
    name = seed.choice([*shipped_drives()])
    straight = longer(shipped_drives()[name])
    if seed.random() < 0.3:
        straight = replace(straight, formula=f"not ({straight.formula})", scenario=None)
    file = replace(straight, road=replace(straight.road, line=bent(seed)))
    one, other = judge_file(straight, library), judge_file(file, library)
    assert (one.accepted, one.reason) == (other.accepted, other.reason)
    asked = shipped_drives()[name].formula
    (tmp_path / "a").mkdir()
    rp.export(longer(replace(shipped_drives()[name], road=file.road)), to="openscenario", out=tmp_path / "a")
    (path,) = (tmp_path / "a").glob("*.xosc")
    home = rp.load(straight.set_name)
    assert rp.monitor(asked, path, home).verdict == "true"
