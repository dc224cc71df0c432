"""The question from which initial values a driver prevents a collision."""

from collections.abc import Mapping, Sequence
from fractions import Fraction
from functools import cached_property
from itertools import product
from typing import ClassVar, get_args

from roadproof.errors import InputError, UsageError
from roadproof.evidence.answer import ClaimAnswer
from roadproof.evidence.assuming import valid_under
from roadproof.evidence.claim import Claim, Mode, parameters_in
from roadproof.evidence.codec import read
from roadproof.evidence.subject import OTHER, Subject, SubjectKind
from roadproof.extensions.drivers import gradual
from roadproof.extensions.drivers.choices import chosen, idle
from roadproof.extensions.drivers.driver_model import DriverModel
from roadproof.extensions.drivers.driver_settings import DriverSettings
from roadproof.extensions.drivers.driving import require
from roadproof.extensions.drivers.lemmas import Lemma
from roadproof.extensions.drivers.lines import SIDES, Side, boundary_text, open_claim
from roadproof.extensions.drivers.manoeuvres import MANOEUVRES, Manoeuvre, Values
from roadproof.extensions.drivers.models import (
    DRIVERS,
    boundary_name,
    lemmas_for,
    manoeuvre_of,
    models_for,
    options_of,
    parameters_of,
    parts_of,
)
from roadproof.extensions.drivers.preventable import data
from roadproof.extensions.drivers.preventable.claims import Beside, Lines
from roadproof.extensions.drivers.preventable.own_tests import OwnTest, PlacedTest, placed_tests
from roadproof.extensions.drivers.preventable.plate import Plate
from roadproof.extensions.drivers.preventable.view import (
    LemmaResult,
    PlateResult,
    PreventableView,
    Shown,
    lemma_data,
    plate_data,
    shown_by,
    sides_of,
)
from roadproof.library.elaborate import read_claim, read_tree
from roadproof.library.motion import value_texts
from roadproof.library.specification import unknown_name
from roadproof.logic.formula import Formula
from roadproof.questions.basis import Basis
from roadproof.questions.question import Answers, EvidencePlace, Steps, heading_of
from roadproof.runtime.budget import Work
from roadproof.runtime.records import dataclass

MOST_PLATES = 200
FOR_A_LEMMA = 20.0
"""Units of work."""


