"""Trajectories of OpenSCENARIO: drives exported and read again, turned roads, and damaged files."""

import math
import random
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from pathlib import Path
from xml.etree import ElementTree as xml

import numpy as np
import pytest

import roadproof as rp
from extensions.exchange.exporting.shipped_drives import shipped_drives
from roadproof.errors import InputError
from roadproof.evidence.drive_file import DriveFile
from roadproof.extensions.exchange import openscenario, scenario_samples
from roadproof.extensions.exchange.export.openscenario import files
from roadproof.extensions.exchange.export.subject import ExportSubject
from roadproof.extensions.exchange.openscenario import read_recording, read_scenario
from roadproof.extensions.exchange.scenario_samples import RATE
from roadproof.extensions.exchange.storyboard import curves, stage
from roadproof.extensions.exchange.storyboard.box import ObjectBox
from roadproof.extensions.traffic.evaluate.one_trace import read_pair, read_samples
from roadproof.extensions.traffic.formats.sources import find_source
from roadproof.world.motion import state_at
from roadproof.world.reference_line import ReferenceLine
from roadproof.world.signals import RECORDED
from tables import read_table

NEAR = {"s": 0.012, "d": 0.012, "v_lon": 0.25, "v_lat": 0.25}
"""m and m/s: vertices are rounded to the millimetre, and speeds at them are estimated."""
SOME = [shipped_drives()[f"scenario-{number:02d}-base"] for number in (1, 2, 4, 12, 20)]


def put(folder: Path, file: DriveFile) -> Path:
    for name, content in files(ExportSubject("drive", 1, file)).items():
        (folder / name).write_bytes(content)
    return folder / "drive.xosc"


@pytest.mark.parametrize("file", SOME, ids=lambda x: f"{x.scenario}-{x.set_name}")
def test_a_drive_comes_back(file: DriveFile, tmp_path: Path) -> None:
    found = read_scenario(put(tmp_path, file))
    table, road = found.table, found.road
    assert {*table["vehicle"]} == {*file.drive.vehicles}
    right = min(lanelet.d[0] for lanelet in road.lanelets) - min(x.d[0] for x in file.road.lanelets)
    begin = None
    for name, motion in file.drive.vehicles.items():
        rows = table["vehicle"] == name
        assert len(table["time"][rows]) == math.floor(file.horizon * RATE) + 1
        for k, time in enumerate(table["time"][rows]):
            state = state_at(motion, Fraction(round(time * RATE), RATE))
            for signal, most in NEAR.items():
                found, true = table[signal][rows][k], float(getattr(state, signal))
                if signal == "s":  # s begins where the road of the file does
                    begin = found - true if begin is None else begin
                    true += begin
                true += float(right) if signal == "d" else 0.0
                assert abs(found - true) <= most, (name, time, signal)


def test_monitors_say_what_they_say_of_the_drive(tmp_path: Path) -> None:
    """Every scenario of the drive's vehicles, on the whole file as one trace with its names."""
    for file in SOME[:3]:
        path = put(tmp_path, file)
        trace = read_samples(path)
        assert {*trace.lanes} == {*file.drive.vehicles}
        assert file.scenario is not None
        assert rp.monitor(file.scenario, path, rp.load(file.set_name)).verdict == "true"


def turned(path: Path, by: float, at: tuple[float, float]) -> None:
    """The same, with the plane turned about the origin and moved."""
    cos, sin = math.cos(by), math.sin(by)

    def place(x: float, y: float) -> str:
        return f'x="{x * cos - y * sin + at[0]:.6f}" y="{x * sin + y * cos + at[1]:.6f}"'

    def vertex(found: re.Match[str]) -> str:
        x, y, h = map(float, found.groups())
        return f'<WorldPosition {place(x, y)} h="{h + by}"'

    def line(found: re.Match[str]) -> str:
        x, y = map(float, found.groups())
        return f'{place(x, y)} hdg="{by}"'

    path.write_text(re.sub(r'<WorldPosition x="(.*?)" y="(.*?)" h="(.*?)"', vertex, path.read_text("utf-8")))
    road = path.with_suffix(".xodr")
    road.write_text(re.sub(r'x="(.*?)" y="(.*?)" hdg="0"', line, road.read_text("utf-8")))


