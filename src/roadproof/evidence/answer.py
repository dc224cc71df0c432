"""Answers: a claim with the file of evidence that decides it.

The verdict follows from the claim and the kind of the evidence, so none stands without evidence of its kind.
A file is read as the answer to a claim only where it is about that claim, compared on trees.
"""

from collections.abc import Callable, Iterator, Mapping
from fractions import Fraction
from functools import cached_property, partial
from typing import TypeAlias

from roadproof.errors import InputError, RoadproofError, StaleError
from roadproof.evidence import certificate, drive_file, none_within
from roadproof.evidence.answer_files import (
    JUDGED,
    REFUTATION,
    UNDECIDED,
    AboutClaim,
    JudgedFile,
    OpenVerdict,
    OwnEvidence,
    RefutationFile,
    Undecided,
)
from roadproof.evidence.answers.doubt import Doubt
from roadproof.evidence.answers.none_within import Model
from roadproof.evidence.certificate import Certificate, certificate_data, read_certificate_data
from roadproof.evidence.claim import Claim, Exists, Judgement, Mode, On, OwnMode, Valid
from roadproof.evidence.codec import read, write
from roadproof.evidence.countermodel import Countermodel, read_trace, trace_data
from roadproof.evidence.drive_file import DriveFile, natural_of, read_drive
from roadproof.evidence.judged import JudgedDrive
from roadproof.evidence.none_within import NoneWithinFile, none_within_data, read_none_within
from roadproof.evidence.refutation import fault_of
from roadproof.evidence.strict import Fields, JsonObject
from roadproof.extension import entries, imported
from roadproof.library.bind import values_with
from roadproof.library.compose import denied_premise, never
from roadproof.library.motion import under_limits, value_texts
from roadproof.library.specification import Query
from roadproof.logic import formula as f
from roadproof.logic.formula import Formula
from roadproof.logic.parts import parts_of
from roadproof.reasons import NO_REASON, Reason, Why
from roadproof.runtime.records import dataclass
from roadproof.verdict import Verdict
from roadproof.world.vehicle import Vehicle


@dataclass(frozen=True)
class Refutation:
    """A trace on which a claim is false, judged; ``drive_sought``: whether a drive was looked for in vain."""

    trace: Countermodel
    drive_sought: bool = False


@dataclass(frozen=True)
class Judged:
    """What a given trace shows."""

    shows: Judgement


Evidence: TypeAlias = (
    Certificate | JudgedDrive | Refutation | NoneWithinFile | OwnEvidence | Judged | Undecided
)


@dataclass(frozen=True)
class Answer:
    """A claim, and the evidence that decides it.

    Raises ``ValueError`` for evidence that decides no claim of this mode, or has other values of parameters.
    """

    claim: Claim
    evidence: Evidence

    def __post_init__(self) -> None:
        _ = self.verdict
        match self.evidence:
            case JudgedDrive(file=file) if other := _other_value(self.claim, file.values):
                raise ValueError(f"{other} on the drive")
            case NoneWithinFile(values=values) if other := _other_value(self.claim, values):
                raise ValueError(f"{other} in the trees")

    @property
    def verdict(self) -> Verdict:
        """The verdict that the evidence shows."""
        match self.claim.mode, self.evidence:
            case mode, Undecided(verdict=open_verdict) if _may_be(mode, open_verdict):
                return open_verdict
            case Valid(), Certificate():
                return Verdict.VACUOUS if self._denied is not None else Verdict.PROVED
            case Valid(), JudgedDrive():
                return Verdict.REFUTED
            case Valid(moving=False, within=None), Refutation():
                return Verdict.REFUTED
            case Valid(), Refutation():
                raise ValueError("it is a trace, but only a drive refutes the claim")
            case OwnMode() as own, evidence if (verdict := own.verdict_of(evidence)) is not None:
                return verdict
            case Exists(), JudgedDrive():
                return Verdict.WITNESSED
            case Exists(), Certificate():
                return Verdict.IMPOSSIBLE
            case Exists(trees=True), NoneWithinFile():
                return Verdict.NONE_WITHIN
            case On(), Judged(shows):
                return shows.verdict
            case mode, evidence:
                word = f" {evidence.verdict}" if isinstance(evidence, Undecided) else ""
                raise ValueError(f"{type(evidence).__name__}{word} decides no {type(mode).__name__} claim")

    @property
    def reason(self) -> Reason:
        """Why the claim is undecided, or says nothing; nothing where it is decided."""
        if self._denied is not None:
            return Why.CONTRADICTION() if self._denied == f.FALSE else Why.PREMISE()
        if isinstance(self.evidence, Certificate) and self.evidence.assumed.said != assumed_by(self.claim):
            return Why.WITH(", ".join(self.evidence.assumed.said))
        return self.evidence.reason if isinstance(self.evidence, Undecided) else NO_REASON

    @cached_property
    def _denied(self) -> Formula | None:
        """What a certificate denies that proves a claim to say nothing; None of all other evidence."""
        if not isinstance(self.claim.mode, Valid) or not isinstance(self.evidence, Certificate):
            return None
        shown = self.claim.read(self.evidence.claim)
        return next((x.formula for x in vacuities(self.claim) if x.formula == shown), None)

    @property
    def is_final(self) -> bool:
        """Whether evidence decides the claim for ever."""
        return not isinstance(self.evidence, Undecided)

    @property
    def drive(self) -> JudgedDrive | None:
        """The drive that shows the verdict, if one does."""
        return self.evidence if isinstance(self.evidence, JudgedDrive) else None

    @property
    def certificate(self) -> Certificate | None:
        """The certificate that shows the verdict, if one does."""
        return self.evidence if isinstance(self.evidence, Certificate) else None


