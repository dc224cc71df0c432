"""Cases for build servers: claims of coverage, and classes of gaps."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from roadproof.frontends.report.cases import Case, definition_location, state_of
from roadproof.frontends.report.question_cases import written
from roadproof.library.specification import Specification
from roadproof.verdict import Verdict

if TYPE_CHECKING:
    from roadproof.extensions.surveys.coverage.answers import GapSurvey


def coverage_cases(
    survey: GapSurvey, specification: Specification, files: Mapping[str, Path]
) -> Iterator[Case]:
    """Yield a case for each claim of coverage, and for each class of gaps, which fails with a drive.

    A claim that is refuted passes: the classes say why. ``files``: drives, by the key of the part to blame.
    """
    for claim in survey.claims:
        message = f"{claim.verdict}: {claim.claim.text}{claim.reason and f' ({claim.reason})'}"
        case = Case(
            suite="claims",
            name=claim.claim.text,
            state=state_of(claim.verdict, (Verdict.PROVED, Verdict.REFUTED)),
            rule=claim.verdict,
            message=message,
        )
        yield written(case, specification, claim.claim.claim)
    for x in survey.classes:
        key = "" if x.part is None else x.part.key
        name = key or "no single condition"
        rule = Verdict.GAPS if x.verdict is Verdict.WITNESSED else x.verdict
        case = Case(
            suite="classes of gaps",
            name=name,
            state=state_of(rule, (Verdict.IMPOSSIBLE,)),
            rule=rule,
            message=f"{rule}: {name}{x.reason and f' ({x.reason})'}",
            evidence=files.get(key),
        )
        component = None if x.part is None else specification.definitions.get(x.part.component)
        place = None if component is None else definition_location(specification, component)
        yield replace(case, place=place)
