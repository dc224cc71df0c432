"""Draws all drives of the atlas as moving pictures with their figures, in several processes."""

from collections.abc import Iterator, Mapping, Sequence
from contextlib import closing
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from roadproof.evidence.drive_file import load_drive
from roadproof.evidence.judged import JudgedDrive
from roadproof.extensions.pages.atlas.answers import EVIDENCE, OBJECTIVES, Answers, name_in
from roadproof.extensions.pages.atlas.notation import text_as_html
from roadproof.extensions.pages.drive_data import Span, strips_of
from roadproof.extensions.pages.miniature import miniature, small_scene
from roadproof.extensions.pages.settings import AtlasSettings
from roadproof.library.specification import Library
from roadproof.runtime import pool
from roadproof.verdict import Verdict

MOST_STRIPS, DEEPEST = 14, 2


@dataclass(frozen=True)
class DriveFigures:
    """The figures of a drive.

    ``speeds``: of each vehicle at the start and the end (m/s). ``gaps``: along the road from SV to each other
    vehicle, at the start and the smallest (m). ``begins``: the start of danger (s).
    """

    speeds: Mapping[str, tuple[float, float]]
    gaps: Mapping[str, tuple[float, float]]
    begins: float | None


@dataclass(frozen=True)
class AtlasPicture:
    """A drive as a moving SVG picture, with the facts that a page shows about it.

    ``duration``: of one loop (s); ``still``: the instant of the picture at rest (s); ``strips``: parts of the
    formula as HTML, their depth in it, and the spans in which they are true (s).
    """

    svg: str
    horizon: float
    duration: float
    still: float
    figures: DriveFigures
    strips: Sequence[tuple[str, int, Sequence[Span]]]


@dataclass(frozen=True)
class _PictureJob:
    path: Path
    name: str
    title: str


def draw_all(answers: Answers, settings: AtlasSettings) -> dict[str, AtlasPicture]:
    """Return every picture, by the file of its drive relative to the pages.

    Raises ``RejectedError`` where the judge rejects a drive, whatever an index says of it.
    """
    titles = dict(_drives(answers))
    jobs = [_PictureJob(answers.folder / file, f"m{k}", x) for k, (file, x) in enumerate(titles.items())]
    draw = partial(_draw, answers.library or answers.home.library)
    with closing(pool.work(draw, jobs, settings.jobs, None, settings.progress, "pictures")) as numbered:
        pictures = dict(numbered)
    return {file: pictures[k] for k, file in enumerate(titles)}


def _drives(answers: Answers) -> Iterator[tuple[str, str]]:
    """Yield the file and a title of each drive."""
    for objective in OBJECTIVES:
        for number, drive in answers.drives.get(objective, {}).items():
            yield drive.source.file, f"A {objective} drive of {answers.home.words(number)}"
    for x in () if answers.overlap is None else answers.overlap.verdicts:
        if x.verdict is Verdict.WITNESSED:
            yield f"{EVIDENCE}/overlap/{name_in(x.evidence)}", f"A drive of scenarios {x.a} and {x.b} at once"
    for y in () if answers.classes is None else answers.classes.classes:
        if isinstance(y.drive, str):
            yield f"{EVIDENCE}/classes/{name_in([y.drive])}", f"A drive of class {y.name}: {y.description}"
    for z in () if answers.coverage is None else answers.coverage.gaps:
        if isinstance(z.drive, str):
            yield (
                f"{EVIDENCE}/coverage/{name_in([z.drive])}",
                f"A drive of gap {z.number}, which no scenario describes",
            )


def _draw(library: Library, job: _PictureJob) -> AtlasPicture:
    file = load_drive(job.path)
    judged = JudgedDrive(file, library)
    scene, strips = small_scene(file, library), strips_of(judged.judgement, file.horizon)
    speeds = {name: (float(x[0].v_lon), float(x[-1].v_lon)) for name, x in scene.states.items()}
    gaps = {x.other: (x.gap[0], min(x.gap)) for x in scene.distances}
    figures = DriveFigures(speeds, gaps, scene.begins)
    parts = [(text_as_html(x.name), x.depth, x.spans) for x in strips if x.depth <= DEEPEST][:MOST_STRIPS]
    svg = miniature(scene, job.name, job.title)
    still = float(scene.times[scene.still])
    return AtlasPicture(svg, float(file.horizon), float(scene.duration), still, figures, parts)
