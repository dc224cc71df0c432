"""Road and vehicle models: what comes along, what users write, what contradicts itself."""

import os
import subprocess
import sys
from fractions import Fraction

import pytest

from roadproof.errors import InputError
from roadproof.runtime.package_data import shipped_folder
from roadproof.world.lanelet_rules import shared_boundaries
from roadproof.world.models import load_road, load_vehicle, names_of
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
    assert merge.adjacent_lanes("merge-1") == ("main-1",)
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


CAR = (shipped_folder("models") / "vehicles" / "car.toml").read_text("utf-8")


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
