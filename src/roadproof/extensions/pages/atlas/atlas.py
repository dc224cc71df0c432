"""Writes the atlas: static pages about all scenarios, which need no network and no scripts."""

from collections.abc import Iterator
from dataclasses import dataclass
from importlib import resources
from pathlib import Path
from typing import Unpack

from roadproof.extensions.pages.atlas import overview_pages as overviews
from roadproof.extensions.pages.atlas.answers import EVIDENCE, Answers, answer_topics
from roadproof.extensions.pages.atlas.pictures import AtlasPicture, draw_all
from roadproof.extensions.pages.atlas.scenario_page import scenario_values
from roadproof.extensions.pages.keywords import AtlasKeywords
from roadproof.extensions.pages.page.templates import render, style_without_scripts
from roadproof.extensions.pages.settings import AtlasSettings as Settings
from roadproof.frontends.api.definitions import Definitions, load
from roadproof.frontends.settings.option import takes
from roadproof.runtime.files import make_folder, write_atomic
from roadproof.runtime.version import VERSION
from roadproof.verdict import ExitCode

STYLE = "atlas.css"


@dataclass(frozen=True)
class Atlas:
    """The pages that were written, and the number of drives on them."""

    folder: Path
    pages: tuple[str, ...]
    drives: int
    exit_code: ExitCode = ExitCode.AS_EXPECTED

    @property
    def path(self) -> Path:
        """The front page."""
        return self.folder / "index.html"

    def __str__(self) -> str:
        size = sum((self.folder / x).stat().st_size for x in self.pages) / 1e6
        return (
            f"{self.path}: {len(self.pages)} pages with {self.drives} moving pictures, {size:.1f} MB\n"
            f"`roadproof check {self.folder / EVIDENCE}` checks the evidence"
        )


@takes(Settings)
def atlas(using: Definitions | None = None, **options: Unpack[AtlasKeywords]) -> Atlas:
    """Write static pages about all scenarios into the folder ``out``, with evidence for each statement.

    ``among``: scenarios such as "1,3-8" (all where None); ``topics``: the questions to ask (all by default),
    such as "proofs", "drives" or "overlaps". Known answers take seconds; others are computed, which can take
    long. Raises ``InputError``, ``UsageError``.
    """
    settings = Settings.of(options)
    answers = answer_topics(using or load(), using is None, settings)
    pictures = draw_all(answers, settings)
    make_folder(answers.folder)
    pages = tuple(_write(answers, pictures))
    return Atlas(answers.folder, pages, len(pictures))


def _write(answers: Answers, pictures: dict[str, AtlasPicture]) -> Iterator[str]:
    """Write the pages, and yield their names."""
    folder = answers.folder
    style = resources.files("roadproof.extensions.pages.atlas").joinpath(STYLE).read_text("utf-8")
    write_atomic(folder / STYLE, (style_without_scripts() + style).encode())
    if answers.diagram is not None:
        write_atomic(folder / "implications.svg", answers.diagram.svg)
    shared = {
        "answers": answers,
        "page_of": overviews.page_of,
        "version": VERSION,
        "set": answers.home.alone.set_name,
        "check": f"roadproof check {EVIDENCE}",
    }
    for name, template, values in _pages(answers, pictures):
        text = render(f"atlas/{template}.html", page=name, **shared, **values)
        write_atomic(folder / name, text.encode())
        yield name


def _pages(
    answers: Answers, pictures: dict[str, AtlasPicture]
) -> Iterator[tuple[str, str, dict[str, object]]]:
    """Yield the name, template and values of each page."""
    yield "index.html", "index", overviews.front_values(answers, pictures)
    if answers.overlap is not None:
        yield "overlaps.html", "overlaps", overviews.overlap_values(answers)
    if answers.order is not None:
        yield "implications.html", "implications", overviews.implication_values(answers)
    if answers.classes is not None:
        yield "classes.html", "classes", overviews.class_values(answers, pictures)
    if answers.coverage is not None:
        yield "gaps.html", "gaps", overviews.gap_values(answers, pictures)
    for number in answers.numbers:
        yield overviews.page_of(number), "scenario", scenario_values(answers, pictures, number)
