"""The scene of a drive in a real browser: no word on another or cut off, however the vehicles stand."""

import random
from collections.abc import Iterator
from itertools import combinations
from pathlib import Path
from typing import Any

import pytest

from extensions.pages.report.reading import opened
from extensions.pages.report.test_bends import ARC, HAIRPIN
from extensions.pages.report.test_bends import file_of as bent_file_of
from extensions.pages.report.test_drive import LIBRARY
from extensions.pages.report.test_drive_picture import random_file
from extensions.pages.report.test_labels import AT_ONE_PLACE
from extensions.pages.studio.browser import why_none
from roadproof.extensions.pages.viewer_data import viewer_data
from roadproof.extensions.pages.viewer_page import viewer_page

pytestmark = pytest.mark.skipif(bool(why_none()), reason=why_none() or "there is a browser")
# The words of the last picture that is drawn, by scene, with the boxes of their letters; arrows as points.
HEARD = """
const brushes = new Map();
const prototype = CanvasRenderingContext2D.prototype;
const { fillText, clearRect } = prototype;
const isScene = (brush) => brush.canvas.classList.contains("scene");
prototype.clearRect = function (...box) {
  if (isScene(this)) brushes.set(this.canvas, []);
  return clearRect.apply(this, box);
};
prototype.fillText = function (words, x, y) {
  if (isScene(this)) {
    const at = this.getTransform().transformPoint(new DOMPoint(x, y));
    const ratio = window.devicePixelRatio || 1;
    const wide = this.measureText(words).width;
    const left = at.x / ratio - wide * { left: 0, center: 0.5, right: 1 }[this.textAlign];
    const size = parseFloat(this.font.match(/([\\d.]+)px/)[1]);
    const base = at.y / ratio;
    brushes.get(this.canvas).push([words, left, left + wide, base - 0.72 * size, base + 0.05 * size]);
  }
  return fillText.call(this, words, x, y);
};
window.heard = () => [...document.querySelectorAll("canvas.scene")].map((x) =>
  ({ wide: x.clientWidth, tall: x.clientHeight, words: brushes.get(x) }));
"""
PLAY = """(share) => new Promise((done) => {
  for (const x of document.querySelectorAll(".scrubber")) {
    x.value = share * Number(x.max);
    x.dispatchEvent(new Event("input", { bubbles: true }));
  }
  requestAnimationFrame(() => requestAnimationFrame(done));
})"""


@pytest.fixture(scope="module")
def drawn(tmp_path_factory) -> Path:
    """A page with a viewer for each of many drives."""
    rng = random.Random(9)
    files = [*(random_file(rng) for _ in range(10)), AT_ONE_PLACE]
    files += [bent_file_of(ARC, 20, 8), bent_file_of(HAIRPIN, 20, 8)]
    documents = [viewer_data(x, LIBRARY).as_json() for x in files]
    path: Path = tmp_path_factory.mktemp("scenes") / "page.html"
    path.write_text(viewer_page(documents, "Scenes"), "utf-8")
    return path


@pytest.fixture(params=[390, 1280])
def page(browser, drawn, request) -> Iterator[Any]:
    context = browser.new_context(viewport={"width": request.param, "height": 900})
    context.add_init_script(HEARD)
    made, faults = opened(context, drawn)
    made.wait_for_selector(".row")
    yield made
    assert faults == []
    context.close()


def faults_of(scene: Any) -> list[tuple[str, ...]]:
    """The words of a scene that lie on each other, or are not wholly in it."""
    words = scene["words"]
    cut = [
        (text,)
        for text, left, right, top, bottom in words
        if left < 0 or right > scene["wide"] or top < 0 or bottom > scene["tall"]
    ]
    return cut + [
        (a[0], b[0])
        for a, b in combinations(words, 2)
        if a[1] < b[2] and b[1] < a[2] and a[3] < b[4] and b[3] < a[4]
    ]


def test_no_word_of_the_scene_lies_on_another_or_is_cut_off(page) -> None:
    for share in (0, 0.13, 0.37, 0.5, 0.61, 0.88, 1):
        page.evaluate(PLAY, share)
        scenes = page.evaluate("heard()")
        assert len(scenes) == 13
        for scene in scenes:
            assert faults_of(scene) == []
            said = " ".join(x[0] for x in scene["words"])
            assert "driving direction" in said
            assert "SV " in said


def test_a_word_on_another_and_one_that_is_cut_off_are_found(page) -> None:
    [scene, *_] = page.evaluate("heard()")
    name = next(x for x in scene["words"] if x[0].startswith("SV"))
    scene["words"] += [["lain", name[1] + 3, name[2] + 3, *name[3:]], ["far", -4, 20, 50, 60]]
    assert {(name[0], "lain"), ("far",)} <= {*faults_of(scene)}