def _may_be(mode: Mode, verdict: OpenVerdict) -> bool:
    """Whether a claim without evidence may have this verdict: within limits only where it is about drives."""
    match verdict:
        case Verdict.NONE_WITHIN:
            return isinstance(mode, Exists)
        case Verdict.PROVED_BOUNDED:
            return isinstance(mode, Valid) and mode.within is not None
        case _:
            return True


def vacuities(claim: Claim) -> Iterator[Query]:
    """Yield what shows that a claim says nothing: that its premise never holds, or that what is assumed is a
    contradiction.
    """
    denied = denied_premise(claim.query)
    if denied is not None:
        yield denied
    if assumed_by(claim):
        yield never(claim.query)


def values_of(claim: Claim) -> tuple[str, ...]:
    """Return the values of the parameters of a claim about drives, as words."""
    return value_texts(claim.home, {x.name: x.value for x in claim.parameters})


def undecided(
    claim: Claim,
    reason: Reason,
    verdict: OpenVerdict = Verdict.UNKNOWN,
    limits: object = None,
    doubt: Doubt | None = None,
) -> Answer:
    """Return the answer to a claim that nothing decides."""
    home = claim.home
    file = Undecided(
        set=home.set_name,
        options=dict(home.options),
        claim=claim.query.text,
        assuming=assumed_by(claim),
        verdict=verdict,
        reason=reason,
        limits=limits,
        doubt=doubt,
    )
    return Answer(claim, file)


def assumed_by(claim: Claim) -> tuple[str, ...]:
    """Return what a claim says that it assumes."""
    return claim.mode.assuming if isinstance(claim.mode, Valid) else ()


# --- files ------------------------------------------------------------------------------------------


def answer_data(answer: Answer) -> JsonObject:
    """Return the file of an answer as plain data."""
    match answer.evidence:
        case Certificate() as proof:
            return certificate_data(proof)
        case JudgedDrive() as drive:
            return drive.as_data()
        case NoneWithinFile() as trees:
            return none_within_data(trees)
        case Undecided() | OwnEvidence() as own:
            return write(own)
        case Judged(shows):
            mode = answer.claim.mode
            assert isinstance(mode, On)
            return write(JudgedFile(files=mode.files, asked=mode.asked, shows=write(shows)))
        case Refutation(trace, drive_sought):
            home, claim = answer.claim.home, answer.claim
            file = RefutationFile(
                set=home.set_name,
                options=dict(home.options),
                claim=claim.query.text,
                assuming=assumed_by(claim),
                drive_sought=drive_sought,
                trace=trace_data(trace),
            )
            return write(file)


def read_answer(claim: Claim, content: object, where: str, is_judged: bool = False) -> Answer:
    """Return the answer to a claim that a file holds.

    Drives and traces are judged; of a certificate the claim is compared, and ``certificate.rule`` checks the
    proof. ``is_judged``: this program has judged the trace of these bytes for this claim before.
    Raises ``InputError`` where the file is about another claim, or shows nothing.
    """
    schema = Fields(content, where).text("schema")
    try:
        reader = _reader(schema, where, is_judged)
        return Answer(claim, reader(claim, content, where))
    except ValueError as error:
        raise InputError(f"{where}: {error}") from None
    except InputError:
        raise
    except RoadproofError as error:
        raise InputError(f"{where}: {error}") from None


