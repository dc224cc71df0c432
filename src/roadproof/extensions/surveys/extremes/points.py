"""Drives asked for at one point after the other, each point a claim; and what the answers show together.

A generator yields claims with their names, and is sent the answers. So the same lines list claims for whoever
settles them, and read the answers for whoever looks at them.
"""

from collections.abc import Callable, Generator
from dataclasses import dataclass, field, replace
from fractions import Fraction
from typing import TypeAlias, TypeVar

from roadproof.engines.search.known_drive import KnownDrive, is_same_motion
from roadproof.engines.search.outcome import Search
from roadproof.engines.search.stages import finest, fit_grid, staged_claim, stand_ins, values_of
from roadproof.evidence.answer import Answer
from roadproof.evidence.certificate import Certificate
from roadproof.evidence.claim import HELP, Claim, Exists, valid_under
from roadproof.evidence.judged import JudgedDrive
from roadproof.library.compose import negation
from roadproof.library.elaborate import read_claim
from roadproof.library.motion import value_texts
from roadproof.library.specification import Query
from roadproof.logic.formula import Not
from roadproof.logic.parts import parts_of, texts_of
from roadproof.logic.rewrite import is_cubic_state, parameters_of
from roadproof.reasons import NO_REASON, Reason, Why
from roadproof.verdict import DriveVerdict, Verdict

T = TypeVar("T")
Point: TypeAlias = tuple[Fraction, ...]
"""A value for each variable, in order, in SI units."""
Asking: TypeAlias = Generator[tuple[str, Claim], Answer, T]
"""Yields claims with their names, is sent the answers, and returns what they show."""


@dataclass(frozen=True)
class PointFinding:
    """What is known at one point; ``query`` is what the drive satisfies, or what has no drive.

    ``name`` and ``answer``: of the claim that shows it; None where a doubt has none. ``number`` tells drives
    apart.
    """

    at: Point
    query: Query
    verdict: DriveVerdict
    reason: Reason = NO_REASON
    name: str = ""
    answer: Answer | None = None
    number: int | None = None

    @property
    def found(self) -> bool:
        """Whether there is a drive."""
        return self.verdict is Verdict.WITNESSED

    @property
    def drive(self) -> JudgedDrive | None:
        """The drive, if there is one."""
        return None if self.answer is None else self.answer.drive

    @property
    def certificate(self) -> Certificate | None:
        """The proof that there is none, if one is known."""
        return None if self.answer is None else self.answer.certificate

    @property
    def assuming(self) -> tuple[str, ...]:
        """The values of parameters with which it is proved that there is none; empty where for all."""
        return () if self.certificate is None else self.certificate.assumed.said


@dataclass
class Remembered:
    """What judging drives showed: it is the same each time that answers are looked through."""

    values: dict[object, tuple[object, object]] = field(default_factory=dict)

    def __reduce__(self) -> "tuple[type[Remembered], tuple[()]]":
        return Remembered, ()  # other processes work it out again

    def of(self, key: object, drive: object, work_out: Callable[[], T]) -> T:
        """Return what is worked out of a drive, once for each ``key`` and drive."""
        known = self.values.get(key)
        if known is None or known[0] is not drive:
            known = self.values[key] = (drive, work_out())
        value: T = known[1]  # type: ignore[assignment]
        return value


