"""Searches for drives at one point after the other, each point a claim.

A generator yields claims with their names, and is sent the answers. So one function lists claims for the loop
that decides them, and computes the view from known answers.
"""

from collections.abc import Callable, Generator
from dataclasses import dataclass, field, replace
from fractions import Fraction
from typing import TypeAlias, TypeVar

from roadproof.engines.search.known_drive import KnownDrive, is_same_motion
from roadproof.engines.setting import Search
from roadproof.evidence.answer import ClaimAnswer
from roadproof.evidence.assuming import valid_under
from roadproof.evidence.certificate import Certificate
from roadproof.evidence.claim import HELP, Claim, Exists
from roadproof.evidence.judged import JudgedDrive
from roadproof.extensions.surveys.staged import finest, fit_grid, staged_claim, stand_ins, values_of
from roadproof.library.compose import negation
from roadproof.library.elaborate import read_claim
from roadproof.library.motion import value_texts
from roadproof.library.specification import Query
from roadproof.logic.formula import Not
from roadproof.logic.parts import parts_of, texts_of
from roadproof.logic.rewrite import is_cubic_state, parameters_of
from roadproof.reasons import NO_REASON, Reason, ReasonKind
from roadproof.verdict import DriveVerdict, Verdict

T = TypeVar("T")
Point: TypeAlias = tuple[Fraction, ...]
"""A value for each variable, in order, in SI units."""
ClaimGenerator: TypeAlias = Generator[tuple[str, Claim], ClaimAnswer, T]
"""Yields claims with their names, is sent the answers, and returns what they show."""


@dataclass(frozen=True)
class PointFinding:
    """The finding at one point; ``query``: the formula that the drive satisfies, or that has no drive.

    ``name`` and ``answer``: those of the claim that decides; None if undecided. ``number``: that of the
    drive, equal for equal motions.
    """

    at: Point
    query: Query
    verdict: DriveVerdict
    reason: Reason = NO_REASON
    name: str = ""
    answer: ClaimAnswer | None = None
    number: int | None = None

    @property
    def has_drive(self) -> bool:
        """Return whether there is a drive."""
        return self.verdict is Verdict.WITNESSED

    @property
    def drive(self) -> JudgedDrive | None:
        """The drive, if there is one."""
        return None if self.answer is None else self.answer.drive

    @property
    def certificate(self) -> Certificate | None:
        """The proof that there is no drive, if one is known."""
        return None if self.answer is None else self.answer.certificate

    @property
    def assuming(self) -> tuple[str, ...]:
        """The values of parameters that the proof assumes; empty if it holds for all."""
        return () if self.certificate is None else self.certificate.assumed.texts


@dataclass
class JudgementCache:
    """A cache of judgements of drives, which do not change."""

    values: dict[object, tuple[object, object]] = field(default_factory=dict)

    def __reduce__(self) -> "tuple[type[JudgementCache], tuple[()]]":
        return JudgementCache, ()  # other processes work it out again

    def of(self, key: object, drive: object, work_out: Callable[[], T]) -> T:
        """Return a value for a drive, which is computed once for each ``key`` and drive."""
        known = self.values.get(key)
        if known is None or known[0] is not drive:
            known = self.values[key] = (drive, work_out())
        value: T = known[1]  # type: ignore[assignment]
        return value


