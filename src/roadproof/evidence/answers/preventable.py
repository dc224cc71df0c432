"""The index and the kept answers of ``roadproof preventable``: drives on both sides, and lemmas."""

from collections.abc import Iterator, Mapping, Sequence, Set
from dataclasses import dataclass
from fractions import Fraction
from functools import partial

from roadproof.drivers import gradual
from roadproof.drivers.boundary import Plane, plane_of
from roadproof.drivers.claims import SIDES, Side, claim_of, with_also
from roadproof.drivers.driving import DriverSettings
from roadproof.drivers.idle import idle
from roadproof.drivers.lemmas import lemmas_for
from roadproof.drivers.lines import End, Line, line_data, sides_in, told_line, truths
from roadproof.drivers.manoeuvres import MANOEUVRES, Manoeuvre, ManoeuvreName, signals_of
from roadproof.drivers.models import MODELS, boundary_of, manoeuvre_of, models_for, parts_of, touched
from roadproof.errors import InputError
from roadproof.evidence.answers.entry import Entry, evidence_name, shows_of
from roadproof.evidence.answers.reader import Background, Reader
from roadproof.evidence.drive_file import DriveFile
from roadproof.evidence.strict import Fields, rational, read_assuming
from roadproof.library.bind import values_with
from roadproof.world.signals import STARTING

SCHEMA = "roadproof/preventable/1"
DRIVERS = "driver.spec"
_PLATE = ("name", "model", "fixed", "verdict", "formula", "stepped", "motion", "lines", "shown", "reason")
_SHOWN = ("side", "at", "verdict", "formula", "scenario", "drive", "reason")
_LEMMA = ("name", "title", "claim", "assuming", "verdict", "certificate", "reason")
_PLACES = "that the places of the plate are where it holds of the controller's drives"
_CONTROLLER = "that the accelerations of SV are what the controller of its model computes"


@dataclass(frozen=True)
class _Plate:
    """What a plate says of itself, compared with what is asked; ``fixed`` in SI units."""

    line: Fields
    name: str
    model: str
    manoeuvre: Manoeuvre
    fixed: Mapping[str, Fraction]

    @property
    def is_stepped(self) -> bool:
        return MODELS[self.model].is_stepped

    @property
    def is_gradual(self) -> bool:
        return gradual.RATE in self.fixed

    @property
    def boundary(self) -> str:
        vehicles = self.manoeuvre.vehicles
        return (
            touched(vehicles) if self.is_gradual else boundary_of(self.manoeuvre.name, self.model, vehicles)
        )

    def fault(self, lines: Sequence[Line], along: tuple[Fraction, Fraction]) -> str:
        """What the plate says that does not follow from its model, its values and its lines, or nothing."""
        told = "-".join(f"{name}-{value}".replace("/", "_") for name, value in self.fixed.items())
        name = f"{self.model}-{told}" if told else self.model
        if self.name != name:
            return f"its name is {self.name[:60]}, but its model and values say {name}"
        if self.line.text("formula") != self.boundary:
            return (
                f"its formula is {self.line.text('formula')[:80]}, but that of its model is {self.boundary}"
            )
        for field, is_so in (("stepped", self.is_stepped), ("motion", self.is_gradual)):
            if bool(self.line.text(field)) is not is_so:
                return f"'{field}' does not go with its model and values"
        shown = [Fields(x, self.line.where, _SHOWN) for x in self.line.items("shown")]
        sides = [x.text("side") for x in shown]
        if lines and sorted(sides) != sorted(SIDES):
            return (
                f"it shows the sides {', '.join(sides)[:60] or 'none'}, but has to show {' and '.join(SIDES)}"
            )
        asked = sides_in(lines, along, self.is_stepped)
        lacking = [
            x.text("side") for x in shown if x.text("side") in asked and x.text("verdict") != "WITNESSED"
        ]
        verdict = "UNKNOWN" if lacking or not lines else "WITNESSED"
        if self.line.text("verdict") != verdict:
            return f"it is {self.line.text('verdict')[:20]}, but its lines and drives say {verdict}"
        return ""


def _read_plate(content: object, background: Background, number: int) -> _Plate:
    """Raises ``InputError``."""
    common = background.home
    line = Fields(content, f"{common.where}, plate {number}", _PLATE)
    model, said = line.text("model"), background.said.text("manoeuvre")
    if said not in MANOEUVRES or model not in MODELS or said not in MODELS[model].manoeuvres:
        raise InputError(f"{line.where}: there is no model '{model[:40]}' of a manoeuvre '{said[:40]}'")
    fixed = {name: rational(x, f"{line.where}, fixed.{name}") for name, x in line.mapping("fixed").items()}
    return _Plate(line, line.text("name"), model, MANOEUVRES[said], fixed)


