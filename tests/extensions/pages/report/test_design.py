"""One design for report, atlas, studio and site: one file has colours and fonts, and texts can be read."""

import re
from itertools import product
from pathlib import Path

import pytest

from roadproof.extensions.pages.page.templates import page, style_without_scripts
from roadproof.extensions.pages.studio.pages import static_files
from roadproof.extensions.pages.viewer_page import design, viewer_page

ROOT = Path(__file__).parents[4]
PAGES = ROOT / "src/roadproof/extensions/pages"
DESIGN = PAGES / "viewer/design.css"
SHEETS = [
    x
    for folder in (ROOT / "src/roadproof", ROOT / "docs/assets")
    for x in sorted(folder.rglob("*"))
    if x.suffix in (".css", ".js", ".html") and "vendor" not in x.parts and x != DESIGN
]
COLOUR = re.compile(
    r"(?<![\w&-])#(?:[0-9a-f]{3,4}|[0-9a-f]{6}|[0-9a-f]{8})\b|\b(?:rgba?|hsla?|oklch)\(", re.IGNORECASE
)
FONT = re.compile(r"\b(?:system-ui|sans-serif|serif|monospace)\b")
SHADOW = re.compile(r"rgb\(0 0 0 / \d+%\)")
"""What is behind a dialogue, and the shadow of a tooltip."""
TOKENS = dict(re.findall(r"(--[\w-]+): light-dark\((#\w{6}, #\w{6})\);", design()))
TEXTS = ("ink", "faint", "accent", "yes", "no", "open", "one")
"""Tokens in which texts are written, on each of the two backgrounds."""
FILLED = ("yes", "no", "one", "accent")
"""Tokens behind texts in the colour of paper: cells of matrices, buttons."""


def luminance(colour: str) -> float:
    """That of WCAG 2.1."""
    shares = [int(colour[k : k + 2], 16) / 255 for k in (1, 3, 5)]
    linear = [x / 12.92 if x <= 0.04045 else ((x + 0.055) / 1.055) ** 2.4 for x in shares]
    return sum(x * y for x, y in zip(linear, (0.2126, 0.7152, 0.0722), strict=True))


def contrast(one: str, other: str) -> float:
    """The ratio of two colours as WCAG 2.1 defines it.

    >>> round(contrast("#000000", "#ffffff"), 1)
    21.0
    """
    low, high = sorted((luminance(one), luminance(other)))
    return (high + 0.05) / (low + 0.05)


def token(name: str, theme: int) -> str:
    return TOKENS[f"--{name}"].split(", ")[theme]


def test_the_measure_of_contrast_is_that_of_wcag():
    assert contrast("#777777", "#ffffff") == pytest.approx(4.478, abs=0.001)
    assert contrast("#ffffff", "#ffffff") == 1


@pytest.mark.parametrize("theme", [0, 1], ids=["light", "dark"])
@pytest.mark.parametrize(
    ("text", "behind"), [*product(TEXTS, ("paper", "ground")), *product(["paper"], FILLED)]
)
def test_texts_contrast_with_what_is_behind_them(theme, text, behind):
    assert contrast(token(text, theme), token(behind, theme)) >= 4.5


def test_badges_of_verdicts_have_the_background_of_paper():
    [badge] = re.findall(r"^\.verdict-word, .* \{(.*)\}$", design(), re.M)
    assert "background: var(--paper);" in badge


@pytest.mark.parametrize("theme", [0, 1], ids=["light", "dark"])
@pytest.mark.parametrize("name", ["one", "two", "three", "four", "true"])
def test_vehicles_and_spans_are_seen_on_the_road(theme, name):
    """Shapes need a ratio of 3 on paper (WCAG 1.4.11)."""
    assert contrast(token(name, theme), token("paper", theme)) >= 3


def test_colours_and_fonts_stand_in_one_file():
    assert len(SHEETS) > 40
    found = [
        f"{path.relative_to(ROOT)}: {line.strip()[:80]}"
        for path in SHEETS
        for line in path.read_text("utf-8").splitlines()
        if COLOUR.search(SHADOW.sub("", line)) or FONT.search(line)
    ]
    assert found == []


def test_each_colour_has_a_light_and_a_dark_value():
    named = re.findall(r"(--[\w-]+): ", design())
    assert {*named} - {*TOKENS} == {"--text", "--code", "--math"}


def test_each_page_has_the_design_and_knows_every_token_that_it_uses():
    studio = "".join(x.text for name, x in static_files().items() if name.endswith(".css"))
    atlas = style_without_scripts() + (PAGES / "atlas/atlas.css").read_text("utf-8")
    report = page("", "", [], [])
    for text in (report, atlas, studio, viewer_page([], "")):
        assert text.count(design()) == 1
        used = {*re.findall(r"var\((--[\w-]+)", text)}
        assert used - {*re.findall(r"(--[\w-]+)\s*:", text)} <= SET_ELSEWHERE


SET_ELSEWHERE = {"--gutter", "--a", "--d", "--s", "--columns"}
"""Properties that scripts and templates set on elements."""


def test_the_site_takes_its_colours_from_the_design():
    settings = (ROOT / "mkdocs.yml").read_text("utf-8")
    assert "extra_css:\n  - assets/design.css\n  - assets/site.css\n" in settings
    site = (ROOT / "docs/assets/site.css").read_text("utf-8")
    assert {*re.findall(r"var\((--[\w-]+)\)", site)} <= {*re.findall(r"(--[\w-]+): ", design())}
