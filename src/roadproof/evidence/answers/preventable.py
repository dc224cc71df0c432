"""The index and the kept answers of ``roadproof preventable``: drives on both sides, and lemmas."""

import re
from collections.abc import Iterator, Mapping, Set

from roadproof.errors import InputError
from roadproof.evidence.answers.entry import Entry, evidence_name, shows_of
from roadproof.evidence.answers.reader import Background, Reader
from roadproof.evidence.strict import Fields, rational, read_assuming
from roadproof.preventing.boundary import Plane, plane_of
from roadproof.preventing.idle import idle
from roadproof.preventing.lines import line_data, told_line, truths
from roadproof.preventing.manoeuvres import MANOEUVRES
from roadproof.preventing.models import manoeuvre_of, models_for, parts_of

SCHEMA = "roadproof/preventable/1"
DRIVERS = "driver.spec"
_PLATE = ("name", "model", "fixed", "verdict", "formula", "stepped", "motion", "lines", "shown", "reason")
_SHOWN = ("side", "at", "verdict", "formula", "scenario", "drive", "reason")
_LEMMA = ("name", "title", "claim", "assuming", "verdict", "certificate", "reason")
# What a drive on each side has to say, given the formula of the boundary.
_CLAIMS = {
    "unpreventable": r"{boundary} and {follows} and F touches\([A-Z0-9, ]+\)",
    "preventable": r"\w+\([A-Z0-9, ]+\) and not {boundary} and {follows} and G not touches\([A-Z0-9, ]+\)",
}
# Of a controller that is stepped, a drive says how it begins, and what comes of it.
_TOUCHES = r"F touches\([A-Z0-9, ]+\)"
_STEPPED = {
    "unpreventable": r"\w+\([A-Z0-9, ]+\) and {touched}",
    "preventable": r"\w+\([A-Z0-9, ]+\) and {untouched}",
}
# Where POV's braking grows at a finite rate, it says what SV and POV do, and what comes of it.
_GRADUAL = r"\w+\([A-Z0-9, ]+\) and follows_gradualDeceleration_{model}\([^()]*\) and {met}"
_LINES = "that the lines of the plate are what its formula or its motion says"
_PLACES = "that the places of the plate are where it holds of the controller's drives"
_CONTROLLER = "that the accelerations of SV are what the controller of its model computes"


def _plate(content: object, background: Background, number: int, beyond: tuple[str, ...]) -> Iterator[Entry]:
    """The entries of a plate; ``beyond``: what is not checked of its lines where they are exact."""
    common = background.home
    plate = Fields(content, f"{common.where}, plate {number}", _PLATE)
    name, model, boundary = plate.text("name"), plate.text("model"), plate.text("formula")
    stepped, motion = plate.text("stepped") != "", plate.text("motion") != ""
    for x in plate.items("shown"):
        line = Fields(x, f"{plate.where}, drive", _SHOWN)
        side, verdict, claim = line.text("side"), line.text("verdict"), line.text("formula")
        scenario = line.text("scenario")
        shows, fault = shows_of(verdict, line.where, "proof", "drive"), ""
        if DRIVERS not in background.said.texts("specs"):
            fault = f"{line.where} is about a driver of {DRIVERS}, which is not among its specification files"
        elif scenario and scenario not in _scenarios(background.said):
            fault = f"{line.where} is of '{scenario[:40]}', which is not what is asked for"
        elif shows == "drive" and not _says(
            _without(claim, scenario), side, boundary, model, stepped, motion
        ):
            fault = f"{line.where} is about '{side}' of {boundary}, but its formula is not: {claim[:120]}"
        file = evidence_name(line, "drive")
        what = f"{name}, {side}"
        yield Entry(
            common, line.where, ("drive", name, side), verdict, what, shows, claim, file,
            unchecked=(_PLACES, _CONTROLLER) if stepped else beyond, fault=fault,
        )  # fmt: skip


def _scenarios(said: Fields) -> tuple[str, ...]:
    """What drives may be of. Raises ``InputError`` where that is none of the manoeuvre."""
    if not said.has("scenario"):
        return ()
    number = said.whole("scenario")
    manoeuvre, _ = manoeuvre_of(str(number))
    if manoeuvre != said.text("manoeuvre"):
        raise InputError(f"{said.where}: scenario {number} is no {said.text('manoeuvre')[:20]}")
    return parts_of(number, MANOEUVRES[manoeuvre].vehicles)


def _without(claim: str, scenario: str) -> str:
    """A claim without what it says of a scenario; nothing where it has to say that and does not."""
    if not scenario:
        return claim
    end = f" and {scenario}"
    return claim.removesuffix(end) if claim.endswith(end) else ""


