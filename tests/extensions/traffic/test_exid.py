"""exiD recordings on Lanelet2 maps: planted drives of scenarios 9 to 24, by hand, and damaged."""

import cmath
import csv
import math
import random
import re
from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from xml.etree import ElementTree as xml

import numpy as np
import pytest

from extensions.traffic.make_recording import Track, make_recording
from extensions.traffic.planar import Bend, straight
from extensions.traffic.planar_exid import LOCATION, degrees_of, osm_of, write_exid
from extensions.traffic.test_boundary import clothoid
from extensions.traffic.test_topology import with_ramps
from roadproof.errors import InputError
from roadproof.evidence.drive_file import load_drive
from roadproof.extensions.traffic.evaluate.evaluate import Findings, evaluate_recording
from roadproof.extensions.traffic.evaluate.one_trace import read_pair
from roadproof.extensions.traffic.evaluate.questions import (
    EvaluationQuestions,
    compile_questions,
    default_settings,
)
from roadproof.extensions.traffic.evaluate.recheck import recheck
from roadproof.extensions.traffic.formats.exid import NO_LANES, read_exid, read_osm, utm_of
from roadproof.extensions.traffic.formats.recording import Recording
from roadproof.extensions.traffic.formats.sources import find_source
from roadproof.world.motion import state_at
from tables import read_table

DRIVES = Path(__file__).parent / "planted"
RATE, SECONDS, PAUSE = 25, 7, 20


def planted(begin: float, rate: int = RATE) -> tuple[Recording, dict[int, tuple[int, ...]]]:
    """The drives of scenarios 1 to 8, one after the other, rears from ``begin`` on; who drove in each."""
    tracks, who = [], {}
    for number in range(1, 9):
        drive = load_drive(DRIVES / f"scenario-{number:02d}.json").drive
        ahead = Fraction(begin) - min(m.s - m.length for m in drive.vehicles.values())
        names = sorted(drive.vehicles, key=lambda name: (name != "SV", name))
        who[number] = tuple(len(tracks) + k for k in range(len(names)))
        for name in names:
            motion = drive.vehicles[name]
            states = [state_at(motion, Fraction(k, rate)) for k in range(SECONDS * rate + 1)]
            rows = [
                tuple(float(x) for x in (z.s + ahead, z.d, z.v_lon, z.v_lat, z.a_lon, z.a_lat))
                for z in states
            ]
            first = (number - 1) * (SECONDS * rate + PAUSE)
            tracks.append(Track(2, first, rows, float(motion.length), float(motion.width)))
    return make_recording(tracks, rate), who


def everything(rate: int = RATE) -> EvaluationQuestions:
    return compile_questions(replace(default_settings(), scenarios=tuple(range(1, 25))), rate)


