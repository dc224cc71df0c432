"""The index and the kept answers of ``roadproof preventable``: drives on both sides, and lemmas."""

import re
from collections.abc import Iterator

from roadproof.evidence.answers.entry import Entry, evidence_name, shows_of
from roadproof.evidence.answers.reader import Background, Reader
from roadproof.evidence.strict import Fields, read_assuming

SCHEMA = "roadproof/preventable/1"
DRIVERS = "driver.spec"
_PLATE = ("name", "model", "fixed", "verdict", "formula", "stepped", "lines", "shown", "reason")
_SHOWN = ("side", "at", "verdict", "formula", "drive", "reason")
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
_LINES = "that the lines of the plate are where the formula holds"
_PLACES = "that the places of the plate are where it holds of the controller's drives"
_CONTROLLER = "that the accelerations of SV are what the controller of its model computes"


def _plate(content: object, background: Background, number: int) -> Iterator[Entry]:
    common = background.home
    plate = Fields(content, f"{common.where}, plate {number}", _PLATE)
    name, model, boundary = plate.text("name"), plate.text("model"), plate.text("formula")
    stepped = plate.text("stepped") != ""
    for x in plate.items("shown"):
        line = Fields(x, f"{plate.where}, drive", _SHOWN)
        side, verdict, claim = line.text("side"), line.text("verdict"), line.text("formula")
        shows, fault = shows_of(verdict, line.where, "proof", "drive"), ""
        if DRIVERS not in background.said.texts("specs"):
            fault = f"{line.where} is about a driver of {DRIVERS}, which is not among its specification files"
        elif shows == "drive" and not _says(claim, side, boundary, model, stepped):
            fault = f"{line.where} is about '{side}' of {boundary}, but its formula is not: {claim[:120]}"
        file = evidence_name(line, "drive")
        what = f"{name}, {side}"
        beyond = (_PLACES, _CONTROLLER) if stepped else (_LINES,)
        yield Entry(
            common, line.where, ("drive", name, side), verdict, what, shows, claim, file,
            unchecked=beyond, fault=fault,
        )  # fmt: skip


def _says(claim: str, side: str, boundary: str, model: str, stepped: bool) -> bool:
    """Whether a drive of ``claim`` shows that side: in words, since only one text is ever written."""
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
        yield from _plate(plate, background, number)
    for number, lemma in enumerate(data.items("lemmas"), 1):
        yield from _lemma(lemma, background, number)


def _record(record: Fields, background: Background) -> Iterator[Entry]:
    if record.has("lemma"):
        yield from _lemma(record.get("lemma"), background, 1)
    else:
        yield from _plate(record.get("plate"), background, 1)


READER = Reader(
    SCHEMA,
    ("set", "manoeuvre", "along", "across", "options", "parameters", "specs"),
    ("view", "seconds", "plates", "lemmas"),
    _index,
    ("plate", "lemma"),
    _record,
)