def _certificate(claim: Claim, content: object, where: str) -> Certificate:
    file = read_certificate_data(content, where)
    _require_readings(claim, file.set_name, file.options, where)
    _require(
        file.assumed.said == assumed_by(claim)
        or (isinstance(claim.mode, Exists) and file.assumed.said == values_of(claim)),
        where,
        f"it assumes {', '.join(file.assumed.said) or 'nothing'}",
    )
    shown = claim.read(file.claim)
    about = (claim.formula, *(x.formula for x in vacuities(claim)))
    wanted = isinstance(claim.mode, Valid) and shown in about
    _require(wanted or _is_part_denied(claim, shown), where, f"it proves {_short(file.claim)}")
    known = claim.query if file.claim == claim.text else None
    fault = certificate.fault_of_queries(file, claim.home.library, known)
    _require(fault is None, where, "" if fault is None else fault[1])
    return file


def _is_part_denied(claim: Claim, shown: Formula) -> bool:
    """Whether a formula says that parts of a claim's conjunction never hold together."""
    if not isinstance(claim.mode, Exists) or not isinstance(shown, f.Not):
        return False
    return {*parts_of(shown.body)} <= {*parts_of(claim.formula)}


def _drive(claim: Claim, content: object, where: str) -> JudgedDrive:
    file = read_drive(content, where)
    _require_readings(claim, file.set_name, file.options, where)
    _require(_shows(claim, file), where, f"its drive is one of {_short(file.formula)}")
    _require_values(claim, file.values, where)
    if isinstance(claim.mode, Exists):
        mode, overlaps = claim.mode, file.overlaps_allowed
        _require(file.drive not in mode.unlike, where, "it is a drive from which it has to differ")
        _require(
            mode.apart is None or mode.collisions or not overlaps, where, "boxes may overlap on its drive"
        )
        ends = f"its horizon={file.horizon} s ends before {mode.apart} s"
        _require(mode.apart is None or file.horizon >= mode.apart, where, ends)
        _require(mode.like is None or _is_given(mode, file), where, "it is not the drive that is given")
    return JudgedDrive(file, claim.home.library, natural_of(content, where))


def _is_given(mode: Exists, file: DriveFile) -> bool:
    """Return whether a drive has the motions that a claim gives, on its road and in its lanes."""
    given = mode.like, mode.road, dict(mode.lanes), mode.horizon, mode.collisions
    return given == (file.drive, file.road, dict(file.lanes), file.horizon, file.overlaps_allowed)


def _shows(claim: Claim, file: DriveFile) -> bool:
    """Return whether a drive is about a claim."""
    if isinstance(claim.mode, OwnMode):
        return claim.mode.is_shown_by(claim, file)
    return claim.read(file.formula) == sought_by(claim)


def sought_by(claim: Claim) -> Formula:
    """Return what a drive shows that decides a claim: the formula, or that it is false within limits."""
    if isinstance(claim.mode, Valid):
        return f.negation(under_limits(claim.home, claim.query, claim.mode.assuming).formula)
    return claim.formula


def _trace(claim: Claim, content: object, where: str) -> Refutation:
    """Return a trace that is not judged."""
    file = read(RefutationFile, content, where)
    _require_about(claim, file, where)
    trace = read_trace(file.trace, where)
    values_with(claim.home.library, trace.parameters)
    return Refutation(trace, file.drive_sought)


def _refutation(claim: Claim, content: object, where: str) -> Refutation:
    shown = _trace(claim, content, where)
    query = under_limits(claim.home, claim.query, assumed_by(claim))
    fault = fault_of(shown.trace, query.formula, claim.home.library.bounds)
    _require(fault is None, where, f"its trace does not refute the claim: {fault}")
    return shown


def _none_within(claim: Claim, content: object, where: str) -> NoneWithinFile:
    file = read_none_within(content, where)
    _require_readings(claim, file.set_name, file.options, where)
    _require(
        claim.read(file.formula) == claim.formula,
        where,
        f"it is about {_short(file.formula)}",
    )
    _require_values(claim, file.values, where)
    _require(_is_within(claim, file), where, "it is about drives within other limits")
    return file