@dataclass(frozen=True)
class PreventableQuestion:
    """Plates and lemmas; ``sheet`` has the values that differ from plate to plate.

    ``scenario``: the number of the one that drives should be of, where the manoeuvre was asked for by it.
    """

    kind: ClassVar[str] = "preventable"
    basis: Basis
    manoeuvre: Manoeuvre
    models: tuple[DriverModel, ...]
    fixed: Values
    sheet: Mapping[str, tuple[Fraction, ...]]
    along: tuple[Fraction, Fraction]
    across: tuple[Fraction, Fraction]
    rows: int = 100
    with_lemmas: bool = True
    scenario: int | None = None
    tests: tuple[OwnTest, ...] = ()

    @property
    def work(self) -> Work:
        """The work that is allowed for a claim."""
        return Work(self.basis.effort, FOR_A_LEMMA)

    @property
    def settings(self) -> data.PlateRequest:
        """The question as data."""
        return data.PlateRequest(
            manoeuvre=self.manoeuvre.name,
            scenario=self.scenario,  # type: ignore[arg-type]  # as it was read
            models=tuple(x.name for x in self.models),
            fixed=self.fixed,
            sheet=tuple(data.Choice(name=name, values=x) for name, x in self.sheet.items()),
            along=self.along,
            across=self.across,
            lines=self.rows,
            lemmas=self.with_lemmas,
            tests=self.tests,
        )

    @classmethod
    def of(cls, basis: Basis, settings: object, where: str) -> "PreventableQuestion":
        """Return the question that plain data ask. Raises ``InputError``."""
        request = read(data.PlateRequest, settings, where)
        kind = MANOEUVRES[request.manoeuvre]
        try:
            if request.scenario is not None and manoeuvre_of(str(request.scenario))[0] != request.manoeuvre:
                raise UsageError(f"scenario {request.scenario} is no {request.manoeuvre}")
            question = cls(
                basis,
                kind,
                models_for(kind.name, request.models),
                request.fixed,
                {x.name: x.values for x in request.sheet},
                request.along,
                request.across,
                request.lines,
                request.lemmas,
                request.scenario,
                request.tests,
            )
            question.check()
        except UsageError as error:
            raise InputError(f"{where}: {error}") from None
        return question

    def check(self) -> None:
        """Raises ``UsageError`` and ``InputError`` for values that no plate has, and for too many plates."""
        kind, known = self.manoeuvre, self.manoeuvre.quantities
        require(self.basis.specification, self.basis.all_values())
        for model in self.models:
            name = boundary_name(kind.name, model.name)
            if model.law is not None and name not in self.basis.specification.definitions:
                needed = model.law.specification or DRIVERS
                raise UsageError(
                    f"there is no definition '{name}': the model needs the specification '{needed}'"
                )
        if not 2 <= self.rows <= data.MOST_LINES:
            raise UsageError(f"lines={self.rows}: a plate has between 2 and {data.MOST_LINES}")
        for name in (*self.fixed, *self.sheet):
            if name not in known:
                raise UsageError(f"{name}: {unknown_name('initial value of a ' + kind.name, name, known)}")
            if name in (kind.line, kind.across) or (name in self.fixed and name in self.sheet):
                raise UsageError(f"{name} varies on the plate: give a range, or omit it")
        for name, (low, high) in ((kind.line, self.along), (kind.across, self.across)):
            known[name].check(low)
            if low >= high:
                raise UsageError(f"{name}={low}:{high}: the range is empty; write the smaller value first")
        count = len(self.plates)
        if count > MOST_PLATES:
            raise UsageError(f"{count} plates: ask for {MOST_PLATES} at most, with fewer values or models")
        for plate in self.plates.values():
            values = kind.values(plate.fixed)
            if gradual.RATE in values:
                gradual.check_gradual(plate.model, values, self.reading)

    @cached_property
    def plates(self) -> dict[str, Plate]:
        """The plates by name: for each choice of the sheet's values, each model."""
        plates: dict[str, Plate] = {}
        for choice in self.choices:
            fixed = {**self.fixed, **choice}
            text = "-".join(f"{name}-{value}".replace("/", "_") for name, value in fixed.items())
            for model in self.models:
                name = f"{model.name}-{text}" if text else model.name
                plates[name] = Plate(
                    manoeuvre=self.manoeuvre.name,
                    model=model.name,
                    fixed=fixed,
                    along=self.along,
                    across=self.across,
                    lines=self.rows,
                )
        return plates

    @cached_property
    def choices(self) -> list[dict[str, Fraction]]:
        """The fixed values of the plates, without those that all share: each choice of the sheet's values."""
        return [dict(zip(self.sheet, values, strict=True)) for values in product(*self.sheet.values())]

    @cached_property
    def placed_tests(self) -> tuple[PlacedTest, ...]:
        """The tests that are within the ranges, each on the nearest of ``choices``."""
        ranges = {self.manoeuvre.line: self.along, self.manoeuvre.across: self.across}
        choices = [{**self.fixed, **x} for x in self.choices]
        return tuple(placed_tests(self.tests, self.manoeuvre, choices, ranges))

    @property
    def is_gradual(self) -> bool:
        """Return whether the braking of POV grows at a finite rate, which no formula describes."""
        return gradual.RATE in self.fixed or gradual.RATE in self.sheet

    @cached_property
    def lemmas(self) -> dict[str, Lemma]:
        """The lemmas by name."""
        aeb = self.reading.choices.cc_aeb
        is_stated = self.with_lemmas and not self.is_gradual
        lemmas = lemmas_for(self.manoeuvre.name, self.models, aeb) if is_stated else []
        return {f"lemma-{lemma.name}": lemma for lemma in lemmas}

    @cached_property
    def reading(self) -> DriverSettings:
        """Values of parameters, and options."""
        return DriverSettings(self.basis.all_values(), self.basis.specification.options)

    @property
    def readings(self) -> tuple[str, ...]:
        """Options and parameters that were chosen, and on which boundaries here depend."""
        made = chosen(self.basis.specification, self.basis.values)
        return tuple(x for x in (f"{name}={value}" for name, value in made.items()) if x not in self.idle)

    @cached_property
    def idle(self) -> tuple[str, ...]:
        """Options and parameters that were chosen, and on which nothing here depends."""
        return idle(self.basis.specification, self.basis.values, self.manoeuvre, self.models)

    # --- claims ----------------------------------------------------------------------------------

    def batches(self, known: Answers) -> list["PlateBatch | LemmaBatch"]:
        """A batch for each plate, and one for each lemma."""
        return self._batches

    @cached_property
    def _batches(self) -> list["PlateBatch | LemmaBatch"]:
        made: list[PlateBatch | LemmaBatch] = []
        for name in self.plates:
            sides: dict[Side, Claim] = {side: self.side_claim(name, side) for side in SIDES}
            made.append(PlateBatch(name, self.boundary_claim(name), sides))
        return made + [LemmaBatch(name, self.lemma_claim(name)) for name in self.lemmas]

    def boundary_claim(self, name: str) -> Claim:
        """Return the claim where on the lines of a plate a collision is unpreventable."""
        plate = self.plates[name]
        stated = gradual.RATE not in plate.fixed
        text = boundary_text(self.manoeuvre, plate.model, plate.fixed)
        mode = Lines(plate, {} if stated else self._readings(plate.model))
        return self._claim(text, mode, more=() if stated else parameters_of(plate.model))

    def side_claim(self, name: str, side: Side) -> Claim:
        """Return the claim that a drive begins on a plate that shows a side."""
        home, plate = self.basis.specification, self.plates[name]
        vehicles = self.manoeuvre.vehicles
        parts = () if self.scenario is None else parts_of(self.scenario, vehicles)
        of = tuple(read_claim(home, x).formula for x in parts)
        text = open_claim(home, self.manoeuvre, plate.model, plate.fixed, side)
        mode = Beside(plate, side, self._readings(plate.model), of, parts)
        return self._claim(text, mode, of, parameters_of(plate.model))

    def _readings(self, model: str) -> dict[str, str]:
        return {name: self.reading.options[name] for name in options_of(model)}

    def _claim(
        self, text: str, mode: Mode, formulas: Sequence[Formula] = (), more: Sequence[str] = ()
    ) -> Claim:
        home = self.basis.specification
        query = read_claim(home, text)
        occurring = parameters_in(
            home.library, (query.formula, *formulas), self.basis.values, further_names=more
        )
        return Claim(query.formula, query.vehicles, query.lanes, mode, occurring, query, home)

    def lemma_claim(self, name: str) -> Claim:
        """Return the claim that a lemma holds at the values of its parameters."""
        home, lemma, values = self.basis.specification, self.lemmas[name], self.basis.all_values()
        values_text = value_texts(home, {x: values[x] for x in lemma.parameters})
        return valid_under(home, read_tree(home, lemma.tree, lemma.claim), values_text)

    def label(self, name: str) -> str:
        """Return which plate or lemma the claim of a name is about."""
        if name in self.lemmas:
            return f"lemma {self.lemmas[name].name}"
        if name in self.plates:
            return f"{name}, lines"
        plate, _, side = name.rpartition("-")
        return f"{plate}, {side}"

    def subject(self, name: str) -> Subject:
        """Return what requirements link to: the plate that a drive is of."""
        plate, _, side = name.rpartition("-")
        is_drive = plate in self.plates and side in get_args(Side)
        return Subject(SubjectKind.PLATE, plate) if is_drive else OTHER

    # --- view ------------------------------------------------------------------------------------

    def view(self, known: Answers) -> PreventableView:
        """Return the plates and lemmas with their answers."""
        lemmas = (LemmaResult(x, self.lemma_claim(name), known.get(name)) for name, x in self.lemmas.items())
        return PreventableView(tuple(self._plate(name, known) for name in self.plates), tuple(lemmas))

    def _plate(self, name: str, known: Answers) -> PlateResult:
        plate, boundary = self.plates[name], known.get(name)
        shown: list[Shown] = []
        if boundary is not None and boundary.is_final:
            there = sides_of(boundary)
            names: dict[Side, str] = {side: f"{name}-{side}" for side in SIDES}
            shown = [shown_by(side, x, known.get(x), side in there) for side, x in names.items()]
        return PlateResult(name, plate.model, plate.fixed, boundary, tuple(shown))

    def data(self, view: PreventableView, place: EvidencePlace, seconds: float) -> data.PreventableData:
        """Return the view as ``--json`` prints it."""
        basis, kind = self.basis, self.manoeuvre
        (low, high), (least, most) = self.along, self.across
        lemmas = zip(self.lemmas, view.lemmas, strict=True)
        return data.PreventableData(
            **heading_of(data.SCHEMA, basis),
            set=basis.specification.set_name,
            **basis.common_data(),
            manoeuvre=kind.name,
            scenario=self.settings.scenario,
            along=(kind.line, str(low), str(high)),
            across=(kind.across, str(least), str(most), str(self.rows)),
            seconds=seconds,
            idle=self.idle,
            plates=tuple(plate_data(x, kind, place) for x in view.plates),
            lemmas=tuple(lemma_data(name, x, place) for name, x in lemmas),
            tests=self.tests,
        )


@dataclass(frozen=True)
class PlateBatch:
    """The claim about the lines of a plate, and those about drives on each side that they may have."""

    name: str
    lines: Claim
    sides: Mapping[Side, Claim]

    def steps(self) -> Steps:
        """Yield the claim about the lines, then those about drives."""
        boundary: ClaimAnswer = yield self.name, self.lines
        there = sides_of(boundary)
        for side, claim in self.sides.items():
            if side in there:
                yield f"{self.name}-{side}", claim


@dataclass(frozen=True)
class LemmaBatch:
    """One lemma."""

    name: str
    claim: Claim

    def steps(self) -> Steps:
        """Yield the claim."""
        yield self.name, self.claim
