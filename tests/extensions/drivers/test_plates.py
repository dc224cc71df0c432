"""Pictures of plates: areas end with their lines, SV has passed where that is said, words are whole."""

import random
from fractions import Fraction as F
from itertools import combinations, pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from matplotlib.path import Path as Polygon
from matplotlib.text import Text

import roadproof as rp
from extensions.drivers.read import boundary
from extensions.drivers.simulated import Car, Case, Simulation
from roadproof.errors import InputError
from roadproof.evidence.codec import write
from roadproof.extensions.drivers.lines import PlateLine, SpanEnd, line_of_truth
from roadproof.extensions.drivers.manoeuvres import CUT_IN, KMH, Plane, line, plane_of
from roadproof.extensions.drivers.preventable import areas
from roadproof.extensions.drivers.preventable.drawing import draw_sheet
from roadproof.extensions.drivers.preventable.own_tests import OwnTest, placed_tests, read_tests

RANGE = (0.0, 100.0)


def line_at(at: float, *spans: tuple[float, float]) -> PlateLine:
    return PlateLine(F(at), tuple((SpanEnd(a, str(a)), SpanEnd(b, str(b))) for a, b in spans))


def random_lines(rng: random.Random) -> list[PlateLine]:
    """Lines with no, one or two spans."""
    lines = []
    for at in range(12):
        count = rng.choice((0, 1, 1, 1, 2))
        ends = sorted(rng.uniform(*RANGE) for _ in range(2 * count))
        lines.append(line_at(at, *zip(ends[::2], ends[1::2], strict=True)))
    return lines


def area_faults(lines: list[PlateLine], outlines: list[Any]) -> list[str]:
    """Places that are shaded and should not be, and the other way round, read with polygons of matplotlib."""
    polygons = [Polygon([*x, x[0]]) for x in outlines if len(x) > 2]

    def shaded(place: float, at: float) -> bool:
        return any(x.contains_point((place, at)) for x in polygons)

    faults = []
    for low, high in pairwise(lines):
        for place in np.linspace(0.5, 99.5, 67):
            for share in (0.02, 0.5, 0.98):
                at = float(low.at) + share * float(high.at - low.at)
                same = len(low.spans) == len(high.spans)
                between = [
                    ((1 - share) * a.near + share * c.near, (1 - share) * b.near + share * d.near)
                    for (a, b), (c, d) in zip(low.spans, high.spans, strict=same)
                    if same
                ]
                if any(abs(place - x) < 0.01 for ends in between for x in ends):
                    continue
                expected = any(a < place < b for a, b in between)
                if shaded(float(place), at) != expected:
                    faults.append(f"{place} at {at}")
    return faults


def test_areas_are_between_spans_of_lines_beside_each_other_and_end_with_them() -> None:
    rng = random.Random(3)
    for _ in range(25):
        lines = random_lines(rng)
        assert area_faults(lines, [*areas.unpreventable_areas(lines)]) == []


def test_an_area_from_the_first_to_the_last_end_is_found() -> None:
    lines = [line_at(k, (10, 20), (60, 80)) for k in range(4)]
    assert area_faults(lines, [*areas.unpreventable_areas(lines)]) == []
    whole = [[(10, 0), (10, 3), (80, 3), (80, 0)]]
    assert area_faults(lines, whole) != []
    lone = [line_at(0), line_at(1, (10, 20)), line_at(2, (10, 20)), line_at(3)]
    assert area_faults(lone, [*areas.unpreventable_areas(lone)]) == []
    assert area_faults(lone, [[(10, 0.5), (10, 2.5), (20, 2.5), (20, 0.5)]])  # half a step more


def test_boundaries_leave_out_ends_of_the_range() -> None:
    lines = [line_at(0, (0, 30)), line_at(1, (5, 100)), line_at(2, (8, 90))]
    found = [*areas.boundaries(lines, RANGE)]
    assert found == [[(5, 1), (8, 2)], [(30, 0)], [(90, 2)]]


# --- where SV has passed ---------------------------------------------------------------------------


def has_passed(values: dict[str, F], model: str) -> bool:
    """Whether SV, driven by the model, is past POV when that comes beside it; simulated in steps."""
    x = {name: float(value) for name, value in values.items()}
    lane = x["width"] + x["dy0"]
    left, speed = (lane + x["width"]) / 2, x["Ve0"]
    mine = Car(0.0, left, speed, 0.0, (), x["length"], x["width"])
    other = Car(x["dx0"] + x["length"], left + lane, speed - x["dV0"], -x["Vy"], (), x["length"], x["width"])
    simulation = Simulation(Case("cut-in", (mine, other), (0.0, lane), (lane, 2 * lane), 0.0), 12.0)
    beside = int(np.flatnonzero(simulation.beside(0))[0])
    simulation.run(model)
    rear = simulation.me["s"][: beside + 1] - x["length"]
    return bool((rear > simulation.others[0]["s"][: beside + 1]).any())


