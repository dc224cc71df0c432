"""Pictures of drives on roads with bends: where vehicles and lanes are, in Python and in a browser."""

import json
import math
import re
import shutil
import subprocess
import xml.etree.ElementTree as ElementTree
from dataclasses import replace
from fractions import Fraction as F
from io import BytesIO
from pathlib import Path

import pytest
from PIL import Image

from roadproof.evidence.drive_file import DriveFile
from roadproof.extensions.pages.animation import draw_animation
from roadproof.extensions.pages.bent_scene import BentScene, scene_of
from roadproof.extensions.pages.drive_picture import drawing_of
from roadproof.extensions.pages.frames import draw_film
from roadproof.extensions.pages.miniature import miniature, small_scene
from roadproof.extensions.pages.plane import RoadView
from roadproof.extensions.pages.scene import AnimationScene
from roadproof.extensions.pages.shapes import PolygonShape, StrokesShape, TextShape
from roadproof.extensions.pages.viewer_data import viewer_data
from roadproof.extensions.pages.viewer_page import viewer_modules
from roadproof.frontends.report.colours import COLOURS
from roadproof.library.loading import bundled_library
from roadproof.world.curves import Spiral
from roadproof.world.drive import Drive, motion_of
from roadproof.world.models import load_road
from roadproof.world.motion import state_at
from roadproof.world.reference_line import Part, ReferenceLine

LIBRARY = bundled_library()
MAP = Path(__file__).parents[4] / "examples/maps/motorway.xodr"
ROAD = load_road(f"{MAP}#lanes=right")
RADIUS = F(400)
ARC = ReferenceLine((Part(F(-2000), F(6000), F(10), F(20), F(1), Spiral(1 / RADIUS, 1 / RADIUS)),))
HAIRPIN = ReferenceLine((Part(F(0), F(100), F(0), F(0), F(0), Spiral(F(1, 30), F(1, 30))),))
SIZE = (F(9, 2), F(9, 5))
SVG = "{http://www.w3.org/2000/svg}"


def file_of(line: ReferenceLine, start: int = 500, speed: int = 30) -> DriveFile:
    """SV behind a slower POV that changes into its lane."""
    vehicles = {
        "SV": motion_of(SIZE, (F(start), F(-4)), (F(speed), F(0)), [], []),
        "POV": motion_of(SIZE, (F(start + 25), F(-1)), (F(speed - 3), F(-1, 2)), [], []),
    }
    road = replace(ROAD, line=line)
    return DriveFile(None, "base", "F danger(SV, POV)", F(4), {}, {}, {}, road, Drive(vehicles))


def on_arc(s: float, d: float) -> tuple[float, float]:
    """Where a place of ``ARC`` is, from its middle and its radius."""
    radius = float(RADIUS)
    middle = 10 - radius * math.sin(1), 20 + radius * math.cos(1)
    turned = 1 + (s + 2000) / radius
    return middle[0] + (radius - d) * math.sin(turned), middle[1] - (radius - d) * math.cos(turned)


def test_a_view_shows_places_of_an_arc() -> None:
    view = RoadView(ARC, 500.0, 20.0, -3.0)
    origin, ahead = on_arc(520, -3), on_arc(520.001, -3)
    heading = math.atan2(ahead[1] - origin[1], ahead[0] - origin[0])
    for s, d in ((20.0, -3.0), (-40.0, 5.0), (90.0, -9.0)):
        x, y = (a - b for a, b in zip(on_arc(500 + s, d), origin, strict=True))
        along = x * math.cos(heading) + y * math.sin(heading)
        assert view.at(s, d) == pytest.approx(
            (along, y * math.cos(heading) - x * math.sin(heading)), abs=0.01
        )


