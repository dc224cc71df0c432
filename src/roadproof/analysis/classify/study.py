"""The classes of scenarios with evidence: a drive for each, a certificate for each claim about them."""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import ClassVar

from roadproof.analysis.basis import Basis, ProofResult
from roadproof.analysis.classify.cells import Cell
from roadproof.analysis.classify.classes import Class, Classes
from roadproof.analysis.classify.divide import Division
from roadproof.analysis.classify.drives import Example, find_examples
from roadproof.analysis.classify.shares import Shares
from roadproof.analysis.classify.text import ClassClaim, claims_of, with_classes, write_classes
from roadproof.analysis.study.evidence_store import INDEX, EvidenceStore, Question
from roadproof.analysis.study.frame import Unprepared
from roadproof.errors import InputError
from roadproof.evidence.answers import classify as kept
from roadproof.evidence.answers.classify import SCHEMA, Doubt
from roadproof.evidence.journal import ANSWERS, HEAD, Journal, head_of, read_kept
from roadproof.evidence.judged import JudgedDrive
from roadproof.evidence.strict import LARGEST_INDEX, read_json
from roadproof.reasons import Reason
from roadproof.runtime.canonical import digest
from roadproof.verdict import Verdict

CLAIMS_IN_A_PIECE = 8
CLAIM = 4.0  # how much more work a claim is given than a drive


@dataclass(frozen=True)
class Alike:
    """Classes in which the same happens, that want drives; ``known`` are drives of others of these."""

    classes: tuple[Class, ...]
    known: tuple[JudgedDrive, ...] = ()


@dataclass(frozen=True)
class ProofClaims:
    """Claims that want proofs."""

    claims: tuple[ClassClaim, ...]


@dataclass(frozen=True)
class ClassificationResult:
    """All answers together; ``doubts`` are about the division, ``shares`` None where none were counted."""

    examples: tuple[Example, ...]
    decisions: tuple[ProofResult[ClassClaim], ...]
    doubts: tuple[Doubt, ...] = ()
    shares: Shares | None = None


@dataclass(frozen=True)
class Classification(Unprepared):
    """The question for drives of ``classes`` and proofs of ``claims``, as a ``study.frame.Study``.

    ``basis`` is about the set that ``text`` defines; where that is empty, the division was cut off.
    """

    record_type: ClassVar[type[kept.Record]] = kept.Record
    basis: Basis
    classes: Classes
    text: str
    claims: tuple[ClassClaim, ...]
    doubts: tuple[Doubt, ...] = ()

    @property
    def question(self) -> Question:
        said = {"set": self.classes.plan.set_name, **self.basis.said()}
        return Question(
            SCHEMA,
            {**said, "scenarios": list(self.classes.plan.numbers)},
            self.basis.limits,
            self.basis.library,
        )

    @cached_property
    def _named(self) -> dict[str, Class | ClassClaim]:
        named: list[Class | ClassClaim] = [*self.classes.all(), *self.claims]
        return {x.name: x for x in named}

    def pieces(self, known: Mapping[str, Example | ProofResult[ClassClaim]]) -> Sequence[Alike | ProofClaims]:
        """Classes in which the same happens are one piece: a drive of one may do for another."""
        pieces: list[Alike | ProofClaims] = []
        for alike in self.classes.alike():
            left = tuple(one for one in alike if one.name not in known)
            drives = [x.drive for one in alike if isinstance(x := known.get(one.name), Example) and x.drive]
            if left:
                pieces.append(Alike(left, tuple(drives)))
        claims = [claim for claim in self.claims if claim.name not in known]
        for first in range(0, len(claims), CLAIMS_IN_A_PIECE):
            pieces.append(ProofClaims(tuple(claims[first : first + CLAIMS_IN_A_PIECE])))
        return pieces

    def settle(self, piece: Alike | ProofClaims) -> dict[str, Example | ProofResult[ClassClaim]]:
        match piece:
            case Alike(classes, known):
                return {x.one.name: x for x in find_examples(self.basis, classes, known)}
            case ProofClaims(claims):
                units = CLAIM * self.basis.effort.units
                return {x.name: self.basis.settle(x, x.query, units, x.name) for x in claims}

    def doubt(
        self, piece: Alike | ProofClaims, reason: Reason
    ) -> dict[str, Example | ProofResult[ClassClaim]]:
        match piece:
            case Alike(classes):
                return {one.name: Example(one, verdict=Verdict.UNKNOWN, reason=reason) for one in classes}
            case ProofClaims(claims):
                return {
                    claim.name: ProofResult(claim, verdict=Verdict.UNKNOWN, reason=reason) for claim in claims
                }

    def is_sure(self, answer: Example | ProofResult[ClassClaim]) -> bool:
        return answer.verdict in (Verdict.WITNESSED, Verdict.PROVED, Verdict.VACUOUS)

    def wanted(self, known: Mapping[str, Example | ProofResult[ClassClaim]]) -> Collection[str]:
        return self._named

    def key(self, name: str) -> str:
        """A class is told from all scenarios, by a formula."""
        one = self._named[name]
        if isinstance(one, ClassClaim):
            return self.basis.key([one.query], name)
        return digest(name, self._alike_keys[one.what])

    @cached_property
    def _alike_keys(self) -> dict[Cell, str]:
        """By what happens, a digest of all classes with that: a drive of one may do for another."""
        home, found = self.basis.specification, dict[Cell, str]()
        for alike in self.classes.alike():
            called = [(x.name, x.vehicles, x.scenarios, x.what.holds, x.place, x.description) for x in alike]
            found[alike[0].what] = self.basis.key((x.query(home) for x in alike), called)
        return found

    def record(
        self, name: str, answer: Example | ProofResult[ClassClaim], shelf: EvidenceStore
    ) -> kept.Record:
        match answer:
            case Example(one):
                kept_class = kept.KeptClass(
                    name=name,
                    vehicles=one.vehicles,
                    scenarios=one.scenarios,
                    happens=one.what.holds,
                    where=one.place,
                    description=one.description,
                    formula=one.formula,
                    verdict=answer.verdict,
                    reason=answer.reason,
                    drive=shelf.drive(f"drives/{name}.json", answer.drive),
                )
                return kept.Record(classes=(kept_class,), claims=())
            case ProofResult(claim):
                kept_claim = kept.Claim(
                    name=name,
                    kind=claim.kind,
                    claim=claim.query.text,
                    verdict=answer.verdict,
                    reason=answer.reason,
                    certificate=shelf.certificate(f"proofs/{name}.json", answer.certificate),
                    seconds=answer.seconds,
                )
                return kept.Record(classes=(), claims=(kept_claim,))

    def recall(
        self, record: kept.Record, shelf: EvidenceStore
    ) -> tuple[str, Example | ProofResult[ClassClaim]]:
        entries: list[kept.KeptClass | kept.Claim] = [*record.classes, *record.claims]
        if len(entries) != 1:
            raise InputError(f"{len(entries)} answers, where one was kept")
        (entry,) = entries
        match entry, self._named.get(entry.name):
            case kept.KeptClass(), Class() as one if entry.formula == one.formula:
                return entry.name, Example(
                    one, verdict=entry.verdict, reason=entry.reason, drive=shelf.read_drive(entry.drive)
                )
            case kept.Claim(), ClassClaim() as claim if entry.claim == claim.query.text:
                certificate = shelf.read_certificate(entry.certificate)
                return entry.name, ProofResult(
                    claim,
                    verdict=entry.verdict,
                    reason=entry.reason,
                    certificate=certificate,
                    seconds=entry.seconds,
                )
            case _:
                raise InputError(f"there is no class and no claim like this '{entry.name}'")

    def classified(
        self, answers: Mapping[str, Example | ProofResult[ClassClaim]], shares: Shares | None = None
    ) -> ClassificationResult:
        """The answers in the order of the classes and of the claims."""
        found = [answers[name] for name in self._named]
        return ClassificationResult(
            tuple(x for x in found if isinstance(x, Example)),
            tuple(x for x in found if isinstance(x, ProofResult)),
            self.doubts,
            shares,
        )

    def index(
        self, classified: ClassificationResult, records: Mapping[str, kept.Record], seconds: float
    ) -> kept.Index:
        """The index, made of the answers as they are recorded."""
        shares = classified.shares
        every = [records[name] for name in self._named]
        return kept.Index(
            **self.question.heading,
            text=self.text,
            classes=tuple(_counted(x, shares) for record in every for x in record.classes),
            claims=tuple(x for record in every for x in record.claims),
            shares=None if shares is None else shares.told,
            doubts=classified.doubts,
            seconds=round(seconds, 1),
        )


