"""The picture of a drive: its shapes are those of the drive, and no label lies on another or is cut off."""

import io
import random
import subprocess
import sys
import xml.etree.ElementTree as ElementTree
from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction as F
from itertools import combinations
from pathlib import Path

import pytest
from matplotlib import font_manager
from matplotlib.ft2font import FT2Font
from PIL import Image

import roadproof as rp
from extensions.pages.report.test_bends import ARC, HAIRPIN
from extensions.pages.report.test_bends import file_of as bent_file_of
from extensions.pages.report.test_drive import LIBRARY, driving, file_of, meet, strips
from roadproof.evidence.drive_file import DriveFile
from roadproof.extensions.pages.artists import SHARP
from roadproof.extensions.pages.drive_axes import EDGE, PLOT, ticks_in
from roadproof.extensions.pages.drive_data import Box, dangers_of, distances_of
from roadproof.extensions.pages.drive_picture import Drawing, drawing_of
from roadproof.extensions.pages.drive_road import SNAPSHOTS, Snapshots
from roadproof.extensions.pages.labels import place_labels
from roadproof.extensions.pages.letters import lines_of, width_of
from roadproof.extensions.pages.shapes import LineShape, PolygonShape, RectangleShape, StrokesShape, TextShape
from roadproof.frontends.api.drives import DriveFolder
from roadproof.frontends.report.colours import COLOURS, DANGER, TRUE
from roadproof.frontends.report.picture import draw_drive
from roadproof.frontends.report.witness import Views
from roadproof.library.loading import load_library
from roadproof.library.specification import Source
from roadproof.world.models import load_road
from roadproof.world.motion import state_at

DRIVE = Path(__file__).parents[4] / "examples/traffic/drives/scenario-04-base.json"
THREE = {"SV": driving(0, 30), "POV1": driving(60, 28), "POV2": driving(105, 20)}


def texts(drawing: Drawing) -> list[TextShape]:
    return [x for x in drawing.shapes if isinstance(x, TextShape)]


def box_of(text: TextShape) -> Box:
    """Left, right, top and bottom of the letters of a text."""
    [(x, y)] = text.places
    wide = width_of(text.text, text.size)
    left = x - wide * {"start": 0.0, "middle": 0.5, "end": 1.0}[text.anchor]
    return left, left + wide, y - 0.75 * text.size, y + 0.2 * text.size


def label_faults(drawing: Drawing) -> list[tuple[str, ...]]:
    """The texts that lie on each other or reach beyond the sheet."""
    boxes = [(x.text, box_of(x)) for x in texts(drawing)]
    sheet = drawing.width, drawing.height
    cut = [(a,) for a, x in boxes if x[0] < 0 or x[2] < 0 or x[1] > sheet[0] or x[3] > sheet[1]]
    return cut + [(a, b) for (a, x), (b, y) in combinations(boxes, 2) if meet(x, y)]


def random_file(rng: random.Random) -> DriveFile:
    """A drive of one to four vehicles, close to each other or far apart, on one of the roads."""
    names = ["SV", "POV", "POV1", "POV2"][: rng.randint(1, 4)]
    spread = rng.choice((8, 60, 900))
    vehicles = {
        name: driving(
            rng.randint(-spread, spread),
            rng.randint(0, 40),
            F(rng.randint(-4, 24), 2),
            F(rng.randint(-2, 2), 2),
        )
        for name in names
    }
    others = [f"danger(SV, {x})" for x in names[1:]]
    formula = " and ".join([*(f"F {x}" for x in others), "F (v_lon(SV) > 3 m/s)"] * rng.randint(1, 4))
    road = load_road(rng.choice(("main-2", "main-3", "merge")))
    horizon = rng.choice((F(1, 2), F(6), F(25)))
    return replace(file_of(None, formula, **vehicles), road=road, horizon=horizon)


def test_no_label_lies_on_another_or_is_cut_off() -> None:
    rng = random.Random(5)
    for _ in range(40):
        file = random_file(rng)
        assert label_faults(drawing_of(file, LIBRARY)) == [], file
    for scenario, formula in (
        (2, "scenario_2(SV, POV1, POV2, L)"),
        (None, "F danger(SV, POV2) and " * 9 + "true"),
    ):
        assert label_faults(drawing_of(file_of(scenario, formula, **THREE), LIBRARY)) == []
    for line in (ARC, HAIRPIN):
        assert label_faults(drawing_of(bent_file_of(line, 20, 8), LIBRARY)) == []


