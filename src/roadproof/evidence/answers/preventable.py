"""How ``check`` reads the index and the kept answers of ``roadproof preventable``."""

from collections.abc import Iterator, Mapping, Set
from dataclasses import replace
from fractions import Fraction
from functools import cached_property, partial

from roadproof.drivers import gradual
from roadproof.drivers import lines as drawn
from roadproof.drivers.driving import DriverSettings
from roadproof.drivers.lemmas import idle, lemmas_for
from roadproof.drivers.lines import SIDES, claim_of, with_also
from roadproof.drivers.manoeuvres import MANOEUVRES, Manoeuvre, Plane, plane_of, signals_of
from roadproof.drivers.models import MODELS, boundary_of, manoeuvre_of, models_for, parts_of, touched
from roadproof.errors import InputError
from roadproof.evidence.answers.entry import Entry, file_of, shows_of
from roadproof.evidence.answers.plates import Index, Lemma, Line, Plate, Preamble, Record, SideDrive
from roadproof.evidence.answers.reader import Background, Reader
from roadproof.evidence.drive_file import DriveFile
from roadproof.evidence.strict import rational
from roadproof.evidence.subject import Subject, SubjectKind
from roadproof.library.bind import values_with
from roadproof.logic.formula import Formula as FormulaTree
from roadproof.runtime.records import dataclass
from roadproof.verdict import Verdict
from roadproof.world.signals import STARTING

DRIVERS = "driver.spec"
_PLACES = "that the places of the plate are where it holds of the controller's drives"
_CONTROLLER = "that the accelerations of SV are what the controller of its model computes"


@dataclass(frozen=True)
class _Plane:
    """A plate with the plane that the question gives it."""

    said: Plate
    where: str
    background: Background
    preamble: Preamble
    fixed: Mapping[str, Fraction]

    @property
    def manoeuvre(self) -> Manoeuvre:
        return MANOEUVRES[self.preamble.manoeuvre]

    @property
    def is_stepped(self) -> bool:
        return MODELS[self.said.model].is_stepped

    @property
    def is_gradual(self) -> bool:
        return gradual.RATE in self.fixed

    @property
    def boundary(self) -> str:
        vehicles = self.manoeuvre.vehicles
        if self.is_gradual:
            return touched(vehicles)
        return boundary_of(self.manoeuvre.name, self.said.model, vehicles)

    @cached_property
    def plane(self) -> Plane:
        """Raises ``InputError``, ``UsageError``."""
        manoeuvre, where = self.manoeuvre, self.background.said.where
        line, low, high = self.preamble.along
        row, least, most, number = self.preamble.across
        if (line, row) != (manoeuvre.line, manoeuvre.across):
            raise InputError(f"{where}: a {manoeuvre.name} varies {manoeuvre.line} and {manoeuvre.across}")
        along = rational(low, where), rational(high, where)
        across = rational(least, where), rational(most, where)
        return plane_of(manoeuvre, self.fixed, along, across, int(number))

    def fault(self) -> str:
        """What the plate says that does not follow from its model, its values and its lines, or nothing."""
        said = self.said
        told = "-".join(f"{name}-{value}".replace("/", "_") for name, value in self.fixed.items())
        name = f"{said.model}-{told}" if told else said.model
        if said.name != name:
            return f"its name is {said.name[:60]}, but its model and values say {name}"
        if said.formula != self.boundary:
            return f"its formula is {said.formula[:80]}, but that of its model is {self.boundary}"
        for field, text, is_so in (
            ("stepped", said.stepped, self.is_stepped),
            ("motion", said.motion, self.is_gradual),
        ):
            if bool(text) is not is_so:
                return f"'{field}' does not go with its model and values"
        sides = [x.side for x in said.shown]
        if said.lines and sorted(sides) != sorted(SIDES):
            return (
                f"it shows the sides {', '.join(sides)[:60] or 'none'}, but has to show {' and '.join(SIDES)}"
            )
        asked = drawn.sides_in([x.drawn for x in said.lines], self.plane.along, self.is_stepped)
        lacking = any(x.side in asked and x.verdict is not Verdict.WITNESSED for x in said.shown)
        verdict = Verdict.UNKNOWN if lacking or not said.lines else Verdict.WITNESSED
        if said.verdict != verdict:
            return f"it is {said.verdict}, but its lines and drives say {verdict}"
        return ""

    def claim(self, shown: SideDrive, at: Mapping[str, Fraction]) -> str:
        """What a drive from these values has to show."""
        common = self.background.home
        reading = DriverSettings(values_with(common.library, common.values or {}), common.options)
        wanted = claim_of(self.manoeuvre, self.said.model, at, shown.side, reading)
        return with_also(wanted, shown.scenario)


