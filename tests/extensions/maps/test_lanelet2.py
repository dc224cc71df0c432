"""Roads of maps in Lanelet2: links, directions, projection, and what is left out."""

import math
from pathlib import Path

import pytest

import roadproof as rp
from extensions.maps.measured_lanelets import RAMP, MapLane, Point, commonroad, lanelet2
from roadproof.errors import InputError
from roadproof.extensions.maps.projections import transverse_mercator
from roadproof.world.models import load_road

CURVATURE = 1 / 400
RAMPS = (*RAMP, MapLane(31, (20, 120), (-12, -8.5), (32,), end=(-7, -3.5)))
ORIGIN = (48.0, 11.0)


def write(folder: Path, text: str) -> Path:
    path = folder / "a.osm"
    path.write_text(text)
    return path


def test_a_map_has_the_same_road_as_in_commonroad(tmp_path: Path) -> None:
    other = tmp_path / "a.xml"
    other.write_text(commonroad(RAMP, CURVATURE))
    there, here = load_road(other), load_road(write(tmp_path, lanelet2(RAMPS, CURVATURE)))
    assert here.lanelets == there.lanelets
    assert here.adjacent == there.adjacent
    assert here.line == there.line


def test_ways_are_listed_and_other_lanelets_are_counted(tmp_path: Path) -> None:
    path = write(tmp_path, lanelet2(RAMPS, CURVATURE))
    crossings = '<tag k="type" v="lanelet"/><tag k="subtype" v="crosswalk"/>'
    more = "".join(f'<relation id="{k}">{crossings}</relation>' for k in (91, 92))
    path.write_text(path.read_text().replace("</osm>", f"{more}</osm>"))
    main, ramp, left_out = rp.stretches(path)
    assert (main.select, main.lanes) == (f"{path}#road=1", (2, 3))
    assert [x.zone for x in main.zones] == ["merge"]
    assert (ramp.select, ramp.refused) == (f"{path}#way=31", "")
    assert left_out.refused == "left out as no roads: 2 of type crosswalk"


def test_lanes_that_are_driven_the_other_way_are_another_road(tmp_path: Path) -> None:
    text = lanelet2((MapLane(1, (0, 100), (0, 3)), MapLane(2, (0, 100), (3, 6))))
    back = text.index('<relation id="2"')
    sides = text[back:].replace("right", "x").replace("left", "right").replace("x", "left")
    one, other = rp.stretches(write(tmp_path, text[:back] + sides))
    assert one.lanes == other.lanes == (1, 1)
    assert one.line is not None
    assert other.line is not None
    assert math.cos(one.line.pose(50).heading - other.line.pose(50).heading) == pytest.approx(-1)


def test_latitude_and_longitude_are_projected(tmp_path: Path) -> None:
    def node(point: Point) -> str:
        latitude, longitude = unprojected(point)
        return f'lat="{latitude:.12f}" lon="{longitude:.12f}">'

    local = load_road(write(tmp_path, lanelet2(RAMPS, CURVATURE)))
    placed = load_road(write(tmp_path, lanelet2(RAMPS, CURVATURE, node)))
    assert len(local.lanelets) == len(placed.lanelets)
    for x, y in zip(local.lanelets, placed.lanelets, strict=True):
        assert (x.lane, x.zone) == (y.lane, y.zone)
        assert [float(z) for z in x.d] == pytest.approx([float(z) for z in y.d], abs=0.005)
        assert [float(z or 0) for z in x.s] == pytest.approx([float(z or 0) for z in y.s], abs=0.05)


def unprojected(point: Point) -> tuple[float, float]:
    """Latitude and longitude of a place, by Newton's method."""
    latitude, longitude = ORIGIN
    for _ in range(10):
        x, y = transverse_mercator(latitude, longitude, ORIGIN)
        latitude += (point[1] - y) / 111_200
        longitude += (point[0] - x) / (111_300 * math.cos(math.radians(latitude)))
    return latitude, longitude


@pytest.mark.parametrize("latitude", [0, 35, 48, 60])
def test_the_projection_agrees_with_the_series_of_krueger(latitude: float) -> None:
    for north in (-0.4, 0, 0.4):
        for east in (-0.6, 0.1, 0.6):
            x, y = transverse_mercator(latitude + north, 11 + east, (latitude, 11))
            if abs(x) < 50_000:
                far, up = krueger(latitude + north, east)
                assert math.hypot(x - far, y - up + krueger(latitude, 0)[1]) < 0.001


def krueger(latitude: float, longitude: float) -> tuple[float, float]:
    """The exact projection to less than a micrometre (Karney 2011, equations 7 to 14 and 35)."""
    flat = 1 / 298.257223563
    n, e = flat / (2 - flat), math.sqrt(flat * (2 - flat))
    radius = 6_378_137 / (1 + n) * (1 + n**2 / 4 + n**4 / 64)
    series = (
        n / 2 - 2 * n**2 / 3 + 5 * n**3 / 16 + 41 * n**4 / 180,
        13 * n**2 / 48 - 3 * n**3 / 5 + 557 * n**4 / 1440,
        61 * n**3 / 240 - 103 * n**4 / 140,
        49561 * n**4 / 161280,
    )
    phi, turn = math.radians(latitude), math.radians(longitude)
    tau = math.tan(phi)
    sigma = math.sinh(e * math.atanh(e * tau / math.hypot(1, tau)))
    conformal = tau * math.hypot(1, sigma) - sigma * math.hypot(1, tau)
    xi = math.atan2(conformal, math.cos(turn))
    eta = math.asinh(math.sin(turn) / math.hypot(conformal, math.cos(turn)))
    up, far = xi, eta
    for k, x in enumerate(series, 1):
        up += x * math.sin(2 * k * xi) * math.cosh(2 * k * eta)
        far += x * math.cos(2 * k * xi) * math.sinh(2 * k * eta)
    return radius * far, radius * up


def test_a_lanelet_without_a_subtype_is_a_road(tmp_path: Path) -> None:
    said = lanelet2(RAMPS)
    assert '<tag k="subtype" v="road"/>' in said
    plain = said.replace('<tag k="subtype" v="road"/>', "")
    assert load_road(write(tmp_path, plain)).lanelets == load_road(write(tmp_path, said)).lanelets


def test_streets_as_lines_are_no_lanelets(tmp_path: Path) -> None:
    streets = '<osm><way id="1"><tag k="highway" v="primary"/></way></osm>'
    with pytest.raises(InputError, match=r"the file has 1 streets as lines \(tag highway\)"):
        load_road(write(tmp_path, streets))


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ('v="road"', 'v="walkway"', "no lanelet of subtype highway or road, but 8 of walkway"),
        ('ref="10000"', 'ref="7"', "right bound: way 7 is not in the file"),
        ('<nd ref="1"/>', '<nd ref="99999"/>', "node 99999 is not in the file"),
        ('v="0.0"', 'v="east"', "local_x of node 1 is 'east'"),
        ('role="left"', 'role="middle"', "left bound has 0 points"),
    ],
)
def test_damage_is_refused(tmp_path: Path, old: str, new: str, told: str) -> None:
    text = lanelet2(RAMPS)
    assert old in text
    with pytest.raises(InputError, match=told):
        load_road(write(tmp_path, text.replace(old, new)))
