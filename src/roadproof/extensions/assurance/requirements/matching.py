"""Finds the evidence for each link of a requirement, and derives the state of the link."""

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import TypeAlias, assert_never

from roadproof.errors import InputError, TextError, UsageError
from roadproof.evidence.finding import STALE, Acceptance
from roadproof.evidence.subject import OF_TESTS, DriverSide, SubjectKind, TestedSide
from roadproof.extensions.assurance.answers.trace import LinkState
from roadproof.extensions.assurance.requirements.checked_evidence import CheckedEvidence, Meaning, meaning_of
from roadproof.extensions.assurance.requirements.requirement import Link
from roadproof.extensions.drivers.models import MODELS
from roadproof.extensions.drivers.outcome import faster_text
from roadproof.library.bind import default_values
from roadproof.library.elaborate import apply_definition
from roadproof.library.scenario_references import read_query
from roadproof.library.specification import Query, Specification
from roadproof.logic.rewrite import without_names
from roadproof.reasons import NO_REASON, Reason, ReasonKind

_LABEL = re.compile(r"[A-Za-z][\w-]*( scenario \d+)? [A-Za-z][\w-]*")
_DRIVER = re.compile(r"(?P<test>.+): (?P<model>\w+) (?P<side>preventable|unpreventable)")
_SHOWN = {
    "PROVED": LinkState.PROVED,
    "IMPOSSIBLE": LinkState.PROVED,
    "COVERED": LinkState.PROVED,
    "WITNESSED": LinkState.WITNESSED,
    "JUDGED": LinkState.WITNESSED,
    "DERIVED": LinkState.WITNESSED,
    "REFUTED": LinkState.REFUTED,
    "GAPS": LinkState.REFUTED,
}
"""The state that an accepted verdict gives a file of evidence; all other verdicts are undecided."""


@dataclass(frozen=True)
class Target:
    """A parsed link; ``meaning``: None for a name that is no formula; ``specification``: the definitions of
    its set.
    """

    link: Link
    specification: Specification
    meaning: Meaning | None = None


@dataclass(frozen=True)
class LinkFinding:
    """The state that one piece of evidence gives a link; ``shows``: targets or margins, for people."""

    evidence: CheckedEvidence
    state: LinkState
    reason: Reason = NO_REASON
    shows: str = ""


Values: TypeAlias = Mapping[str, Fraction]


def read_target(link: Link, home: Specification, source: str) -> Target:
    """Parse a link under the definitions of a trace. Raises ``InputError``, whose message names
    ``source``.
    """
    if link.kind == "claim":
        try:
            return Target(link, home, meaning_of(home, link.target, source))
        except TextError:
            if _LABEL.fullmatch(link.target):
                return Target(link, home)
            raise
    if link.kind == "driver":
        try:
            driver_link(link)
        except InputError as error:
            raise InputError(f"{source}: {error}") from None
    if link.kind == "scenario":
        try:
            query, specification = _scenario(link.target, home, source)
        except TextError:
            raise
        except (InputError, UsageError) as error:
            raise InputError(f"{source}: {error}") from None
        return Target(link, specification, Meaning(without_names(query.formula)))
    return Target(link, home)


def _scenario(target: str, home: Specification, source: str) -> tuple[Query, Specification]:
    """Return the query and definitions of a scenario: number, number@set, name, definition or formula.

    Raises ``InputError``.
    """
    word, _, set_name = target.partition("@")
    if set_name in home.library.sets and re.fullmatch(r"\d+|\w+", word):
        home, target = home.in_set(set_name), word
    if target in home.definitions:
        return apply_definition(home, target), home
    return read_query(home, target, source)[1], home


def findings_of_link(
    target: Target, evidence: Sequence[CheckedEvidence], values: Values, folder: Path
) -> list[LinkFinding]:
    """Return the findings about a link.

    ``values``: the values of all parameters; ``folder``: where relative paths of links start.
    """
    match target.link.kind:
        case "claim" | "scenario":
            findings = _findings_of_formula(target, evidence)
        case "test":
            findings = _findings_of_test(target.link.target, evidence)
        case "driver":
            findings = _findings_of_driver(driver_link(target.link), evidence)
        case "plate":
            findings = (_finding_of_file(x) for x in evidence if _is_plate(x, target.link.target))
        case "evidence":
            place = (folder / target.link.target).resolve()
            findings = (_finding_of_file(x) for x in evidence if _is_at(x, place))
        case _:
            assert_never(target.link.kind)
    return [_stale_if_values_differ(x, values) for x in findings]


def combined_state(kind: str, findings: Sequence[LinkFinding]) -> tuple[LinkState, Reason]:
    """Return the state of a link and the reason for it.

    A refutation counts first, then rejected evidence. Links to driver models, plates and files need all of
    their evidence, other links need one piece.
    """
    if not findings:
        return LinkState.MISSING, ReasonKind.NO_EVIDENCE()
    worst = max(findings, key=lambda x: x.state.rank)
    if worst.state in (LinkState.REFUTED, LinkState.REJECTED) or kind in ("driver", "plate", "evidence"):
        return worst.state, worst.reason
    best = min(findings, key=lambda x: x.state.rank)
    return best.state, best.reason