@pytest.mark.parametrize("model", ["careful", "r157", "eu1426", "rss"])
def test_sv_has_passed_left_of_the_first_span_and_nowhere_else(model: str) -> None:
    assert areas.tells_passed("cut-in", False, {"cc_gate": "none"})
    rng, formula = random.Random(11), boundary("cut-in", model)
    left = right = 0
    for _ in range(12):
        fixed = {
            "Ve0": rng.randint(30, 130) * KMH,
            "Vy": F(rng.randint(3, 20), 10),
            "dy0": F(rng.randint(5, 25), 10),
        }
        where: Plane = plane_of(CUT_IN, fixed, CUT_IN.along, CUT_IN.range, 7)
        lines = [line_of_truth(row, line(where, formula, row)) for row in where.rows]
        for one in lines[1:]:
            if not one.spans:
                continue
            first, last = one.spans[0][0].near, one.spans[-1][1].near
            for place in (0.5 * first, first - 0.2, first + 0.2, last + 0.2):
                if 0 <= place <= 120 and min(abs(place - x) for x in (first, last)) > 0.1:
                    values = where.values(one.at, F(round(place * 100), 100))
                    is_left = place < first
                    assert has_passed(values, model) == is_left, (values, first, last)
                    left, right = left + is_left, right + (not is_left)
    assert left > 8
    assert right > 20


def test_passed_areas_are_where_all_models_say_so() -> None:
    one = [line_at(0, (0, 20)), line_at(1, (10, 30)), line_at(2, (20, 40)), line_at(3)]
    other = [line_at(0, (0, 25)), line_at(1, (6, 30)), line_at(2, (25, 40)), line_at(3, (30, 50))]
    [found] = areas.passed_areas([one, other], RANGE)
    assert [*found] == [(0, 1), (0, 2), (20, 2), (6, 1)]
    assert not [*areas.passed_areas([], RANGE)]
    for manoeuvre, is_stepped, gate in (
        ("deceleration", False, "none"),
        ("cut-in", True, "none"),
        ("cut-in", False, "before_delay"),
    ):
        assert not areas.tells_passed(manoeuvre, is_stepped, {"cc_gate": gate})


# --- the picture -----------------------------------------------------------------------------------


def word_faults(figure: Any) -> list[tuple[str, ...]]:
    """The texts of a figure that lie on each other or are not wholly on it."""
    figure.draw_without_rendering()
    width, height = figure.bbox.width, figure.bbox.height
    shown = [x for x in figure.findobj(Text) if x.get_visible() and x.get_text().strip()]
    shown = [x for x in shown if x.axes is None or x.axes.axison]
    boxes = [(x.get_text(), x.get_window_extent()) for x in shown]
    cut = [(t,) for t, b in boxes if b.x0 < 0 or b.y0 < 0 or b.x1 > width or b.y1 > height]
    return cut + [(a, c) for (a, b), (c, d) in combinations(boxes, 2) if b.overlaps(d)]


def sheet(manoeuvre: str, models: list[str], **more: Any) -> Any:
    found = rp.preventable(manoeuvre, models, lines=4, lemmas=False, jobs=1, **more)
    return draw_sheet(found.question, found.plates)


def words(figure: Any) -> str:
    return " ".join(x.get_text() for x in figure.findobj(Text))


FIXED = {"Ve0": "60 km/h", "Vy": 1, "dy0": 2, "length": 5, "width": 2}


def test_titles_are_whole_and_no_word_lies_on_another(tmp_path: Path) -> None:
    table = tmp_path / "tests.csv"
    table.write_text("test,Ve0,dV0,Vy,dx0\na,16.7,8,1,20\nb,30,9,1,25\n", "utf-8")
    for figure in (
        sheet("cut-in", ["careful"], at=FIXED),
        sheet("cut-in", ["careful", "r157", "eu1426", "rss"], at={"Ve0": "60 km/h", "Vy": 1}, tests=table),
        sheet("cut-in", ["careful"], at={**FIXED, "Ve0": ["60 km/h", "90 km/h"], "dy0": [1, 2]}),
        sheet("deceleration", ["careful"], at={"Ve0": ["60 km/h", "130 km/h"]}),
        sheet("cut-in", ["fsm"], at={"Ve0": "60 km/h", "Vy": 1}),
    ):
        assert word_faults(figure) == []
        plates = [x for x in figure.axes if x.axison]
        assert all("[" in x.get_xlabel() and "[" in x.get_ylabel() for x in plates)


