"""Which initial values of a manoeuvre a driver can prevent a collision from: exact lines, drives, lemmas.

A question in pieces: a plate for each model and choice of fixed values, and the lemmas which say that the
formula is the boundary.
"""

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from functools import cached_property
from itertools import product
from typing import ClassVar, TypeAlias

from roadproof.analysis.basis import Basis
from roadproof.analysis.preventable.sides import beside_boundary, far_apart, first_drive
from roadproof.analysis.study.evidence_store import EvidenceStore, Question
from roadproof.analysis.study.frame import Unprepared
from roadproof.drivers import gradual
from roadproof.drivers.driving import DriverSettings
from roadproof.drivers.lemmas import Lemma, chosen, idle, lemmas_for
from roadproof.drivers.lines import SIDES, Line, Side, end_of, sides_in, told_line, truths
from roadproof.drivers.manoeuvres import Manoeuvre, Plane, Values, plane_of
from roadproof.drivers.models import MODELS, Model, ModelName, boundary_of, parts_of, touched
from roadproof.drivers.stepped import TOLD, beside_change, labels_of, places_of, spans_of
from roadproof.engines.prove.prover import prove
from roadproof.errors import InputError
from roadproof.evidence.answers import plates as kept
from roadproof.evidence.claim import valid_under
from roadproof.evidence.judged import JudgedDrive
from roadproof.evidence.settled import Settled
from roadproof.evidence.strict import JsonObject
from roadproof.library.elaborate import read_claim, read_tree
from roadproof.library.motion import Assumption, value_texts
from roadproof.reasons import NO_REASON, Reason
from roadproof.runtime.budget import BudgetExceeded
from roadproof.verdict import ClaimVerdict, Verdict

_ROWS = 10  # in which a drive of a scenario is looked for


@dataclass(frozen=True)
class Shown:
    """A drive on one side of the boundary with its initial values; or why there is none.

    ``scenario``: the scenario that it is of, as a formula, or what happens in that; empty where neither.
    """

    side: Side
    values: Mapping[str, Fraction] = field(default_factory=dict)
    drive: JudgedDrive | None = None
    reason: Reason = NO_REASON
    scenario: str = ""


@dataclass(frozen=True)
class Plate:
    """One model over the plane whose lines run ``along`` (SI)."""

    name: str
    model: ModelName
    fixed: Values
    along: tuple[Fraction, Fraction]
    lines: tuple[Line, ...] = ()
    shown: tuple[Shown, ...] = ()
    reason: Reason = NO_REASON

    @property
    def stepped(self) -> str:
        """What is said of a plate whose lines are no exact boundary; empty where they are one."""
        return TOLD if MODELS[self.model].is_stepped else ""

    @property
    def motion(self) -> str:
        """What is said of a plate whose ends are worked out from the motion; empty where a formula says."""
        return gradual.TOLD if gradual.RATE in self.fixed else ""

    @property
    def verdict(self) -> kept.SideVerdict:
        """WITNESSED where each side that the plane has is shown by a drive."""
        sides = sides_in(self.lines, self.along, MODELS[self.model].is_stepped)
        lacking = any(x.drive is None and x.side in sides for x in self.shown)
        return Verdict.UNKNOWN if lacking or not self.lines else Verdict.WITNESSED


@dataclass(frozen=True)
class LemmaResult(Settled[ClaimVerdict]):
    """A lemma with its verdict."""

    lemma: Lemma
    assuming: tuple[str, ...] = ()


Answer: TypeAlias = Plate | LemmaResult


@dataclass(frozen=True)
class PlatePiece:
    """One plate to be drawn."""

    name: str
    model: Model
    fixed: Values


Piece: TypeAlias = PlatePiece | Lemma


