"""Names of vehicles in pictures, read from the files: on no other name, and within the picture."""

import random
import re
import xml.etree.ElementTree as ElementTree
from collections.abc import Mapping, Sequence
from dataclasses import replace
from fractions import Fraction as F
from itertools import combinations

import pytest

from extensions.pages.report.test_bends import ARC, HAIRPIN
from extensions.pages.report.test_bends import file_of as bent_file_of
from extensions.pages.report.test_drive import LIBRARY, SVG, driving, file_of, meet
from extensions.pages.report.test_drive_picture import random_file
from roadproof.evidence.drive_file import DriveFile
from roadproof.extensions.pages.drive_data import Box
from roadproof.extensions.pages.labels import PlacedLabel, place_labels
from roadproof.extensions.pages.letters import fitted, width_of
from roadproof.extensions.pages.miniature import NAME, miniature, small_scene
from roadproof.extensions.pages.moving import draw_moving

WITHIN = (0.0, 300.0, 0.0, 70.0)
AT_ONE_PLACE = file_of(
    2,
    "scenario_2(SV, POV1, POV2, L)",
    SV=driving(0, 30),
    POV1=driving(4, 30, F(13, 2)),
    POV2=driving(2, 31, F(6), F(-1, 4)),
)
Words = list[tuple[str, Box]]


def between(one: Sequence[float], other: Sequence[float], share: float) -> Box:
    left, right, low, high = (a + share * (b - a) for a, b in zip(one, other, strict=True))
    return left, right, low, high


def place_at(label: PlacedLabel, time: float) -> Box:
    """The box of a label at a time in instants, as a picture that moves on straight lines has it."""
    k = int(time)
    if k + 1 >= len(label.boxes):
        return label.boxes[-1]
    return between(label.boxes[k], label.before.get(k + 1, label.boxes[k + 1]), time - k)


def random_tracks(rng: random.Random) -> dict[str, list[Box]]:
    """One to four vehicles that move to and fro across each other."""
    count, tracks = rng.choice((1, 2, 12)), dict[str, list[Box]]()
    for name in ["SV", "POV", "POV1", "POV2"][: rng.randint(1, 4)]:
        x, y = rng.uniform(10, 270), rng.uniform(15, 45)
        tracks[name] = []
        for _ in range(count):
            x = min(max(x + rng.uniform(-30, 30), 0), 280)
            y = min(max(y + rng.uniform(-8, 8), 12), 48)
            tracks[name].append((x, x + 20, y, y + 9))
    return tracks


def faults_of(tracks: Mapping[str, Sequence[Box]], labels: Mapping[str, PlacedLabel]) -> list[str]:
    """Names that meet each other or a vehicle, or leave the picture, at some of many times."""
    faults = []
    count = len(next(iter(tracks.values())))
    for step in range(8 * (count - 1) + 1):
        time = step / 8
        placed = {name: place_at(x, time) for name, x in labels.items()}
        boxes = {name: place_at(PlacedLabel(x, False, {}), time) for name, x in tracks.items()}
        faults += [f"{a} on {b}" for a, b in combinations(placed, 2) if meet(placed[a], placed[b])]
        faults += [f"{a} on vehicle {b}" for a in placed for b, x in boxes.items() if meet(placed[a], x)]
        faults += [
            f"{name} beyond"
            for name, (left, right, low, high) in placed.items()
            if left < 0 or right > WITHIN[1] or low < 0 or high > WITHIN[3]
        ]
    return faults


def test_names_meet_nothing_however_vehicles_move() -> None:
    rng = random.Random(17)
    jumps = 0
    for _ in range(300):
        tracks = random_tracks(rng)
        labels = place_labels(tracks, {x: (7.0 * len(x), 12.0) for x in tracks}, WITHIN)
        assert faults_of(tracks, labels) == [], tracks
        jumps += sum(len(x.before) for x in labels.values())
    assert jumps > 50  # the tests have some


def test_a_name_on_another_and_one_on_its_way_across_another_are_found() -> None:
    here, there = (0.0, 20.0, 30.0, 40.0), (200.0, 220.0, 30.0, 40.0)
    tracks = {"SV": [here] * 2, "POV": [there] * 2}
    above, beside = (0.0, 20.0, 10.0, 20.0), (100.0, 120.0, 10.0, 20.0)
    still = PlacedLabel([above, above], False, {})
    assert "SV on POV" in faults_of(tracks, {"SV": still, "POV": still})
    across = PlacedLabel([beside, (200.0, 220.0, 10.0, 20.0)], False, {})
    passing = PlacedLabel([(180.0, 200.0, 10.0, 20.0), beside], False, {})
    assert "SV on POV" in faults_of(tracks, {"SV": across, "POV": passing})
    jumping = PlacedLabel([beside, (200.0, 220.0, 10.0, 20.0)], False, {1: beside})
    assert "SV on POV" not in faults_of(tracks, {"SV": jumping, "POV": PlacedLabel([above] * 2, False, {})})


# --- Read from files, as a browser plays them -------------------------------------------------------


def played(element: ElementTree.Element, name: str, share: float) -> float:
    """The value of an attribute at a share of the round."""
    for x in element.findall(f"{SVG}animate"):
        if x.get("attributeName") != name:
            continue
        values = [float(y) for y in x.attrib["values"].split(";")]
        last = len(values) - 1
        times = [
            float(y) for y in x.get("keyTimes", ";".join(str(k / last) for k in range(last + 1))).split(";")
        ]
        k = max(k for k, time in enumerate(times[:-1]) if time <= share)
        wide = times[k + 1] - times[k]
        return values[k] + (values[k + 1] - values[k]) * ((share - times[k]) / wide if wide else 0)
    return float(element.attrib[name])


