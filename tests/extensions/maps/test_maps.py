"""Stretches of maps in OpenDRIVE: bends, widths that change, both directions, routes."""

from fractions import Fraction as F
from pathlib import Path

import pytest

import roadproof as rp
from roadproof.errors import InputError, UsageError
from roadproof.extensions.maps.opendrive import read_map
from roadproof.extensions.maps.selection import read_selection
from roadproof.extensions.maps.stretch import select
from roadproof.frontends.cli.main import main
from roadproof.world.models import load_road

MAP = Path(__file__).parents[3] / "examples" / "maps" / "motorway.xodr"


def road(number: int, geometry: str, lanes: str, link: str = "", **more: str) -> str:
    said = {"length": "100", "junction": "-1", "id": str(number)} | more
    told = " ".join(f'{name}="{value}"' for name, value in said.items())
    plan = f"<planView>{geometry}</planView>"
    return f"<road {told}><link>{link}</link>{plan}<lanes>{lanes}</lanes></road>"


def section(right: str = "", left: str = "", s: str = "0") -> str:
    return f'<laneSection s="{s}"><left>{left}</left><center/><right>{right}</right></laneSection>'


def lane(number: int, width: str = 'a="3.5" b="0" c="0" d="0"', kind: str = "driving", link: str = "") -> str:
    widths = f'<width sOffset="0" {width}/>'
    return f'<lane id="{number}" type="{kind}"><link>{link}</link>{widths}</lane>'


def line(x: float = 0, y: float = 0, heading: float = 0, length: float = 100) -> str:
    return f'<geometry s="0" x="{x}" y="{y}" hdg="{heading}" length="{length}"><line/></geometry>'


def write(folder: Path, *roads: str) -> Path:
    path = folder / "a.xodr"
    path.write_text(f"<OpenDRIVE><header/>{''.join(roads)}</OpenDRIVE>")
    return path


def test_a_motorway_of_another_tool_has_bends_and_ramps() -> None:
    right, left = rp.stretches(MAP)
    assert (right.direction, right.lanes, right.radius) == ("along s", (2, 3), 400)
    assert [(x.zone, x.begin, x.end) for x in right.zones] == [("merge", 400, 700), ("depart", 1000, 1300)]
    assert right.length_error.share == F(11) / 400
    assert (left.direction, left.lanes, left.zones) == ("against s", (2, 2), ())


def test_lanes_that_are_driven_against_s_are_seen_from_the_other_end() -> None:
    there, back = load_road(f"{MAP}#lanes=right"), load_road(f"{MAP}#lanes=left")
    assert there.line is not None
    assert back.line is not None
    assert back.line.place(100.0, -2.0) == pytest.approx(there.line.place(1500.0, 2.0), abs=1e-6)
    assert {x.d for x in back.lanelets} == {(F(-15, 2), F(-15, 4)), (F(-15, 4), F(0))}


def test_a_part_is_cut_along_s_of_the_map() -> None:
    part = load_road(f"{MAP}#lanes=right,from=350,to=450")
    assert min(x.s[0] for x in part.lanelets if x.s[0] is not None) == 350
    assert max(x.s[1] for x in part.lanelets if x.s[1] is not None) == 450
    back = load_road(f"{MAP}#lanes=left,from=350,to=450")
    assert {x.s for x in back.lanelets if x.s[0] is not None and x.s[0] < 1200} == {(1150, 1200)}


def test_a_width_that_changes_is_constant_in_steps(tmp_path: Path) -> None:
    wide = section(lane(-1) + lane(-2, 'a="0" b="0.1" c="-0.0006" d="0"'))
    path = write(tmp_path, road(1, line(), wide))
    for step, most in (("1", 0.5), ("0.25", 0.126), ("0.05", 0.026)):
        (found,) = rp.stretches(f"{path}#step={step}")
        assert 0 < found.width_error <= most
        for x in found.lanelets:
            if x.lane != "main-1":
                continue
            for s in (x.s[0] or 0, x.s[1] or 0):
                width = s / 10 - 6 * s * s / 10_000
                assert abs(float(x.d[1] - x.d[0] - width)) <= found.width_error + 1e-9


def test_lanes_of_left_hand_traffic_are_to_the_left(tmp_path: Path) -> None:
    both = section(lane(-1), lane(1) + lane(2))
    path = write(tmp_path, road(1, line(), both, rule="LHT"))
    along, against = (
        rp.stretches(path)[::-1] if rp.stretches(path)[0].direction == "against s" else rp.stretches(path)
    )
    assert [x.d for x in along.lanelets] == [(0, F(7, 2)), (F(7, 2), 7)]
    assert [x.d for x in against.lanelets] == [(0, F(7, 2))]
    assert load_road(path).lanelets == along.lanelets


