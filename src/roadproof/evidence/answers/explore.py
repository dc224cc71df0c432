"""The index and the kept answers of ``roadproof explore``: for which values a formula has a drive."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction

from roadproof.errors import InputError
from roadproof.evidence.answers.entry import Common, Entry, one_of, shows_of
from roadproof.evidence.answers.proofs import unchecked_of
from roadproof.evidence.answers.reader import Background, Reader
from roadproof.evidence.strict import Fields, rational, read_assuming, text
from roadproof.spec.bind import values_with
from roadproof.spec.motion import values_said

SCHEMA = "roadproof/explore/1"
_EXPLORED = ("scenario", "set", "formula", "vary", "values", "boundaries", "searches", "drives", "extremes")
_EXPLORED_MORE = ("seconds", "stem")
_FINDING = ("at", "verdict", "formula", "reason", "number", "drive", "certificate", "assuming")
_BOUNDARY = ("held", "missed", "surely")
_EXTREME = ("sense", "measure", "when", "unit", "point", "best", "missed", "surely", "endless", "searches")


def read_index(data: Fields, background: Background) -> Iterator[Entry]:
    """The entries of an index. Raises ``InputError``."""
    for number, content in enumerate(data.items("explored"), 1):
        yield from _one(content, f"{data.where}, exploration {number}", background)


def read_record(record: Fields, background: Background) -> Iterator[Entry]:
    """The entries of a kept answer. Raises ``InputError``."""
    return _one(record.get("exploration"), record.where, background)


def _one(content: object, where: str, background: Background) -> Iterator[Entry]:
    """The entries of one exploration."""
    one = Fields(content, where, (*_EXPLORED, *_EXPLORED_MORE))
    common = background.at(one.text("set"))
    of = tuple(str(one.content.get(name)) for name in ("scenario", "set", "formula"))
    knobs = [Fields(x, f"{where}, vary").text("name") for x in one.items("vary")]
    for k, finding in enumerate(one.items("values"), 1):
        yield _entry(finding, f"{where}, value {k}", common, knobs, (*of, "value", k))
    for k, boundary in enumerate(one.items("boundaries"), 1):
        place = f"{where}, boundary {k}"
        sides = Fields(boundary, place, _BOUNDARY)
        for side in _BOUNDARY:
            if sides.has(side):
                key = (*of, "boundary", k, side)
                yield _entry(sides.get(side), f"{place}, {side}", common, knobs, key)
    for k, extreme in enumerate(one.items("extremes"), 1):
        place = f"{where}, extreme {k}"
        sides = Fields(extreme, place, _EXTREME)
        # Where it is sought is a point of the knobs; its own values are of a measure, in the formula.
        point = dict(zip(knobs, sides.items("point"), strict=False))
        there = replace(common, values=_values(common, point, place))
        for side in ("best", "missed", "surely"):
            if sides.has(side):
                key = (*of, "extreme", k, side)
                yield _entry(sides.get(side), f"{place}, {side}", there, [], key)


def _entry(
    content: object, where: str, common: Common, knobs: Sequence[str], key: tuple[object, ...]
) -> Entry:
    line = Fields(content, where, _FINDING)
    verdict, at = line.text("verdict"), line.items("at")
    shows = shows_of(verdict, where, "impossibility", "drive")
    told = ", ".join(f"{name}={text(value, where)}" for name, value in zip(knobs, at, strict=False))
    values = _values(common, dict(zip(knobs, at, strict=False)), where) if knobs else None
    assuming = read_assuming(line) if "assuming" in line.content else ()
    fault = "" if not knobs or len(at) == len(knobs) else f"{where}: {len(at)} values of {len(knobs)}"
    return Entry(
        common,
        where,
        key,
        verdict,
        told,
        shows,
        line.text("formula"),
        one_of(line, shows),
        values=values,
        unchecked=(*unchecked_of(verdict), *(() if knobs else ("that its formula says the value at=",))),
        fault=fault or _other(common, verdict, values if knobs else common.values, assuming, where),
        assuming=assuming,
    )


def _other(
    common: Common, verdict: str, values: Mapping[str, Fraction] | None, assuming: tuple[str, ...], where: str
) -> str:
    """What a proof assumes that is no value of a parameter there, or nothing."""
    if not assuming:
        return ""
    if verdict != "IMPOSSIBLE":
        return f"{where}: {verdict} assumes nothing, but it says {', '.join(assuming)[:120]}"
    here = values_with(common.library, values or {})
    said = values_said(common.specification, assuming)
    if len(said) < len(assuming):
        return f"{where} assumes more than values of parameters: {', '.join(assuming)[:120]}"
    wrong = [
        f"{name}={value}, where it is {here[name]}" for name, value in said.items() if here[name] != value
    ]
    return f"{where} assumes {wrong[0]}" if wrong else ""


def _values(common: Common, at: Mapping[str, object], where: str) -> dict[str, Fraction] | None:
    """The values of the parameters that are varied; limits of vehicles are no parameters."""
    chosen = {n: rational(x, f"{where}, {n}") for n, x in at.items() if n in common.library.parameters}
    if common.values is None and not chosen:
        return None
    if any(not isinstance(value, str) for value in at.values()):
        raise InputError(f"{where}: its values are no texts")
    return {**(common.values or {}), **chosen}


READER = Reader(
    SCHEMA,
    ("options", "parameters", "specs"),
    ("view", "seconds", "explored"),
    read_index,
    ("exploration",),
    read_record,
)