class Points:
    """The claims of one formula at several points, and the drives of their answers.

    ``searches``: the number of answers that are neither proofs nor follow from an earlier drive.
    """

    def __init__(self, remembered: JudgementCache) -> None:
        self.remembered = remembered
        self.answers: dict[str, ClaimAnswer] = {}
        self.drives: list[KnownDrive] = []
        self.searches = 0

    def ask(self, name: str, claim: Claim) -> ClaimGenerator[ClaimAnswer]:
        """Ask a claim, once."""
        if name not in self.answers:
            answer = yield name, claim
            self.answers[name] = answer
            known = len(self.drives)
            if answer.drive is not None:
                self.number(answer.drive)
            is_search = isinstance(claim.mode, Exists) and claim.mode.by == "search"
            self.searches += len(self.drives) > known or (is_search and answer.drive is None)
        return self.answers[name]

    def number(self, drive: JudgedDrive) -> int:
        """Return the number of a drive, from 1; equal motions have equal numbers."""
        for k, known in enumerate(self.drives, 1):
            if is_same_motion(known.judged.file, drive.file):
                return k
        self.drives.append(KnownDrive(drive))
        return len(self.drives)

    def find(
        self, name: str, at: Point, search: Search, natural: bool = True
    ) -> ClaimGenerator[PointFinding]:
        """Ask for a drive at a point; for formulas about a state, else for a proof that there is none.

        ``natural``: whether natural drives come first. Raises ``UsageError``.
        """
        fitting = fit_grid(search)
        if fitting is None:
            if not self.has_drive(name, search):
                for k, near in enumerate(stand_ins(search), 1):
                    yield from self.ask(f"{HELP}{name}-near-{k}", staged_claim(near, explain=False))
            claim = staged_claim(search, by="known")
        else:
            claim = staged_claim(fitting, natural)
        claim_name = f"{HELP}{name}" if is_cubic_state(search.query.formula) else name
        answer = yield from self.ask(claim_name, claim)
        finding = self.finding(claim_name, at, search, answer)
        if fitting is None and not finding.has_drive:
            finding = replace(finding, reason=ReasonKind.NO_COMMON_STEP(float(finest(search.setting))))
        return finding if finding.has_drive else (yield from self.never(name, at, search)) or finding

    def again(self, name: str, at: Point, search: Search) -> ClaimGenerator[PointFinding]:
        """Ask whether a known drive serves a point."""
        answer = yield from self.ask(name, staged_claim(search, by="known"))
        return self.finding(name, at, search, answer)

    def finding(self, name: str, at: Point, search: Search, answer: ClaimAnswer) -> PointFinding:
        """Return the finding of an answer at a point."""
        number = None if answer.drive is None else self.number(answer.drive)
        verdict: DriveVerdict = Verdict.UNKNOWN
        match answer.verdict:
            case Verdict.WITNESSED | Verdict.NONE_WITHIN | Verdict.IMPOSSIBLE as known:
                verdict = known
        return PointFinding(at, search.query, verdict, answer.reason, name, answer, number)

    def has_drive(self, name: str, search: Search) -> bool:
        """Return whether a known drive serves a point."""
        claim = staged_claim(search, by="known")
        return any(
            self.remembered.of(
                (name, k, claim.query.text, claim.parameters),
                x.judged,
                lambda drive=x: drive.here(claim) is not None,  # type: ignore[misc]
            )
            for k, x in reversed([*enumerate(self.drives)])
        )

    def never(self, name: str, at: Point, search: Search) -> ClaimGenerator[PointFinding | None]:
        """Ask for a proof that a formula holds in no state, with the parameter values of a search.

        The proof is about all states and needs no limits. It exists only for formulas about one state that
        the encoders do not read.
        """
        if not is_cubic_state(search.query.formula):
            return None
        home, values = search.specification, values_of(search)
        there = {name: values[name] for name in parameters_of(search.query.formula)}
        claim = valid_under(home, negation(search.query), value_texts(home, there))
        answer = yield from self.ask(name, claim)
        if answer.certificate is None:
            return None
        return self._impossible(name, at, search, answer, ReasonKind.PROVED_STATES())

    def proved(self, name: str, at: Point, search: Search, of: str) -> ClaimGenerator[PointFinding | None]:
        """Ask for a proof that there is no drive, for all values of parameters.

        ``of``: the quantity that the proof covers entirely, in words for the reason.
        """
        answer = yield from self.ask(f"{HELP}{name}", staged_claim(search, by="proof"))
        if answer.certificate is None:
            return None
        return self._impossible(
            name, at, search, answer, ReasonKind.PROVED_CORE(of, " and ".join(core_of(answer)))
        )

    def _impossible(
        self, name: str, at: Point, search: Search, answer: ClaimAnswer, reason: Reason
    ) -> PointFinding:
        claim_name = next(known for known, x in self.answers.items() if x is answer)
        return PointFinding(at, search.query, Verdict.IMPOSSIBLE, reason, claim_name, answer)


def core_of(answer: ClaimAnswer) -> tuple[str, ...]:
    """Return the contradicting parts of a claim that is proved impossible."""
    proof = answer.certificate
    assert proof is not None
    denied = read_claim(answer.claim.home, proof.claim).formula
    assert isinstance(denied, Not)
    return texts_of([*dict.fromkeys(parts_of(denied.body))])
