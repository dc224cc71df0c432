"""The view of answers about plates: lines, drives on both sides, lemmas."""

from collections.abc import Mapping, Sequence

from roadproof.evidence.answer import ClaimAnswer, assumed_by
from roadproof.evidence.certificate import Certificate
from roadproof.evidence.claim import Claim
from roadproof.evidence.judged import JudgedDrive
from roadproof.extensions.drivers import gradual
from roadproof.extensions.drivers.lemmas import Lemma
from roadproof.extensions.drivers.lines import PlateLine, Side, boundary_text, sides_in
from roadproof.extensions.drivers.manoeuvres import Manoeuvre, Values
from roadproof.extensions.drivers.models import driver_model
from roadproof.extensions.drivers.preventable import data
from roadproof.extensions.drivers.preventable.boundary import start_of
from roadproof.extensions.drivers.preventable.boundary_file import BoundaryFile
from roadproof.extensions.drivers.preventable.claims import Beside
from roadproof.extensions.drivers.preventable.plate import PlateLineData
from roadproof.extensions.drivers.stepped import TOLD
from roadproof.questions.question import EvidencePlace
from roadproof.reasons import NO_REASON, Reason, ReasonKind
from roadproof.runtime.records import dataclass
from roadproof.verdict import ClaimVerdict, Verdict, claim_verdict


@dataclass(frozen=True)
class Shown:
    """A drive on one side of the boundary with its initial values; or why there is none.

    ``scenario``: the scenario that it is of, as a formula, or what happens in that; empty where neither.
    ``is_there``: whether the plate has more than single places of the side.
    """

    side: Side
    values: Values
    drive: JudgedDrive | None = None
    reason: Reason = NO_REASON
    scenario: str = ""
    name: str = ""
    answer: ClaimAnswer | None = None
    is_there: bool = True


@dataclass(frozen=True)
class PlateResult:
    """One model over the plane of two initial values; ``boundary``: the answer about its lines."""

    name: str
    model: str
    fixed: Values
    boundary: ClaimAnswer | None = None
    shown: tuple[Shown, ...] = ()

    @property
    def file_lines(self) -> tuple[PlateLineData, ...]:
        """The lines as files have them."""
        return lines_in(self.boundary)

    @property
    def lines(self) -> tuple[PlateLine, ...]:
        """The lines."""
        return tuple(x.drawn for x in self.file_lines)

    @property
    def reason(self) -> Reason:
        """Return why there are no lines."""
        return NO_REASON if self.boundary is None else self.boundary.reason

    @property
    def stepped(self) -> str:
        """The note on a plate whose lines are no exact boundary; empty where they are one."""
        return TOLD if driver_model(self.model).is_stepped else ""

    @property
    def motion(self) -> str:
        """The note on a plate whose ends are computed from the motion; empty where a formula states them."""
        return gradual.TOLD if gradual.RATE in self.fixed else ""

    @property
    def verdict(self) -> data.SideVerdict:
        """WITNESSED where each side that the plane has is shown by a drive."""
        lacking = any(x.drive is None and x.is_there for x in self.shown)
        return Verdict.UNKNOWN if lacking or not self.shown else Verdict.WITNESSED


@dataclass(frozen=True)
class LemmaResult:
    """A lemma with its answer; None where it is not settled."""

    lemma: Lemma
    claim: Claim
    answer: ClaimAnswer | None = None

    @property
    def verdict(self) -> ClaimVerdict:
        """The verdict; UNKNOWN where there is no answer."""
        return Verdict.UNKNOWN if self.answer is None else claim_verdict(self.answer.verdict)

    @property
    def certificate(self) -> Certificate | None:
        """The proof, if there is one."""
        return None if self.answer is None else self.answer.certificate

    @property
    def reason(self) -> Reason:
        """Return why it is in doubt."""
        return NO_REASON if self.answer is None else self.answer.reason

    @property
    def assuming(self) -> tuple[str, ...]:
        """The values at which it is claimed."""
        return assumed_by(self.claim)


@dataclass(frozen=True)
class PreventableView:
    """The plates and the lemmas, in order."""

    plates: tuple[PlateResult, ...]
    lemmas: tuple[LemmaResult, ...]


def lines_in(answer: ClaimAnswer | None) -> tuple[PlateLineData, ...]:
    """Return the lines that an answer has; none where it is in doubt."""
    sides = None if answer is None else answer.evidence
    return sides.lines if isinstance(sides, BoundaryFile) else ()


def sides_of(boundary: ClaimAnswer) -> frozenset[Side]:
    """Return the sides that a plate has more than single places of; none where it is in doubt."""
    file = boundary.evidence
    if not isinstance(file, BoundaryFile):
        return frozenset()
    lines = [x.drawn for x in file.lines]
    return sides_in(lines, file.plate.along, driver_model(file.plate.model).is_stepped)


def shown_by(side: Side, name: str, answer: ClaimAnswer | None, is_there: bool) -> Shown:
    """Return what an answer shows of a side, which a plate may not have."""
    if answer is None:
        return Shown(side, {}, reason=NO_REASON if is_there else ReasonKind.NO_PLACE(side), is_there=is_there)
    mode = answer.claim.mode
    start = None
    if answer.drive is not None and isinstance(mode, Beside):
        start = start_of(answer.claim, mode, answer.drive.file)
    if start is None:
        return Shown(side, {}, reason=answer.reason, name=name, answer=answer)
    return Shown(side, start[0], answer.drive, answer.reason, start[1], name, answer)


# --- as data -----------------------------------------------------------------------------------------


def plate_data(plate: PlateResult, manoeuvre: Manoeuvre, place: EvidencePlace) -> data.PlateData:
    """Return a plate as ``--json`` prints it."""
    final = plate.boundary if plate.boundary is not None and plate.boundary.is_final else None
    file = None if final is None else place(plate.name, final)
    return data.PlateData(
        name=plate.name,
        model=plate.model,
        fixed=_texts(plate.fixed),
        verdict=plate.verdict,
        formula=boundary_text(manoeuvre, plate.model, plate.fixed),
        stepped=plate.stepped,
        motion=plate.motion,
        lines=plate.file_lines,
        boundary=file if isinstance(file, str) else None,
        shown=tuple(_side_data(x, place) for x in plate.shown),
        reason=plate.reason,
    )


def _side_data(shown: Shown, place: EvidencePlace) -> data.SideDrive:
    drive = shown.drive
    return data.SideDrive(
        side=shown.side,
        at=_texts(shown.values),
        verdict=Verdict.UNKNOWN if drive is None else Verdict.WITNESSED,
        formula="" if drive is None else drive.file.formula,
        scenario=shown.scenario,
        drive=None if drive is None or shown.answer is None else place(shown.name, shown.answer),
        reason=shown.reason,
    )


def lemma_data(name: str, x: LemmaResult, place: EvidencePlace) -> data.LemmaData:
    """Return a lemma as ``--json`` prints it."""
    return data.LemmaData(
        name=x.lemma.name,
        title=x.lemma.title,
        claim=x.lemma.claim,
        assuming=x.assuming,
        verdict=x.verdict,
        certificate=None if x.answer is None or x.certificate is None else place(name, x.answer),
        reason=x.reason,
    )


def _texts(values: Values) -> Mapping[str, str]:
    return {name: str(value) for name, value in values.items()}


def evidence_names(plates: Sequence[PlateResult]) -> dict[str, str]:
    """Return the name of the first drive of each plate that has one, by plate."""
    shown = ((x.name, next((y.name for y in x.shown if y.drive is not None), "")) for x in plates)
    return {plate: name for plate, name in shown if name}