def test_a_road_may_lie_anywhere(tmp_path: Path) -> None:
    path = put(tmp_path, SOME[1])
    before = read_scenario(path).table
    turned(path, 2.0, (1000.0, -300.0))
    after = read_scenario(path).table
    for signal in RECORDED:
        assert np.allclose(before[signal], after[signal], atol=1e-3), signal


def test_it_is_a_format_of_recordings(tmp_path: Path) -> None:
    recording = find_source(put(tmp_path, SOME[0])).read()
    assert recording.rate == RATE
    assert "vehicles are numbered: SV is 1, POV is 2" in recording.notes
    assert recording.vehicles == 2


def without(tag: str) -> Callable[[str], str]:
    """The file without its first element of that tag."""

    def change(text: str) -> str:
        root = xml.fromstring(text)
        parent = next(x for x in root.iter() if x.find(tag) is not None)
        child = parent.find(tag)
        assert child is not None
        parent.remove(child)
        return xml.tostring(root, "unicode")

    return change


def exchanged(old: str, new: str) -> Callable[[str], str]:
    def change(text: str) -> str:
        assert old in text
        return text.replace(old, new, 1)

    return change


@pytest.mark.parametrize(
    ("change", "told"),
    [
        (without("RoadNetwork"), "a LogicFile with filepath is needed"),
        (exchanged("drive.xodr", "drive.opt"), "a road in OpenDRIVE (.xodr) is needed"),
        (exchanged("drive.xodr", "none.xodr"), "none.xodr"),
        (without("Entities"), "there is no ScenarioObject"),
        (exchanged('<ScenarioObject name="SV"', '<ScenarioObject name="POV"'), "two ScenarioObjects"),
        (without("Vehicle"), "is no Vehicle"),
        (exchanged('vehicleCategory="car"', 'vehicleCategory="tram"'), "vehicleCategory=tram is none of"),
        (
            exchanged('length="4.5"', 'length="long"'),
            "length of the Dimensions of ScenarioObject SV is 'long'",
        ),
        (exchanged('length="4.5"', 'length="$l"'), "there is no parameter l"),
        (
            exchanged('<EntityRef entityRef="SV"', '<EntityRef entityRef="NN"'),
            "there is no ScenarioObject NN",
        ),
        (
            exchanged('<EntityRef entityRef="POV"', '<EntityRef entityRef="SV"/><EntityRef entityRef="POV"'),
            "SV follows two trajectories",
        ),
        (without("TimeReference"), "a Timing with domainAbsoluteRelative=absolute"),
        (exchanged('domainAbsoluteRelative="absolute"', 'domainAbsoluteRelative="relative"'), "absolute"),
        (lambda text: text.replace("Polyline", "Nurbs"), "Nurbs: order is needed"),
        (lambda text: text.replace("WorldPosition", "GeoPosition"), "GeoPosition: this kind of position"),
        (exchanged('<Vertex time="0"', '<Vertex time="100"'), "each later than the one before"),
        (exchanged('<Vertex time="0"', '<Vertex time="nan"'), "a finite number is needed"),
        (exchanged('scale="1"', 'scale="1e9"'), "s; at most 40,000 s are read"),
        (without("RoutingAction"), "PrivateAction: it has 0 elements"),
        (exchanged("<OpenSCENARIO>", "<!DOCTYPE x><OpenSCENARIO>"), "document type"),
        (lambda text: text[:900], "no well-formed XML"),
        (lambda text: text.replace("OpenSCENARIO", "OpenDRIVE"), "OpenSCENARIO is needed"),
    ],
)
def test_what_is_wrong_is_said(change: Callable[[str], str], told: str, tmp_path: Path) -> None:
    path = put(tmp_path, SOME[0])
    path.write_text(change(path.read_text("utf-8")), "utf-8")
    with pytest.raises(InputError) as error:
        read_recording(path)
    assert told in str(error.value)
    assert "drive.xosc" in str(error.value) or "xodr" in str(error.value)


# --- planted faults --------------------------------------------------------------------------------


