"""The relation of two formulas: whether a drive tells them apart, in each direction."""

from collections.abc import Mapping
from dataclasses import replace
from functools import cached_property
from typing import Annotated, ClassVar, Final, Literal, TypeAlias

from roadproof.evidence.answer import ClaimAnswer
from roadproof.evidence.answers import headings, shared
from roadproof.evidence.certificate import Certificate
from roadproof.evidence.claim import Claim, Exists, claim_of
from roadproof.evidence.codec import Doc, read
from roadproof.evidence.judged import JudgedDrive
from roadproof.evidence.schema_notes import EvidenceSchema
from roadproof.library.compose import both, implication, negation
from roadproof.library.elaborate import read_claim
from roadproof.library.specification import Query
from roadproof.questions.basis import Basis
from roadproof.questions.drive_search_data import DriveSearchData, search_data, search_mode
from roadproof.questions.question import Answers, Steps, heading_of
from roadproof.questions.question import EvidencePlace as Placing
from roadproof.reasons import NO_REASON, Reason
from roadproof.runtime.budget import Work
from roadproof.runtime.records import dataclass
from roadproof.verdict import ClaimVerdict, Verdict

SCHEMA: Final = "roadproof/compare/2"
DIRECTIONS: Final = ("first implies second", "second implies first")
PROOF: Final = 5.0  # units of work for a proof before a drive is looked for
Relation: TypeAlias = Literal["equivalent", "stronger", "weaker", "incomparable", "unknown"]


@dataclass(frozen=True, kw_only=True)
class Side:
    """A formula, read in a spec set."""

    formula: shared.Formula
    set: shared.SetName


@dataclass(frozen=True, kw_only=True)
class Sides:
    """Two formulas, and how drives are looked for that tell them apart."""

    first: Side
    second: Side
    within: DriveSearchData


@dataclass(frozen=True)
class Direction:
    """The answer whether one formula implies the other: a proof, or a drive with the one and not the other.

    ``claim`` says it; ``answer`` None: it is not settled.
    """

    claim: Query
    answer: ClaimAnswer | None

    @property
    def verdict(self) -> ClaimVerdict:
        """PROVED where no drive tells them apart, REFUTED where one does."""
        match None if self.answer is None else self.answer.verdict:
            case Verdict.IMPOSSIBLE:
                return Verdict.PROVED
            case Verdict.WITNESSED:
                return Verdict.REFUTED
            case Verdict.NONE_WITHIN:
                return Verdict.PROVED_BOUNDED
            case Verdict.PROVED | Verdict.PROVED_BOUNDED | Verdict.REFUTED | Verdict.VACUOUS:
                return Verdict.UNKNOWN
            case Verdict.DERIVED | Verdict.COVERED | Verdict.GAPS | Verdict.CROSSCHECK_FAILED:
                return Verdict.UNKNOWN
            case None | Verdict.UNKNOWN:
                return Verdict.UNKNOWN

    @property
    def reason(self) -> Reason:
        """Return why there is no better answer, or with which values there is a proof."""
        return NO_REASON if self.answer is None else self.answer.reason

    @property
    def certificate(self) -> Certificate | None:
        """The proof that the opposite never holds, if there is one."""
        return None if self.answer is None else self.answer.certificate

    @property
    def drive(self) -> JudgedDrive | None:
        """The drive that tells the two apart, if there is one."""
        return None if self.answer is None else self.answer.drive


@dataclass(frozen=True)
class Comparison:
    """The relation of the first formula to the second; stronger is to imply it and not the reverse.

    ``sets``: the spec sets that the two are of.
    """

    first: Query
    second: Query
    forward: Direction
    backward: Direction
    sets: tuple[str, str]

    @property
    def directions(self) -> Mapping[str, Direction]:
        """The two directions by name."""
        return dict(zip(DIRECTIONS, (self.forward, self.backward), strict=True))

    @property
    def relation(self) -> Relation:
        """The relation in a word."""
        match self.forward.verdict, self.backward.verdict:
            case Verdict.PROVED, Verdict.PROVED:
                return "equivalent"
            case Verdict.PROVED, Verdict.REFUTED:
                return "stronger"
            case Verdict.REFUTED, Verdict.PROVED:
                return "weaker"
            case Verdict.REFUTED, Verdict.REFUTED:
                return "incomparable"
            case _:  # open: pairs with a verdict that decides nothing
                return "unknown"


