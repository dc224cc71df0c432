"""What OpenDRIVE maps of others have: namespaces, borders, repeated pieces, roads that cannot be read."""

from fractions import Fraction as F
from itertools import pairwise
from pathlib import Path

import pytest

import roadproof as rp
from extensions.maps.test_maps import lane, line, road, section, write
from roadproof.errors import InputError
from roadproof.extensions.maps.opendrive import outer_edge, read_map
from roadproof.frontends.cli.main import main
from roadproof.world.models import load_road

WIDE = 'a="3.5" b="0" c="0" d="0"'


def test_a_namespace_does_not_matter(tmp_path: Path) -> None:
    path = write(tmp_path, road(1, line(), section(lane(-1))))
    plain = load_road(path).lanelets
    path.write_text(path.read_text().replace("<OpenDRIVE>", '<OpenDRIVE xmlns="http://example.org/a">'))
    assert load_road(path).lanelets == plain


def test_borders_are_edges_whatever_the_lanes_inside(tmp_path: Path) -> None:
    def bordered(number: int, places: str) -> str:
        return f'<lane id="{number}" type="driving"><border sOffset="0" {places}/></lane>'

    right = bordered(-1, 'a="-3" b="0" c="0" d="0"') + bordered(-2, 'a="-6.5" b="0" c="0" d="0"')
    path = write(tmp_path, road(1, line(), section(right)))
    assert [x.d for x in load_road(path).lanelets] == [(F(-13, 2), F(-3)), (F(-3), F(0))]
    (found,) = read_map(path).roads
    edges = [outer_edge(found.offset, found.sections[0], k, F(10)) for k in (0, -1, -2)]
    assert edges == [0, -3, F(-13, 2)]
    path = write(tmp_path, road(1, line(), section(right.replace('a="-6.5"', 'a="-2"'))))
    with pytest.raises(InputError, match=r"lane -2: its width is below 0, -1\.00 m"):
        load_road(path)


def test_of_pieces_at_one_place_the_last_one_holds(tmp_path: Path) -> None:
    twice = f'<width sOffset="0" a="9" b="0" c="0" d="0"/><width sOffset="0" {WIDE}/>'
    path = write(tmp_path, road(1, line(), section(f'<lane id="-1" type="driving">{twice}</lane>')))
    assert [x.d for x in load_road(path).lanelets] == [(F(-7, 2), F(0))]


def test_numbers_may_have_exponents_of_three_digits(tmp_path: Path) -> None:
    path = write(tmp_path, road(1, line(), section(lane(-1)), length="1.0e+002"))
    assert load_road(path).lanelets[-1].s[1] == 100


def test_a_road_ends_where_its_geometries_end(tmp_path: Path) -> None:
    path = write(tmp_path, road(1, line(), section(lane(-1)), length="100.2"))
    assert load_road(path).lanelets[-1].s[1] == 100
    path = write(tmp_path, road(1, line(), section(lane(-1)), length="101"))
    with pytest.raises(InputError, match="length=101, but its geometries end at 100"):
        load_road(path)


def test_a_road_that_cannot_be_read_costs_that_road(tmp_path: Path) -> None:
    bad = line() + '<geometry s="100" x="101" y="0" hdg="0" length="50"><line/></geometry>'
    path = write(tmp_path, road(1, line(), section(lane(-1))), road(2, bad, section(lane(-1)), length="150"))
    one, other = rp.stretches(path)
    assert (one.select, one.refused) == (f"{path}#road=1,lanes=right", "")
    assert other.select == f"{path}#road=2"
    assert "geometry 2: it begins 1.00 m from where the one before it ends" in other.refused
    with pytest.raises(InputError, match=r"geometry 2: it begins 1\.00 m"):
        load_road(f"{path}#road=2")
    with pytest.raises(InputError, match=r"2 roads \(1, 2\); name one"):
        load_road(path)


def test_where_two_lanes_become_one_the_nearer_one_goes_on(tmp_path: Path) -> None:
    ends = '<successor id="-1"/>'
    first = section(lane(-1, link=ends) + lane(-2, link=ends))
    path = write(tmp_path, road(1, line(), first + section(lane(-1), s="60")))
    found = {(x.lane, x.s, x.d) for x in load_road(path).lanelets}
    right, left = (F(-7), F(-7, 2)), (F(-7, 2), F(0))
    assert found == {("main-1", (0, 60), right), ("main-2", (0, 60), left), ("main-2", (60, 100), left)}


def test_the_narrow_end_of_a_lane_beside_the_rest_of_it_is_left_out(tmp_path: Path) -> None:
    inner = (
        '<lane id="-1" type="restricted"><width sOffset="0" a="0" b="0" c="0" d="0"/>'
        '<width sOffset="40" a="0" b="0.7" c="0" d="0"/></lane>'
        f'<lane id="-2" type="driving"><width sOffset="0" {WIDE}/>'
        '<width sOffset="40" a="3.5" b="-0.35" c="0" d="0"/>'
        '<width sOffset="50" a="0" b="0" c="0" d="0"/></lane>' + lane(-3)
    )
    path = write(tmp_path, road(1, line(), section(inner)))
    found = load_road(f"{path}#step=1").lanelets
    ending = [x for x in found if x.lane == "main-2"]
    assert 45 < max(x.s[1] or 0 for x in ending) < 50
    assert all(a.d[0] < b.d[1] and b.d[0] < a.d[1] for a, b in pairwise(ending))
    assert {x.s[1] for x in found if x.lane == "main-1"} >= {F(100)}


def test_ramps_without_a_type_are_named(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A lane that ends is on the main road unless its type says that it is a ramp."""
    told = "no lane is of a type for ramps (entry, exit, onRamp, offRamp): all are main road"
    for kind in ("driving", "entry"):
        ending = section(lane(-1) + lane(-2, kind=kind)) + section(lane(-1), s="60")
        path = write(tmp_path, road(1, line(), ending))
        assert main(["road", str(path)]) == 0
        assert (told in capsys.readouterr().out) == (kind == "driving")