def test_a_title_that_is_cut_off_is_found() -> None:
    figure = sheet("deceleration", ["careful"], at={"Ve0": "60 km/h"})
    figure.texts[0].set_text("a collision is unpreventable in what is shaded, " * 3)
    assert word_faults(figure)


@pytest.mark.parametrize(
    ("along", "across", "told"),
    [
        (("60 m", "70 m"), None, "preventable on all lines"),
        ((1, 2), ("8 km/h", "10 km/h"), "unpreventable on all lines"),
    ],
)
def test_an_empty_and_a_full_plate_say_so_and_have_a_legend(along: Any, across: Any, told: str) -> None:
    at = {"Ve0": "60 km/h", "Vy": 1}
    figure = sheet("cut-in", ["careful"], at=at, along=along, across=across)
    said = words(figure)
    assert f"competent and careful driver:\n{told}" in said
    assert "shaded: unpreventable" in said
    assert "white: preventable" in said
    assert word_faults(figure) == []


def test_the_side_where_sv_has_passed_has_a_word_where_there_is_one() -> None:
    at = {"Ve0": "60 km/h", "Vy": 1}
    assert "dotted: SV has passed POV" in words(sheet("cut-in", ["careful"], at=at))
    assert "SV has passed" not in words(sheet("deceleration", ["careful"], at={"Ve0": "60 km/h"}))


# --- tests of the reader ---------------------------------------------------------------------------


def test_tests_are_read_from_a_table_of_the_catalogue(tmp_path: Path) -> None:
    path = tmp_path / "drivers.csv"
    path.write_text(
        "test,scenario,driver,Ve0,dV0,Vy,Gx,dx0,dy0\n"
        "a,scenario_1,careful,30,5,0.5,,20,1.6\n"
        "a,scenario_1,rss,30,5,0.5,,20,1.6\n"
        "b,scenario_4,careful,30,5,,3,20,\n"
        "c,scenario_9,careful,25,0,1,,10.5,\n"
        "d,scenario_1,careful,,,,,,\n",
        "utf-8",
    )
    found = read_tests(path, CUT_IN)
    assert [x.name for x in found] == ["a", "c"]
    assert found[1].values == {"Ve0": 25, "dV0": 0, "Vy": 1, "dx0": F("10.5")}
    for text, told in (
        ("test,dx0\na,3\n", "no column dV0"),
        ("test,dx0,dV0\na,3,fast\n", "line 2: dV0=fast"),
        ("", "no column"),
    ):
        path.write_text(text, "utf-8")
        with pytest.raises(InputError, match=told):
            read_tests(path, CUT_IN)


def test_each_test_is_on_the_nearest_plate_and_outside_the_ranges_on_none() -> None:
    rng = random.Random(2)
    ranges = {"dx0": (F(0), F(120)), "dV0": (F(0), F(20))}
    for _ in range(60):
        plates = [
            {"Ve0": F(rng.randint(10, 40)), "Vy": F(rng.randint(3, 20), 10)} for _ in range(rng.randint(1, 6))
        ]
        values = {"Ve0": F(rng.randint(10, 40)), "Vy": F(rng.randint(3, 20), 10)}
        values |= {"dx0": F(rng.randint(-10, 140)), "dV0": F(rng.randint(-2, 22))}
        found = [*placed_tests([OwnTest(name="a", values=values)], CUT_IN, plates, ranges)]
        inside = 0 <= values["dx0"] <= 120 and 0 <= values["dV0"] <= 20
        assert len(found) == inside
        far = [max(abs(float(values[n]) / float(x) - 1) for n, x in plate.items()) for plate in plates]
        for x in found:
            assert far[x.plate] == pytest.approx(min(far))
            assert x.has_values == (min(far) <= 0.01)


def test_tests_are_counted_in_words(tmp_path: Path) -> None:
    table = tmp_path / "tests.csv"
    table.write_text("test,Ve0,dV0,Vy,dx0\nmine,16.7,8,1,20\nother,30,9,1,25\nfar,30,9,1,250\n", "utf-8")
    at = {"Ve0": "60 km/h", "Vy": 1}
    found = rp.preventable("cut-in", ["careful"], at=at, lines=3, lemmas=False, jobs=1, tests=table)
    assert "tests: 2 drawn, 1 with the fixed values of their plate, 1 with others" in str(found)
    assert "1 outside the ranges" in str(found)
    assert "mine: Ve0 60.12 km/h" in str(found)
    again = type(found.question).of(found.question.basis, write(found.question.settings), "the question")
    assert again.placed_tests == found.question.placed_tests