def _not_accepted(checked: CheckedEvidence) -> LinkFinding | None:
    """Return the finding for evidence that is not accepted, None for accepted evidence."""
    finding = checked.finding
    if finding.outcome is Acceptance.ACCEPTED:
        return None
    if finding.outcome is Acceptance.UNDECIDED:
        return LinkFinding(checked, LinkState.UNKNOWN, finding.reason)
    state = LinkState.STALE if finding.reason.kind in STALE else LinkState.REJECTED
    return LinkFinding(checked, state, finding.reason)


def _finding_of_file(checked: CheckedEvidence) -> LinkFinding:
    """Return the state that a piece of evidence gives to a link to itself."""
    wrong = _not_accepted(checked)
    if wrong is not None:
        return wrong
    if checked.remark:
        return LinkFinding(checked, LinkState.REFUTED, ReasonKind.TOLD(checked.remark))
    state = _SHOWN.get(checked.finding.verdict, LinkState.UNKNOWN)
    return LinkFinding(
        checked, state, NO_REASON if state.is_shown else ReasonKind.TOLD(checked.finding.verdict)
    )


def _findings_of_formula(target: Target, evidence: Sequence[CheckedEvidence]) -> Iterator[LinkFinding]:
    """Yield the findings whose claim is the formula or label of a link, or its negation."""
    label = " ".join(target.link.target.split())
    for checked in evidence:
        if checked.finding.kind == "test":
            continue
        by_label = (
            target.meaning is None
            and checked.finding.subject is SubjectKind.PROPERTY
            and checked.finding.name == label
        )
        if by_label or (target.meaning is not None and checked.meaning == target.meaning):
            yield _not_accepted(checked) or _finding_of_formula(target.link.kind, checked)
        elif target.meaning is not None and checked.meaning == target.meaning.opposite:
            yield from _findings_of_opposite(target.link.kind, checked)


def _finding_of_formula(kind: str, checked: CheckedEvidence) -> LinkFinding:
    """Return the finding for accepted evidence about the formula itself."""
    verdict, reason = checked.finding.verdict, checked.finding.reason
    if kind == "claim":
        if verdict == "IMPOSSIBLE":
            return LinkFinding(checked, LinkState.REFUTED, ReasonKind.NEVER_HOLDS())
        if verdict == "WITNESSED":
            return LinkFinding(checked, LinkState.UNKNOWN, ReasonKind.ONE_DRIVE())
        if verdict == "REFUTED":
            return LinkFinding(checked, LinkState.REFUTED, ReasonKind.TRACE_REFUTES())
    elif verdict == "IMPOSSIBLE":
        return LinkFinding(checked, LinkState.REFUTED, ReasonKind.NO_DRIVE_SHOWS())
    elif verdict == "REFUTED":
        return LinkFinding(checked, LinkState.UNKNOWN, ReasonKind.OPPOSITE_DRIVE())
    if verdict == "VACUOUS":
        reason = ReasonKind.VACUOUS()
    state = _SHOWN.get(verdict, LinkState.UNKNOWN)
    explanation = ReasonKind.VERDICT(verdict, reason) if reason else ReasonKind.TOLD(verdict)
    return LinkFinding(checked, state, NO_REASON if state.is_shown else explanation)


def _findings_of_opposite(kind: str, checked: CheckedEvidence) -> Iterator[LinkFinding]:
    """Yield the finding for accepted evidence about the negated formula."""
    if checked.finding.outcome is not Acceptance.ACCEPTED:
        return
    if checked.finding.verdict == "PROVED":
        yield LinkFinding(
            checked,
            LinkState.REFUTED,
            ReasonKind.NO_DRIVE_SHOWS() if kind == "scenario" else ReasonKind.OPPOSITE_PROVED(),
        )
    elif checked.finding.verdict == "WITNESSED" and kind == "claim":
        yield LinkFinding(checked, LinkState.REFUTED, ReasonKind.DRIVE_REFUTES())


def _findings_of_test(name: str, evidence: Sequence[CheckedEvidence]) -> Iterator[LinkFinding]:
    """Yield the findings of a catalogue about a test; without a catalogue, of the drive whose file has its
    name.
    """
    of_test = [
        checked
        for checked in evidence
        if checked.finding.subject in (SubjectKind.TEST, SubjectKind.RUN) and checked.finding.name == name
    ]
    if not of_test:
        of_test = [
            checked
            for checked in evidence
            if checked.finding.kind == "drive" and Path(checked.finding.where).stem == name
        ]
    for checked in of_test:
        wrong = _not_accepted(checked)
        if wrong is not None:
            yield wrong
        elif checked.remark:
            yield LinkFinding(checked, LinkState.REFUTED, ReasonKind.TOLD(checked.remark))
        elif checked.finding.shows == "unreadable":
            yield LinkFinding(checked, LinkState.REJECTED, ReasonKind.TOLD(checked.finding.claim))
        elif checked.finding.shows == "nothing":
            yield LinkFinding(checked, LinkState.UNKNOWN, ReasonKind.SHOWS_NONE())
        elif checked.finding.verdict == "READ":
            yield LinkFinding(checked, LinkState.UNKNOWN, ReasonKind.NO_DRIVE_OF_FORMULA())
        elif checked.finding.verdict == "IMPOSSIBLE":
            yield LinkFinding(checked, LinkState.REFUTED, ReasonKind.NO_DRIVE_SHOWS())
        else:
            state = _SHOWN.get(checked.finding.verdict, LinkState.UNKNOWN)
            is_row = checked.finding.subject is SubjectKind.TEST
            yield LinkFinding(checked, state, shows=checked.finding.claim if is_row else "")


