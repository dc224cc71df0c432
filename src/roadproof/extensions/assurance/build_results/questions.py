"""The cases of each question."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from roadproof.evidence.finding import NO_EVIDENCE, Acceptance, Finding
from roadproof.extensions.assurance.build_results.cases import (
    Case,
    Location,
    Rule,
    State,
    definition_location,
    named_definitions,
    state_of,
    test_location,
)
from roadproof.library.elaborate import read_claim
from roadproof.library.specification import Specification
from roadproof.logic.syntax import Claim
from roadproof.verdict import Verdict

if TYPE_CHECKING:
    from roadproof.extensions.catalogue.kept import Remark
    from roadproof.extensions.catalogue.tested import Targets
    from roadproof.extensions.drivers.preventable.view import LemmaResult, Plate
    from roadproof.extensions.surveys.coverage.answers import Survey
    from roadproof.questions.prove import ClaimResult, ProveQuestion
    from roadproof.questions.witness import SearchResult


def written(case: Case, specification: Specification, claim: Claim) -> Case:
    """The same, with the definitions that it names; it is at the first of them where it has no place."""
    named = named_definitions(specification, claim)
    first = named[0][1] if named else None
    return replace(case, place=case.place or first, related=named)


def claim_cases(
    asked: ProveQuestion,
    answers: Sequence[ClaimResult],
    files: Mapping[str, Path],
    places: Mapping[str, Location],
) -> Iterator[Case]:
    """A case for each claim. ``files``: evidence, ``places``: where it is written, both by ``name``."""
    for x in answers:
        task, specification = x.task, asked.specification_of(x.task)
        text = " ".join(task.claim.split())
        expected = "" if x.verdict is x.expected else f", expected {x.expected}"
        reason = x.reason
        by = x.refuted_by
        told = f"{x.verdict}{f' by a {by}' if by else ''}{expected}: {text}{reason and f' ({reason})'}"
        case = Case(
            suite=f"claims in {task.set_name}",
            name=text if task.title == "" else f"{task.name}: {text}",
            state=state_of(x.verdict, (x.expected,)),
            rule=x.verdict,
            message=told,
            place=places.get(x.name),
            evidence=files.get(x.name),
            seconds=x.seconds,
        )
        yield written(case, specification, read_claim(specification, task.claim).claim)


def search_cases(searches: Iterable[tuple[SearchResult, Path | None]]) -> Iterator[Case]:
    """A case for each search for a drive, with its evidence where there is a file."""
    for x, file in searches:
        name = x.query.text if x.scenario is None else f"scenario {x.scenario}"
        case = Case(
            suite=f"drives in {x.set_name}",
            name=name,
            state=state_of(x.verdict, (Verdict.WITNESSED,)),
            rule=x.verdict,
            message=f"{x.verdict}: {name}{x.reason and f' ({x.reason})'}",
            evidence=file,
            seconds=x.cost.seconds or None,
        )
        yield written(case, x.task.specification, x.query.claim)


def coverage_cases(survey: Survey, specification: Specification, files: Mapping[str, Path]) -> Iterator[Case]:
    """A case for each claim that there is no gap, and for each class of gaps, which fails with a drive.

    A claim that is refuted passes: the classes say why. ``files``: drives, by ``Part.key`` of their class.
    """
    for claim in survey.claims:
        told = f"{claim.verdict}: {claim.claim.text}{claim.reason and f' ({claim.reason})'}"
        case = Case(
            suite="claims",
            name=claim.claim.text,
            state=state_of(claim.verdict, (Verdict.PROVED, Verdict.REFUTED)),
            rule=claim.verdict,
            message=told,
        )
        yield written(case, specification, claim.claim.claim)
    for x in survey.classes:
        key = "" if x.part is None else x.part.key
        name = key or "no single condition"
        rule = {Verdict.WITNESSED: Verdict.GAPS}.get(x.verdict, x.verdict)
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


def catalogue_cases(
    tests: Sequence[str],
    found: Targets,
    sources: Mapping[str, str] | None = None,
    specification: Specification | None = None,
) -> Iterator[Case]:
    """A case for each test, which fails where it is not what it claims, and for each thing to be tested.

    Where places are wanted, ``sources`` has the file that names each test.
    """
    remarks: tuple[tuple[Verdict | Rule, State, Sequence[Remark]], ...] = (
        (Verdict.UNKNOWN, "undecided", found.doubts),
        (Rule.WRONG_TEST, "failed", found.faults),
        (Rule.CONTRADICTION, "failed", found.contradictions),
    )
    wrong = {x.tests[0]: (rule, state, x.told) for rule, state, those in remarks for x in those}
    for test in tests:
        file = (sources or {}).get(test)
        place = None if file is None else test_location(file, test)
        case = Case(suite="tests", name=test, state="passed", place=place)
        if test in wrong:
            rule, state, told = wrong[test]
            case = replace(case, state=state, rule=rule, message=told)
        yield case
    missing = {x.name for x in found.missing}
    for x in (*found.targets, *(found.gaps.targets if found.gaps.asked else ())):
        case = Case(suite="tested", name=x.name, state="passed")
        if x.name in found.gaps.open:
            told = f"in doubt: {found.gaps.open[x.name]}"
            case = replace(case, state="undecided", rule=Verdict.UNKNOWN, message=told)
        elif x.name in missing:
            told = f"no test shows {x.words}"
            case = replace(case, state="failed", rule=Rule.NOT_TESTED, message=told)
        definition = None if specification is None else specification.definitions.get(x.name)
        if specification is not None and definition is not None:
            case = replace(case, place=definition_location(specification, definition))
        yield case


def plate_cases(
    plates: Sequence[Plate],
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


def finding_cases(findings: Sequence[Finding], strict: bool) -> Iterator[Case]:
    """A case for each claim of a file or of an index that was checked.

    Answers without evidence are undecided if ``strict``, and where nothing else was checked.
    """
    rules = {Acceptance.REJECTED: Rule.REJECTED, Acceptance.UNREADABLE: Rule.UNREADABLE}
    nothing = all(x.kind == NO_EVIDENCE for x in findings)
    for x in findings:
        state: State = "passed" if x.outcome is Acceptance.ACCEPTED else "failed"
        without = (strict or nothing) and x.kind == NO_EVIDENCE
        if x.outcome is Acceptance.UNDECIDED or without:
            state = "undecided"
        file = x.where.partition(", ")[0]
        reason = x.reason or ("there is no evidence" if without else "")
        yield Case(
            suite="evidence",
            name=f"{x.where}: {x.label or ' '.join(x.claim.split())}".removesuffix(": "),
            state=state,
            rule=rules.get(x.outcome, Verdict.UNKNOWN),
            message=f"{x.outcome}: {reason}",
            place=Location(file) if Path(file).exists() else None,
        )


def recording_cases(
    names: Iterable[str], failed: Mapping[str, str], lost: Sequence[str], broken: Sequence[str], path: Path
) -> Iterator[Case]:
    """A case for each recording, and for each fact that the results violate; ``path``: the recordings.

    ``failed``: those that ``--keep-going`` skips, and why.
    """
    for name in names:
        reason = failed.get(name, "")
        state: State = "undecided" if name in lost else "skipped" if reason else "passed"
        rule = Verdict.UNKNOWN if name in lost else Rule.UNREADABLE
        yield Case(
            suite="recordings",
            name=name,
            state=state,
            rule=rule,
            message=reason,
            place=_recording_file(path, name),
        )
    for line in broken:
        yield Case(
            suite="facts",
            name=line,
            state="failed",
            rule=Verdict.CROSSCHECK_FAILED,
            message=line,
            place=Location(str(path)),
        )


def _recording_file(path: Path, name: str) -> Location:
    found = sorted(path.glob(f"{name}*")) if path.is_dir() else []
    return Location(str(found[0] if found else path))
