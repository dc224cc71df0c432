"""The cards of a failing drive on a page, and of the drives of driver models beside it."""

from collections.abc import Mapping, Sequence
from pathlib import Path

from roadproof.extensions.drivers.verdict import DriverVerdict
from roadproof.extensions.pages.page.page_context import DriveCard, PageContext
from roadproof.extensions.pages.page.results import PageResult

_HERE = Path()


def failure_cards(
    part: str,
    name: str,
    drives: Mapping[str, object],
    verdicts: Sequence[DriverVerdict],
    result: PageResult,
    context: PageContext,
) -> tuple[DriveCard, ...]:
    """Return a card for each drive: that of the vehicle under test under ``""``, others by driver model."""
    cards: list[DriveCard] = []
    for driver, drive in drives.items():
        place = "-".join(filter(None, (part, str(result.id), name, driver)))
        shown = drive if isinstance(drive, Mapping) else (result.folder or _HERE) / str(drive)
        word = "WITNESSED" if driver else "FAILS"
        title = _title(next(x for x in verdicts if x.driver == driver)) if driver else "your vehicle fails"
        cards.append(DriveCard(context.drive(shown), word, name, place, title=title))
    return tuple(cards)


def _title(verdict: DriverVerdict) -> str:
    if verdict.gap is not None:
        margin = f", {verdict.gap:g} m left"
    else:
        margin = "" if verdict.instant is None else f", touches at {verdict.instant:g} s"
    return f"{verdict.driver} drives instead: {verdict.side}{margin}"
