"""The files that questions of the sweep of keys read, as text: tests of a catalogue, and a recording."""

from collections.abc import Iterator, Mapping
from pathlib import Path

from extensions.traffic.make_recording import Track, make_recording
from extensions.traffic.planar import commonroad_of
from extensions.traffic.test_topology import with_ramps
from roadproof.extensions.maps.network import ZONES_ENDING
from roadproof.extensions.traffic.formats.samples import ROAD_ENDING

EXAMPLE = Path(__file__).parents[2] / "examples" / "catalogue" / "tests"
RATE, SECONDS, BRAKING = 10, 6, 4.0


def _braking() -> str:
    """A scenario of CommonRoad on the merge road, all typed urban: a vehicle ahead of another one brakes."""
    times = [k / RATE for k in range(SECONDS * RATE + 1)]
    behind = [(30.0 * t, 2.7, 30.0, 0.0, 0.0, 0.0) for t in times]
    ahead = [
        (80 + 28 * t - BRAKING / 2 * t**2, 2.7, 28 - BRAKING * t, 0.0, -BRAKING, 0.0) for t in times if t <= 3
    ]
    after = ahead[-1][0], ahead[-1][2]
    ahead += [(after[0] + after[1] * (t - 3), 2.7, after[1], 0.0, 0.0, 0.0) for t in times if t > 3]
    recording = make_recording([Track(2, 0, behind), Track(2, 0, ahead)], RATE)
    return commonroad_of(recording, with_ramps("merge"), types=lambda _: "urban")


FORMULA = """\
[[test]]
id = "fast"
formula = "scenario_90(SV,POV,L)"
at_start = { "v_lon(SV)" = "22 m/s .. 30 m/s" }
claims = [90]
"""
_ROAD = (EXAMPLE / "samples" / "braking_road.toml").read_text("utf-8")
FILES: Mapping[str, str | None] = {
    "tests/drive.json": (EXAMPLE / "drives" / "braking.json").read_text("utf-8"),
    "tests/samples.csv": (EXAMPLE / "samples" / "braking.csv").read_text("utf-8"),
    f"tests/samples{ROAD_ENDING}": _ROAD,
    "tests/merge.xml": _braking(),
    "tests/catalogue.toml": FORMULA,
    "recordings/merge.xml": _braking(),
}


ZONES = '[[lanelet]]\nid = 1007\nattribute = "departure"\n'
_EDITS: Mapping[str, tuple[str, str]] = {
    "tests/drive.json": ('"horizon": "6"', '"horizon": "5"'),
    "tests/samples.csv": ("28.013", "28.011"),
    f"tests/samples{ROAD_ENDING}": ('"main-2"', '"main"'),
    "tests/catalogue.toml": ("22 m/s", "23 m/s"),
}


def other_files(folder: str) -> Iterator[tuple[str, str, str | None]]:
    """Changes of the files of a folder, each with its name, the file and its other content.

    Each file has a byte more, is gone, and where that can be read says something else; each way to say more
    of a road comes beside each file.
    """
    for name, content in FILES.items():
        if not name.startswith(f"{folder}/") or content is None:
            continue
        yield f"{name}: a byte more", name, f"{content}\n"
        yield f"{name}: gone", name, None
        if name in _EDITS:
            before, after = _EDITS[name]
            assert before in content, name
            yield f"{name}: {after}", name, content.replace(before, after, 1)
        for ending in (ZONES_ENDING, ROAD_ENDING):
            beside = f"{name.rpartition('.')[0]}{ending}"
            if beside not in FILES and not name.endswith((ending, ".toml")):
                yield f"{beside}: there", beside, ZONES if ending == ZONES_ENDING else _ROAD