def _plate(content: object, background: Background, number: int) -> Iterator[Entry]:
    """The entries of a plate."""
    common, plate = background.home, _read_plate(content, background, number)
    plane = _plane(background.said, plate)
    lines = [_read_line(x, plate.line.where) for x in plate.line.items("lines")]
    of_plate = plate.fault(lines, plane.along)
    for k, x in enumerate(plate.line.items("shown")):
        line = Fields(x, f"{plate.line.where}, drive {k + 1}", _SHOWN)
        side, verdict, claim = line.text("side"), line.text("verdict"), line.text("formula")
        shows = shows_of(verdict, line.where, "proof", "drive")
        at = {name: rational(v, f"{line.where}, at.{name}") for name, v in line.mapping("at").items()}
        fault = of_plate and f"{plate.line.where}: {of_plate}"
        if shows == "drive" and not fault:
            fault = _drive_fault(line, plate, plane, background, at)
        elif shows != "drive" and (at or claim) and not fault:
            fault = f"{line.where}: {verdict} with initial values or a formula"
        yield Entry(
            common, line.where, ("drive", plate.name, side), verdict, f"{plate.name}, {side}", shows, claim,
            evidence_name(line, "drive"), unchecked=(_PLACES, _CONTROLLER) if plate.is_stepped else (),
            fault=fault, fault_of_drive=partial(_begins_otherwise, plate.manoeuvre, at),
        )  # fmt: skip


def _drive_fault(
    line: Fields, plate: _Plate, plane: Plane, background: Background, at: Mapping[str, Fraction]
) -> str:
    """Why a drive's formula is not what its side, its values and its scenario demand, or nothing."""
    common, scenario = background.home, line.text("scenario")
    side: Side | None = next((x for x in SIDES if x == line.text("side")), None)
    if side is None:
        return f"{line.where}: there is no side '{line.text('side')[:40]}'"
    if DRIVERS not in background.said.texts("specs"):
        return f"{line.where} is about a driver of {DRIVERS}, which is not among its specification files"
    if scenario and scenario not in _scenarios(background.said):
        return f"{line.where} is of '{scenario[:40]}', which is not what is asked for"
    row, place = at.get(plane.manoeuvre.across), at.get(plane.manoeuvre.line)
    if row is None or place is None or dict(at) != plane.values(row, place):
        return f"{line.where}: its initial values are not those of the plate at a place of its lines"
    if row not in plane.rows or not plane.along[0] <= place <= plane.along[1]:
        told = f"{plane.manoeuvre.across}={row}, {plane.manoeuvre.line}={place}"
        return f"{line.where}: {told} is not on the plate"
    reading = DriverSettings(values_with(common.library, common.values or {}), common.options)
    wanted = with_also(claim_of(plate.manoeuvre, plate.model, at, side, reading), scenario)
    claim = line.text("formula")
    if common.formula(claim) != common.formula(wanted):
        return f"{line.where} is '{side}' of {plate.boundary}, but its formula is not: {claim[:120]}"
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


def _scenarios(said: Fields) -> tuple[str, ...]:
    """What drives may be of. Raises ``InputError`` where that is none of the manoeuvre."""
    if not said.has("scenario"):
        return ()
    number = said.whole("scenario")
    manoeuvre, _ = manoeuvre_of(str(number))
    if manoeuvre != said.text("manoeuvre"):
        raise InputError(f"{said.where}: scenario {number} is no {said.text('manoeuvre')[:20]}")
    return parts_of(number, MANOEUVRES[manoeuvre].vehicles)


def _read_line(content: object, where: str) -> Line:
    """The inverse of ``line_data``. Raises ``InputError``."""
    data = Fields(content, f"{where}, line", ("at", "unpreventable"))
    spans = []
    for span in data.items("unpreventable"):
        if not isinstance(span, list) or len(span) != 2:
            raise InputError(f"{data.where}: a span has two ends")
        begin, end = (Fields(x, data.where, ("near", "exact")) for x in span)
        spans.append((_end(begin), _end(end)))
    return Line(data.rational("at"), tuple(spans))


def _end(data: Fields) -> End:
    near = data.get("near")
    if not isinstance(near, int | float) or isinstance(near, bool):
        raise InputError(f"{data.where}: near is no number")
    return End(float(near), data.text("exact"))


def _lemma(content: object, background: Background, number: int) -> Iterator[Entry]:
    common = background.home
    line = Fields(content, f"{common.where}, lemma {number}", _LEMMA)
    name, verdict, claim = line.text("name"), line.text("verdict"), line.text("claim")
    shows = shows_of(verdict, line.where)
    file, assuming = evidence_name(line, "certificate"), read_assuming(line)
    manoeuvre = _manoeuvre(background.said)
    known = lemmas_for(manoeuvre, models_for(manoeuvre), common.options.get("cc_aeb", "none"))
    named = [x.claim for x in known if x.name == name]
    fault = "" if claim in named else f"{line.where}: the claim of lemma '{name[:60]}' is another"
    yield Entry(
        common, line.where, ("lemma", name), verdict, f"lemma {name}", shows, claim, file, fault=fault,
        assuming=assuming,
    )  # fmt: skip


