"""The moving picture of a drive, tested on what is drawn at each instant, not on pixels."""

import xml.etree.ElementTree as ElementTree
from dataclasses import replace
from fractions import Fraction as F

import pytest

from report.test_drive import FOUR, LIBRARY, driving, file_of
from roadproof.evidence.drive_file import DriveFile
from roadproof.frontends.report.drive import DANGER
from roadproof.frontends.report.drive_data import danger_spans, vehicles_of
from roadproof.frontends.report.moving import Scene, draw_moving

SVG = "{http://www.w3.org/2000/svg}"
CROSSING = {"SV": driving(0, 20), "POV": driving(-25, 30, F(13, 2), F(-1, 2))}
BEHIND = {"SV": driving(100, 20), "POV": driving(0, 30)}
THREE = {"SV": driving(0, 30), "POV1": driving(60, 28), "POV2": driving(105, 20)}
DRIVES = {
    "ahead": file_of(),
    "overtaken": file_of(None, "F danger(SV, POV)", **CROSSING),
    "behind": file_of(None, "F danger(SV, POV)", **BEHIND),
    "three": file_of(2, "scenario_2(SV, POV1, POV2, L)", **THREE),
}


def rectangles(file: DriveFile) -> list[ElementTree.Element]:
    root = ElementTree.fromstring(draw_moving(file, LIBRARY))
    return [x for x in root.iter(f"{SVG}rect") if x.get("x") is not None]


def at_instants(shape: ElementTree.Element, instants: int) -> list[tuple[float, ...]]:
    """Left, top, width and height at each instant, as a browser shows them."""
    moved = {x.get("attributeName"): (x.get("values") or "").split(";") for x in shape.iter(f"{SVG}animate")}
    still = [[shape.get(name) or ""] * instants for name in ("x", "y", "width", "height")]
    shown = [moved.get(name, same) for name, same in zip(("x", "y", "width", "height"), still, strict=True)]
    return [tuple(float(values[k]) for values in shown) for k in range(instants)]


def meet(one: tuple[float, ...], other: tuple[float, ...], room: float) -> bool:
    """Whether two boxes meet, if both were wider by ``room`` pixels."""
    return min(other[2:]) > 0 and all(
        one[k] < other[k] + other[k + 2] + room and other[k] < one[k] + one[k + 2] + room for k in (0, 1)
    )


def drawn(shapes: list[ElementTree.Element], colour: str) -> ElementTree.Element:
    """The first shape of a colour, which is the vehicle; strips over time stand below it."""
    return next(x for x in shapes if x.get("fill") == colour and not x.get("fill-opacity"))


def red_at(area: ElementTree.Element, times: list[F]) -> list[bool]:
    """Whether an area is red, at each instant."""
    [change] = [x for x in area.iter(f"{SVG}animate") if x.get("attributeName") == "fill"]
    values = (change.get("values") or "").split(";")
    since = [float(x) * 7 for x in (change.get("keyTimes") or "").split(";")]
    return [values[sum(begin <= time + F(1, 1000) for begin in since) - 1] == DANGER for time in times]


@pytest.mark.parametrize("name", DRIVES)
def test_an_area_is_red_exactly_while_the_vehicle_is_in_it(name: str) -> None:
    file = DRIVES[name]
    scene = Scene(file, LIBRARY)
    shapes = rectangles(file)
    areas = [x for x in shapes if x.get("fill-opacity")]
    others = vehicles_of(file)[1:]
    assert len(areas) == len(others)
    seen = set()
    for other, area in zip(others, areas, strict=True):
        box = drawn(shapes, scene.colours[other])
        boxes, reached = (at_instants(x, len(scene.times)) for x in (box, area))
        for red, one, two in zip(red_at(area, scene.times), boxes, reached, strict=True):
            assert meet(one, two, 0.3 if red else -0.3) == red
            seen.add(red)
    assert seen == {True, False}


@pytest.mark.parametrize("name", DRIVES)
def test_danger_is_red_for_as_long_as_it_must_last(name: str) -> None:
    scene = Scene(DRIVES[name], LIBRARY)
    areas = [x for x in rectangles(scene.file) if x.get("fill-opacity")]
    least = LIBRARY.parameters["minDanger"].value
    for other, area in zip(vehicles_of(scene.file)[1:], areas, strict=True):
        spans = danger_spans(scene.file, LIBRARY, "SV", other)
        red = red_at(area, scene.times)
        for k, time in enumerate(scene.times):
            last = min(len(red) - 1, k + int(least * 10))
            in_danger = any(begin < time < end for begin, end in spans)
            if in_danger:
                assert all(red[k : last + 1])
            elif all(red[k : last + 1]):
                assert any(abs(time - x) < 0.1 for span in spans for x in span)


def test_vehicles_stand_where_the_drive_has_them() -> None:
    scene = Scene(DRIVES["ahead"], LIBRARY)
    shapes = rectangles(DRIVES["ahead"])
    sv, pov = (drawn(shapes, scene.colours[name]) for name in ("SV", "POV"))
    ahead = [b[0] - a[0] for a, b in zip(*(at_instants(x, 61) for x in (sv, pov)), strict=True)]
    assert ahead[0] / scene.scale[0] == pytest.approx(105, abs=0.05)
    assert ahead[60] / scene.scale[0] == pytest.approx(45, abs=0.05)
    assert ahead[30] / scene.scale[0] == pytest.approx(75, abs=0.05)


def test_text_of_a_drive_cannot_become_markup() -> None:
    drawn = draw_moving(DRIVES["ahead"], LIBRARY, "<script>alert(1)</script> & more").decode()
    assert "<script" not in drawn
    assert "&lt;script&gt;alert(1)&lt;/script&gt; &amp; more" in drawn


def test_the_same_drive_gives_the_same_file() -> None:
    assert draw_moving(file_of(4, FOUR), LIBRARY) == draw_moving(file_of(4, FOUR), LIBRARY)


def test_a_drive_of_one_vehicle_speaks_of_no_distances() -> None:
    shown = draw_moving(file_of(None, "v_lon(SV) > 0 m/s", SV=driving(0, 30)), LIBRARY).decode()
    assert "the view follows SV<" in shown
    assert "RSS" not in shown
    assert "danger" not in shown


def test_danger_that_no_definition_speaks_of_has_no_row(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("roadproof.frontends.report.moving.danger_spans", lambda *_: None)
    shown = draw_moving(file_of(), LIBRARY).decode()
    assert "danger between" not in shown
    assert "danger begins" not in shown


@pytest.mark.parametrize(("horizon", "ticks"), [(6, 7), (40, 9), (4000, 9)])
def test_ticks_of_a_long_drive_do_not_run_into_each_other(horizon: int, ticks: int) -> None:
    root = ElementTree.fromstring(draw_moving(replace(file_of(), horizon=F(horizon)), LIBRARY))
    told = [x.text or "" for x in root.iter(f"{SVG}text")]
    assert sum(x.removesuffix(" s").isdecimal() for x in told) == ticks