LINKED = (
    '<predecessor elementType="road" elementId="1" contactPoint="end"/>',
    '<predecessor id="-1"/>',
)


def test_a_route_is_one_road(tmp_path: Path) -> None:
    first = road(1, line(), section(lane(-1)))
    turned = '<geometry s="0" x="100" y="-0.5" hdg="0" length="100"><arc curvature="0.01"/></geometry>'
    second = road(2, turned, section(lane(-1, link=LINKED[1])), LINKED[0], junction="7")
    path = write(tmp_path, first, second)
    route = load_road(f"{path}#route=1+2")
    assert [(x.lane, x.s) for x in route.lanelets] == [("main-1", (0, 100)), ("main-1", (100, 200))]
    assert route.line is not None
    before, after = route.line.place(99.999, 0), route.line.place(100.001, 0)
    assert after == pytest.approx(before, abs=0.01)
    assert [x.d for x in route.lanelets] == [(F(-7, 2), 0), (F(-4), F(-1, 2))]
    crossing = road(3, line(50, -50, 1.57), section(lane(-1)))
    path = write(tmp_path, first, crossing)
    with pytest.raises(InputError, match="only traffic along one road is supported, no crossing traffic"):
        load_road(f"{path}#route=1+3")


@pytest.mark.parametrize(
    ("said", "rule"),
    [
        ("#rode=1", "'rode=1': after # write road=ID"),
        ("#road=1,road=2", "'road=2': after #"),
        ("#road=1,route=1+2", "road and route: name one"),
        ("#lanes=up", "lanes=up: one of left, right"),
        ("#from=9,to=4", "from=9 is not below to=4"),
        ("#from=x", "from=x: a number of metres"),
        ("#step=0", "step=0: at least 0.01 m"),
    ],
)
def test_what_is_selected_has_to_be_well_said(said: str, rule: str) -> None:
    with pytest.raises(UsageError, match=rule):
        read_selection(f"a.xodr{said}")


@pytest.mark.parametrize(
    ("said", "rule"),
    [
        ("#road=9", "there is no road 9"),
        ("#from=9000", "the road goes from 0 m to 1600 m"),
    ],
)
def test_what_is_selected_has_to_be_there(said: str, rule: str) -> None:
    with pytest.raises(InputError, match=rule):
        load_road(f"{MAP}{said}")


def test_of_several_roads_one_has_to_be_named(tmp_path: Path) -> None:
    path = write(tmp_path, road(1, line(), section(lane(-1))), road(2, line(0, 50), section(lane(-1))))
    with pytest.raises(InputError, match=r"2 roads \(1, 2\); name one as"):
        load_road(path)
    assert load_road(f"{path}#road=2").line.place(0, 0) == (0, 50)  # type: ignore[union-attr]


@pytest.mark.parametrize(
    ("old", "new", "rule"),
    [
        ('curvature="0.0025"', 'curvature="0.05"', "geometry 4: it begins .* m from where the one before"),
        ('rule="RHT"', 'rule="UK"', "rule=UK: one of RHT, LHT"),
        ('id="2" type="driving"', 'id="-7" type="driving"', "lane -7: ids on the left are 1, 2"),
    ],
)
def test_what_a_map_may_not_say(old: str, new: str, rule: str, tmp_path: Path) -> None:
    text = MAP.read_text()
    assert old in text
    path = tmp_path / "a.xodr"
    path.write_text(text.replace(old, new, 1))
    with pytest.raises(InputError, match=rule):
        read_map(path)


def test_the_command_lists_and_draws(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    picture = tmp_path / "a.svg"
    assert main(["road", f"{MAP}#lanes=right,from=300,to=900", "--out", str(picture)]) == 0
    told = capsys.readouterr().out
    assert "merge zone from 400 m to 700 m" in told
    assert "main-2c        main    s 700 to 900" in told
    assert picture.read_bytes().startswith(b"<?xml")
    assert main(["road", str(MAP), "--out", str(tmp_path / "a.pdf")]) == 2


def test_a_polyline_of_poly3_and_of_parametric_cubics_joins(tmp_path: Path) -> None:
    cubics = (
        '<geometry s="0" x="0" y="0" hdg="0" length="50"><poly3 a="0" b="0" c="0.001" d="0"/></geometry>'
        '<geometry s="50" x="49.9172" y="2.4917" hdg="0.0995" length="50">'
        '<paramPoly3 pRange="arcLength" aU="0" bU="1" cU="0" dU="0" aV="0" bV="0" cV="0.001" dV="0"/>'
        "</geometry>"
    )
    path = write(tmp_path, road(1, cubics, section(lane(-1))))
    found = select(path, read_selection(str(path))[1])
    before, after = (found.line.place(s, 0) for s in (49.99, 50.01))
    assert after == pytest.approx(before, abs=0.03)