class Points:
    """The claims of one formula at several points, and the drives that their answers have shown.

    ``searches``: how many answers neither follow from an earlier drive nor are proofs.
    """

    def __init__(self, remembered: Remembered) -> None:
        self.remembered = remembered
        self.answers: dict[str, Answer] = {}
        self.drives: list[KnownDrive] = []
        self.searches = 0

    def ask(self, name: str, claim: Claim) -> Asking[Answer]:
        """Ask a claim, once."""
        if name not in self.answers:
            answer = yield name, claim
            self.answers[name] = answer
            known = len(self.drives)
            if answer.drive is not None:
                self.number(answer.drive)
            sought = isinstance(claim.mode, Exists) and claim.mode.by == "search"
            self.searches += len(self.drives) > known or (sought and answer.drive is None)
        return self.answers[name]

    def number(self, drive: JudgedDrive) -> int:
        """Return the number of a drive, from 1: those with the same motions have the same."""
        for k, known in enumerate(self.drives, 1):
            if is_same_motion(known.judged.file, drive.file):
                return k
        self.drives.append(KnownDrive(drive))
        return len(self.drives)

    def find(self, name: str, at: Point, search: Search, natural: bool = True) -> Asking[PointFinding]:
        """Ask for a drive at a point; of some formulas for a proof where there is none.

        ``natural``: natural drives come first, and not last. Raises ``UsageError``.
        """
        fitting = fit_grid(search)
        if fitting is None:
            if not self.has_drive(name, search):
                for k, near in enumerate(stand_ins(search), 1):
                    yield from self.ask(f"{HELP}{name}-near-{k}", staged_claim(near, explain=False))
            claim = staged_claim(search, by="known")
        else:
            claim = staged_claim(fitting, natural)
        sought = f"{HELP}{name}" if is_cubic_state(search.query.formula) else name
        answer = yield from self.ask(sought, claim)
        found = self.finding(sought, at, search, answer)
        if fitting is None and not found.found:
            found = replace(found, reason=Why.NO_COMMON_STEP(float(finest(search.setting))))
        return found if found.found else (yield from self.never(name, at, search)) or found

    def again(self, name: str, at: Point, search: Search) -> Asking[PointFinding]:
        """Ask whether a drive that is known serves a point."""
        answer = yield from self.ask(name, staged_claim(search, by="known"))
        return self.finding(name, at, search, answer)

    def finding(self, name: str, at: Point, search: Search, answer: Answer) -> PointFinding:
        """Return what an answer shows of a point."""
        number = None if answer.drive is None else self.number(answer.drive)
        verdict: DriveVerdict = Verdict.UNKNOWN
        match answer.verdict:
            case Verdict.WITNESSED | Verdict.NONE_WITHIN | Verdict.IMPOSSIBLE as known:
                verdict = known
        return PointFinding(at, search.query, verdict, answer.reason, name, answer, number)

    def has_drive(self, name: str, search: Search) -> bool:
        """Return whether a drive that is known serves a point."""
        claim = staged_claim(search, by="known")
        return any(
            self.remembered.of(
                (name, k, claim.query.text, claim.parameters),
                x.judged,
                lambda drive=x: drive.here(claim) is not None,  # type: ignore[misc]
            )
            for k, x in reversed([*enumerate(self.drives)])
        )

    def never(self, name: str, at: Point, search: Search) -> Asking[PointFinding | None]:
        """Ask for a proof that a formula holds in no state, with the parameters at the values of a search.

        It is for all states, wherever, however fast and how near vehicles are: it needs no limits. Formulas
        about more than a state, and those that engines read, have none.
        """
        if not is_cubic_state(search.query.formula):
            return None
        home, values = search.specification, values_of(search)
        there = {name: values[name] for name in parameters_of(search.query.formula)}
        claim = valid_under(home, negation(search.query), value_texts(home, there))
        answer = yield from self.ask(name, claim)
        if answer.certificate is None:
            return None
        return self._impossible(name, at, search, answer, Why.PROVED_STATES())

    def proved(self, name: str, at: Point, search: Search, of: str) -> Asking[PointFinding | None]:
        """Ask for a proof that there is no drive, whatever the values of parameters are.

        ``of``: what it is proved for all of, in words.
        """
        answer = yield from self.ask(f"{HELP}{name}", staged_claim(search, by="proof"))
        if answer.certificate is None:
            return None
        return self._impossible(name, at, search, answer, Why.PROVED_CORE(of, " and ".join(core_of(answer))))

    def _impossible(
        self, name: str, at: Point, search: Search, answer: Answer, reason: Reason
    ) -> PointFinding:
        asked = next(known for known, x in self.answers.items() if x is answer)
        return PointFinding(at, search.query, Verdict.IMPOSSIBLE, reason, asked, answer)


def core_of(answer: Answer) -> tuple[str, ...]:
    """Return the parts that clash, of a claim that is proved to be impossible."""
    proof = answer.certificate
    assert proof is not None
    denied = read_claim(answer.claim.home, proof.claim).formula
    assert isinstance(denied, Not)
    return texts_of([*dict.fromkeys(parts_of(denied.body))])
