"""The function ``preventable``: from which initial values a driver prevents a collision."""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import ClassVar, Unpack

from roadproof.errors import UsageError
from roadproof.evidence.kernels import KernelVerdict
from roadproof.extensions.drivers import settings
from roadproof.extensions.drivers.driving import require
from roadproof.extensions.drivers.keywords import PreventableKeywords
from roadproof.extensions.drivers.manoeuvres import MANOEUVRES, Course, Manoeuvre
from roadproof.extensions.drivers.models import (
    GRADUAL,
    manoeuvre_of,
    models_for,
    specifications,
    unpreventable,
)
from roadproof.extensions.drivers.preventable import report
from roadproof.extensions.drivers.preventable.cases import plate_cases
from roadproof.extensions.drivers.preventable.drawing import draw_sheet
from roadproof.extensions.drivers.preventable.own_tests import read_tests
from roadproof.extensions.drivers.preventable.question import PreventableQuestion
from roadproof.extensions.drivers.preventable.view import (
    LemmaResult,
    PlateResult,
    PreventableView,
    evidence_names,
)
from roadproof.extensions.kernel.boundary import Boundary, BoundaryRuling, judge_boundary
from roadproof.extensions.kernel.coq import ready
from roadproof.frontends.api.build_result import BuildResult
from roadproof.frontends.api.definitions import Definitions, load
from roadproof.frontends.api.question_answers import QuestionAnswers
from roadproof.frontends.api.settings import basis_of
from roadproof.frontends.report.cases import Case
from roadproof.frontends.report.numbers import count, took
from roadproof.frontends.report.picture import Picture, drawn, drive_pictures, picture
from roadproof.frontends.report.sheet import Sheet, as_csv
from roadproof.frontends.settings.option import takes
from roadproof.library.bind import Number, exact
from roadproof.library.specification import unknown_name
from roadproof.runtime.records import dataclass
from roadproof.verdict import ExitCode, Verdict


@dataclass(frozen=True, repr=False)
class Plates(QuestionAnswers[PreventableView], BuildResult):
    """The plates, exact, with judged drives on both sides and proved lemmas.

    ``boundaries``: what Coq says of each formula and the motion of its model, where it was asked.
    """

    question: PreventableQuestion
    pieces: ClassVar[str] = "plates and lemmas"
    command: ClassVar[str] = "preventable"
    boundaries: Sequence[BoundaryRuling] = ()

    def cases(self) -> Iterator[Case]:
        named = evidence_names(self.plates)
        lemmas = zip(self.question.lemmas, self.lemmas, strict=True)
        named |= {name: name for name, x in lemmas if x.certificate is not None}
        files = {x: self.folder / f"{name}.json" for x, name in named.items() if self.folder}
        return plate_cases(self.plates, self.lemmas, self.question.basis.specification, files)

    @property
    def plates(self) -> Sequence[PlateResult]:
        """The plates, in order."""
        return self.view.plates

    @property
    def lemmas(self) -> Sequence[LemmaResult]:
        """The lemmas that the formulas are the boundary, in order."""
        return self.view.lemmas

    @property
    def verdicts(self) -> dict[str, Verdict]:
        return {x.name: x.verdict for x in self.plates} | {
            f"lemma-{x.lemma.name}": x.verdict for x in self.lemmas
        }

    @property
    def exit_code(self) -> ExitCode:
        codes = (
            ExitCode.UNKNOWN if x.verdict is KernelVerdict.UNKNOWN else ExitCode.CROSSCHECK_FAILED
            for x in self.boundaries
            if x.verdict is not KernelVerdict.ACCEPTED
        )
        return max(super().exit_code, *codes, ExitCode.AS_EXPECTED)

    @property
    def _sheet(self) -> Sheet[report.Entry]:
        """An entry for each span in which a collision is unpreventable, in SI units."""
        return report.sheet_of(self.question, self.plates)

    def each_picture(self) -> Iterator[tuple[str, Picture]]:
        """The sheet, then the drives."""
        yield "plates", picture(draw_sheet(self.question, self.plates))
        for plate in self.plates:
            yield from drive_pictures(
                ((f"{plate.name}-{x.side}", x.drive) for x in plate.shown), self.library
            )

    def files(self, pictures: bool) -> dict[str, bytes]:
        table = {"plates.csv": as_csv(self._sheet).encode()}
        table |= {f"boundary-{x.model}.v": x.source.encode() for x in self.boundaries if x.source}
        sheet = {"plates": picture(draw_sheet(self.question, self.plates))} if pictures else {}
        return table | drawn(sheet)

    def __str__(self) -> str:
        time = took(self.seconds or None)
        summary = f"{count(len(self.plates), 'plate')}, {count(len(self.lemmas), 'lemma')}{time}"
        proved = "".join(f"{x}\n" for x in self.boundaries)
        return f"{report.as_text(self.question, self.plates, self.lemmas)}\n{proved}{summary}"


