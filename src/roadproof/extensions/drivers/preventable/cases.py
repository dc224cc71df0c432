"""The cases of plates and lemmas."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from roadproof.frontends.report.cases import Case, state_of
from roadproof.frontends.report.question_cases import written
from roadproof.library.specification import Specification
from roadproof.verdict import Verdict

if TYPE_CHECKING:
    from roadproof.extensions.drivers.preventable.view import LemmaResult, PlateResult


def plate_cases(
    plates: Sequence[PlateResult],
    lemmas: Sequence[LemmaResult],
    specification: Specification,
    files: Mapping[str, Path],
) -> Iterator[Case]:
    """A case for each plate, which passes with a drive on each side, and for each lemma."""
    for plate in plates:
        reasons = [plate.reason, *(x.reason for x in plate.shown)]
        yield Case(
            suite="plates",
            name=plate.name,
            state=state_of(plate.verdict, (Verdict.WITNESSED,)),
            rule=plate.verdict,
            message=f"{plate.verdict}: {plate.name} ({'; '.join(filter(None, reasons))})",
            evidence=files.get(plate.name),
        )
    for x in lemmas:
        case = Case(
            suite="lemmas",
            name=x.lemma.name,
            state=state_of(x.verdict, (Verdict.PROVED,)),
            rule=x.verdict,
            message=f"{x.verdict}: {x.lemma.name}{x.reason and f' ({x.reason})'}",
            evidence=files.get(f"lemma-{x.lemma.name}"),
        )
        yield written(case, specification, x.lemma.tree)
