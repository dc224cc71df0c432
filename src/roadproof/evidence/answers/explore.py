"""The index and the kept answers of ``roadproof explore``: for which values a formula has a drive."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction

from roadproof.errors import InputError
from roadproof.evidence.answers.entry import Common, Entry, one_of, shows_of
from roadproof.evidence.answers.proofs import unchecked_of
from roadproof.evidence.answers.reader import Background, Reader
from roadproof.evidence.strict import Fields, rational, read_assuming
from roadproof.logic import syntax
from roadproof.logic.formula import Formula
from roadproof.logic.parse import parse_claim
from roadproof.logic.show import text as show
from roadproof.logic.syntax import BinaryOperator
from roadproof.signals import LIMITED, SignalName
from roadproof.spec.bind import values_with
from roadproof.spec.compose import always, both, comparison, eventually
from roadproof.spec.elaborate import read_claim, read_term
from roadproof.spec.motion import values_said
from roadproof.spec.query import Query
from roadproof.spec.scenarios import Scenario, applied, name_of
from roadproof.units import UNITS, unit_text
from roadproof.world.vehicle import LIMITS

SCHEMA = "roadproof/explore/1"
_EXPLORED = ("scenario", "set", "formula", "vary", "values", "boundaries", "searches", "drives", "extremes")
_EXPLORED_MORE = ("seconds", "stem")
_FINDING = ("at", "verdict", "formula", "reason", "number", "drive", "certificate", "assuming")
_BOUNDARY = ("held", "missed", "surely")
_UNCHECKED = (
    *("searches", "drives", "seconds", "stem", "values[].reason", "values[].number"),
    *(f"boundaries[].{x}.{y}" for x in _BOUNDARY for y in ("reason", "number")),
    *(f"extremes[].{x}.{y}" for x in ("best", "missed", "surely") for y in ("reason", "number")),
    *("extremes[].endless", "extremes[].searches"),
)
_SENSES: Mapping[str, BinaryOperator] = {"least": "<=", "greatest": ">="}
_EXTREME = ("sense", "measure", "when", "unit", "point", "best", "missed", "surely", "endless", "searches")


def read_index(data: Fields, background: Background) -> Iterator[Entry]:
    """The entries of an index. Raises ``InputError``."""
    for number, content in enumerate(data.items("explored"), 1):
        yield from _one(content, f"{data.where}, exploration {number}", background)


def read_record(record: Fields, background: Background) -> Iterator[Entry]:
    """The entries of a kept answer. Raises ``InputError``."""
    return _one(record.get("exploration"), record.where, background)


@dataclass(frozen=True)
class _Knob:
    """What is varied from ``low`` to ``high``: a parameter, or an end of a signal's range (SI units)."""

    name: str
    low: Fraction
    high: Fraction
    vehicles: tuple[str, ...] = ()
    signal: SignalName | None = None
    end: str = ""
    fault: str = ""

    def says(self, common: Common, base: Query, value: Fraction) -> Iterator[Query]:
        """The limit at a value, as formulas; nothing of a parameter."""
        if self.signal is not None:
            for vehicle in self.vehicles:
                left = syntax.Call(self.signal, (syntax.Name(vehicle),))
                op: BinaryOperator = ">=" if self.end == "min" else "<="
                dimension = UNITS[LIMITS[self.signal]][1]
                given = base.claim.given
                yield always(comparison(common.specification, given, left, op, value, dimension))


@dataclass(frozen=True)
class _Exploration:
    """One exploration, read: what it is about and what it varies."""

    line: Fields
    common: Common
    base: Query
    knobs: tuple[_Knob, ...]
    fault: str

    def point(self, at: Sequence[object], where: str) -> dict[str, Fraction]:
        """The value of each knob. Raises ``InputError``."""
        if len(at) != len(self.knobs):
            raise InputError(f"{where}: {len(at)} values of {len(self.knobs)}")
        return {k.name: rational(x, f"{where}, {k.name}") for k, x in zip(self.knobs, at, strict=True)}

    def limits(self, point: Mapping[str, Fraction]) -> list[Query]:
        """The limits of vehicles at a point, as formulas."""
        return [x for knob in self.knobs for x in knob.says(self.common, self.base, point[knob.name])]

    def values(self, point: Mapping[str, Fraction]) -> dict[str, Fraction] | None:
        """The values of all parameters at a point."""
        chosen = {k.name: point[k.name] for k in self.knobs if k.signal is None}
        if self.common.values is None and not chosen:
            return None
        return {**(self.common.values or {}), **chosen}

    def expected(self, *parts: Query) -> Formula:
        """What is asked about, and that these parts hold."""
        return both(self.base, *parts).formula if parts else self.base.formula


def _one(content: object, where: str, background: Background) -> Iterator[Entry]:
    """The entries of one exploration."""
    one = Fields(content, where, (*_EXPLORED, *_EXPLORED_MORE))
    common = background.at(one.text("set"))
    base = read_claim(common.specification, one.text("formula"))
    knobs = tuple(_knob(x, where, common, base) for x in one.items("vary"))
    fault = (
        _misnamed(one, common, base)
        or next((x.fault for x in knobs if x.fault), "")
        or _off_range(one, knobs)
    )
    exploration = _Exploration(one, common, base, knobs, fault)
    of = tuple(str(one.content.get(name)) for name in ("scenario", "set", "formula"))
    for k, finding in enumerate(one.items("values"), 1):
        yield _at_point(exploration, finding, f"{where}, value {k}", (*of, "value", k))
    for k, boundary in enumerate(one.items("boundaries"), 1):
        place = f"{where}, boundary {k}"
        sides = Fields(boundary, place, _BOUNDARY)
        for side in _BOUNDARY:
            if sides.has(side):
                yield _at_point(exploration, sides.get(side), f"{place}, {side}", (*of, "boundary", k, side))
    for k, extreme in enumerate(one.items("extremes"), 1):
        place = f"{where}, extreme {k}"
        sides = Fields(extreme, place, _EXTREME)
        for side in ("best", "missed", "surely"):
            if sides.has(side):
                key = (*of, "extreme", k, side)
                yield _of_measure(exploration, sides, sides.get(side), f"{place}, {side}", key)