@takes(settings.Preventable)
def preventable(
    manoeuvre: str | int,
    models: Sequence[str] = (),
    using: Definitions | None = None,
    **options: Unpack[PreventableKeywords],
) -> Plates:
    """Compute where a collision is unpreventable for driver models, over planes of initial values.

    ``manoeuvre``: "cut-in", "cut-out" or "deceleration"; or a scenario in which it happens (1, 2 or 4; 5, 6
    or 8, where SV changes lanes), of which drives are then shown where there are such. ``models``: names,
    all that say something of it where there are none. ``at``: initial values by name, several for several
    plates (SI units or with a unit); ``along``, ``across``: ranges of the two that vary; ``lines`` of each.
    ``tests``: a table of tests (CSV) to draw as points, such as drivers.csv of ``catalogue``.
    ``using``: definitions with those of ``driver.spec`` (``load(specs=["driver"])``). Raises ``InputError``,
    ``UsageError``.
    """
    given = settings.Preventable.of(options)
    home = using or load(specs=[*specifications()])
    basis = basis_of(home, given)
    require(home.specification, basis.all_values())
    name, scenario = manoeuvre_of(str(manoeuvre))
    kind = MANOEUVRES[name]
    at = {name: _values(kind, name, x) for name, x in (given.at or {}).items()}
    sheet = {name: at.pop(name, values) for name, values in kind.sheet.items()}
    sheet |= {name: values for name, values in at.items() if len(values) > 1}
    fixed = {name: values[0] for name, values in at.items() if len(values) == 1}
    question = PreventableQuestion(
        basis,
        kind,
        models_for(kind.name, tuple(dict.fromkeys(models))),
        fixed,
        sheet,
        _range(kind, kind.line, given.along) or kind.along,
        _range(kind, kind.across, given.across) or kind.range,
        given.lines,
        given.lemmas,
        scenario,
        () if given.tests is None else read_tests(Path(given.tests), kind),
    )
    question.check()
    boundaries = () if given.kernel is None else _boundaries(question)
    return replace(Plates.decide(question, given), boundaries=boundaries)


def _boundaries(question: PreventableQuestion) -> tuple[BoundaryRuling, ...]:
    """Return the rulings of Coq on the boundary of each model. Raises ``MissingSolverError``."""
    course: Course = GRADUAL if question.is_gradual else question.manoeuvre.name
    vehicles = question.manoeuvre.vehicles
    boundaries = [
        Boundary(course, x.name, unpreventable(course, x.name, vehicles), vehicles) for x in question.models
    ]
    with ready() as coq:
        return tuple(judge_boundary(coq, question.basis.specification, x) for x in boundaries)


def _values(kind: Manoeuvre, name: str, given: Number | Sequence[Number]) -> tuple[Fraction, ...]:
    """Initial values, SI. Raises ``UsageError``, ``InputError``."""
    if name not in kind.quantities:
        raise UsageError(f"{name}: {unknown_name('initial value of a ' + kind.name, name, kind.quantities)}")
    if name in (kind.line, kind.across):
        raise UsageError(f"{name} varies on the plate: give a range, or omit it")
    quantity = kind.quantities[name]
    several = [given] if isinstance(given, str) or not isinstance(given, Sequence) else given
    values = tuple(dict.fromkeys(exact(name, x, quantity.unit) for x in several))
    for value in values:
        quantity.check(value)
    return values


def _range(
    kind: Manoeuvre, name: str, given: tuple[Number, Number] | None
) -> tuple[Fraction, Fraction] | None:
    """A range, SI. Raises ``UsageError``, ``InputError``."""
    if given is None:
        return None
    quantity = kind.quantities[name]
    low, high = (exact(name, x, quantity.unit) for x in given)
    quantity.check(low)
    if low >= high:
        raise UsageError(f"{name}={given[0]}:{given[1]}: the range is empty; write the smaller value first")
    return low, high