def _plane(said: Plate, background: Background, number: int) -> _Plane:
    """Raises ``InputError``."""
    where = f"{background.home.where}, plate {number}"
    preamble = background.once(Preamble)
    if said.model not in MODELS or preamble.manoeuvre not in MODELS[said.model].manoeuvres:
        raise InputError(
            f"{where}: there is no model '{said.model[:40]}' of a manoeuvre '{preamble.manoeuvre}'"
        )
    fixed = {name: rational(x, f"{where}, fixed.{name}") for name, x in said.fixed.items()}
    return _Plane(said, where, background, preamble, fixed)


def _plate(said: Plate, background: Background, number: int) -> Iterator[Entry]:
    """The entries of a plate."""
    plate = _plane(said, background, number)
    of_plate = plate.fault()
    for k, shown in enumerate(said.shown, 1):
        where = f"{plate.where}, drive {k}"
        shows = shows_of(shown.verdict, where, "proof", "drive")
        at = {name: rational(v, f"{where}, at.{name}") for name, v in shown.at.items()}
        fault = of_plate and f"{plate.where}: {of_plate}"
        if shows == "drive" and not fault:
            fault = _drive_fault(shown, where, plate, at)
        elif shows != "drive" and (at or shown.formula) and not fault:
            fault = f"{where}: {shown.verdict} with initial values or a formula"
        yield Entry(
            background.home,
            where,
            ("drive", said.name, shown.side),
            shown.verdict,
            f"{said.name}, {shown.side}",
            shows,
            shown.formula,
            file_of(where, shows, None, shown.drive),
            unchecked=(_PLACES, _CONTROLLER) if plate.is_stepped else (),
            fault=fault,
            fault_of_drive=partial(_begins_otherwise, plate.manoeuvre, at),
            subject=Subject(SubjectKind.PLATE, said.name),
            expected=partial(_expected, plate, shown, at),
        )


def _expected(plate: _Plane, shown: SideDrive, at: Mapping[str, Fraction]) -> list[FormulaTree]:
    return [plate.background.home.formula(plate.claim(shown, at))]


def _drive_fault(shown: SideDrive, where: str, plate: _Plane, at: Mapping[str, Fraction]) -> str:
    """Why a drive's formula is not what its side, its values and its scenario demand, or nothing."""
    common, plane = plate.background.home, plate.plane
    if DRIVERS not in plate.preamble.specs:
        return f"{where} is about a driver of {DRIVERS}, which is not among its specification files"
    if shown.scenario and shown.scenario not in _scenarios(plate.preamble, plate.background.said.where):
        return f"{where} is of '{shown.scenario[:40]}', which is not what is asked for"
    row, place = at.get(plane.manoeuvre.across), at.get(plane.manoeuvre.line)
    if row is None or place is None or dict(at) != plane.values(row, place):
        return f"{where}: its initial values are not those of the plate at a place of its lines"
    if row not in plane.rows or not plane.along[0] <= place <= plane.along[1]:
        told = f"{plane.manoeuvre.across}={row}, {plane.manoeuvre.line}={place}"
        return f"{where}: {told} is not on the plate"
    if common.formula(shown.formula) != common.formula(plate.claim(shown, at)):
        return f"{where} is '{shown.side}' of {plate.boundary}, but its formula is not: {shown.formula[:120]}"
    return ""


def _begins_otherwise(manoeuvre: Manoeuvre, at: Mapping[str, Fraction], file: DriveFile) -> str:
    """Where a drive does not begin as the initial values say, or nothing."""
    states = signals_of(manoeuvre, at)
    if set(file.drive.vehicles) != set(manoeuvre.vehicles):
        return f"its vehicles are {', '.join(file.drive.vehicles)}"
    for vehicle, motion in file.drive.vehicles.items():
        for size in ("length", "width"):
            if getattr(motion, size) != at[size]:
                return f"{size}({vehicle})={getattr(motion, size)}, but the plate says {at[size]}"
        for signal in STARTING:
            begins, said = getattr(motion, signal), states[signal, vehicle]
            if begins != said:
                return f"{signal}({vehicle})={begins} at time 0, but the plate says {said}"
    return ""


