"""The classes of scenarios with evidence: a drive for each, a certificate for each claim about them."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

from roadproof.analysis.basis import Basis
from roadproof.analysis.classify.classes import Class, Classes
from roadproof.analysis.classify.divide import Division, Doubt
from roadproof.analysis.classify.drives import Example, find_examples
from roadproof.analysis.classify.shares import Shares
from roadproof.analysis.classify.text import ClassClaim, claims_of, with_classes, write_classes
from roadproof.effort import Late
from roadproof.errors import InputError
from roadproof.evidence.certificate import Certificate
from roadproof.evidence.judged import Judged
from roadproof.study.shelf import Question, Shelf
from roadproof.verdict import Verdict

SCHEMA = "roadproof/classify/1"
CLAIMS_IN_A_PIECE = 8
CLAIM = 4.0  # how much more work a claim is given than a drive


@dataclass(frozen=True)
class Decision:
    """The verdict on a claim; a certificate where it is proved, else a reason."""

    claim: ClassClaim
    verdict: Verdict
    reason: str
    certificate: Certificate | None = None
    seconds: float = 0.0

    @property
    def holds(self) -> bool:
        """Whether the claim is proved, be it because its premise never holds."""
        return self.verdict in (Verdict.PROVED, Verdict.VACUOUS)


@dataclass(frozen=True)
class Alike:
    """Classes in which the same happens, that want drives; ``known`` are drives of others of these."""

    classes: tuple[Class, ...]
    known: tuple[Judged, ...] = ()


@dataclass(frozen=True)
class Claimed:
    """Claims that want proofs."""

    claims: tuple[ClassClaim, ...]


@dataclass(frozen=True)
class Classified:
    """All answers together; ``doubts`` are about the division, ``shares`` None where none were counted."""

    examples: tuple[Example, ...]
    decisions: tuple[Decision, ...]
    doubts: tuple[Doubt, ...] = ()
    shares: Shares | None = None


@dataclass(frozen=True)
class Classification:
    """The question for drives of ``classes`` and proofs of ``claims``, as a ``study.frame.Study``.

    ``basis`` is about the set that ``text`` defines; where that is empty, the division was cut off.
    """

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
            self.basis.models,
            self.basis.library,
        )

    @cached_property
    def _named(self) -> dict[str, Class | ClassClaim]:
        named: list[Class | ClassClaim] = [*self.classes.all(), *self.claims]
        return {x.name: x for x in named}

    def pieces(self, known: Mapping[str, Example | Decision]) -> Sequence[Alike | Claimed]:
        """Classes in which the same happens are one piece: a drive of one may do for another."""
        pieces: list[Alike | Claimed] = []
        for alike in self.classes.alike():
            left = tuple(one for one in alike if one.name not in known)
            drives = [x.drive for one in alike if isinstance(x := known.get(one.name), Example) and x.drive]
            if left:
                pieces.append(Alike(left, tuple(drives)))
        claims = [claim for claim in self.claims if claim.name not in known]
        for first in range(0, len(claims), CLAIMS_IN_A_PIECE):
            pieces.append(Claimed(tuple(claims[first : first + CLAIMS_IN_A_PIECE])))
        return pieces

    def settle(self, piece: Alike | Claimed) -> dict[str, Example | Decision]:
        match piece:
            case Alike(classes, known):
                return {x.one.name: x for x in find_examples(self.basis, classes, known)}
            case Claimed(claims):
                return {claim.name: self._decide(claim) for claim in claims}

    def _decide(self, claim: ClassClaim) -> Decision:
        try:
            result = self.basis.proof_of(claim.query, CLAIM * self.basis.effort.units, claim.name)
        except Late as late:
            return Decision(claim, Verdict.UNKNOWN, str(late), seconds=late.seconds)
        return Decision(claim, result.verdict, result.reason, result.certificate, result.seconds)

    def doubt(self, piece: Alike | Claimed, reason: str) -> dict[str, Example | Decision]:
        match piece:
            case Alike(classes):
                return {one.name: Example(one, Verdict.UNKNOWN, reason) for one in classes}
            case Claimed(claims):
                return {claim.name: Decision(claim, Verdict.UNKNOWN, reason) for claim in claims}

    def is_sure(self, answer: Example | Decision) -> bool:
        return answer.verdict in (Verdict.WITNESSED, Verdict.PROVED, Verdict.VACUOUS)

    def record(self, name: str, answer: Example | Decision, shelf: Shelf) -> dict[str, Any]:
        match answer:
            case Example(one, verdict, reason, drive):
                entry: dict[str, Any] = {
                    "name": name,
                    "vehicles": list(one.vehicles),
                    "scenarios": list(one.scenarios),
                    "happens": list(one.what.holds),
                    "where": one.place,
                    "description": one.description,
                    "formula": one.formula,
                    "verdict": str(verdict),
                    "reason": reason,
                    "drive": shelf.drive(f"drives/{name}.json", drive),
                }
                return {"classes": [entry], "claims": []}
            case Decision(claim, verdict, reason, certificate, seconds):
                entry = {
                    "name": name,
                    "kind": claim.kind,
                    "claim": claim.query.text,
                    "verdict": str(verdict),
                    "reason": reason,
                    "certificate": shelf.certificate(f"proofs/{name}.json", certificate),
                    "seconds": seconds,
                }
                return {"classes": [], "claims": [entry]}

    def recall(self, record: Mapping[str, Any], shelf: Shelf) -> tuple[str, Example | Decision]:
        entries = [*record["classes"], *record["claims"]]
        if len(entries) != 1:
            raise InputError(f"{len(entries)} answers, where one was kept")
        (said,) = entries
        name, verdict, reason = said["name"], Verdict(said["verdict"]), said["reason"]
        match self._named.get(name):
            case Class() as one if said.get("formula") == one.formula:
                return name, Example(one, verdict, reason, shelf.read_drive(said["drive"]))
            case ClassClaim() as claim if said.get("claim") == claim.query.text:
                certificate = shelf.read_certificate(said["certificate"])
                return name, Decision(claim, verdict, reason, certificate, said["seconds"])
            case _:
                raise InputError(f"there is no class and no claim like this '{name}'")

    def classified(
        self, answers: Mapping[str, Example | Decision], shares: Shares | None = None
    ) -> Classified:
        """The answers in the order of the classes and of the claims."""
        found = [answers[name] for name in self._named]
        return Classified(
            tuple(x for x in found if isinstance(x, Example)),
            tuple(x for x in found if isinstance(x, Decision)),
            self.doubts,
            shares,
        )

    def as_data(self, classified: Classified, records: Mapping[str, Mapping[str, Any]]) -> dict[str, Any]:
        """The index, made of the answers as they are recorded."""
        shares = classified.shares
        data: dict[str, Any] = {
            **self.question.heading,
            "view": "dense",
            "text": self.text,
            "classes": [
                {**records[x.one.name]["classes"][0], **_counts(x.one, shares)} for x in classified.examples
            ],
            "claims": [records[x.claim.name]["claims"][0] for x in classified.decisions],
            "shares": None if shares is None else _shares_data(shares),
        }
        if classified.doubts:
            data["doubts"] = [{"about": x.about, "reason": x.reason} for x in classified.doubts]
        return data


def _counts(one: Class, shares: Shares | None) -> dict[str, int | None]:
    if shares is None:
        return {"situations": None, "traces": None}
    return {"situations": shares.situations[one.name], "traces": shares.traces[one.name]}


def _shares_data(shares: Shares) -> dict[str, Any]:
    return {
        "source": shares.source,
        "recordings": shares.recordings,
        "end": "clip",
        "traces": shares.all_traces,
        "covered": shares.covered,
        "repeated": shares.repeated,
        "situations": {str(count): number for count, number in sorted(shares.classified.items())},
        "broken": shares.broken,
    }


def classification_of(basis: Basis, division: Division) -> Classification:
    """The question that a division of scenarios of ``basis`` leaves. Raises ``InputError``."""
    if division.cut_off:
        return Classification(basis, division.classes, "", (), division.doubts)
    text = write_classes(division.classes, basis.specification)
    specification = with_classes(text, basis.specification)
    claims = claims_of(division.classes, division.empty, specification)
    about = replace(basis, specification=specification, sets=())
    return Classification(about, division.classes, text, claims, division.doubts)
