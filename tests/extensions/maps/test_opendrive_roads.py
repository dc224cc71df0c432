"""Roads in OpenDRIVE: reference roads come out; what is not straight, or of two zones, is refused."""

import random
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import pytest

import roadproof as rp
from roadproof.errors import InputError
from roadproof.frontends.cli.main import main
from roadproof.world.models import load_road
from roadproof.world.road import Lanelet, Road
from tables import read_table

TYPES = {"main": "driving", "merge": "onRamp", "departure": "exit"}
BEGIN, END = Fraction(-500), Fraction(900)
HEAD = '<header revMajor="1" revMinor="7" name="x" version="1.0"/>'
TURN = '<geometry s="1400" hdg="0.4" length="0"><line/></geometry>'
PLAN = '<planView><geometry s="0" x="5" y="7" hdg="0.3" length="{length}"><line/></geometry></planView>'


def sections(road: Road) -> list[tuple[Fraction, Fraction]]:
    ends = sorted({x for lanelet in road.lanelets for x in lanelet.s if x is not None and BEGIN < x < END})
    return list(zip([BEGIN, *ends], [*ends, END], strict=True))


def span(x: Lanelet) -> tuple[Fraction, Fraction]:
    return BEGIN if x.s[0] is None else x.s[0], END if x.s[1] is None else x.s[1]


def lane_xml(number: int, kind: str, width: Fraction) -> str:
    inner = f'<width sOffset="0" a="{float(width)!r}" b="0" c="0" d="0"/>'
    return f'<lane id="{number}" type="{kind}" level="false">{inner}</lane>'


def xodr(road: Road) -> str:
    """All lanes right of a reference line at d = 0, moved there by laneOffset; s counts from -500 m."""
    top = max(x.d[1] for x in road.lanelets)
    parts = []
    for low, high in sections(road):
        here = [x for x in road.lanelets if span(x)[0] <= low and high <= span(x)[1]]
        here.sort(key=lambda x: -x.d[0])
        lanes = [lane_xml(-k, TYPES[x.attribute], x.d[1] - x.d[0]) for k, x in enumerate(here, start=1)]
        lanes.append(lane_xml(-len(here) - 1, "shoulder", Fraction(2)))
        centre = '<center><lane id="0" type="none"/></center>'
        left = f"<left>{lane_xml(1, 'driving', Fraction(3))}</left>"
        sides = f"{left}{centre}<right>{''.join(lanes)}</right>"
        parts.append(f'<laneSection s="{low - BEGIN}">{sides}</laneSection>')
    offset = f'<laneOffset s="0" a="{float(top)!r}" b="0" c="0" d="0"/>'
    plan = PLAN.format(length=END - BEGIN)
    lanes_of = f"<lanes>{offset}{''.join(parts)}</lanes>"
    body = f'<road id="1" length="{END - BEGIN}" junction="-1">{plan}{lanes_of}</road>'
    return f'<?xml version="1.0"?><OpenDRIVE>{HEAD}{body}</OpenDRIVE>'


def ended(road: Road) -> Road:
    """A departure lane that ends with its zone, as that of a section does."""
    last = {x.s[1] for x in road.lanelets if x.zone == "depart" and x.attribute == "main"}
    lanelets = [replace(x, s=(x.s[0], max(last))) if x.attribute == "departure" else x for x in road.lanelets]
    return replace(road, lanelets=tuple(lanelets))


def told(x: Lanelet, by: Fraction = Fraction(0)) -> tuple[object, ...]:
    low, high = span(x)
    return x.lane, x.zone, x.attribute, low + by, high + by, x.d


@pytest.mark.parametrize("name", ["main-2", "main-3", "merge", "depart", "weave"])
def test_reference_roads_of_opendrive(name: str, tmp_path: Path) -> None:
    road = ended(load_road(name))
    path = tmp_path / f"{name}.xodr"
    path.write_text(xodr(road))
    read = load_road(path)
    assert {told(x) for x in read.lanelets} == {told(x, -BEGIN) for x in road.lanelets}
    assert read.adjacent == road.adjacent


def test_a_drive_on_it(tmp_path: Path) -> None:
    path = tmp_path / "merge.xodr"
    path.write_text(xodr(load_road("merge")))
    (drive,) = rp.witness(12, road=path).drives
    assert rp.monitor(12, drive).verdict == "true"
    assert {x.lane for x in drive.file.road.lanelets} == {"main-1", "main-2", "merge-1"}


@pytest.mark.parametrize(
    ("old", "new", "said"),
    read_table(__file__, "what_is_refused"),
)
def test_what_is_refused(
    old: str, new: str, said: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "a.xodr"
    text = xodr(load_road("merge"))
    assert old in text
    path.write_text(text.replace(old, new) if "Scenario" in new else text.replace(old, new, 1))
    if not said:
        assert {x.zone for x in load_road(path).lanelets} == {"main"}
        return
    with pytest.raises(InputError, match=said):
        load_road(path)
    assert main(["witness", "4", "--road", str(path), "--quiet"]) == 3
    message = capsys.readouterr().err
    assert "a.xodr" in message
    assert "Traceback" not in message


def test_two_zones_in_one_section(tmp_path: Path) -> None:
    path = tmp_path / "a.xodr"
    text = xodr(load_road("merge"))
    exit_lane = '<lane id="-9" type="exit"><width sOffset="0" a="3" b="0" c="0" d="0"/></lane>'
    head, mark, rest = text.partition('type="onRamp"')
    path.write_text(head + mark + rest.replace("</right>", f"{exit_lane}</right>", 1))
    with pytest.raises(InputError, match="laneSection 2: merge and departure lanes"):
        load_road(path)


def test_hurt_files(tmp_path: Path) -> None:
    """150 random cuts and changes: a road, or an InputError that names the file."""
    path, chance, refused = tmp_path / "a.xodr", random.Random(3), 0
    text = xodr(load_road("merge"))
    for _ in range(150):
        begin = chance.randrange(len(text))
        end = min(len(text), begin + chance.randrange(1, 30))
        path.write_text(text[:begin] + chance.choice(["", "0", "<x/>", "-", "1e9", "x", "1/0"]) + text[end:])
        said = refusal(path)
        assert said is None or "a.xodr" in said
        refused += said is not None
    assert refused > 90


def refusal(path: Path) -> str | None:
    try:
        load_road(path)
    except InputError as error:
        return str(error)
    return None