def test_vehicles_are_rectangles_in_the_direction_of_the_road() -> None:
    view = RoadView(ARC, 500.0, 0.0, 0.0)
    corners = view.vehicle((60.0, 64.5, -4.0, -2.2))
    assert math.dist(corners[0], corners[1]) == pytest.approx(4.5)
    assert math.dist(corners[1], corners[2]) == pytest.approx(1.8)
    (x0, y0), (x1, y1) = corners[:2]
    assert math.atan2(y1 - y0, x1 - x0) == pytest.approx(62.25 / 400)
    middle = [(a + b) / 2 for a, b in zip(corners[0], corners[2], strict=True)]
    assert middle == pytest.approx(view.at(62.25, -3.1))


def drawn(file: DriveFile) -> tuple[BentScene, ElementTree.Element]:
    scene = scene_of(file, LIBRARY)
    assert isinstance(scene, BentScene)
    return scene, ElementTree.fromstring(draw_animation(file, LIBRARY, "svg"))


def points_of(text: str) -> list[tuple[float, float]]:
    return [(float(x), float(y)) for x, y in (pair.split(",") for pair in text.split())]


def test_a_moving_picture_has_vehicles_where_the_drive_has_them() -> None:
    scene, root = drawn(file_of(ARC))
    for name, colour in zip(("SV", "POV"), COLOURS, strict=False):
        polygons = [
            x for x in root.iter(f"{SVG}polygon") if x.get("fill") == colour and not x.get("fill-opacity")
        ]
        (animate,) = polygons[0].findall(f"{SVG}animate")
        frames = [points_of(x) for x in animate.get("values", "").split(";")][: len(scene.times)]
        for k in (0, 17, len(scene.times) - 1):
            state = state_at(scene.file.drive.vehicles[name], scene.times[k])
            sv = state_at(scene.file.drive.vehicles["SV"], scene.times[k])
            centre = float(state.s - sv.s - SIZE[0] / 2), float(state.d - SIZE[1] / 2)
            shown = [sum(x) / 4 for x in zip(*frames[k], strict=True)]
            assert shown == pytest.approx(scene.place(scene.views[k].at(*centre)), abs=0.06)
            assert math.dist(frames[k][0], frames[k][1]) == pytest.approx(4.5 * scene.scale[0], abs=0.2)


def test_lanes_move_and_turn_to_where_each_view_sees_them() -> None:
    scene, root = drawn(file_of(ARC))
    lanes = scene.pavement()
    assert lanes.pivot is not None
    area = next(x for x in lanes.shapes if isinstance(x, PolygonShape))
    begin = scene.road.pieces[0]
    k = len(scene.times) - 1
    turned = math.radians(lanes.shifts[k].turned)
    x, y = (
        a + b - c
        for a, b, c in zip(
            area.outlines[0][0], (lanes.shifts[k].x, lanes.shifts[k].y), lanes.pivot, strict=True
        )
    )
    there = (
        lanes.pivot[0] + x * math.cos(turned) - y * math.sin(turned),
        lanes.pivot[1] + x * math.sin(turned) + y * math.cos(turned),
    )
    expected = scene.views[k].at(begin[1][0] - scene.travel[k], begin[2][1])
    assert there == pytest.approx(scene.place(expected), abs=1e-6)
    assert turned == pytest.approx(scene.travel[k] / 400)
    kinds = [x.get("type") for x in root.iter(f"{SVG}animateTransform")]
    assert kinds == ["translate", "rotate"]


def test_all_that_moves_stays_in_the_picture() -> None:
    for file in (file_of(ARC), file_of(HAIRPIN, 20, 8)):
        scene = scene_of(file, LIBRARY)
        assert isinstance(scene, BentScene)
        left, top, width, height = scene.pavement().window
        for shape in scene.vehicles():
            for x, y in (p for points in getattr(shape, "outlines", ()) for p in points):
                assert left <= x <= left + width
                assert top <= y <= top + height
        assert all(isinstance(x, PolygonShape | StrokesShape) for x in scene.pavement().shapes)