def test_a_label_on_another_and_one_that_is_cut_off_are_found() -> None:
    drawing = drawing_of(file_of(), LIBRARY)
    [name, *_] = (x for x in texts(drawing) if x.text == "POV")
    [(x, y)] = name.places
    on_it = replace(drawing, shapes=[*drawing.shapes, replace(name, text="SV", places=[(x + 6, y + 5)])])
    assert ("POV", "SV") in label_faults(on_it)
    beyond = replace(
        drawing, shapes=[*drawing.shapes, replace(name, text="far", places=[(drawing.width, 3)])]
    )
    assert ("far",) in label_faults(beyond)


@pytest.mark.parametrize("family", ["Liberation Sans", "Arial", "Helvetica"])
def test_widths_are_at_least_those_of_the_font(family: str) -> None:
    try:
        path = font_manager.findfont(family, fallback_to_default=False)
    except ValueError:
        pytest.skip(f"the font {family} is not installed")
    font = FT2Font(path)
    font.set_size(100, 72)
    for text in (*map(chr, range(32, 127)), "scenario_2(SV, POV1, POV2, main-1)", "0.0 s"):
        font.set_text(f"i{text}i")
        wide = font.get_width_height()[0] / 64
        font.set_text("ii")
        alone = wide - font.get_width_height()[0] / 64
        assert alone <= width_of(text, 100) + 2, text
        assert width_of(text, 100) <= 1.3 * alone + 4, text


def test_lines_are_no_wider_than_they_may_be_and_lose_nothing() -> None:
    rng = random.Random(3)
    for _ in range(200):
        words = ["".join(rng.choices("abMW(), ", k=rng.randint(1, 40))).strip() or "x" for _ in range(12)]
        text, width = " ".join(words), rng.uniform(20, 300)
        lines = lines_of(text, width)
        assert all(width_of(x) <= width for x in lines)
        assert "".join(lines).replace(" ", "") == text.replace(" ", "")


def test_names_of_vehicles_are_on_nothing_however_they_stand() -> None:
    rng = random.Random(11)
    for _ in range(500):
        names = ["SV", "POV", "POV1", "POV2"][: rng.randint(1, 4)]
        boxes, sizes = dict[str, Box](), dict[str, tuple[float, float]]()
        for name in names:
            x, y = rng.uniform(0, 60), rng.uniform(0, 30)
            boxes[name], sizes[name] = (x, x + 20, y, y + 8), (8.0 * len(name), 11.0)
        labels = place_labels({name: [x] for name, x in boxes.items()}, sizes, (0, 300, -5, 45))
        placed = {name: label.boxes[0] for name, label in labels.items()}
        for name, place in placed.items():
            assert place[0] >= 0
            assert place[2] >= -5
            assert place[3] <= 45
            assert not any(meet(place, x) for x in boxes.values())
            assert not any(meet(place, x) for other, x in placed.items() if other != name)


def corners(shape: PolygonShape) -> Box:
    xs, ys = zip(*shape.outlines[0], strict=True)
    return min(xs), max(xs), min(ys), max(ys)


def vehicle_shapes(drawing: Drawing, colour: str) -> list[PolygonShape]:
    return [x for x in drawing.shapes if isinstance(x, PolygonShape) and x.opacity == 1 and x.fill == colour]


def test_vehicles_stand_where_the_drive_has_them() -> None:
    file = file_of(2, "scenario_2(SV, POV1, POV2, L)", **THREE)
    drawing, names = drawing_of(file, LIBRARY), ["SV", "POV1", "POV2"]
    snapshots = Snapshots(file, dict(zip(names, COLOURS, strict=False)))
    along, across = snapshots.scale
    for name, colour in snapshots.colours.items():
        shapes = vehicle_shapes(drawing, colour)
        assert len(shapes) == SNAPSHOTS
        for k, (shape, sv) in enumerate(zip(shapes, vehicle_shapes(drawing, COLOURS[0]), strict=True)):
            time = F(6) * k / (SNAPSHOTS - 1)
            mine, first = (state_at(file.drive.vehicles[x], time) for x in (name, "SV"))
            box, origin = corners(shape), corners(sv)
            assert (box[1] - origin[1]) / along == pytest.approx(float(mine.s - first.s))
            assert (origin[2] - box[2]) / across == pytest.approx(float(mine.d - first.d))
            assert (box[1] - box[0]) / along == pytest.approx(5)
            assert (box[3] - box[2]) / across == pytest.approx(2)