@dataclass(frozen=True)
class Preventable(Unprepared):
    """The question as a ``study.frame.Study``: ``sheet`` has the values that differ from plate to plate.

    ``scenario``: the number of the one that drives should be of, where the manoeuvre was asked for by it.
    """

    record_type: ClassVar[type[kept.Record]] = kept.Record
    basis: Basis
    manoeuvre: Manoeuvre
    models: tuple[Model, ...]
    fixed: Values
    sheet: Mapping[str, tuple[Fraction, ...]]
    along: tuple[Fraction, Fraction]
    across: tuple[Fraction, Fraction]
    rows: int = 100
    with_lemmas: bool = True
    scenario: int | None = None

    @property
    def question(self) -> Question:
        said: JsonObject = {
            "set": self.basis.specification.set_name,
            "manoeuvre": self.manoeuvre.name,
            "scenario": self.scenario,
            "along": [self.manoeuvre.line, *map(str, self.along)],
            "across": [self.manoeuvre.across, *map(str, self.across), str(self.rows)],
        }
        return Question(kept.SCHEMA, said | self.basis.said(), {}, self.basis.library)

    @cached_property
    def plates(self) -> dict[str, PlatePiece]:
        """The plates by name: for each choice of the sheet's values, each model."""
        found: dict[str, PlatePiece] = {}
        for values in product(*self.sheet.values()):
            fixed = {**self.fixed, **dict(zip(self.sheet, values, strict=True))}
            told = "-".join(f"{name}-{value}".replace("/", "_") for name, value in fixed.items())
            for model in self.models:
                name = f"{model.name}-{told}" if told else model.name
                found[name] = PlatePiece(name, model, fixed)
        return found

    @property
    def is_gradual(self) -> bool:
        """Whether the braking of POV grows at a finite rate, which no formula describes."""
        return gradual.RATE in self.fixed or gradual.RATE in self.sheet

    @cached_property
    def lemmas(self) -> dict[str, Lemma]:
        """The lemmas by name."""
        aeb = self.reading.choices.cc_aeb
        is_said = self.with_lemmas and not self.is_gradual
        asked = lemmas_for(self.manoeuvre.name, self.models, aeb) if is_said else []
        return {f"lemma-{lemma.name}": lemma for lemma in asked}

    def pieces(self, known: Mapping[str, Answer]) -> Sequence[Piece]:
        left: dict[str, Piece] = {**self.plates, **self.lemmas}
        return [piece for name, piece in left.items() if name not in known]

    def settle(self, piece: Piece) -> dict[str, Answer]:
        if isinstance(piece, Lemma):
            return {f"lemma-{piece.name}": self._prove(piece)}
        return {piece.name: self._plate(piece)}

    def doubt(self, piece: Piece, reason: Reason) -> dict[str, Answer]:
        if isinstance(piece, Lemma):
            return {
                f"lemma-{piece.name}": LemmaResult(
                    piece, self._said(piece), verdict=Verdict.UNKNOWN, reason=reason
                )
            }
        return {piece.name: Plate(piece.name, piece.model.name, piece.fixed, self.along, reason=reason)}

    def is_sure(self, answer: Answer) -> bool:
        return answer.verdict is not Verdict.UNKNOWN

    @cached_property
    def reading(self) -> DriverSettings:
        """Values of parameters, and options."""
        return DriverSettings(self.basis.all_values(), self.basis.specification.options)

    def plane(self, fixed: Values) -> Plane:
        """The plane of a plate."""
        return plane_of(self.manoeuvre, fixed, self.along, self.across, self.rows)

    @property
    def readings(self) -> tuple[str, ...]:
        """Options and parameters that were chosen, and on which boundaries here depend."""
        made = chosen(self.basis.specification, self.basis.values)
        return tuple(x for x in (f"{name}={value}" for name, value in made.items()) if x not in self.idle)

    @cached_property
    def idle(self) -> tuple[str, ...]:
        """Options and parameters that were chosen, and on which nothing here depends."""
        return idle(self.basis.specification, self.basis.values, self.manoeuvre, self.models)

    def _plate(self, piece: PlatePiece) -> Plate:
        plane, model = self.plane(piece.fixed), piece.model.name
        if piece.model.is_stepped:
            return self._stepped(piece, plane)
        true = tuple(truths(self.basis.specification, plane, model, self.basis.all_values()))
        lines = tuple(map(told_line, plane.rows, true))
        shown = tuple(self._show(plane, model, beside_boundary(plane, true, side), side) for side in SIDES)
        return Plate(piece.name, model, piece.fixed, self.along, lines, shown)

    def _stepped(self, piece: PlatePiece, plane: Plane) -> Plate:
        """The plate of a controller: what it does from each place that is looked at."""
        model, places, labels = piece.model.name, places_of(plane), labels_of(plane)
        lines = tuple(
            Line(row, tuple((end_of(a), end_of(b)) for a, b in spans_of(places, found)))
            for row, found in zip(plane.rows, labels, strict=True)
        )
        shown = tuple(
            self._show(plane, model, beside_change(plane, labels, side == "unpreventable"), side)
            for side in SIDES
        )
        return Plate(piece.name, model, piece.fixed, self.along, lines, shown)

    def _show(
        self, plane: Plane, model: ModelName, candidates: Iterable[dict[str, Fraction]], side: Side
    ) -> Shown:
        places = list(candidates) if self._parts else candidates
        for also in self._parts:
            rows = far_apart(plane, places, _ROWS)
            shown = first_drive(
                plane, model, rows, side, self.basis.specification, self.reading, also, most=len(rows)
            )
            if not isinstance(shown, Reason):
                return Shown(side, *shown, scenario=also)
        found = first_drive(plane, model, places, side, self.basis.specification, self.reading)
        return Shown(side, reason=found) if isinstance(found, Reason) else Shown(side, *found)

    @property
    def _parts(self) -> tuple[str, ...]:
        """What drives should be of, the scenario before what happens in it."""
        return () if self.scenario is None else parts_of(self.scenario, self.manoeuvre.vehicles)

    def _said(self, lemma: Lemma) -> tuple[str, ...]:
        values = self.basis.all_values()
        return value_texts(self.basis.specification, {name: values[name] for name in lemma.parameters})

    def _prove(self, lemma: Lemma) -> LemmaResult:
        home, said = self.basis.specification, self._said(lemma)
        try:
            query, effort = read_tree(home, lemma.tree, lemma.claim), self.basis.effort.of(20)
            result = prove(home, query, effort, assumed=Assumption(said))
        except BudgetExceeded as late:
            return LemmaResult(lemma, said, verdict=Verdict.UNKNOWN, reason=late.reason)
        return LemmaResult(
            lemma, said, verdict=result.verdict, certificate=result.certificate, reason=result.reason
        )

    def wanted(self, known: Mapping[str, Answer]) -> Collection[str]:
        return [*self.plates, *self.lemmas]

    def key(self, name: str) -> str:
        """A plate has drives whose files name every parameter, and driver models use definitions that no
        formula here names: so all values and the whole library count.
        """
        basis, home, vehicles = self.basis, self.basis.specification, self.manoeuvre.vehicles
        if name in self.lemmas:
            lemma = self.lemmas[name]
            query = read_tree(home, lemma.tree, lemma.claim)
            claim = valid_under(home, query, self._said(lemma))
            return basis.key([query], claim.digest(), lemma.name, lemma.title, lemma.claim)
        piece = self.plates[name]
        boundary = boundary_of(self.manoeuvre.name, piece.model.name, vehicles)
        asked = [read_claim(home, x) for x in (boundary, touched(vehicles), *self._parts)]
        plane = self.manoeuvre.name, vehicles, self.along, self.across, self.rows, self.scenario
        return basis.key(
            asked, name, piece.model, piece.fixed, plane, basis.all_values(), basis.library.fingerprint
        )

    # --- answers as plain data -------------------------------------------------------------------

    def record(self, name: str, answer: Answer, shelf: EvidenceStore) -> kept.Record:
        if isinstance(answer, LemmaResult):
            return kept.Record(lemma=self._kept_lemma(name, answer, shelf))
        return kept.Record(plate=self._kept_plate(name, answer, shelf))

    def _kept_lemma(self, name: str, answer: LemmaResult, shelf: EvidenceStore) -> kept.Lemma:
        return kept.Lemma(
            name=answer.lemma.name,
            title=answer.lemma.title,
            claim=answer.lemma.claim,
            assuming=answer.assuming,
            verdict=answer.verdict,
            certificate=shelf.certificate(f"{name}.json", answer.certificate),
            reason=answer.reason,
        )

    def _kept_plate(self, name: str, answer: Plate, shelf: EvidenceStore) -> kept.Plate:
        vehicles = self.manoeuvre.vehicles
        boundary = boundary_of(self.manoeuvre.name, answer.model, vehicles)
        return kept.Plate(
            name=name,
            model=answer.model,
            fixed={key: str(value) for key, value in answer.fixed.items()},
            verdict=answer.verdict,
            formula=touched(vehicles) if answer.motion else boundary,
            stepped=answer.stepped,
            motion=answer.motion,
            lines=tuple(map(kept.Line.of, answer.lines)),
            shown=tuple(_kept_drive(name, x, shelf) for x in answer.shown),
            reason=answer.reason,
        )

    def recall(self, record: kept.Record, shelf: EvidenceStore) -> tuple[str, Answer]:
        if record.lemma is not None:
            name = f"lemma-{record.lemma.name}"
            if name not in self.lemmas or self.lemmas[name].claim != record.lemma.claim:
                raise InputError(f"{name} is no lemma of this question")
            certificate = shelf.read_certificate(record.lemma.certificate)
            known, assuming = self.lemmas[name], record.lemma.assuming
            return name, LemmaResult(
                known,
                assuming,
                verdict=record.lemma.verdict,
                certificate=certificate,
                reason=record.lemma.reason,
            )
        plate = record.plate
        if plate is None:
            raise InputError("a kept answer has neither a plate nor a lemma")
        shown = tuple(
            Shown(x.side, _exact(x.at), shelf.read_drive(x.drive), x.reason, x.scenario) for x in plate.shown
        )
        lines = tuple(x.drawn for x in plate.lines)
        fixed = _exact(plate.fixed)
        return plate.name, Plate(plate.name, plate.model, fixed, self.along, lines, shown, plate.reason)

    def index(self, records: Mapping[str, kept.Record], seconds: float) -> kept.Index:
        """The index, made of the answers as they are recorded."""
        return kept.Index(
            **self.question.heading,
            seconds=round(seconds, 1),
            idle=self.idle,
            plates=tuple(x for name in self.plates if (x := records[name].plate) is not None),
            lemmas=tuple(y for name in self.lemmas if (y := records[name].lemma) is not None),
        )


def _kept_drive(plate: str, shown: Shown, shelf: EvidenceStore) -> kept.SideDrive:
    drive = shown.drive
    return kept.SideDrive(
        side=shown.side,
        at={name: str(value) for name, value in shown.values.items()},
        verdict=Verdict.UNKNOWN if drive is None else Verdict.WITNESSED,
        formula="" if drive is None else drive.file.formula,
        scenario=shown.scenario,
        drive=shelf.drive(f"{plate}-{shown.side}.json", drive),
        reason=shown.reason,
    )


def _exact(values: Mapping[str, str]) -> dict[str, Fraction]:
    return {name: Fraction(value) for name, value in values.items()}
