"""Where a start at s = 0 stands for all starts: by example, and on drives that are moved along."""

from dataclasses import replace
from fractions import Fraction

import pytest

from planting import plant
from roadproof.engines.encode import along
from roadproof.engines.encode.unroll import Grid
from roadproof.library.bind import bind
from roadproof.library.elaborate import read_claim, signature
from roadproof.world.drive import Drive
from searching.known import BASE, CAR, ROADS, VALUES, holds_on_samples, known

GRID = Grid(Fraction(3, 5), 10)


def bound(text, road="main-2", lane="main-1"):
    query = read_claim(BASE, text)
    lanes = dict.fromkeys(query.lanes, lane)
    return bind(query.formula, ROADS[road], lanes, VALUES), dict.fromkeys(query.vehicles, CAR)


def same(text, road="main-2"):
    formula, cars = bound(text, road)
    return along.is_same_everywhere(formula, ROADS[road], cars)


def starts(text, road="main-2"):
    formula, cars = bound(text, road)
    return along.starting_range([formula], ROADS[road], cars, GRID, Fraction(80))


@pytest.mark.parametrize(
    "text",
    [
        "s(SV) - s(POV) > 10 m",
        "F G v_lon(SV) > 20 m/s",
        "j_lon(SV) > 1 m/s^3",
        "rear(SV) > front(POV) and d(SV) > 3 m",
        "max(s(SV), s(POV)) - s(SV) < 3 m",
        "(s(SV) - s(POV))^2 > 9 * 1 m * 1 m",
        "s(SV)^2 - 2 * s(SV) * s(POV) + s(POV)^2 > 9 * 1 m * 1 m",
        "inverse(s(SV) - s(POV)) > inverse(3 m)",
        "atLane(SV, L) and danger(SV, POV)",
        *(f"scenario_{k}(SV, POV, L)" for k in (1, 3, 4, 5, 6, 7, 8)),
    ],
)
def test_differences_along_are_the_same_everywhere_on_an_endless_road(text):
    assert same(text)
    assert starts(text) is None
    assert not same(text, "merge")  # where a lane ends


@pytest.mark.parametrize(
    "text",
    [
        "s(SV) = 30 m",
        "rear(SV) > 30 m",
        "2 * s(SV) - 3 * s(POV) > 0 m",
        "s(SV) + s(POV) > 0 m",
        "F not (v_lon(SV) > 20 m/s and s(POV) <= 1 m)",
        "max(s(SV), 0 m) < s(POV)",
        "s(SV)^2 > 9 * 1 m * 1 m",
        "s(SV) * v_lat(SV) > s(POV) * v_lat(POV)",
        "inverse(s(SV)) > inverse(3 m)",
    ],
)
def test_places_along_are_not_the_same_everywhere(text):
    assert not same(text)
    assert starts(text) is not None


def test_what_is_named_is_within_a_drive_of_the_starts():
    fast, around = 40 * GRID.horizon, 1000
    assert starts("s(SV) = 500 m") == (-fast - around, 500 + CAR.length + around)
    assert starts("rear(SV) < -500 m") == (-500 + CAR.length - fast - around, CAR.length + around)
    assert starts("v_lon(SV) > 20 m/s", "merge") == (-100 - fast - around, 300 + CAR.length + around)
    far = "s(SV) = 30000000 m or s(SV) = 9000 m"
    assert starts(far) == (-fast - around, 9000 + CAR.length + around)


def is_right_about_moved_drives():
    """A drive moved along answers as before, wherever that is said of its formula."""
    for seed in range(25):
        case = known(seed)
        query = read_claim(BASE, case.text)
        lanes = {name: case.lanes[name] for name in query.lanes}
        formula = bind(query.formula, ROADS[case.road], lanes, VALUES)
        if along.is_same_everywhere(formula, ROADS[case.road], dict.fromkeys(query.vehicles, CAR)):
            for by in (Fraction(-1000, 3), Fraction(1, 10), Fraction(250)):
                cars = {n: replace(m, s=m.s + by) for n, m in case.drive.vehicles.items()}
                if not holds_on_samples(case.text, case.road, Drive(cars), case.grid, case.lanes):
                    return False
    return True


FAULTS = {
    "every road is endless": ("is_same_everywhere", "endless and", "True and"),
    "places are no matter": ("is_same_everywhere", "and not names_places(formula, vehicles)", ""),
    "each vehicle for itself": ("names_places", "any(", "all("),
    "the first factor only": (
        "slope_along",
        "if _is_moved(signal, place):",
        "if _is_moved(signal, place) and k == 0 and 1 > 2:",
    ),
}


@pytest.mark.parametrize("fault", FAULTS)
def test_faults_in_symmetry_are_caught(fault, monkeypatch):
    def right():
        texts = ("s(SV) = 30 m", "s(SV)^2 > 9 * 1 m * 1 m", "F v_lon(SV) > 20 m/s and s(POV) < 1 m")
        named = not any(same(text) for text in texts)
        return is_right_about_moved_drives() and named and not same("s(SV) > s(POV)", "merge")

    if fault == next(iter(FAULTS)):
        assert right()
    plant(monkeypatch, along, *FAULTS[fault])
    assert not right()


@pytest.mark.parametrize("number", range(9, 25))
def test_sectors_of_the_road_are_places(number):
    name = f"scenario_{number}"
    call = f"{name}({', '.join(signature(BASE, name))})"
    assert not same(call, "merge" if number < 17 else "depart")
