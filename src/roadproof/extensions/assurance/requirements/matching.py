"""Which evidence shows which link, and the state that follows from it."""

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
from roadproof.library.bind import default_values
from roadproof.library.elaborate import apply_definition
from roadproof.library.scenario_references import read_query
from roadproof.library.specification import Query, Specification
from roadproof.logic.rewrite import without_names
from roadproof.reasons import NO_REASON, Reason, Why

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
"""What an accepted verdict says of a file of evidence; all others are not decided."""


@dataclass(frozen=True)
class Target:
    """A link as it is read: ``meaning`` None where its name is no formula; ``specification``: of its set."""

    link: Link
    specification: Specification
    meaning: Meaning | None = None


@dataclass(frozen=True)
class Shown:
    """What one piece of evidence says of a link."""

    evidence: CheckedEvidence
    state: LinkState
    reason: Reason = NO_REASON


Values: TypeAlias = Mapping[str, Fraction]


def read_target(link: Link, home: Specification, source: str) -> Target:
    """A link read with the definitions of a trace. Raises ``InputError``, which names ``source``."""
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
    """A scenario by number, number@set, name or definition, or a formula. Raises ``InputError``."""
    word, _, set_name = target.partition("@")
    if set_name in home.library.sets and re.fullmatch(r"\d+|\w+", word):
        home, target = home.in_set(set_name), word
    if target in home.definitions:
        return apply_definition(home, target), home
    return read_query(home, target, source)[1], home


def shown_by(
    target: Target, evidence: Sequence[CheckedEvidence], values: Values, folder: Path
) -> list[Shown]:
    """What the evidence says of a link. ``values``: of all parameters; paths begin in ``folder``."""
    match target.link.kind:
        case "claim" | "scenario":
            found = _of_formula(target, evidence)
        case "test":
            found = _of_test(target.link.target, evidence)
        case "driver":
            found = _of_driver(driver_link(target.link), evidence)
        case "plate":
            found = (_by_itself(x) for x in evidence if _is_plate(x, target.link.target))
        case "evidence":
            place = (folder / target.link.target).resolve()
            found = (_by_itself(x) for x in evidence if _is_at(x, place))
    return [_with_values(x, values) for x in found]


def combined(kind: str, found: Sequence[Shown]) -> tuple[LinkState, Reason]:
    """The state of a link. A refutation counts before all else, then evidence that is rejected.

    Of driver models, plates and files all parts must be shown, of other links one is enough.
    """
    if not found:
        return LinkState.MISSING, Why.NO_EVIDENCE()
    worst = max(found, key=lambda x: x.state.rank)
    if worst.state in (LinkState.REFUTED, LinkState.REJECTED) or kind in ("driver", "plate", "evidence"):
        return worst.state, worst.reason
    best = min(found, key=lambda x: x.state.rank)
    return best.state, best.reason


def _not_accepted(x: CheckedEvidence) -> Shown | None:
    """What evidence that is not accepted says; None where it is."""
    finding = x.finding
    if finding.outcome is Acceptance.ACCEPTED:
        return None
    if finding.outcome is Acceptance.UNDECIDED:
        return Shown(x, LinkState.UNKNOWN, finding.reason)
    state = LinkState.STALE if finding.reason.kind in STALE else LinkState.REJECTED
    return Shown(x, state, finding.reason)


def _by_itself(x: CheckedEvidence) -> Shown:
    """What evidence says of itself."""
    wrong = _not_accepted(x)
    if wrong is not None:
        return wrong
    if x.remark:
        return Shown(x, LinkState.REFUTED, Why.TOLD(x.remark))
    state = _SHOWN.get(x.finding.verdict, LinkState.UNKNOWN)
    return Shown(x, state, NO_REASON if state.is_shown else Why.TOLD(x.finding.verdict))


def _of_formula(target: Target, evidence: Sequence[CheckedEvidence]) -> Iterator[Shown]:
    label = " ".join(target.link.target.split())
    for x in evidence:
        if x.finding.kind == "test":
            continue
        by_label = (
            target.meaning is None and x.finding.subject is SubjectKind.PROPERTY and x.finding.name == label
        )
        if by_label or (target.meaning is not None and x.meaning == target.meaning):
            yield _not_accepted(x) or _same(target.link.kind, x)
        elif target.meaning is not None and x.meaning == target.meaning.opposite:
            yield from _opposite(target.link.kind, x)


def _same(kind: str, x: CheckedEvidence) -> Shown:
    """What accepted evidence of the very formula says."""
    verdict, reason = x.finding.verdict, x.finding.reason
    if kind == "claim":
        if verdict == "IMPOSSIBLE":
            return Shown(x, LinkState.REFUTED, Why.NEVER_HOLDS())
        if verdict == "WITNESSED":
            return Shown(x, LinkState.UNKNOWN, Why.ONE_DRIVE())
        if verdict == "REFUTED":
            return Shown(x, LinkState.REFUTED, Why.TRACE_REFUTES())
    elif verdict == "IMPOSSIBLE":
        return Shown(x, LinkState.REFUTED, Why.NO_DRIVE_SHOWS())
    elif verdict == "REFUTED":
        return Shown(x, LinkState.UNKNOWN, Why.OPPOSITE_DRIVE())
    if verdict == "VACUOUS":
        reason = Why.VACUOUS()
    state = _SHOWN.get(verdict, LinkState.UNKNOWN)
    told = Why.VERDICT(verdict, reason) if reason else Why.TOLD(verdict)
    return Shown(x, state, NO_REASON if state.is_shown else told)


