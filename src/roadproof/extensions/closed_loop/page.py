"""The section about a vehicle under test on a report page."""

from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple

from roadproof.evidence.codec import read
from roadproof.evidence.strict import LARGEST_EVIDENCE, read_json
from roadproof.extensions.closed_loop.data import FalsifyData, TargetResult
from roadproof.extensions.closed_loop.simulations_file import PointKind, SimulationsFile
from roadproof.extensions.pages.page.page_context import DriveCard, PageContext
from roadproof.extensions.pages.page.results import PageResult, Words
from roadproof.extensions.pages.page.section_kind import SectionKind, Values

_WIDE, _HIGH, _MOST = 420.0, 220.0, 3000
_HERE = Path()
_COLOURS: Mapping[PointKind, str] = {
    "other": "var(--faint)",
    "shown": "var(--one)",
    "fails": "var(--two)",
    "preventable": "var(--four)",
}


class PlaneDot(NamedTuple):
    """A simulation in the picture of a plane: its place (px) and its colour."""

    x: float
    y: float
    colour: str


class TargetCards(NamedTuple):
    """A failing target on the page: its drives as cards, those of driver models beside, and its plane.

    ``gaps``, ``faster``: the ranges of the plane (m, m/s).
    """

    target: TargetResult
    cards: tuple[DriveCard, ...]
    dots: tuple[PlaneDot, ...]
    gaps: tuple[float, float]
    faster: tuple[float, float]


def _falsified(result: PageResult, context: PageContext, words: Words) -> Values:
    """Return the values of the template: the answer, and for each failure its drives and its plane."""
    answer = read(FalsifyData, result.data, result.name)
    failures = [_cards(x, result, context) for x in answer.targets if x.finding == "FAILS"]
    return {"answer": answer, "failures": failures}


def _cards(x: TargetResult, result: PageResult, context: PageContext) -> TargetCards:
    drives = {"": x.failing, **x.driven}
    cards = tuple(_card(name, drive, x, result, context) for name, drive in drives.items())
    file = _simulations(x, result)
    points = () if file is None else file.points[:_MOST]
    gaps, faster = _range([p.gap for p in points]), _range([p.faster for p in points])
    dots = (
        PlaneDot(
            round(_WIDE * (p.gap - gaps[0]) / (gaps[1] - gaps[0]), 1),
            round(_HIGH * (faster[1] - p.faster) / (faster[1] - faster[0]), 1),
            _COLOURS[p.kind],
        )
        for p in points
    )
    return TargetCards(x, cards, tuple(dots), gaps, faster)


def _card(driver: str, drive: object, x: TargetResult, result: PageResult, context: PageContext) -> DriveCard:
    place = "-".join(filter(None, ("fails", str(result.id), x.name, driver)))
    shown = drive if isinstance(drive, Mapping) else (result.folder or _HERE) / str(drive)
    sides = {y.driver: y.side for y in x.drivers}
    words = f"{driver} in the place of SV: {sides.get(driver, '')}" if driver else "the vehicle under test"
    return DriveCard(context.drive(shown), "WITNESSED" if driver else "REFUTED", words, place)


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


FALSIFY = SectionKind("Vehicle under test", "In which scenarios does it fail?", "falsify", _falsified)