def test_a_vehicle_beside_the_road_is_not_drawn_and_takes_no_room() -> None:
    usual = drawing_of(file_of(), LIBRARY)
    away = drawing_of(file_of(SV=driving(0, 30), POV=driving(105, 20, F(3), F(6))), LIBRARY)
    assert len(vehicle_shapes(usual, COLOURS[1])) == SNAPSHOTS
    assert len(vehicle_shapes(away, COLOURS[1])) < SNAPSHOTS
    named = [sum(x.text == "POV" for x in texts(d)) for d in (usual, away)]
    assert (
        named[0] - named[1] == SNAPSHOTS - len(vehicle_shapes(away, COLOURS[1])) - 1
    )  # a speed across has a name


def left_of(drawing: Drawing) -> float:
    """The x at which axes of time begin."""
    return drawing.width - EDGE - PLOT


def test_bars_are_the_times_at_which_parts_hold() -> None:
    file = file_of()
    drawing = drawing_of(file, LIBRARY)
    left = drawing.width - EDGE - PLOT
    bars = [x for x in drawing.shapes if isinstance(x, RectangleShape) and x.fill == TRUE][1:]  # the legend
    spans = [span for strip in strips(file) for span in strip.spans]
    assert len(bars) == len(spans)
    for bar, (begin, end) in zip(bars, spans, strict=True):
        [(x, _, wide, _)] = bar.boxes
        assert 6 * (x - left) / PLOT == pytest.approx(begin, abs=0.02)
        assert 6 * wide / PLOT == pytest.approx(max(end - begin, 6 * 1.5 / PLOT), abs=0.02)
    rows = [x.text for x in texts(drawing)][-len(strips(file)) - 7 :]
    assert [x for x in rows if "(" in x] == [x.name for x in strips(file)]


def test_danger_begins_where_the_judge_says() -> None:
    file = file_of(2, "scenario_2(SV, POV1, POV2, L)", **THREE)
    drawing = drawing_of(file, LIBRARY)
    left = left_of(drawing)
    lines = [x.ends[0][0] for x in drawing.shapes if isinstance(x, LineShape) and x.stroke == DANGER]
    begun = sorted({round(6 * (x - left) / PLOT, 1) for x in lines})
    assert begun == sorted({round(x.begins, 1) for x in dangers_of(file, LIBRARY)})
    shown = [x.text for x in texts(drawing) if x.fill == DANGER]
    assert shown == [f"danger with {x.other} begins" for x in dangers_of(file, LIBRARY)]
    safe = drawing_of(file_of(SV=driving(0, 20), POV=driving(105, 30)), LIBRARY)
    assert not any(isinstance(x, LineShape) and x.stroke == DANGER for x in safe.shapes)


def affine(values: Sequence[float], pixels: Sequence[float]) -> bool:
    """Whether pixels are values by one scale that turns them over."""
    low, high = (
        min(range(len(values)), key=values.__getitem__),
        max(range(len(values)), key=values.__getitem__),
    )
    scale = (pixels[high] - pixels[low]) / (values[high] - values[low])
    shifts = [y - scale * v for v, y in zip(values, pixels, strict=True)]
    return scale < 0 and max(shifts) - min(shifts) < 1e-6


def test_curves_are_the_distances_of_the_drive() -> None:
    file = file_of(SV=driving(0, 20), POV=driving(-25, 30, F(13, 2), F(-1, 2)))
    drawing = drawing_of(file, LIBRARY)
    curves = [x for x in drawing.shapes if isinstance(x, StrokesShape) and x.stroke == COLOURS[1]]
    found = 0
    directions: tuple[str, str] = ("along", "across")
    for direction in directions:
        [distance] = distances_of(file, LIBRARY, direction)  # type: ignore[arg-type]
        for curve in curves:
            pixels = [y for piece in curve.lines for _, y in piece]
            if len(pixels) != len(distance.gap):
                continue
            wanted = distance.gap if curve.dash is None else distance.needed
            found += len(set(wanted)) > 1 and affine(wanted, pixels)
    assert found == 4


def test_a_vehicle_alone_has_no_gaps() -> None:
    drawing = drawing_of(file_of(None, "F (v_lon(SV) > 3 m/s)", SV=driving(0, 30)), LIBRARY)
    shown = [x.text for x in texts(drawing)]
    assert "speed along, m/s" in shown
    assert not any("gap" in x or "speed across" in x for x in shown)