def _is_within(claim: Claim, file: NoneWithinFile) -> bool:
    """Whether trees are about all drives that a claim asks for; they choose what it leaves open."""
    mode = claim.mode
    if not isinstance(mode, Exists):
        return False
    models = {name: mode.vehicles.get(name, mode.vehicles.get("")) for name in claim.vehicles}
    return (
        mode.road in (None, file.road)
        and mode.dt in (None, file.dt)
        and mode.horizon <= file.horizon
        and mode.reach <= file.reach
        and mode.collisions <= file.overlaps_allowed
        and (
            bool(mode.limits)
            or file.road.line is not None
            or all(x is None or _moves_as(x, file.vehicles[name]) for name, x in models.items())
        )
    )


def _moves_as(one: Vehicle, other: Vehicle) -> bool:
    """Whether two models can do the same, whatever natural drives of them are."""
    return all(getattr(one, x) == getattr(other, x) for x in Model.__annotations__)


def _own(claim: Claim, content: object, where: str, schema: str) -> OwnEvidence:
    """Return evidence of a kind that an extension adds."""
    kind: type[OwnEvidence] = imported(entries("evidence")[schema])
    file = read(kind, content, where)
    _require_about(claim, file, where)
    fault = file.fault_for(claim)
    _require(not fault, where, fault)
    return file


def _undecided(claim: Claim, content: object, where: str) -> Undecided:
    file = read(Undecided, content, where)
    _require_about(claim, file, where)
    return file


def _judged(claim: Claim, content: object, where: str) -> Judged:
    file = read(JudgedFile, content, where)
    mode = claim.mode
    if not isinstance(mode, On):
        raise InputError(f"{where} is no answer to its claim: it is about a given trace")
    if file.files != mode.files:
        raise StaleError(f"{where} is no answer to its claim: it is about a trace with other bytes")
    _require(file.asked == mode.asked, where, "it was asked something else")
    return Judged(read(mode.judge.kind, file.shows, where))


_READERS: Mapping[str, Callable[[Claim, object, str], Evidence]] = {
    certificate.SCHEMA: _certificate,
    **dict.fromkeys(drive_file.SCHEMAS_READ, _drive),
    none_within.SCHEMA: _none_within,
    REFUTATION: _refutation,
    UNDECIDED: _undecided,
    JUDGED: _judged,
}


def is_answer(schema: str) -> bool:
    """Whether files of a schema are answers."""
    return schema in _READERS or schema in entries("evidence")


def _reader(schema: str, where: str, is_judged: bool) -> Callable[[Claim, object, str], Evidence]:
    if is_judged and schema == REFUTATION:
        return _trace
    if schema in _READERS:
        return _READERS[schema]
    own = entries("evidence")
    if schema not in own:
        raise InputError(f"{where}: schema='{schema[:60]}' is none of {', '.join((*_READERS, *own))}")
    return partial(_own, schema=schema)


def _require_about(claim: Claim, file: AboutClaim, where: str) -> None:
    _require_readings(claim, file.set, file.options, where)
    _require(file.assuming == assumed_by(claim), where, f"it assumes {', '.join(file.assuming) or 'nothing'}")
    _require(
        claim.read(file.claim) == claim.formula,
        where,
        f"it is about {_short(file.claim)}",
    )


def _require_readings(claim: Claim, set_name: str, options: Mapping[str, str], where: str) -> None:
    home = claim.home
    _require(set_name == home.set_name, where, f"it is about set {set_name}")
    _require(home.library.select(set_name, options) is home, where, "it was read with other options")


def _require_values(claim: Claim, values: Mapping[str, Fraction], where: str) -> None:
    other = _other_value(claim, values)
    _require(not other, where, other)


def _other_value(claim: Claim, values: Mapping[str, Fraction]) -> str:
    """Return which parameter has another value than a claim gives it, or nothing."""
    known = values_with(claim.home.library, values)
    other = ((name, value) for name, value in claim.values.items() if known[name] != value)
    return next((f"it has {name}={known[name]}, and not {value}" for name, value in other), "")


def _require(holds: bool, where: str, otherwise: str) -> None:
    """Raises ``InputError`` where a file is not about the claim that it is named after."""
    if not holds:
        raise InputError(f"{where} is no answer to its claim: {otherwise}")


def _short(text: str) -> str:
    return " ".join(text.split())[:120]