def _opposite(kind: str, x: CheckedEvidence) -> Iterator[Shown]:
    """What evidence of the opposite says, where it is accepted."""
    if x.finding.outcome is not Acceptance.ACCEPTED:
        return
    if x.finding.verdict == "PROVED":
        yield Shown(
            x, LinkState.REFUTED, Why.NO_DRIVE_SHOWS() if kind == "scenario" else Why.OPPOSITE_PROVED()
        )
    elif x.finding.verdict == "WITNESSED" and kind == "claim":
        yield Shown(x, LinkState.REFUTED, Why.DRIVE_REFUTES())


def _of_test(name: str, evidence: Sequence[CheckedEvidence]) -> Iterator[Shown]:
    """What a catalogue says of a test; without one, of the drive whose file has its name."""
    mine = [
        x
        for x in evidence
        if x.finding.subject in (SubjectKind.TEST, SubjectKind.RUN) and x.finding.name == name
    ]
    if not mine:
        mine = [x for x in evidence if x.finding.kind == "drive" and Path(x.finding.where).stem == name]
    for x in mine:
        wrong = _not_accepted(x)
        if wrong is not None:
            yield wrong
        elif x.remark:
            yield Shown(x, LinkState.REFUTED, Why.TOLD(x.remark))
        elif x.finding.shows == "unreadable":
            yield Shown(x, LinkState.REJECTED, Why.TOLD(x.finding.claim))
        elif x.finding.shows == "nothing":
            yield Shown(x, LinkState.UNKNOWN, Why.SHOWS_NONE())
        elif x.finding.verdict == "READ":
            yield Shown(x, LinkState.UNKNOWN, Why.NO_DRIVE_OF_FORMULA())
        elif x.finding.verdict == "IMPOSSIBLE":
            yield Shown(x, LinkState.REFUTED, Why.NO_DRIVE_SHOWS())
        else:
            yield Shown(x, _SHOWN.get(x.finding.verdict, LinkState.UNKNOWN))


@dataclass(frozen=True)
class DriverLink:
    """That a driver model in place of SV prevents the collision of a test, or does not."""

    test: str
    model: str
    side: str


def driver_link(link: Link) -> DriverLink:
    """Return what a link such as ``CUT-1: careful preventable`` says. Raises ``InputError``."""
    read = _DRIVER.fullmatch(" ".join(link.target.split()))
    if read is None or read["model"] not in MODELS:
        raise InputError(
            f"drivers='{link.target[:60]}': write TEST: MODEL preventable, or unpreventable; models are "
            f"{', '.join(MODELS)}"
        )
    return DriverLink(read["test"], read["model"], read["side"])


def _of_driver(link: DriverLink, evidence: Sequence[CheckedEvidence]) -> Iterator[Shown]:
    """What a catalogue says of a test under a driver model, in each scenario that it shows."""
    for x in evidence:
        wrong = _not_accepted(x)
        if wrong is not None and _is_driven(x, link.test, link.model):
            yield wrong
        if x.finding.subject is not SubjectKind.TEST or x.finding.name != link.test:
            continue
        if wrong is not None:
            yield wrong
            continue
        for decided in x.finding.drivers:
            if decided.driver == link.model:
                yield Shown(x, _side_shown(decided.side, link.side), _side_reason(decided, link.side))


def _side_shown(side: TestedSide, wanted: str) -> LinkState:
    match side:
        case "preventable" | "unpreventable":
            return LinkState.WITNESSED if side == wanted else LinkState.REFUTED
        case "partly":
            return LinkState.REFUTED
        case "not foreseen" | "undecided":
            return LinkState.UNKNOWN
        case _:
            assert_never(side)


def _side_reason(decided: DriverSide, wanted: str) -> Reason:
    return NO_REASON if decided.side == wanted else Why.DRIVER_SIDE(decided.scenario, decided.side)


def is_beside(link: Link, x: CheckedEvidence) -> bool:
    """Whether accepted evidence is about the test of a link, but does not show the link by itself.

    Such as that ``CUT-1 excludes scenario_4``, or the drive of a driver model in the test.
    """
    if x.finding.outcome is not Acceptance.ACCEPTED:
        return False
    match link.kind:
        case "test":
            of_test = x.finding.subject in OF_TESTS and x.finding.name == link.target
            return of_test or any(_is_driven(x, link.target, model) for model in MODELS)
        case "driver":
            about = driver_link(link)
            return _is_driven(x, about.test, about.model)
        case "claim" | "scenario" | "plate" | "evidence":
            return False
        case _:
            assert_never(link.kind)


def _is_driven(x: CheckedEvidence, test: str, model: str) -> bool:
    return x.finding.subject is SubjectKind.DRIVEN and x.finding.name == f"{test}: {model}"


def _is_plate(x: CheckedEvidence, name: str) -> bool:
    return x.finding.subject is SubjectKind.PLATE and x.finding.name == name


def _is_at(x: CheckedEvidence, place: Path) -> bool:
    here = x.path.resolve()
    return here == place or place in here.parents


def _with_values(x: Shown, values: Values) -> Shown:
    """The same, stale where its drive was judged with other values of parameters than are in force."""
    if not (x.state.is_shown and x.evidence.values):
        return x
    library = x.evidence.specification.library
    here = default_values(library) | dict(values)
    other = [
        f"{n} = {v} (now {here[n]})" for n, v in sorted(x.evidence.values.items()) if here.get(n, v) != v
    ]
    return Shown(x.evidence, LinkState.STALE, Why.JUDGED_WITH(", ".join(other))) if other else x