def words_of(root: ElementTree.Element, share: float) -> Words:
    """Each text of a moving picture with the box of its letters."""
    words = []
    for x in root.iter(f"{SVG}text"):
        size = float(x.get("font-size", "12"))
        wide = width_of(x.text or "", size)
        left = (
            played(x, "x", share)
            - wide * {"start": 0, "middle": 0.5, "end": 1}[x.get("text-anchor", "start")]
        )
        y = played(x, "y", share)
        words.append((x.text or "", (left, left + wide, y - 0.75 * size, y + 0.2 * size)))
    return words


def label_faults(words: Words, width: float, height: float) -> list[tuple[str, ...]]:
    """The texts that lie on each other or reach beyond the picture."""
    cut = [(a,) for a, x in words if x[0] < 0 or x[2] < 0 or x[1] > width or x[3] > height]
    return cut + [(a, b) for (a, x), (b, y) in combinations(words, 2) if meet(x, y)]


def moving_faults(svg: bytes, times: int = 60) -> list[tuple[str, ...]]:
    root = ElementTree.fromstring(svg)
    width, height = float(root.attrib["width"]), float(root.attrib["height"])
    return [x for k in range(times) for x in label_faults(words_of(root, k / times), width, height)]


def drives() -> list[DriveFile]:
    rng = random.Random(5)
    long = "F danger(SV, POV2) and " * 9 + "true"
    moved = [random_file(rng) for _ in range(12)]
    beside = [replace(x, horizon=min(x.horizon, F(6))) for x in moved]
    bent = [bent_file_of(ARC, 20, 8), bent_file_of(HAIRPIN, 20, 8)]
    return [*beside, *bent, AT_ONE_PLACE, replace(AT_ONE_PLACE, scenario=None, formula=long)]


def test_no_text_of_a_moving_picture_lies_on_another_or_is_cut_off() -> None:
    for file in drives():
        assert moving_faults(draw_moving(file, LIBRARY)) == [], file


def test_a_name_above_each_vehicle_would_be_found() -> None:
    """The rule of pictures before: it has faults with three vehicles at one place."""
    svg = draw_moving(AT_ONE_PLACE, LIBRARY).decode()
    root = ElementTree.fromstring(svg)
    names = [x for x in root.iter(f"{SVG}text") if x.text in ("POV1", "POV2")]
    for x in names:
        x.set("x", "400")
        x.set("y", "80")
        for animated in list(x):
            x.remove(animated)
    assert ("POV1", "POV2") in moving_faults(ElementTree.tostring(root))


def test_the_driving_direction_is_whole_in_a_moving_picture() -> None:
    root = ElementTree.fromstring(draw_moving(AT_ONE_PLACE, LIBRARY))
    assert "driving direction" in [x.text for x in root.iter(f"{SVG}text")]
    places = [
        [float(y) for y in re.findall(r"[\d.]+", x.attrib["d"])]
        for x in root.iter(f"{SVG}path")
        if x.get("d")
    ]
    [arrow] = [x for x in places if len(x) == 10]
    assert max(arrow[::2]) <= float(root.attrib["width"]) - 10


def small_words(svg: str, share: float) -> Words:
    """The names of a small picture at a share of its round, from its keyframes."""
    words = []
    for frames, name in re.findall(r'style="--a:(x?n\d+)"><text [^>]*class="label"[^>]*>([^<]+)</text>', svg):
        [style] = re.findall(rf"@keyframes {frames}\{{((?:[^{{}}]*\{{[^{{}}]*\}})*)\}}", svg)
        found = re.findall(r"([\d.]+)%\{transform:translate\(([-\d.]+)px,([-\d.]+)px\)\}", style)
        steps = [(float(a) / 100, float(b), float(c)) for a, b, c in found]
        *_, begin = [x for x in steps if x[0] <= share]
        end = next((x for x in steps if x[0] > share), begin)
        part = (share - begin[0]) / (end[0] - begin[0]) if end != begin else 0.0
        x, y = (begin[k] + part * (end[k] - begin[k]) for k in (1, 2))
        wide = 1.06 * width_of(name, NAME)  # bold
        words.append((name, (x - wide / 2, x + wide / 2, y - 0.72 * NAME, y + 0.05 * NAME)))
    return words


def small_faults(svg: str, times: int = 60) -> list[tuple[str, ...]]:
    width, height = (float(x) for x in re.findall(r'viewBox="0 0 (\S+) (\S+)"', svg)[0])
    return [x for k in range(times) for x in label_faults(small_words(svg, k / times), width, height)]


def test_no_name_of_a_small_picture_lies_on_another_or_is_cut_off() -> None:
    for file in drives():
        svg = miniature(small_scene(file, LIBRARY), "x", "told")
        assert len(small_words(svg, 0.3)) == len(file.drive.vehicles)
        assert small_faults(svg) == [], file


def test_a_small_picture_with_two_names_at_one_place_is_found() -> None:
    svg = miniature(small_scene(AT_ONE_PLACE, LIBRARY), "x", "told")
    same = re.sub(r"translate\([-\d.]+px,[-\d.]+px\)", "translate(90px,30px)", svg)
    assert ("POV1", "POV2") in small_faults(same)


@pytest.mark.parametrize("width", [0, 20, 60, 500])
def test_a_fitted_text_is_no_wider_than_it_may_be(width: float) -> None:
    text = "initialCondition_2(SV, POV1, POV2, main-1)"
    shown = fitted(text, width, 11)
    assert width_of(shown, 11) <= max(width, width_of("…", 11))
    assert shown == text or text.startswith(shown.removesuffix("…"))
