"""The section about a vehicle under test on a report page."""

from collections import Counter
from collections.abc import Iterator, Mapping
from typing import NamedTuple

from roadproof.evidence.codec import read
from roadproof.evidence.strict import LARGEST_EVIDENCE, read_json
from roadproof.extensions.closed_loop.data import FalsifyData, TargetResult
from roadproof.extensions.closed_loop.failure_cards import failure_cards
from roadproof.extensions.closed_loop.simulations_file import PointKind, SimulationsFile
from roadproof.extensions.pages.page.page_context import DriveCard, PageContext
from roadproof.extensions.pages.page.results import PageResult, Words
from roadproof.extensions.pages.page.section_kind import OpenItem, SectionKind, Values

_LEFT, _WIDE, _HIGH, _INSET, _MOST = 48, 242, 160, 6, 3000
"""The frame of a plane (px), how far its points are from it, and how many are drawn at most."""
_STYLES: Mapping[PointKind, tuple[str, str]] = {
    "other": ("var(--faint)", "another drive"),
    "shown": ("var(--one)", "the scenario, no failure"),
    "fails": ("var(--two)", "failure that no driver model prevents"),
    "preventable": ("var(--four)", "failure that a driver model prevents, on samples"),
}
"""The colour of a simulation by its kind, and its words in the legend."""


class PlaneDot(NamedTuple):
    """A simulation in the picture of a plane: its place (px) and its colour."""

    x: float
    y: float
    colour: str


class PlaneKey(NamedTuple):
    """A line of the legend of a plane."""

    colour: str
    words: str
    number: int


class TargetCards(NamedTuple):
    """A failing target on the page: its drives as cards, those of driver models beside, and its plane.

    ``gaps``, ``faster``: the ranges of the plane (m, m/s). ``keys``: its legend. ``line``: the boundary of
    the driver model ``guide`` (px), with a space between points.
    """

    target: TargetResult
    cards: tuple[DriveCard, ...]
    dots: tuple[PlaneDot, ...]
    gaps: tuple[float, float]
    faster: tuple[float, float]
    keys: tuple[PlaneKey, ...]
    line: str
    guide: str


def _falsified(result: PageResult, context: PageContext, words: Words) -> Values:
    """Return the values of the template: the answer, and for each failure its drives and its plane."""
    answer = read(FalsifyData, result.data, result.name)
    failures = [_cards(x, result, context) for x in answer.targets if x.finding == "FAILS"]
    return {"answer": answer, "failures": failures}


def _cards(x: TargetResult, result: PageResult, context: PageContext) -> TargetCards:
    drives = {"": x.failing, **x.driven}
    cards = failure_cards("fails", x.name, drives, x.drivers, result, context)
    file = _simulations(x, result)
    points = () if file is None else file.points[:_MOST]
    boundary = () if file is None else file.boundary
    every = [*((p.gap, p.faster) for p in points), *((p.gap, p.faster) for p in boundary)]
    gaps, faster = _range([gap for gap, _ in every]), _range([speed for _, speed in every])

    def place(gap: float, speed: float) -> tuple[float, float]:
        across = (gap - gaps[0]) / (gaps[1] - gaps[0]), (faster[1] - speed) / (faster[1] - faster[0])
        left, top = _LEFT + _INSET, _INSET
        x, y = left + (_WIDE - 2 * _INSET) * across[0], top + (_HIGH - 2 * _INSET) * across[1]
        return round(x, 1), round(y, 1)

    dots = (PlaneDot(*place(p.gap, p.faster), _STYLES[p.kind][0]) for p in points)
    line = " ".join("{},{}".format(*place(p.gap, p.faster)) for p in boundary)
    counts = Counter(p.kind for p in points)
    keys = tuple(PlaneKey(*style, counts[kind]) for kind, style in _STYLES.items() if counts[kind])
    guide = "" if file is None else file.guide
    return TargetCards(x, cards, tuple(dots), gaps, faster, keys, line, guide)


def _simulations(x: TargetResult, result: PageResult) -> SimulationsFile | None:
    """Return the simulations of a target, None where the page has no file of them."""
    match x.simulated:
        case Mapping() as content:
            return read(SimulationsFile, content, result.name)
        case str() as name if result.folder is not None:
            path = result.folder / name
            return read(SimulationsFile, read_json(path, LARGEST_EVIDENCE), str(path))
        case _:  # open: no search
            return None


def _range(values: list[float]) -> tuple[float, float]:
    low, high = min(values, default=0.0), max(values, default=1.0)
    return (low, high) if low < high else (low, low + 1)


def _points(result: PageResult) -> Iterator[OpenItem]:
    """Yield the targets that the vehicle fails, or that are not decided."""
    for x in read(FalsifyData, result.data, result.name).targets:
        if x.finding in ("FAILS", "NOT SHOWN", "ERROR"):
            reason = f": {x.reason}" if x.reason else ""
            yield OpenItem(x.finding, f"{x.name}, {x.title}{reason}", f"result-{result.id}")


def _counts(result: PageResult) -> str:
    """Return how many targets have each finding."""
    counts = Counter(x.finding for x in read(FalsifyData, result.data, result.name).targets)
    return ", ".join(f"{n} {finding}" for finding, n in counts.items())


FALSIFY = SectionKind(
    "Vehicle under test", "In which scenarios does it fail?", "falsify", _falsified, _points, _counts
)