def _misnamed(one: Fields, common: Common, base: Query) -> str:
    """Why an exploration is not of the scenario that it names, or nothing."""
    if not one.has("scenario"):
        return ""
    number = one.whole("scenario")
    known = name_of(number) in common.specification.definitions
    if known and applied(common.specification, Scenario(number, common.set_name)).formula == base.formula:
        return ""
    return f"{one.where} is called scenario {number}, but its formula is another: {one.text('formula')[:120]}"


def _off_range(one: Fields, knobs: Sequence[_Knob]) -> str:
    """Why the values are not from the least to the greatest of what is varied, or nothing."""
    found = [Fields(x, one.where).items("at") for x in one.items("values")]
    for k, knob in enumerate(knobs):
        values = [rational(at[k], one.where) for at in found if k < len(at)]
        if (min(values, default=knob.low), max(values, default=knob.high)) != (knob.low, knob.high):
            return (
                f"{one.where}: {knob.name} is varied from {knob.low} to {knob.high}, but its values are not"
            )
    return ""


def _knob(content: object, where: str, common: Common, base: Query) -> _Knob:
    """What is varied. Raises ``InputError``."""
    data = Fields(content, f"{where}, vary", ("name", "unit", "low", "high"))
    name, unit = data.text("name"), data.text("unit")
    low, high = data.rational("low"), data.rational("high")
    if name in common.library.parameters:
        known_unit = unit_text(UNITS[common.library.parameters[name].unit][1])
        return _Knob(name, low, high, fault=_other_unit(data.where, unit, known_unit))
    vehicle, signal, end = (*name.split("."), "", "", "")[:3]
    known = next((x for x in LIMITED if x == signal), None)
    vehicles = base.vehicles if vehicle == "vehicle" else (vehicle,)
    if (
        known is None
        or name.count(".") != 2
        or end not in ("min", "max")
        or not {*vehicles} <= {*base.vehicles}
    ):
        raise InputError(
            f"{data.where}: '{name[:60]}' is no parameter and no limit of a vehicle of the formula"
        )
    return _Knob(name, low, high, tuple(vehicles), known, end, _other_unit(data.where, unit, LIMITS[known]))


def _other_unit(where: str, said: str, known: str) -> str:
    return "" if said == known else f"{where}: unit='{said[:20]}', but it is '{known}'"


def _at_point(one: _Exploration, content: object, where: str, key: tuple[object, ...]) -> Entry:
    """What was found at values of the knobs."""
    line = Fields(content, where, _FINDING)
    point = one.point(line.items("at"), where)
    told = ", ".join(f"{name}={value}" for name, value in point.items())
    return _entry(one, line, told, one.values(point), one.expected(*one.limits(point)), key)


def _of_measure(
    one: _Exploration, extreme: Fields, content: object, where: str, key: tuple[object, ...]
) -> Entry:
    """What was found of a measure at a point of the knobs."""
    line = Fields(content, where, _FINDING)
    point = one.point(extreme.items("point"), extreme.where)
    at = [rational(x, f"{where}, at") for x in line.items("at")]
    if len(at) > 1 or extreme.text("sense") not in _SENSES:
        raise InputError(f"{where}: it is no value of a measure")
    specification, given = one.common.specification, one.base.claim.given
    head = show(syntax.Claim(given, syntax.Literal_(True))).removesuffix("true") if given else ""
    term = head + extreme.text("measure")
    left, dimension = parse_claim(term).body, read_term(specification, term, "measure")[1]
    if extreme.text("unit") != unit_text(dimension):
        raise InputError(
            f"{extreme.where}: unit='{extreme.text('unit')[:20]}', but it is '{unit_text(dimension)}'"
        )
    bound = [
        comparison(specification, given, left, _SENSES[extreme.text("sense")], value, dimension)
        for value in at
    ]
    if extreme.text("when"):
        bound = [eventually(both(read_claim(specification, head + extreme.text("when")), *bound))]
    return _entry(one, line, "", one.values(point), one.expected(*one.limits(point), *bound), key)


def _entry(
    one: _Exploration,
    line: Fields,
    told: str,
    values: Mapping[str, Fraction] | None,
    expected: Formula,
    key: tuple[object, ...],
) -> Entry:
    verdict, claim = line.text("verdict"), line.text("formula")
    shows = shows_of(verdict, line.where, "impossibility", "drive")
    assuming = read_assuming(line) if "assuming" in line.content else ()
    fault = one.fault
    if not fault and one.common.formula(claim) != expected:
        fault = f"{line.where}: its formula is not that of its values: {claim[:120]}"
    return Entry(
        one.common,
        line.where,
        key,
        verdict,
        told,
        shows,
        claim,
        one_of(line, shows),
        values=values,
        unchecked=unchecked_of(verdict),
        fault=fault or _other(one.common, verdict, values, assuming, line.where),
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


READER = Reader(
    SCHEMA,
    ("options", "parameters", "specs"),
    ("view", "seconds", "explored"),
    read_index,
    ("exploration",),
    read_record,
    unchecked=("seconds", *(f"explored[].{x}" for x in _UNCHECKED)),
    unchecked_kept=tuple(f"exploration.{x}" for x in _UNCHECKED),
)