def _counted(one: kept.KeptClass, shares: Shares | None) -> kept.CountedClass:
    counts = (None, None) if shares is None else (shares.situations[one.name], shares.traces[one.name])
    return kept.CountedClass(**vars(one), situations=counts[0], traces=counts[1])


def classification_of(basis: Basis, division: Division) -> Classification:
    """The question that a division of scenarios of ``basis`` leaves. Raises ``InputError``."""
    if division.cut_off:
        return Classification(basis, division.classes, "", (), division.doubts)
    text = write_classes(division.classes, basis.specification)
    specification = with_classes(text, basis.specification)
    claims = claims_of(division.classes, division.empty, specification)
    about = replace(basis, specification=specification, sets=())
    return Classification(about, division.classes, text, claims, division.doubts)


# --- what earlier runs left in a folder ------------------------------------------------------------

KINDS = ("drives", "proofs")


def make_room(folder: Path, question: Question) -> None:
    """Remove evidence of classes that are no more, which speaks of another classes.spec, and its index.

    Only what an earlier run has written: a folder without its traces is left alone.
    """
    if not (_says(folder / HEAD, "of") or _says(folder / INDEX, "schema")):
        return
    evidence = [path for kind in KINDS for path in (folder / kind).glob("*.json")]
    kept = _kept(folder, question)
    if kept is None:
        for path in (folder / HEAD, *(folder / ANSWERS).glob("*.json")):
            path.unlink(missing_ok=True)
    lines = [] if kept is None else [line.record for line in kept.lines if line.record is not None]
    named = {name for record in lines for name in record.texts("evidence")}
    (folder / INDEX).unlink(missing_ok=True)
    for path in evidence:
        if path.relative_to(folder).as_posix() not in named:
            path.unlink(missing_ok=True)


def _says(path: Path, field: str) -> bool:
    try:
        said = read_json(path, LARGEST_INDEX)
    except InputError:
        return False
    return isinstance(said, dict) and said.get(field) == SCHEMA


def _kept(folder: Path, question: Question) -> Journal | None:
    """The answers of a run that asked the same."""
    try:
        kept = read_kept(folder)
    except InputError:
        return None
    head = head_of(question.schema, question.fingerprint, question.said)
    return kept if kept is not None and kept.head.content == head else None