@dataclass(frozen=True)
class CompareQuestion:
    """The question which of two formulas implies the other; ``second`` is read in ``other`` set."""

    kind: ClassVar[str] = "compare"
    basis: Basis
    first: Query
    second: Query
    other: str
    within: Exists

    @property
    def work(self) -> Work:
        """The work that is allowed for a claim."""
        effort = self.basis.effort
        return Work(effort, min(PROOF, effort.units), alone=True)

    @property
    def settings(self) -> Sides:
        """The question as data."""
        return Sides(
            first=Side(formula=self.first.text, set=self.basis.specification.set_name),
            second=Side(formula=self.second.text, set=self.other),
            within=search_data(self.within),
        )

    @classmethod
    def of(cls, basis: Basis, settings: object, where: str) -> "CompareQuestion":
        """Return the question that plain data ask. Raises ``InputError``."""
        data = read(Sides, settings, where)
        home = basis.specification.in_set(data.first.set)
        first = read_claim(home, data.first.formula)
        second = read_claim(home, data.second.formula)
        return cls(
            replace(basis, specification=home),
            first,
            second,
            data.second.set,
            search_mode(data.within, where),
        )

    @cached_property
    def claims(self) -> Mapping[str, Claim]:
        """The claims that a drive tells the formulas apart, by name."""
        home = self.basis.specification
        pairs = (self.first, self.second), (self.second, self.first)
        apart = (both(one, negation(other)) for one, other in pairs)
        return {
            file_name(name): claim_of(home, query, self.within, self.basis.values)
            for name, query in zip(DIRECTIONS, apart, strict=True)
        }

    def batches(self, known: Answers) -> list["DirectionBatch"]:
        """A batch for each direction."""
        return [DirectionBatch(name, claim) for name, claim in self.claims.items()]

    def label(self, name: str) -> str:
        """Return what the drive of a claim shows."""
        return "first without second" if name == file_name(DIRECTIONS[0]) else "second without first"

    def direction(self, name: str, answer: ClaimAnswer | None) -> Direction:
        """Return a direction with its answer."""
        forward = name == file_name(DIRECTIONS[0])
        pair = (self.first, self.second) if forward else (self.second, self.first)
        return Direction(implication(*pair), answer)

    def view(self, known: Answers) -> Comparison:
        """Return how the formulas relate."""
        forward, backward = (self.direction(x, known.get(x)) for x in map(file_name, DIRECTIONS))
        sets = self.basis.specification.set_name, self.other
        return Comparison(self.first, self.second, forward, backward, sets)

    def data(self, view: Comparison, place: Placing, seconds: float) -> "ComparisonData":
        """Return the view as ``--json`` prints it."""
        return ComparisonData(
            **heading_of(SCHEMA, self.basis),
            **ComparisonData.of_road(self.within.road),
            first=self.settings.first,
            second=self.settings.second,
            relation=view.relation,
            forward=_direction_data(view.forward),
            backward=_direction_data(view.backward),
        )


@dataclass(frozen=True)
class DirectionBatch:
    """The claim of one direction."""

    name: str
    claim: Claim

    def steps(self) -> Steps:
        """Yield the claim."""
        yield self.name, self.claim


def direction_named(name: str) -> str:
    """Return which direction an answer is about."""
    return next(x for x in DIRECTIONS if file_name(x) == name)


def file_name(direction: str) -> str:
    """Return the name of the answer to a direction."""
    return direction.replace(" ", "-")


def _direction_data(x: Direction) -> "DirectionData":
    from roadproof.evidence.certificate_file import certificate_data  # here: few have a certificate

    proof = x.certificate
    return DirectionData(
        claim=x.claim.text,
        verdict=x.verdict,
        reason=x.reason,
        certificate=None if proof is None else certificate_data(replace(proof, tableau=None)),
        drive=None if x.drive is None else x.drive.as_data(),
    )


@dataclass(frozen=True, kw_only=True)
class DirectionData:
    """The answer whether one formula implies the other."""

    claim: shared.Formula
    verdict: ClaimVerdict
    reason: shared.Reason
    certificate: Annotated[
        Annotated[object, EvidenceSchema("certificate.json")] | None,
        Doc("Of a PROVED: the opposite never holds."),
    ]
    drive: Annotated[
        Annotated[object, EvidenceSchema("drive.json")] | None,
        Doc("Of a REFUTED: one formula holds on it, the other does not."),
    ]


@dataclass(frozen=True, kw_only=True)
class ComparisonData(headings.OnRoad, headings.BaseHeading):
    """The answer which of two formulas implies the other."""

    schema: Literal["roadproof/compare/2"] = SCHEMA
    first: Side
    second: Side
    relation: Annotated[Relation, Doc("stronger: the first implies the second, and not the reverse.")]
    forward: Annotated[DirectionData, Doc("Whether the first implies the second.")]
    backward: Annotated[DirectionData, Doc("Whether the second implies the first.")]