def test_the_picture_says_what_it_shows() -> None:
    drawing = drawing_of(file_of(), LIBRARY)
    shown = [x.text for x in texts(drawing)]
    assert shown[0] == "Scenario 4: deceleration ahead, lane keep, main road"
    assert shown[1].startswith("Main road: you (SV) keep your lane")
    assert shown[2] == f"set base, road main-2, L = main-1; {dangers_of(file_of(), LIBRARY)[0]}"
    for text in (
        "main road",
        "driving direction",
        "RSS distance",
        "nearer than that",
        "danger begins",
        "6 s",
    ):
        assert text in shown
    assert shown.count("main-1") == shown.count("main-2") == SNAPSHOTS
    assert [x for x in shown if x.endswith(" s")][:SNAPSHOTS] == ["0.0 s", "1.5 s", "3.0 s", "4.5 s", "6.0 s"]


def test_a_formula_is_its_own_title() -> None:
    file = file_of(None, "F danger(SV, POV)")
    assert texts(drawing_of(file, LIBRARY))[0].text == "F danger(SV, POV)"
    assert texts(drawing_of(file, LIBRARY, "mine"))[0].text == "mine"


def test_a_library_without_rss_distances_draws_none() -> None:
    other = load_library([Source("mine.spec", "def dangerAhead(a, b: vehicle) := s(a) < s(b)")])
    assert label_faults(drawing_of(file_of(), other)) == []


def test_ticks_are_round_and_few() -> None:
    rng = random.Random(2)
    for _ in range(500):
        low = rng.uniform(-500, 500)
        high, most = low + 10 ** rng.uniform(-3, 4), rng.randint(6, 12)
        ticks = ticks_in((low, high), most)
        assert 2 <= len(ticks) <= most
        assert all(low - 1e-6 <= x <= high + 1e-6 and abs(float(text) - x) < 1e-9 for x, text in ticks)
        assert len({text for _, text in ticks}) == len(ticks)


def test_text_of_a_drive_cannot_become_markup() -> None:
    formula = "v_lon(SV) <v_lon(POV)"
    svg = draw_drive(file_of(None, formula), LIBRARY).svg
    assert formula.encode() not in svg
    assert formula in [x.text for x in ElementTree.fromstring(svg).iter("{http://www.w3.org/2000/svg}text")]


def test_the_same_drive_gives_the_same_file() -> None:
    assert draw_drive(file_of(), LIBRARY).svg == draw_drive(file_of(), LIBRARY).svg


def test_a_png_is_made_on_request_of_the_same_shapes() -> None:
    drawn = draw_drive(file_of(), LIBRARY)
    drawing = drawing_of(file_of(), LIBRARY)
    image = Image.open(io.BytesIO(drawn.png)).convert("RGB")
    assert image.size == (round(SHARP * drawing.width), round(SHARP * drawing.height))
    for colour in COLOURS[:2]:
        left, right, top, bottom = corners(vehicle_shapes(drawing, colour)[0])
        middle = round(SHARP * (left + right) / 2), round(SHARP * (top + bottom) / 2)
        assert image.getpixel(middle) == tuple(bytes.fromhex(colour[1:]))
    assert drawn._repr_png_() is None
    assert drawn._repr_svg_() == drawn.svg.decode()


def test_drives_are_drawn_without_matplotlib_and_numpy() -> None:
    code = (
        "import sys; from pathlib import Path; from roadproof.evidence.drive_file import load_drive;"
        "from roadproof.frontends.report.picture import draw_drive;"
        "from roadproof.library.loading import bundled_library;"
        f"x = draw_drive(load_drive(Path({str(DRIVE)!r})), bundled_library()).svg;"
        "print(len(x) > 9999, sorted({y.split('.')[0] for y in sys.modules} & {'numpy', 'matplotlib'}))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "True []"


def test_without_the_extension_there_is_no_picture(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("roadproof.frontends.report.picture.entries", lambda _: {})
    found = rp.witness(4)
    assert found.pictures() == {}
    with pytest.raises(rp.UsageError, match="there is no picture of Witnesses"):
        found.plot()
    with pytest.raises(rp.UsageError, match="no installed extension draws them"):
        draw_drive(file_of(), LIBRARY)


def test_a_png_of_an_earlier_version_goes_with_its_drive(tmp_path: Path) -> None:
    first, other = (rp.witness(k).drives[0] for k in (4, 1))
    write = DriveFolder(tmp_path, LIBRARY, Views())
    former = tmp_path / "x.png"
    write(("x", first))
    assert {x.name for x in tmp_path.iterdir()} == {"x.csv", "x.svg"}
    former.touch()
    write(("x", first))
    assert former.exists()
    write(("x", other))
    assert not former.exists()