def bent(s: np.ndarray, d: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    return clothoid(s, d - 3.5)  # the line between the main lanes


def rampwards(s: np.ndarray, d: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """A straight road turned by 200 degrees and far from the origin."""
    turn = np.radians(200.0)
    x, y = s * np.cos(turn) - d * np.sin(turn), s * np.sin(turn) + d * np.cos(turn)
    return x + 400, y - 250, np.full_like(s, turn)


CASES: dict[str, tuple[str, int, float, Bend]] = {
    "merge": ("merge", 8, -95.0, straight),
    "exit": ("depart", 16, -95.0, straight),
    "merge, turned": ("merge", 8, -95.0, rampwards),
    "exit, bent": ("depart", 16, -95.0, bent),
    "weave, merging": ("weave", 8, -350.0, rampwards),
    "weave, departing": ("weave", 16, 30.0, bent),
}


@pytest.fixture(scope="module", params=CASES)
def found(
    request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory
) -> tuple[int, dict[int, tuple[int, ...]], Recording, Findings]:
    name, shift, begin, bend = CASES[request.param]
    recording, who = planted(begin)
    path = write_exid(recording, with_ramps(name), tmp_path_factory.mktemp("exid"), bend)
    read = find_source(path).read()
    return shift, who, read, evaluate_recording(read, everything())


def test_planted_drives_are_found(found: tuple[int, dict[int, tuple[int, ...]], Recording, Findings]) -> None:
    """All eight of the zone, in every set and for both minDanger."""
    shift, who, _, findings = found
    for number, names in who.items():
        sv, pov, *rest = names
        pov2 = rest[0] if rest else None
        hits = {
            (m.set_name, m.min_danger)
            for m in findings.matches
            if (m.sv, m.pov, m.pov2, m.scenario) == (sv, pov, pov2, number + shift)
        }
        assert hits == {(name, k) for name in ("base", "extA", "ext") for k in (0, 1)}, number + shift
    assert {m.scenario for m in findings.matches} <= {shift + k for k in range(1, 9)}


def test_the_recursive_evaluator_confirms_all(
    found: tuple[int, dict[int, tuple[int, ...]], Recording, Findings],
) -> None:
    _, _, recording, findings = found
    assert list(recheck(recording, everything(), findings)) == []


def test_by_hand(tmp_path: Path) -> None:
    """One car, on the ramp and then beside the main road, on a road that is turned."""
    rows = [(-150 + 1.2 * k + k * k / 1250, -0.85, 30.0 + k / 25, 0.0, 1.0, 0.0) for k in range(60)]
    recording = make_recording([Track(2, 4, rows, 4.4, 1.8)])
    path = write_exid(recording, with_ramps("merge"), tmp_path, rampwards)
    r = read_exid(tmp_path, "07")
    assert (r.name, r.rate, r.first_frame.tolist(), r.kind.tolist()) == ("07", 25, [4], ["Car"])
    assert {x.id: (x.zone, x.attribute) for x in r.lanelets} == {
        str(k): (x.zone, x.attribute) for k, x in enumerate(with_ramps("merge").lanelets, start=1)
    }
    assert np.ptp(r.s - recording.s) < 1e-4
    assert np.ptp(r.d - recording.d) < 1e-4
    assert r.v_lon == pytest.approx(recording.v_lon, abs=1e-4)
    assert r.v_lat == pytest.approx(0, abs=1e-4)
    assert r.a_lon == pytest.approx(recording.a_lon, abs=1e-4)
    assert (r.occupancy == 1 << [x.name for x in r.lanes].index("8")).all()
    assert (r.zones == 2).all()
    assert "merge lane 8 (lanelets 8, 7) inferred, since it ends at 7 beside lanelets that go on" in r.notes
    assert find_source(path).format.name == "exiD"
    assert [x.name for x in find_source(tmp_path).files] == [
        f"location{LOCATION}.osm",
        *(f"07_{x}.csv" for x in ("recordingMeta", "tracksMeta", "tracks")),
    ]
    assert read_pair(f"{path}:0").lanes == {"SV": r.lanes[int(r.lane[0])].name}


def test_lat_and_lon(tmp_path: Path) -> None:
    """The same map by degrees: nodes are where local coordinates put them, to the millimetre."""
    road = with_ramps("merge")
    for name, local in (("a", True), ("b", False)):
        (tmp_path / f"{name}.osm").write_text(osm_of(road, rampwards, step=60.0, local=local))
    one, other = (read_osm(tmp_path / f"{name}.osm", (300000.0, 5600000.0)).lanelets for name in "ab")
    assert one.keys() == other.keys()
    for name in one:
        assert np.abs(one[name].left - other[name].left).max() < 1e-3
        assert (one[name].successors, one[name].beside) == (other[name].successors, other[name].beside)


def test_utm() -> None:
    """The tower of Toronto (zone 17), whose place is published, and points on a middle meridian."""
    assert utm_of(np.array([43.642566]), np.array([-79.387139]))[0] == pytest.approx(
        [630084, 4833438], abs=1.5
    )
    assert utm_of(np.array([0.0]), np.array([9.0]))[0] == pytest.approx([500000, 0], abs=1e-6)
    assert utm_of(np.array([-1.0]), np.array([9.0]))[0, 1] == pytest.approx(
        1e7 - utm_of(np.array([1.0]), np.array([9.0]))[0, 1]
    )
    lat, lon = degrees_of(300000.0, 5600000.0)
    assert utm_of(np.array([lat]), np.array([lon]))[0] == pytest.approx([300000, 5600000], abs=1e-6)


def one_car(folder: Path) -> Path:
    rows = [(-150 + 1.2 * k, -0.85, 30.0, 0.0, 0.0, 0.0) for k in range(60)]
    return write_exid(make_recording([Track(2, 4, rows, 4.4, 1.8)]), with_ramps("merge"), folder, rampwards)


def cell(file: str, row: int, column: str, value: str) -> Callable[[Path], None]:
    def damage(folder: Path) -> None:
        path = folder / f"07_{file}.csv"
        rows = [line.split(",") for line in path.read_text().splitlines()]
        for place in range(1, len(rows)) if row == 0 else (row - 1,):
            rows[place][rows[0].index(column)] = value
        path.write_text("".join(",".join(line) + "\n" for line in rows))

    return damage


def map_text(old: str, new: str, count: int = 1) -> Callable[[Path], None]:
    def damage(folder: Path) -> None:
        path = folder / "maps" / f"location{LOCATION}.osm"
        text = path.read_text()
        assert re.search(old, text), old
        path.write_text(re.sub(old, new, text, count=count))

    return damage


def rename_map(folder: Path) -> None:
    path = folder / "maps" / f"location{LOCATION}.osm"
    path.rename(path.with_name("location13.osm"))


def second_map(folder: Path) -> None:
    path = folder / "maps" / f"location{LOCATION}.osm"
    (folder / "maps" / "3_other.osm").write_bytes(path.read_bytes())


def turn_over(folder: Path) -> None:
    """y grows down."""
    path = folder / "07_tracks.csv"
    rows = [line.split(",") for line in path.read_text().splitlines()]
    for column in ("yCenter", "yVelocity", "yAcceleration"):
        at = rows[0].index(column)
        for row in rows[1:]:
            row[at] = str(-float(row[at]))
    path.write_text("".join(",".join(line) + "\n" for line in rows))


def aside(folder: Path) -> None:
    """All is 100 m further in y."""
    path = folder / "07_tracks.csv"
    rows = [line.split(",") for line in path.read_text().splitlines()]
    at = rows[0].index("yCenter")
    for row in rows[1:]:
        row[at] = str(float(row[at]) + 100)
    path.write_text("".join(",".join(line) + "\n" for line in rows))


DAMAGE: dict[str, tuple[Callable[[Path], None], str]] = {
    **{name: (cell(*place), said) for name, *place, said in read_table(__file__, "damaged_cells")},
    **{name: (map_text(*cell), said) for name, *cell, said in read_table(__file__, "damaged_maps")},
    "y grows down": (turn_over, "does y grow up, and is heading in degrees"),
    "off the road": (aside, r"row 2, column trackId=0: on no lanelet of the map at any time"),
    "no map": (rename_map, r"locationId=3: one map is needed whose name has this number, but there are loc"),
    "two maps": (second_map, r"there are 3_other.osm, location3.osm"),
}


@pytest.mark.parametrize("name", DAMAGE)
def test_damage_is_named(name: str, tmp_path: Path) -> None:
    path = one_car(tmp_path)
    assert find_source(path).read().vehicles == 1
    damage, said = DAMAGE[name]
    damage(tmp_path)
    with pytest.raises(InputError, match=said):
        find_source(path).read()


def test_missing_files_are_named(tmp_path: Path) -> None:
    path = one_car(tmp_path)
    (tmp_path / "07_tracksMeta.csv").unlink()
    with pytest.raises(InputError, match=r"07_tracksMeta.csv: the file cannot be read"):
        find_source(path).read()


def test_samples_that_name_no_lanelet_are_compared_with_none(tmp_path: Path) -> None:
    """``-1`` and nothing are no lanelets; the lane follows from the position alone."""
    path = one_car(tmp_path)
    expected = find_source(path).read()
    cell("tracks", 0, "laneletId", "-1")(tmp_path)
    found = find_source(path).read()
    assert found.lane.tolist() == expected.lane.tolist()
    assert not any("laneletId" in x for x in found.notes)


# --- exiD files and Lanelet2 maps that vary every field, against a reading with ``csv`` and " -------
# "ElementTree alone.

TURN = math.radians(200)
AT = complex(400, -250)


def cars(seed: int) -> list[Track]:
    """On the main lanes, apart; with drift, accelerations along and across, of different sizes."""
    rng = random.Random(seed)
    made = []
    for k in range(5):
        v, drift, pull, aside = (
            25 + 5 * rng.random(),
            rng.uniform(-0.6, 0.6),
            rng.uniform(-1, 1),
            rng.uniform(-0.4, 0.4),
        )
        s, d, first = -500 + 120.0 * k, rng.uniform(2.5, 5.5), rng.randrange(0, 20)
        rows = []
        for n in range(rng.randrange(2, 15)):
            t = n / 25
            rows.append(
                (
                    *(s + v * t + pull * t * t / 2, d + drift * t + aside * t * t / 2),
                    *(v + pull * t, drift + aside * t, pull, aside),
                )
            )
        made.append(Track(2, first, rows, rng.uniform(3.5, 12), rng.uniform(1.6, 2.5)))
    return made


def kinds(folder: Path, names: list[str]) -> None:
    path = folder / "07_tracksMeta.csv"
    head, *lines = path.read_text().splitlines()
    lines = [f"{line.rpartition(',')[0]},{name}" for line, name in zip(lines, names, strict=True)]
    path.write_text("\n".join((head, *lines)) + "\n")


@pytest.mark.parametrize("seed", range(4))
def test_every_column_is_read_as_the_format_says(seed: int, tmp_path: Path) -> None:
    path = write_exid(make_recording(cars(seed)), with_ramps("merge"), tmp_path, rampwards)
    classes = ["car", "truck", "van", "motorcycle", "trailer"]
    kinds(tmp_path, classes)
    r = read_exid(tmp_path, "07")
    assert r.kind.tolist() == [x.capitalize() for x in classes]
    with (tmp_path / "07_tracksMeta.csv").open(newline="") as file:
        meta = {int(row["trackId"]): row for row in csv.DictReader(file)}
    rows_of: dict[int, list[dict[str, str]]] = {}
    with path.open(newline="") as file:
        for row in csv.DictReader(file):
            rows_of.setdefault(int(row["trackId"]), []).append(row)
    origin = None
    for k, number in enumerate(r.vehicle_id.tolist()):
        told, rows = meta[number], slice(r.start[k], r.start[k + 1])
        size = float(told["length"]), float(told["width"])
        assert (r.length[k], r.width[k]) == size
        assert (r.first_frame[k], r.last_frame[k]) == (int(told["initialFrame"]), int(told["finalFrame"]))

        def number_in(row: dict[str, str], name: str) -> complex:
            return complex(*(float(row[f"{axis}{name}"]) for axis in "xy"))

        for n, row in enumerate(rows_of[number]):
            place = (number_in(row, "Center") - AT) * cmath.exp(-1j * TURN)
            speed, pull = (number_in(row, x) * cmath.exp(-1j * TURN) for x in ("Velocity", "Acceleration"))
            at = rows.start + n
            assert (r.v_lon[at], r.v_lat[at]) == pytest.approx((speed.real, speed.imag), abs=1e-4)
            assert (r.a_lon[at], r.a_lat[at]) == pytest.approx((pull.real, pull.imag), abs=1e-4)
            shift = r.s[at] - (place.real + size[0] / 2), r.d[at] - (place.imag + size[1] / 2)
            origin = origin or shift  # where s and d begin is up to the map
            assert shift == pytest.approx(origin, abs=1e-3)


def test_a_turned_box_is_inside_where_it_is_turned(tmp_path: Path) -> None:
    """15 degrees to either side: a corner is over the marking, where that of a box along the road is not."""
    rows = [(-400 + 1.2 * n, 3.5 - 1.75 + 0.9, 30.0, 0.0, 0.0, 0.0) for n in range(3)]
    for degrees, middle in ((15, 2.4), (-15, 2.4), (15, 1.1), (-15, 1.1)):
        tracks = [Track(2, 0, [(s, middle + 0.9, *more) for s, _, *more in rows], 5.0, 1.8)]
        folder = tmp_path / f"{degrees}-{middle}"
        path = write_exid(make_recording(tracks), with_ramps("merge"), folder, rampwards)
        text = [line.split(",") for line in path.read_text().splitlines()]
        at = {name: k for k, name in enumerate(text[0])}
        for line in text[1:]:
            turned = TURN + math.radians(degrees)
            line[at["heading"]] = str(math.degrees(turned) % 360)
            velocity = complex(float(line[at["xVelocity"]]), float(line[at["yVelocity"]]))
            line[at["lonVelocity"]] = str((velocity * cmath.exp(-1j * turned)).real)
        path.write_text("".join(",".join(line) + "\n" for line in text))
        r = read_exid(folder, "07")
        corners = [
            middle + (complex(x, y) * cmath.exp(1j * math.radians(degrees))).imag
            for x in (-2.5, 2.5)
            for y in (-0.9, 0.9)
        ]
        lanes = sum(low < max(corners) and min(corners) < low + 3.5 for low in (0.0, 3.5))
        assert lanes == (2 if middle == 2.4 else 1)
        assert {int(x).bit_count() for x in r.occupancy} == {lanes}


def drawn(local: bool = True) -> str:
    return osm_of(with_ramps("merge"), rampwards, step=60.0, local=local)


def bounds(text: str) -> dict[str, tuple[list[complex], list[complex]]]:
    """Left and right line of each lanelet in driving direction, by a reading of its own."""
    root = xml.fromstring(text)
    nodes = {
        x.attrib["id"]: complex(*(float(x.find(f"tag[@k='local_{a}']").attrib["v"]) for a in "xy"))  # type: ignore[union-attr]
        for x in root.findall("node")
    }
    ways = {x.attrib["id"]: [nodes[y.attrib["ref"]] for y in x.findall("nd")] for x in root.findall("way")}
    found = {}
    for x in root.findall("relation"):
        sides = {m.attrib["role"]: ways[m.attrib["ref"]] for m in x.findall("member")}
        left, right = sides["left"], sides["right"]
        along = cmath.exp(1j * TURN)
        found[x.attrib["id"]] = (
            sorted(left, key=lambda z: (z / along).real),
            sorted(right, key=lambda z: (z / along).real),
        )
    return found


@pytest.mark.parametrize("seed", range(5))
def test_bounds_are_turned_into_driving_direction(seed: int, tmp_path: Path) -> None:
    """Ways are drawn forwards and backwards at random; left stays left."""
    rng = random.Random(seed)
    root = xml.fromstring(drawn())
    for way in root.findall("way"):
        if rng.random() < 0.5:
            nodes = way.findall("nd")
            for node in nodes:
                way.remove(node)
            for node in reversed(nodes):
                way.insert(0, node)
                way.remove(node)
                way.append(node)
    for relation in root.findall("relation"):
        if rng.random() < 0.5:
            relation[0], relation[1] = relation[1], relation[0]
    text = xml.tostring(root, "unicode")
    path = tmp_path / "a.osm"
    path.write_text(text)
    found = read_osm(path, (0.0, 0.0))
    lanelets = found.lanelets
    assert found.notes == ()
    expected = bounds(text)
    assert {*lanelets} == {*expected}
    for name, (left, right) in expected.items():
        for line, points in ((lanelets[name].left, left), (lanelets[name].right, right)):
            ends = [complex(*line[0]), complex(*line[-1])]
            assert ends == pytest.approx([points[0], points[-1]], abs=1e-6), name
    plain = read_osm(write_text(tmp_path / "b.osm", drawn()), (0.0, 0.0)).lanelets
    for name, lanelet in plain.items():
        assert lanelets[name].successors == lanelet.successors
        assert {*lanelets[name].beside} == {*lanelet.beside}


def write_text(path: Path, text: str) -> Path:
    path.write_text(text)
    return path


@pytest.mark.parametrize("subtype", sorted(NO_LANES))
def test_lanelets_that_are_no_lanes_are_left_out(subtype: str, tmp_path: Path) -> None:
    text = drawn()
    place = text.rindex('v="highway"')
    changed = text[:place] + f'v="{subtype}"' + text[place + len('v="highway"') :]
    everything = read_osm(write_text(tmp_path / "a.osm", text), (0.0, 0.0)).lanelets
    found = read_osm(write_text(tmp_path / "b.osm", changed), (0.0, 0.0))
    lanelets = found.lanelets
    (gone,) = {*everything} - {*lanelets}
    assert found.notes == (f"left out lanelets of b.osm that are no lanes of the road: 1 of kind {subtype}",)
    assert all(gone not in (*x.successors, *x.beside) for x in lanelets.values())


def test_a_lanelet_that_is_driven_both_ways_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="one_way=no"):
        read_osm(write_text(tmp_path / "a.osm", drawn().replace('v="yes"', 'v="no"', 1)), (0.0, 0.0))


def test_places_south_of_the_equator_count_from_ten_million() -> None:
    """The series of the meridian arc (Snyder 1987, eq. 3-21), on middle meridians of four zones."""
    a, f = 6378137.0, 1 / 298.257223563
    e2 = f * (2 - f)
    for lat, lon in ((-33.0, 21.0), (-0.5, 9.0), (47.0, -75.0), (12.0, 3.0)):
        p = math.radians(lat)
        arc = a * (
            (1 - e2 / 4 - 3 * e2**2 / 64 - 5 * e2**3 / 256) * p
            - (3 * e2 / 8 + 3 * e2**2 / 32 + 45 * e2**3 / 1024) * math.sin(2 * p)
            + (15 * e2**2 / 256 + 45 * e2**3 / 1024) * math.sin(4 * p)
            - (35 * e2**3 / 3072) * math.sin(6 * p)
        )
        east, north = utm_of(np.array([lat]), np.array([lon]))[0]
        assert (east, north) == pytest.approx((500000, 0.9996 * arc + (1e7 if lat < 0 else 0)), abs=0.01)


@pytest.mark.parametrize(
    ("listed", "reads"), [("8;7", True), ("7;8", True), ("-1", True), ("99", False), ("8;99", True)]
)
def test_lanelet_ids_are_lists(listed: str, reads: bool, tmp_path: Path) -> None:
    """A box on several lanelets; one of them has to be of the map."""
    path = write_exid(make_recording(cars(1)), with_ramps("merge"), tmp_path, rampwards)
    head, first, *lines = path.read_text().splitlines()
    at = head.split(",").index("laneletId")
    cells = first.split(",")
    cells[at] = listed
    path.write_text("\n".join((head, ",".join(cells), *lines)) + "\n")
    if reads:
        assert read_exid(tmp_path, "07").vehicles == 5
    else:
        with pytest.raises(InputError, match="has no lanelet 99 among its lanes"):
            read_exid(tmp_path, "07")