def _scenarios(said: Preamble, where: str) -> tuple[str, ...]:
    """What drives may be of. Raises ``InputError`` where that is none of the manoeuvre."""
    if said.scenario is None:
        return ()
    manoeuvre, _ = manoeuvre_of(str(said.scenario))
    if manoeuvre != said.manoeuvre:
        raise InputError(f"{where}: scenario {said.scenario} is no {said.manoeuvre}")
    return parts_of(said.scenario, MANOEUVRES[manoeuvre].vehicles)


def _lemma(said: Lemma, background: Background, number: int) -> Entry:
    common, where = background.home, f"{background.home.where}, lemma {number}"
    manoeuvre = background.once(Preamble).manoeuvre
    shows = shows_of(said.verdict, where)
    known = lemmas_for(manoeuvre, models_for(manoeuvre), common.options.get("cc_aeb", "none"))
    named = [x.claim for x in known if x.name == said.name]
    return Entry(
        common,
        where,
        ("lemma", said.name),
        said.verdict,
        f"lemma {said.name}",
        shows,
        said.claim,
        file_of(where, shows, said.certificate, None),
        fault="" if said.claim in named else f"{where}: the claim of lemma '{said.name[:60]}' is another",
        assuming=said.assuming,
        expected=lambda: [common.formula(x) for x in named],
    )


def _entries(answer: Index | Record, background: Background) -> Iterator[Entry]:
    if isinstance(answer, Record):
        plates = [] if answer.plate is None else [answer.plate]
        lemmas = [] if answer.lemma is None else [answer.lemma]
    else:
        _scenarios(answer, background.where)
        plates, lemmas = [*answer.plates], [*answer.lemmas]
    for number, plate in enumerate(plates, 1):
        yield from _plate(plate, background, number)
    for number, lemma in enumerate(lemmas, 1):
        yield _lemma(lemma, background, number)


def _record_faults(kept: Record, background: Background) -> Iterator[str]:
    """As of an index with this plate alone."""
    if kept.plate is not None:
        yield from _line_fault(kept.plate, background, 1)


def _faults(said: Index, background: Background, formulas: Mapping[str, str]) -> Iterator[str]:
    """Plates whose lines differ from their formula or motion (controllers aside), and wrong idle options."""
    if background.said.has("idle"):
        found = _idle(said, background, {x.model for x in said.plates})
        if said.idle != found:
            yield f"what no boundary depends on is {', '.join(found) or 'nothing that was chosen'}"
    for number, plate in enumerate(said.plates, 1):
        yield from _line_fault(plate, background, number)


def _line_fault(said: Plate, background: Background, number: int) -> Iterator[str]:
    """Where the lines of a plate are not those of its plane, or say otherwise than its formula or motion."""
    if not said.lines:
        return
    common, plate = background.home, _plane(said, background, number)
    plane, rows = plate.plane, [Fraction(x.at) for x in said.lines]
    if len(rows) != len(plane.rows):
        yield f"plate {said.name} has {len(rows)} lines, but {len(plane.rows)} are asked for"
    elif rows != [*plane.rows]:
        yield f"plate {said.name}: its lines are at other values of {plane.manoeuvre.across}"
    elif not plate.is_stepped:
        true = drawn.truths(common.specification, plane, said.model, common.values or {})
        known = (Line.of(drawn.told_line(row, x)) for row, x in zip(plane.rows, true, strict=True))
        wrong = next((x for told, x in zip(said.lines, known, strict=True) if told != x), None)
        if wrong is not None:
            at = f"{plane.manoeuvre.across}={wrong.at}"
            yield f"plate {said.name} says otherwise at {at} than its formula or its motion"


def _idle(said: Index, background: Background, models: Set[str]) -> tuple[str, ...]:
    """What was chosen and has no say in the plates. Raises ``InputError``, ``UsageError``."""
    common = background.home
    if not models:
        raise InputError(f"{common.where}: there is no plate")
    asked = models_for(said.manoeuvre, tuple(sorted(models)))
    return idle(common.specification, common.values or {}, MANOEUVRES[said.manoeuvre], asked)


_READER = Reader.of(Index, Preamble, Record, _entries, faults=_faults, record_faults=_record_faults)
READER = replace(_READER, unchecked_kept=(*_READER.unchecked_kept, "said.along", "said.scenario"))
