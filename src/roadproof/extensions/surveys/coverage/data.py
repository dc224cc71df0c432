"""The gaps of a spec set as plain data."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from roadproof.extensions.surveys.coverage import schema
from roadproof.extensions.surveys.coverage.answers import ClassAnswer, Gap, Need, names_of
from roadproof.extensions.surveys.coverage.schema import SCHEMA, CoverageData
from roadproof.questions.basis import Basis
from roadproof.questions.question import EvidencePlace, heading_of
from roadproof.world.not_read import road_not_read_note
from roadproof.world.road import Road

if TYPE_CHECKING:
    from roadproof.extensions.surveys.coverage.question import CoverageView

__all__ = ["SCHEMA", "CoverageData", "coverage_data"]


def coverage_data(
    basis: Basis,
    wider: Sequence[str],
    view: "CoverageView",
    place: EvidencePlace,
    seconds: float,
    roads: Sequence[Road],
) -> CoverageData:
    """Return the view as ``--json`` prints it."""
    survey, gaps, classes = view.survey, list[schema.NumberedGap](), list[schema.CountedClass]()
    for x in survey.classes:
        first = len(gaps) + 1
        gaps += [_gap(number, gap, place) for number, gap in enumerate(x.gaps, first)]
        classes.append(_class(x, range(first, len(gaps) + 1), place))
    return CoverageData(
        **heading_of(SCHEMA, basis),
        set=basis.specification.set_name,
        **basis.common_data(),
        wider=tuple(wider),
        verdict=survey.verdict,
        claims=claims_data(view, place),
        classes=tuple(classes),
        gaps=tuple(gaps),
        needs=tuple(_need(x, place) for x in survey.needs),
        traffic=None if survey.traffic is None else survey.traffic.data,
        left_out=tuple(x for road in roads for x in road_not_read_note(road)),
        seconds=round(seconds, 1),
    )


def claims_data(view: "CoverageView", place: EvidencePlace) -> tuple[schema.CoverageClaimData, ...]:
    """Return the claims of coverage as plain data."""
    return tuple(
        schema.CoverageClaimData(
            claim=x.claim.text,
            verdict=x.verdict,
            certificate=None if x.certificate is None else place(name, view.known[name]),
            reason=x.reason,
        )
        for name, x in zip(view.proofs, view.survey.claims, strict=True)
    )


def class_data(x: ClassAnswer, place: EvidencePlace) -> schema.GapClassDetail:
    """Return a class with its gaps as plain data."""
    return schema.GapClassDetail(
        **_class_fields(x, place), gaps=tuple(schema.GapData(**_drive(y, place)) for y in x.gaps)
    )


def _gap(number: int, gap: Gap, place: EvidencePlace) -> schema.NumberedGap:
    return schema.NumberedGap(number=number, **_drive(gap, place))


def _drive(gap: Gap, place: EvidencePlace) -> dict[str, Any]:
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


def _class(x: ClassAnswer, numbers: range, place: EvidencePlace) -> schema.CountedClass:
    class_fields = _class_fields(x, place)
    return schema.CountedClass(**class_fields, gaps=tuple(numbers), in_traffic=x.in_traffic, trace=x.trace)


def _class_fields(x: ClassAnswer, place: EvidencePlace) -> dict[str, Any]:
    return {
        **names_of(x.part),
        "verdict": x.verdict,
        "claim": "" if x.claim is None else x.claim.text,
        "certificate": None if x.proof is None else place(x.proof.name, x.proof.answer),
        "reason": x.reason,
        "none_for": x.none_for,
    }


def _need(x: Need, place: EvidencePlace) -> schema.NeedData:
    file = None if x.drive is None else x.drive.file
    return schema.NeedData(
        definition=x.definition,
        extends=x.parent,
        verdict=x.verdict,
        road="" if file is None else file.road.name,
        formula="" if file is None else file.formula,
        drive=None if x.shown is None else place(x.shown.name, x.shown.answer),
    )