def _index(data: Fields, background: Background) -> Iterator[Entry]:
    _scenarios(data)
    for number, plate in enumerate(data.items("plates"), 1):
        yield from _plate(plate, background, number)
    for number, lemma in enumerate(data.items("lemmas"), 1):
        yield from _lemma(lemma, background, number)


def _record(record: Fields, background: Background) -> Iterator[Entry]:
    if record.has("lemma"):
        yield from _lemma(record.get("lemma"), background, 1)
    else:
        yield from _plate(record.get("plate"), background, 1)


def _record_faults(record: Fields, background: Background) -> Iterator[str]:
    """As of an index with this plate alone."""
    if not record.has("lemma"):
        yield from _line_fault(record.get("plate"), background, 1)


def _faults(data: Fields, background: Background, formulas: Mapping[str, str]) -> Iterator[str]:
    """Plates whose lines are not what their formula or motion says; a controller's are not looked at.

    And where what is said to have no say is not what has none.
    """
    common = background.home
    if data.has("idle"):
        models = {Fields(x, common.where, _PLATE).text("model") for x in data.items("plates")}
        found = _idle(data, background, models)
        if tuple(data.texts("idle")) != found:
            yield f"what no boundary depends on is {', '.join(found) or 'nothing that was chosen'}"
    for number, content in enumerate(data.items("plates"), 1):
        yield from _line_fault(content, background, number)


def _line_fault(content: object, background: Background, number: int) -> Iterator[str]:
    """Where the lines of a plate are not those of its plane, or say otherwise than its formula or motion."""
    common, plate = background.home, _read_plate(content, background, number)
    told = plate.line.items("lines")
    if not told:
        return
    plane = _plane(background.said, plate)
    rows = [Fields(x, plate.line.where).rational("at") for x in told]
    if len(told) != len(plane.rows):
        yield f"plate {plate.name} has {len(told)} lines, but {len(plane.rows)} are asked for"
    elif rows != [*plane.rows]:
        yield f"plate {plate.name}: its lines are at other values of {plane.manoeuvre.across}"
    elif not plate.is_stepped:
        true = truths(common.specification, plane, plate.model, common.values or {})
        known = map(line_data, map(told_line, plane.rows, true))
        wrong = next((x for said, x in zip(told, known, strict=True) if said != x), None)
        if wrong is not None:
            at = f"{plane.manoeuvre.across}={wrong['at']}"
            yield f"plate {plate.name} says otherwise at {at} than its formula or its motion"


def _idle(data: Fields, background: Background, models: Set[str]) -> tuple[str, ...]:
    """What was chosen and has no say in the plates. Raises ``InputError``, ``UsageError``."""
    common, manoeuvre = background.home, _manoeuvre(data)
    if not models:
        raise InputError(f"{data.where}: there is no plate")
    asked = models_for(manoeuvre, tuple(sorted(models)))
    return idle(common.specification, common.values or {}, MANOEUVRES[manoeuvre], asked)


def _manoeuvre(data: Fields) -> ManoeuvreName:
    """The manoeuvre that the question names. Raises ``InputError``."""
    said = data.text("manoeuvre")
    found = next((x for x in MANOEUVRES if x == said), None)
    if found is None:
        raise InputError(f"{data.where}: there is no manoeuvre '{said[:20]}'")
    return found


def _plane(said: Fields, plate: _Plate) -> Plane:
    """The plane of a plate, as the question says it. Raises ``InputError``, ``UsageError``."""
    manoeuvre = plate.manoeuvre
    along, across = said.texts("along"), said.texts("across")
    if (len(along), len(across)) != (3, 4) or not across[3].isdecimal():
        raise InputError(f"{said.where}: along and across say no plane")
    if (along[0], across[0]) != (manoeuvre.line, manoeuvre.across):
        raise InputError(f"{said.where}: a {manoeuvre.name} varies {manoeuvre.line} and {manoeuvre.across}")
    low, high = (rational(x, said.where) for x in along[1:])
    least, most = (rational(x, said.where) for x in across[1:3])
    return plane_of(manoeuvre, plate.fixed, (low, high), (least, most), int(across[3]))


READER = Reader(
    SCHEMA,
    ("set", "manoeuvre", "scenario", "along", "across", "options", "parameters", "specs"),
    ("view", "seconds", "idle", "plates", "lemmas"),
    _index,
    ("plate", "lemma"),
    _record,
    _faults,
    unchecked=(
        *("seconds", "plates[].reason", "plates[].shown[].reason", "lemmas[].title", "lemmas[].reason"),
    ),
    unchecked_kept=(
        *("plate.reason", "plate.shown[].reason", "lemma.title", "lemma.reason"),
        *("said.along", "said.scenario"),
    ),
    record_faults=_record_faults,
)
