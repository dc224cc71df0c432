"""Road and vehicle models: what comes along, what users write, what contradicts itself."""

import os
import random
import subprocess
import sys
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import pytest

import roadproof as rp
from roadproof.errors import InputError
from roadproof.frontends.cli.main import main
from roadproof.runtime.package_data import shipped
from roadproof.world.lanelet_rules import shared_boundaries
from roadproof.world.models import load_road, load_vehicle, names_of
from roadproof.world.road import Lanelet, Road
from tables import read_table

ROAD = """
[[lanelet]]
id = "a"
lane = "one"
zone = "main"
attribute = "main"
s = [-inf, 100]
d = [0, "7/2"]

[[lanelet]]
id = "b"
lane = "one"
zone = "merge"
attribute = "main"
s = [100, inf]
d = [0, 3.5]

[[lanelet]]
id = "c"
lane = "two"
zone = "merge"
attribute = "merge"
s = [100, 300.25]
d = [-3.5, 0]
"""


def written(tmp_path, text):
    path = tmp_path / "model.toml"
    path.write_text(text, "utf-8")
    return path


def test_reference_roads():
    assert {"depart", "main-2", "main-3", "merge"} <= set(names_of("roads"))
    lanes = {name: load_road(name).lanes for name in names_of("roads")}
    assert lanes["main-3"] == ("main-1", "main-2", "main-3")
    assert lanes["merge"] == ("main-1", "main-2", "merge-1")
    assert lanes["depart"] == ("main-1", "main-2", "departure-1")
    merge = load_road("merge")
    assert merge.beside("merge-1") == ("main-1",)
    assert {x.lane for x in merge.lanelets_in("merge")} == {"main-1", "main-2", "merge-1"}
    assert {x.attribute for x in merge.lanelets_in("merge")} == {"main", "merge"}
    for name in names_of("roads"):
        assert all(x.d[1] - x.d[0] == Fraction(7, 2) for x in load_road(name).lanelets)


def test_kinds_of_vehicles_fit_their_lanes_and_each_other():
    """Every model is read, fits a lane of 3.5 m, and cruises within its limits; from short to long."""
    models = {name: load_vehicle(name) for name in names_of("vehicles")}
    assert [*models] == ["bus", "car", "motorcycle", "truck"]
    for model in models.values():
        assert model.width < Fraction(7, 2)
        assert model.v_lon[0] <= model.cruise[0] < model.cruise[1] <= model.v_lon[1]
    lengths = [models[name].length for name in ("motorcycle", "car", "bus", "truck")]
    assert lengths == sorted(lengths)


def test_a_road_is_shown_alike_in_every_process():
    """Answers are kept under fingerprints of what was asked, and sets have another order in each process."""
    code = "from roadproof.world.models import load_road; print(repr(load_road('main-3')))"
    shown = {
        subprocess.run(
            [sys.executable, "-c", code],
            env={**os.environ, "PYTHONHASHSEED": seed},
            capture_output=True,
            text=True,
            check=True,
        ).stdout
        for seed in "123"
    }
    assert len(shown) == 1


def test_a_users_road_is_read_exactly(tmp_path):
    road = load_road(written(tmp_path, ROAD))
    assert road.name == "model"
    assert road.lanelets[0].s == (None, 100)
    assert road.lanelets[0].d == (0, Fraction(7, 2))
    assert road.lanelets[2].s == (100, Fraction(1201, 4))
    assert road.adjacent == frozenset({frozenset({"one", "two"})})
    assert shared_boundaries(road.lanelets[:2]) == frozenset()


@pytest.mark.parametrize(
    ("old", "new", "message"),
    read_table(__file__, "contradictory_roads_are_refused"),
)
def test_contradictory_roads_are_refused(tmp_path, old, new, message):
    assert old in ROAD
    path = written(tmp_path, ROAD.replace(old, new, 1))
    with pytest.raises(InputError, match=message):
        load_road(path)


CAR = (shipped("models") / "vehicles" / "car.toml").read_text("utf-8")


@pytest.mark.parametrize(
    ("old", "new", "message"),
    read_table(__file__, "contradictory_vehicles_are_refused"),
)
def test_contradictory_vehicles_are_refused(tmp_path, old, new, message):
    assert old in CAR
    with pytest.raises(InputError, match=message):
        load_vehicle(written(tmp_path, CAR.replace(old, new, 1)))


def test_what_cannot_be_read(tmp_path):
    with pytest.raises(InputError, match="there are depart, main-2, main-3, merge"):
        load_road("motorway")
    with pytest.raises(InputError, match="cannot read"):
        load_road(tmp_path / "none.toml")
    with pytest.raises(InputError, match="cannot read"):
        load_road(str(tmp_path / "x.toml"))
    binary = tmp_path / "b.toml"
    binary.write_bytes(b"\xff\x00")
    with pytest.raises(InputError, match="not UTF-8"):
        load_vehicle(binary)
    with pytest.raises(InputError, match="at least one"):
        load_road(written(tmp_path, ""))


# --- Roads in OpenDRIVE: reference roads come out; what is not straight, or of two zones, is refused

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