def test_frames_show_what_the_moving_picture_shows() -> None:
    file = file_of(HAIRPIN, 20, 8)
    film = draw_film(file, LIBRARY)
    scene = scene_of(file, LIBRARY, grain=film.grain)
    assert isinstance(scene, BentScene)
    first, last = (Image.frombytes("RGBA", film.size, film.draw(k)) for k in (0, film.count - 1))
    for image, k in ((first, 0), (last, film.count - 1)):
        motion = file.drive.vehicles["POV"]
        state, sv = (state_at(x, scene.times[k]) for x in (motion, file.drive.vehicles["SV"]))
        at = scene.views[k].at(float(state.s - sv.s) - 0.5, float(state.d) - 0.3)
        x, y = scene.place(at)
        assert image.getpixel((round(x), round(y)))[:3] == tuple(bytes.fromhex(COLOURS[1][1:]))


def test_other_pictures_say_what_bends_do_to_lengths() -> None:
    file = file_of(ARC)
    texts = " ".join(x.text for x in drawing_of(file, LIBRARY).shapes if isinstance(x, TextShape))
    assert "lengths in its lanes differ from those in s by up to 2.8 %" in texts
    assert "m to scale, as seen from the middle" in texts
    svg = draw_animation(file, LIBRARY, "svg").decode()
    assert "lengths differ by up to 2.8 %, 30 m" in svg
    small = miniature(small_scene(file, LIBRARY), "x", "told")
    assert re.search(r"@keyframes xt0\{0%\{transform:rotate\(", small)
    assert re.search(r"@keyframes xa0\{0%\{d:path\('M", small)
    assert Image.open(BytesIO(draw_animation(file, LIBRARY, "gif"))).n_frames == 4 * 12 + 1


def test_a_straight_road_has_no_line_in_the_viewer() -> None:
    straight = replace(file_of(ARC), road=replace(ROAD, line=None, map=None))
    assert type(scene_of(straight, LIBRARY)) is AnimationScene
    assert "line" not in viewer_data(straight, LIBRARY).as_json()["drive"]["road"]
    road = viewer_data(file_of(ARC), LIBRARY).as_json()["drive"]["road"]
    assert road["error"] == pytest.approx([2.75, 7.5 * 1600 / 400])


@pytest.mark.skipif(shutil.which("node") is None, reason="the program node is missing")
@pytest.mark.parametrize("line", [ROAD.line, ARC, HAIRPIN])
def test_the_projection_of_the_browser_is_that_of_python(line: ReferenceLine, tmp_path: Path) -> None:
    file = file_of(line, 20 if line is HAIRPIN else 330, 8)
    data = viewer_data(file, LIBRARY).as_json()["drive"]
    modules = viewer_modules()
    for name in ("drive", "plane"):
        text = modules[f"viewer/{name}"].replace('"viewer/drive"', '"./drive.mjs"')
        (tmp_path / f"{name}.mjs").write_text(text)
    asked = [[s, d] for s in (-20.0, 3.7, 41.0) for d in (-9.0, 0.0, 6.0)]
    (tmp_path / "ask.mjs").write_text(
        'import { viewOf } from "./plane.mjs"; import { windowOf, acrossOf, stateAt } from "./drive.mjs";'
        f"const drive = {json.dumps(data)}; const asked = {json.dumps(asked)};"
        "const origin = stateAt(drive.vehicles.SV, 2.5).s; const view = viewOf(drive, 2.5);"
        "console.log(JSON.stringify([windowOf(drive), acrossOf(drive.road), origin,"
        " asked.map(([s, d]) => view.at(origin + s, d))]));"
    )
    said = subprocess.run(["node", str(tmp_path / "ask.mjs")], capture_output=True, text=True, check=True)
    window, across, origin, found = json.loads(said.stdout)
    view = RoadView(line, origin, sum(window) / 2, sum(across) / 2)
    for place, point in zip(asked, found, strict=True):
        assert point == pytest.approx(view.at(*place), abs=0.01)
