"""exiD files and Lanelet2 maps that vary every field, against a reading with ``csv`` and "
"ElementTree alone."""

import cmath
import csv
import math
import random
from pathlib import Path
from xml.etree import ElementTree as xml

import numpy as np
import pytest

from roadproof.errors import InputError
from roadproof.recordings.formats.exid import read_exid
from roadproof.recordings.formats.osm import LEFT_OUT, read_osm, utm_of
from traffic.make_recording import Track, make_recording
from traffic.planar_exid import osm_of, write_exid
from traffic.test_topology import with_ramps

TURN = math.radians(200)
AT = complex(400, -250)


def rampwards(s: np.ndarray, d: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    point = AT + (s + 1j * d) * cmath.exp(1j * TURN)
    return point.real, point.imag, np.full_like(s, TURN)


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
    lanelets, notes = read_osm(path, (0.0, 0.0))
    assert notes == ()
    expected = bounds(text)
    assert {*lanelets} == {*expected}
    for name, (left, right) in expected.items():
        for line, points in ((lanelets[name].left, left), (lanelets[name].right, right)):
            ends = [complex(*line[0]), complex(*line[-1])]
            assert ends == pytest.approx([points[0], points[-1]], abs=1e-6), name
    plain, _ = read_osm(write_text(tmp_path / "b.osm", drawn()), (0.0, 0.0))
    for name, lanelet in plain.items():
        assert lanelets[name].successors == lanelet.successors
        assert {*lanelets[name].beside} == {*lanelet.beside}


def write_text(path: Path, text: str) -> Path:
    path.write_text(text)
    return path


@pytest.mark.parametrize("subtype", sorted(LEFT_OUT))
def test_lanelets_that_are_no_lanes_are_left_out(subtype: str, tmp_path: Path) -> None:
    text = drawn()
    place = text.rindex('v="highway"')
    changed = text[:place] + f'v="{subtype}"' + text[place + len('v="highway"') :]
    everything, _ = read_osm(write_text(tmp_path / "a.osm", text), (0.0, 0.0))
    lanelets, notes = read_osm(write_text(tmp_path / "b.osm", changed), (0.0, 0.0))
    (gone,) = {*everything} - {*lanelets}
    assert notes == (f"lanelets of subtype {subtype} are left out",)
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