@dataclass(frozen=True)
class DriverLink:
    """The statement that a driver model in place of SV prevents the collision of a test, or does not."""

    test: str
    model: str
    side: str


def driver_link(link: Link) -> DriverLink:
    """Return the test, model and side of a link such as ``CUT-1: careful preventable``. Raises
    ``InputError``.
    """
    match = _DRIVER.fullmatch(" ".join(link.target.split()))
    if match is None or match.group("model") not in MODELS:
        raise InputError(
            f"drivers='{link.target[:60]}': write TEST: MODEL preventable, or unpreventable; models are "
            f"{', '.join(MODELS)}"
        )
    return DriverLink(*match.group("test", "model", "side"))


def _findings_of_driver(link: DriverLink, evidence: Sequence[CheckedEvidence]) -> Iterator[LinkFinding]:
    """Yield the decisions of a catalogue about a test under a driver model, one for each scenario that it
    shows.
    """
    for checked in evidence:
        wrong = _not_accepted(checked)
        if wrong is not None and _is_driven(checked, link.test, link.model):
            yield wrong
        if checked.finding.subject is not SubjectKind.TEST or checked.finding.name != link.test:
            continue
        if wrong is not None:
            yield wrong
            continue
        for decided in checked.finding.drivers:
            if decided.driver == link.model:
                state, reason = _side_state(decided.side, link.side), _side_reason(decided, link.side)
                yield LinkFinding(checked, state, reason, _margin_text(decided))


def _side_state(side: TestedSide, required: str) -> LinkState:
    match side:
        case "preventable" | "unpreventable":
            return LinkState.WITNESSED if side == required else LinkState.REFUTED
        case "partly":
            return LinkState.REFUTED
        case "not covered" | "undecided":
            return LinkState.UNKNOWN
        case _:
            assert_never(side)


def _side_reason(decided: DriverSide, required: str) -> Reason:
    return NO_REASON if decided.side == required else ReasonKind.DRIVER_SIDE(decided.scenario, decided.side)


def _margin_text(decided: DriverSide) -> str:
    """Return the margin of a driver model: its least gap, or how fast it touches the other vehicle."""
    if decided.instant is not None and decided.speed is not None:
        return f"{decided.scenario}: touches at {decided.instant:g} s, {faster_text(decided.speed)}"
    return "" if decided.gap is None else f"{decided.scenario}: least gap {decided.gap:g} m"


def is_related(link: Link, checked: CheckedEvidence) -> bool:
    """Return whether accepted evidence is about the test of a link, but does not show the link by itself.

    Examples: ``CUT-1 excludes scenario_4``, or the drive of a driver model in the test.
    """
    if checked.finding.outcome is not Acceptance.ACCEPTED:
        return False
    match link.kind:
        case "test":
            of_test = checked.finding.subject in OF_TESTS and checked.finding.name == link.target
            return of_test or any(_is_driven(checked, link.target, model) for model in MODELS)
        case "driver":
            about = driver_link(link)
            return _is_driven(checked, about.test, about.model)
        case "claim" | "scenario" | "plate" | "evidence":
            return False
        case _:
            assert_never(link.kind)


def _is_driven(checked: CheckedEvidence, test: str, model: str) -> bool:
    return checked.finding.subject is SubjectKind.DRIVEN and checked.finding.name == f"{test}: {model}"


def _is_plate(checked: CheckedEvidence, name: str) -> bool:
    return checked.finding.subject is SubjectKind.PLATE and checked.finding.name == name


def _is_at(checked: CheckedEvidence, place: Path) -> bool:
    here = checked.path.resolve()
    return here == place or place in here.parents


def _stale_if_values_differ(finding: LinkFinding, values: Values) -> LinkFinding:
    """Return the finding, as STALE where its drive was judged with other parameter values than
    are in force.
    """
    if not (finding.state.is_shown and finding.evidence.values):
        return finding
    library = finding.evidence.specification.library
    here = default_values(library) | dict(values)
    other = [
        f"{n} = {v} (now {here[n]})"
        for n, v in sorted(finding.evidence.values.items())
        if here.get(n, v) != v
    ]
    if not other:
        return finding
    return LinkFinding(finding.evidence, LinkState.STALE, ReasonKind.JUDGED_WITH(", ".join(other)))
