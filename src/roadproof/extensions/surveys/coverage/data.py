"""Which disturbances a set misses, as plain data."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from roadproof.extensions.surveys.coverage import kept as shown
from roadproof.extensions.surveys.coverage.answers import ClassAnswer, Gap, Need, names_of
from roadproof.extensions.surveys.coverage.kept import SCHEMA, CoverageData
from roadproof.questions.basis import Basis
from roadproof.questions.question import Place, heading_of
from roadproof.world.road import Road
from roadproof.world.unread import unread_of_road

if TYPE_CHECKING:
    from roadproof.extensions.surveys.coverage.question import CoverageView

__all__ = ["SCHEMA", "CoverageData", "coverage_data"]


def coverage_data(
    basis: Basis,
    wider: Sequence[str],
    view: "CoverageView",
    place: Place,
    seconds: float,
    roads: Sequence[Road],
) -> CoverageData:
    """Return the view as ``--json`` prints it."""
    survey, gaps, classes = view.survey, list[shown.NumberedGap](), list[shown.CountedClass]()
    for x in survey.classes:
        first = len(gaps) + 1
        gaps += [_gap(number, gap, place) for number, gap in enumerate(x.gaps, first)]
        classes.append(_class(x, range(first, len(gaps) + 1), place))
    said: dict[str, Any] = {"set": basis.specification.set_name, **basis.said()}
    return CoverageData(
        **heading_of(SCHEMA, basis),
        **said,
        wider=tuple(wider),
        verdict=survey.verdict,
        claims=claims_data(view, place),
        classes=tuple(classes),
        gaps=tuple(gaps),
        needs=tuple(_need(x, place) for x in survey.needs),
        traffic=None if survey.traffic is None else survey.traffic.told,
        left_out=tuple(x for road in roads for x in unread_of_road(road)),
        seconds=round(seconds, 1),
    )


def claims_data(view: "CoverageView", place: Place) -> tuple[shown.Claim, ...]:
    """Return the claims that there is no gap."""
    return tuple(
        shown.Claim(
            claim=x.claim.text,
            verdict=x.verdict,
            certificate=None if x.certificate is None else place(name, view.known[name]),
            reason=x.reason,
        )
        for name, x in zip(view.proofs, view.survey.claims, strict=True)
    )


def class_data(x: ClassAnswer, place: Place) -> shown.KeptClass:
    """Return a class with its gaps."""
    return shown.KeptClass(**_said(x, place), gaps=tuple(shown.Gap(**_drive(y, place)) for y in x.gaps))


def _gap(number: int, gap: Gap, place: Place) -> shown.NumberedGap:
    return shown.NumberedGap(number=number, **_drive(gap, place))


def _drive(gap: Gap, place: Place) -> dict[str, Any]:
    file = gap.drive.file
    return {
        "road": file.road.name,
        "formula": file.formula,
        "first": gap.first,
        "caught_by": gap.caught_by,
        "classes": gap.classes,
        "drive": place(gap.shown.name, gap.shown.answer),
        "elsewhere": {road: place(x.name, x.answer) for road, x in gap.elsewhere.items()},
    }


def _class(x: ClassAnswer, numbers: range, place: Place) -> shown.CountedClass:
    said = _said(x, place)
    return shown.CountedClass(**said, gaps=tuple(numbers), in_traffic=x.in_traffic, trace=x.trace)


def _said(x: ClassAnswer, place: Place) -> dict[str, Any]:
    return {
        **names_of(x.part),
        "verdict": x.verdict,
        "claim": "" if x.claim is None else x.claim.text,
        "certificate": None if x.proof is None else place(x.proof.name, x.proof.answer),
        "reason": x.reason,
        "none_for": x.none_for,
    }


def _need(x: Need, place: Place) -> shown.Need:
    file = None if x.drive is None else x.drive.file
    return shown.Need(
        definition=x.definition,
        extends=x.parent,
        verdict=x.verdict,
        road="" if file is None else file.road.name,
        formula="" if file is None else file.formula,
        drive=None if x.shown is None else place(x.shown.name, x.shown.answer),
    )