def _says(claim: str, side: str, boundary: str, model: str, stepped: bool, motion: bool) -> bool:
    """Whether a drive of ``claim`` shows that side: in words, since only one text is ever written."""
    if motion:
        met = boundary if side == "unpreventable" else boundary.replace("F ", "G not ", 1)
        pattern = _GRADUAL.format(model=re.escape(model), met=re.escape(met))
        known = side in _CLAIMS and not stepped and re.fullmatch(_TOUCHES, boundary) is not None
        return known and re.fullmatch(pattern, claim) is not None
    if stepped:
        return (
            side in _STEPPED
            and re.fullmatch(_TOUCHES, boundary) is not None
            and _comes(claim, side, boundary)
        )
    if side not in _CLAIMS or not re.fullmatch(
        rf"unpreventable_\w+_{re.escape(model)}\([A-Z0-9, ]+\)", boundary
    ):
        return False
    follows = boundary.replace("unpreventable_", "follows_", 1).partition("(")[0]
    driven = re.escape(follows) + r"\([^()]*\)"
    return re.fullmatch(_CLAIMS[side].format(boundary=re.escape(boundary), follows=driven), claim) is not None


def _comes(claim: str, side: str, boundary: str) -> bool:
    """Whether what comes of the drive is what the plate's formula is about."""
    untouched = boundary.replace("F ", "G not ", 1)
    pattern = _STEPPED[side].format(touched=re.escape(boundary), untouched=re.escape(untouched))
    return re.fullmatch(pattern, claim) is not None


def _lemma(content: object, background: Background, number: int) -> Iterator[Entry]:
    common = background.home
    line = Fields(content, f"{common.where}, lemma {number}", _LEMMA)
    name, verdict, claim = line.text("name"), line.text("verdict"), line.text("claim")
    shows = shows_of(verdict, line.where)
    file, assuming = evidence_name(line, "certificate"), read_assuming(line)
    yield Entry(
        common, line.where, ("lemma", name), verdict, f"lemma {name}", shows, claim, file, assuming=assuming
    )


def _index(data: Fields, background: Background) -> Iterator[Entry]:
    for number, plate in enumerate(data.items("plates"), 1):
        yield from _plate(plate, background, number, ())
    for number, lemma in enumerate(data.items("lemmas"), 1):
        yield from _lemma(lemma, background, number)


def _record(record: Fields, background: Background) -> Iterator[Entry]:
    if record.has("lemma"):
        yield from _lemma(record.get("lemma"), background, 1)
    else:
        yield from _plate(record.get("plate"), background, 1, (_LINES,))


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
        plate = Fields(content, f"{common.where}, plate {number}", _PLATE)
        if plate.text("stepped") or not plate.items("lines"):
            continue
        plane, told = _plane(data, plate), plate.items("lines")
        if len(told) != plane.lines:
            yield f"plate {plate.text('name')} has {len(told)} lines, but {plane.lines} are asked for"
            continue
        true = truths(common.specification, plane, plate.text("model"), common.values or {})
        known = map(line_data, map(told_line, plane.rows, true))
        wrong = next((x for said, x in zip(told, known, strict=True) if said != x), None)
        if wrong is not None:
            at = f"{plane.manoeuvre.across}={wrong['at']}"
            yield f"plate {plate.text('name')} says otherwise at {at} than its formula or its motion"


def _idle(data: Fields, background: Background, models: Set[str]) -> tuple[str, ...]:
    """What was chosen and has no say in the plates. Raises ``InputError``, ``UsageError``."""
    common, manoeuvre = background.home, data.text("manoeuvre")
    if manoeuvre not in MANOEUVRES or not models:
        raise InputError(f"{data.where}: there is no manoeuvre '{manoeuvre[:20]}', or no plate of it")
    asked = models_for(manoeuvre, tuple(sorted(models)))
    return idle(common.specification, common.values or {}, MANOEUVRES[manoeuvre], asked)


def _plane(data: Fields, plate: Fields) -> Plane:
    """The plane of a plate, as the index says it. Raises ``InputError``, ``UsageError``."""
    manoeuvre = MANOEUVRES.get(data.text("manoeuvre"))
    along, across = data.texts("along"), data.texts("across")
    if manoeuvre is None or (len(along), len(across)) != (3, 4) or not across[3].isdecimal():
        raise InputError(f"{data.where}: manoeuvre, along and across say no plane")
    if (along[0], across[0]) != (manoeuvre.line, manoeuvre.across):
        raise InputError(f"{data.where}: a {manoeuvre.name} varies {manoeuvre.line} and {manoeuvre.across}")
    fixed = {name: rational(x, f"{plate.where}, fixed.{name}") for name, x in plate.mapping("fixed").items()}
    low, high = (rational(x, data.where) for x in along[1:])
    least, most = (rational(x, data.where) for x in across[1:3])
    return plane_of(manoeuvre, fixed, (low, high), (least, most), int(across[3]))


READER = Reader(
    SCHEMA,
    ("set", "manoeuvre", "scenario", "along", "across", "options", "parameters", "specs"),
    ("view", "seconds", "idle", "plates", "lemmas"),
    _index,
    ("plate", "lemma"),
    _record,
    _faults,
)