def the_reference_point_is_the_centre(monkeypatch: pytest.MonkeyPatch) -> None:
    made = stage.ObjectBox
    monkeypatch.setattr(stage, "ObjectBox", lambda *told, **limits: made(*told[:4], (0, 0)))


def the_corner_is_the_centre(monkeypatch: pytest.MonkeyPatch) -> None:
    sampled = scenario_samples.sample_centre_lines

    def shifted(path: Path, boxes: dict[str, ObjectBox], ways: object) -> object:
        table = sampled(path, boxes, ways)  # type: ignore[arg-type]
        table["d"][:] -= table["width"] / 2
        return table

    monkeypatch.setattr(openscenario, "sample_centre_lines", shifted)


def speeds_of_the_last_vertex(monkeypatch: pytest.MonkeyPatch) -> None:
    speeds = curves._slopes
    monkeypatch.setattr(curves, "_slopes", lambda knots, places: np.roll(speeds(knots, places), 1))


def the_road_is_not_where_it_is(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(ReferenceLine, "locate", lambda line, x, y: (x, y))


@pytest.mark.parametrize(
    "plant",
    [the_corner_is_the_centre, speeds_of_the_last_vertex, the_road_is_not_where_it_is],
)
def test_a_planted_fault_is_noticed(
    plant: Callable[[pytest.MonkeyPatch], None], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    plant(monkeypatch)
    with pytest.raises(AssertionError):
        test_a_drive_comes_back(SOME[1], tmp_path)


def test_a_planted_reference_point_is_noticed(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """As s begins anywhere, a box that is moved along shows in what the formulas say, and against samples."""
    honest = read_scenario(put(tmp_path, SOME[1])).table["s"]
    the_reference_point_is_the_centre(monkeypatch)
    moved = read_scenario(put(tmp_path, SOME[1])).table["s"]
    assert abs(np.median(honest - moved)) > 1


# --- OpenSCENARIO with every field that is read away from its default, against a reading written here
# The files are written here by the published schema (1.0 to 1.3), not by the exporter; the reading below
# uses ElementTree and polynomials of numpy, and none of the reader's functions.

FRAMES_A_SECOND = 25
KINDS = read_table(__file__, "kinds")


@dataclass(frozen=True)
class Line:
    """A vehicle: rows of (time as written, s, d, heading to the road) of its reference point."""

    name: str
    vertices: tuple[tuple[float, float, float, float], ...]
    category: str = "car"
    size: tuple[float, float] = (4.5, 1.8)
    centre: tuple[float, float] = (1.35, 0.0)
    scale: float = 1.0
    offset: float = 0.0
    begin: float = 0.0
    """When its event begins (s)."""
    follow: str = 'initialDistanceOffset="0"'
    mode: str = "position"
    closed: str = "false"
    headings: bool = True
    in_reference: bool = True
    """Whether the trajectory is in a TrajectoryRef, as from 1.1 on."""


def straight(speed: float, s: float, d: float, heading: float = 0.0, ends: float = 4.0, drift: float = 0.0):
    """Vertices each second."""
    times = [float(x) for x in np.arange(0.0, ends + 0.5)]
    return tuple((t, s + speed * t, d + drift * t, heading) for t in times)


SHIFT, TURN = (700.0, -40.0), 0.6


def plane(s: float, d: float) -> tuple[float, float]:
    return (
        SHIFT[0] + s * math.cos(TURN) - d * math.sin(TURN),
        SHIFT[1] + s * math.sin(TURN) + d * math.cos(TURN),
    )


def filled(template: str, **values: object) -> str:
    return (Path(__file__).parent / "templates" / template).read_text("utf-8").format(**values)


def vertex(line: Line, row: tuple[float, float, float, float]) -> str:
    time, s, d, heading = row
    x, y = plane(s, d)
    turned = f' h="{heading + TURN!r}"' if line.headings else ""
    return (
        f'<Vertex time="{time!r}"><Position><WorldPosition x="{x!r}" y="{y!r}" z="0.3"{turned} p="0.01" '
        'r="0"/></Position></Vertex>'
    )


def group(line: Line) -> str:
    shape = f"<Shape><Polyline>{''.join(vertex(line, x) for x in line.vertices)}</Polyline></Shape>"
    way = f'<Trajectory name="t" closed="{line.closed}"><ParameterDeclarations/>{shape}</Trajectory>'
    if line.in_reference:
        way = f"<TrajectoryRef>{way}</TrajectoryRef>"
    return filled("group.xml", line=line, way=way, trigger=trigger(line.begin))


def trigger(begin: float, rule: str = "greaterThan", delay: str = "0") -> str:
    return (
        f'<StartTrigger><ConditionGroup><Condition name="c" delay="{delay}" conditionEdge="none">'
        f'<ByValueCondition><SimulationTimeCondition value="{begin}" rule="{rule}"/></ByValueCondition>'
        "</Condition></ConditionGroup></StartTrigger>"
    )


def inner(text: str) -> str:
    """What is inside an element."""
    return text[text.index(">") + 1 : text.rindex("</")]


def put_lines(folder: Path, lines: Sequence[Line], minor: int = 2) -> Path:
    """A file of its own act and story for each vehicle but the first two, which share one."""
    folder.mkdir(exist_ok=True)
    (folder / "away").mkdir(exist_ok=True)
    road = filled("road.xodr", x=SHIFT[0], y=SHIFT[1], hdg=TURN)
    (folder / "away/any.xodr").write_text(road, "utf-8")
    acts = [lines[:2], *([x] for x in lines[2:])]
    stories = "".join(
        f'<Story name="s{k}"><Act name="a{k}">{"".join(map(group, act))}{trigger(0)}</Act></Story>'
        for k, act in enumerate(acts)
    )
    entities = "".join(filled("entity.xml", line=line) for line in lines)
    path = folder / "fields.xosc"
    path.write_text(filled("scenario.xosc", minor=minor, entities=entities, stories=stories), "utf-8")
    return path


def told(path: Path) -> Mapping[str, Mapping[str, np.ndarray]]:
    """By vehicle: time, front-left corner and its motion, by a reading of its own.

    Between vertices the place is the cubic that has there the slopes of the parabola through three vertices.
    """
    root = xml.parse(path).getroot()
    network = root.find("RoadNetwork/LogicFile")
    assert network is not None
    geometry = xml.parse(path.parent / network.attrib["filepath"]).getroot().find(".//geometry")
    assert geometry is not None
    origin = complex(float(geometry.attrib["x"]), float(geometry.attrib["y"]))
    towards = np.exp(-1j * float(geometry.attrib["hdg"]))
    found = {}
    for thing in root.iter("ScenarioObject"):
        centre, size = thing.find(".//Center"), thing.find(".//Dimensions")
        assert centre is not None
        assert size is not None
        (course,) = [
            x
            for x in root.iter("ManeuverGroup")
            if [y.attrib["entityRef"] for y in x.iter("EntityRef")] == [thing.attrib["name"]]
        ]
        timing = next(course.iter("Timing")).attrib
        lever = complex(float(centre.attrib["x"]), float(centre.attrib["y"]))
        knots, places = [], []
        for node in course.iter("Vertex"):
            place = next(node.iter("WorldPosition")).attrib
            knots.append(float(node.attrib["time"]) * float(timing["scale"]) + float(timing["offset"]))
            point = complex(float(place["x"]), float(place["y"]))
            places.append((point + lever * np.exp(1j * float(place.get("h", 0))) - origin) * towards)
        times = [
            k / FRAMES_A_SECOND
            for k in range(10_000)
            if knots[0] - 1e-6 <= k / FRAMES_A_SECOND <= knots[-1] + 1e-6
        ]
        length, width = (float(size.attrib[x]) for x in ("length", "width"))
        rows = {"time": np.array(times)}
        for axis, half in (("s", length / 2), ("d", width / 2)):
            numbers = [x.real if axis == "s" else x.imag for x in places]
            values = np.array([cubic(knots, numbers, t) for t in times])
            name = {"s": "lon", "d": "lat"}[axis]
            rows |= {axis: values[:, 0] + half, f"v_{name}": values[:, 1], f"a_{name}": values[:, 2]}
        rows |= {"length": np.full(len(times), length), "width": np.full(len(times), width)}
        found[thing.attrib["name"]] = rows
    return found


def cubic(knots: list[float], places: list[float], time: float) -> tuple[float, float, float]:
    k = max([i for i, knot in enumerate(knots[:-1]) if knot <= time + 1e-9], default=0)
    a, b = knots[k], knots[k + 1]
    rows = [[a**3, a**2, a, 1], [b**3, b**2, b, 1], [3 * a**2, 2 * a, 1, 0], [3 * b**2, 2 * b, 1, 0]]
    right = [places[k], places[k + 1], slope(knots, places, k), slope(knots, places, k + 1)]
    p = np.poly1d(np.linalg.solve(np.array(rows), np.array(right)))
    return float(p(time)), float(p.deriv()(time)), float(p.deriv(2)(time))


def slope(knots: list[float], places: list[float], k: int) -> float:
    """That of the parabola through a vertex and those beside it; at an end, through the nearest three."""
    if len(knots) == 2:
        return (places[1] - places[0]) / (knots[1] - knots[0])
    first = min(max(k - 1, 0), len(knots) - 3)
    parabola = np.polyfit(knots[first : first + 3], places[first : first + 3], 2)
    return float(np.polyval(np.polyder(parabola), knots[k]))


def differences(path: Path) -> list[str]:
    table = read_scenario(path).table
    expected, wrong = told(path), []
    if {*table["vehicle"].tolist()} != {*expected}:
        return ["vehicles"]
    for name, columns in expected.items():
        rows = table["vehicle"] == name
        for column, values in columns.items():
            ours = table[column][rows]
            if len(ours) != len(values) or not np.allclose(ours, values, atol=2e-5, rtol=0):
                wrong.append(f"{name}: {column}")
    return wrong


BASE = Line("SV", straight(20, 50, -3))
OTHER = Line("POV", straight(25, 90, -6, drift=0.3), "truck", (12.5, 2.5), (4.1, 0.0))
VARIED: Mapping[str, Line] = {
    "time scale": replace(BASE, scale=0.5),
    "time scale above one": replace(BASE, scale=1.7),
    "time offset": replace(BASE, offset=2.0),
    "offset between samples": replace(BASE, offset=1.23),
    "scale and offset": replace(BASE, scale=2.0, offset=3.5),
    "negative offset": replace(BASE, vertices=tuple((t + 5, *x) for t, *x in BASE.vertices), offset=-4.0),
    "a box to the left": replace(BASE, centre=(1.35, 0.4)),
    "a box to the right and behind": replace(BASE, centre=(-0.7, -0.25)),
    "a turned box": replace(BASE, vertices=straight(20, 50, -3, heading=0.3)),
    "turned to the right": replace(BASE, vertices=straight(20, 50, -3, heading=-0.4), centre=(2.0, 0.3)),
    "backwards on its wheels": replace(BASE, vertices=straight(20, 50, -3, heading=math.pi)),
    "a heading that changes": replace(
        BASE, vertices=tuple((t, s, d + t / 4, 0.1 * t) for t, s, d, _ in BASE.vertices), centre=(1.2, 0.2)
    ),
    "no heading": replace(BASE, headings=False, centre=(1.0, 0.5)),
    "unequal steps": replace(
        BASE, vertices=((0, 50, -3, 0), (0.3, 57, -2.9, 0), (1.7, 85, -2.5, 0), (4.0, 140, -2, 0))
    ),
    "two vertices": replace(BASE, vertices=((0, 50, -3, 0), (4, 130, -2.5, 0))),
    "a trajectory as in 1.0": replace(BASE, in_reference=False, follow=""),
    "other sizes": replace(BASE, size=(5.25, 2.05)),
    "an event before the first vertex": replace(BASE, offset=2.0, begin=1.0),
}


@pytest.mark.parametrize("name", VARIED)
def test_each_field_is_read_as_the_format_says(name: str, tmp_path: Path) -> None:
    assert differences(put_lines(tmp_path, [VARIED[name], OTHER])) == []


def test_a_file_that_varies_everything_at_once(tmp_path: Path) -> None:
    rng = random.Random(7)
    lines = []
    for k, category in enumerate(KINDS):
        vertices, t = [], rng.uniform(0, 0.5)
        for _ in range(6):
            s = 60 * k + 21 * t + rng.uniform(-0.5, 0.5)
            vertices.append((round(t, 3), s, -3.5 + rng.uniform(-2, 2), rng.uniform(-0.2, 0.2)))
            t += rng.uniform(0.4, 1.2)
        lines.append(
            Line(
                f"V{k}",
                tuple(vertices),
                category,
                (rng.uniform(2, 16), rng.uniform(1, 2.6)),
                (rng.uniform(-1, 4), rng.uniform(-0.3, 0.3)),
                rng.choice([0.5, 1.25, 2.0]),
                rng.uniform(0, 3),
            )
        )
    path = put_lines(tmp_path, lines)
    assert differences(path) == []
    for minor in (0, 1, 3):
        assert differences(put_lines(tmp_path, lines, minor)) == []


def test_each_category_has_its_class_and_its_label(tmp_path: Path) -> None:
    lines = [
        Line(f"V{k}", straight(20, 60 * k, -3), category, (4.0 + k, 1.8)) for k, category in enumerate(KINDS)
    ]
    recording = read_recording(put_lines(tmp_path, lines))
    assert dict(zip(recording.label.tolist(), recording.kind.tolist(), strict=True)) == KINDS
    assert recording.label.tolist() == [*KINDS]  # V0, V1, … are numbered by name
    assert recording.length.tolist() == [4.0 + k for k in range(len(KINDS))]


def test_vehicles_that_begin_and_end_at_other_times_share_their_frames(tmp_path: Path) -> None:
    """A frame is counted from the first sample of the file, whichever vehicle it is of."""
    lines = [replace(BASE, offset=2.0), replace(OTHER, offset=1.0, scale=1.5)]
    recording = find_source(put_lines(tmp_path, lines)).read()
    assert recording.first_frame.tolist() == [25, 0]
    assert recording.last_frame.tolist() == [125, 150]
    assert "frame 0 is time 1 s" in recording.notes
    trace = read_pair(f"{tmp_path}/fields.xosc:1,2")
    ((gap,), *_) = trace.batch.signals["s", "POV"] - trace.batch.signals["s", "SV"]
    # At 2 s SV's axle is at 50 m, POV's at 90 + 25/1.5 m; fronts are half a length ahead of the middles.
    assert gap == pytest.approx((90 + 25 / 1.5 + 4.1 + 6.25) - (50 + 1.35 + 2.25), abs=1e-6)


@pytest.mark.parametrize(
    ("line", "said"),
    [
        (
            replace(BASE, follow='initialDistanceOffset="5"'),
            "initialDistanceOffset=5: begin at the first Vertex",
        ),
        (replace(BASE, closed="true"), "closed=true"),
        (replace(BASE, begin=1.0), "StartTrigger of the Event"),
        (replace(BASE, scale=-1.0), "each later than the one before"),
        (replace(BASE, scale=0.0), "each later than the one before"),
    ],
)
def test_what_would_be_another_motion_is_refused(line: Line, said: str, tmp_path: Path) -> None:
    with pytest.raises(InputError) as error:
        read_recording(put_lines(tmp_path, [OTHER, line]))
    assert said in str(error.value)
    assert "a of SV" in str(error.value)


@pytest.mark.parametrize(
    ("old", "new", "reads"),
    read_table(__file__, "what_begins_late_is_refused"),
)
def test_what_begins_late_is_refused(old: str, new: str, reads: bool, tmp_path: Path) -> None:
    """Conditions of a group hold together, one group is enough, and the act begins like the event."""
    path = put_lines(tmp_path, [BASE, OTHER])
    text = path.read_text("utf-8")
    for place in (text.index(old), text.rindex(old)):
        path.write_text(text[:place] + new + text[place + len(old) :], "utf-8")
        if reads:
            assert differences(path) == []
        else:
            with pytest.raises(
                InputError, match=r"StartTrigger of the (Event|Act): a SimulationTimeCondition"
            ):
                read_scenario(path)
