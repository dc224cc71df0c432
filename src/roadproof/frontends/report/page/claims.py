"""Values of sections about claims: an index of proofs, and evidence that lies alone."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from roadproof.analysis.study.evidence_store import INDEX
from roadproof.evidence.answers.proofs import ANSWER_SCHEMA, OWN, Answer, Claim, ClaimAnswer, Index
from roadproof.evidence.codec import read
from roadproof.evidence.finding import Acceptance, Finding
from roadproof.evidence.strict import Fields
from roadproof.frontends.report.page.page_context import PageContext
from roadproof.frontends.report.page.results import Result, Words
from roadproof.library.motion import statement
from roadproof.verdict import Verdict


def evidence(findings: Sequence[Finding], context: PageContext) -> dict[str, object]:
    """The findings: what is not accepted, proofs, and drives with their files."""
    accepted = [x for x in findings if x.outcome is Acceptance.ACCEPTED]
    paths = {id(finding): path for path, finding in context.findings.items()}
    return {
        "accepted": accepted,
        "wrong": [x for x in findings if x not in accepted],
        "proofs": [x for x in accepted if x.kind != "drive"],
        "drives": [(paths[id(x)], x) for x in accepted if x.kind == "drive" and id(x) in paths],
    }


@dataclass(frozen=True)
class _ShownClaim:
    """A claim with what was found of its evidence, and the drive that refutes it."""

    verdict: Verdict
    label: str
    set: str
    claim: str
    finding: Finding | None
    drive: Path | Mapping[str, Any] | None

    @property
    def outcome(self) -> str:
        return "" if self.finding is None else str(self.finding.outcome)


def claims(result: Result, context: PageContext, words: Words) -> dict[str, object]:
    """An index of claims, or the answer of ``prove --json``."""
    shown = [*_shown_claims(result, context)]
    accepted = sum(x.outcome == Acceptance.ACCEPTED for x in shown)
    return {"claims": shown, "accepted": accepted}


def _shown_claims(result: Result, context: PageContext) -> Iterator[_ShownClaim]:
    for number, x in enumerate(_entries_of(result), 1):
        finding = context.finding(result.folder, x.evidence if isinstance(x, Claim) else x.certificate)
        if finding is None and result.folder is not None:
            finding = context.inside.get(f"{result.folder / INDEX}, claim {number}")
        claim = statement(x.assuming, x.claim)
        yield _ShownClaim(x.verdict, _label(x), x.set, claim, finding, _drive_against(x, result))


def _entries_of(result: Result) -> Sequence[Claim | ClaimAnswer]:
    if result.schema == ANSWER_SCHEMA:
        return read(Answer, result.data, result.name).verdicts
    return read(Index, result.data, result.name).claims


def _label(claim: Claim | ClaimAnswer) -> str:
    if claim.property == OWN:
        return ""
    scenario = "" if claim.scenario is None else f" {claim.scenario}"
    return f"{claim.property}{f'-{claim.part}' if claim.part else ''}{scenario}"


def _drive_against(claim: Claim | ClaimAnswer, result: Result) -> Path | Mapping[str, Any] | None:
    if claim.verdict is not Verdict.REFUTED:
        return None
    if isinstance(claim, ClaimAnswer):
        is_drive = claim.refuted_by == "drive"
        return Fields(claim.counterexample, "its counterexample").mapping("drive") if is_drive else None
    return None if claim.evidence is None or result.folder is None else result.folder / str(claim.evidence)
