"""The index and the kept answers of ``roadproof explore``: for which values a formula has a drive."""

from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction
from typing import Annotated, Final, Literal, TypeAlias

from roadproof.errors import InputError
from roadproof.evidence.answers import shared
from roadproof.evidence.answers.entry import Common, Entry, fault_of_number, file_of, shows_of
from roadproof.evidence.answers.proofs import unchecked_of
from roadproof.evidence.answers.reader import Background, Reader
from roadproof.evidence.codec import LEFT_OUT, UNCHECKED, Doc, Rule
from roadproof.evidence.strict import rational
from roadproof.library.bind import values_with
from roadproof.library.compose import always, both, comparison, eventually
from roadproof.library.elaborate import read_claim, read_term
from roadproof.library.motion import values_said
from roadproof.library.specification import Query
from roadproof.logic import formula as f
from roadproof.logic import syntax
from roadproof.logic.formula import Formula
from roadproof.logic.parse import parse_claim
from roadproof.logic.show import declared
from roadproof.logic.syntax import BinaryOperator
from roadproof.reasons import NO_REASON
from roadproof.runtime.records import dataclass
from roadproof.verdict import DriveVerdict
from roadproof.world.signals import LIMITED, SignalName
from roadproof.world.units import UNITS, unit_text
from roadproof.world.vehicle import LIMITS

SCHEMA: Final = "roadproof/explore/1"
_SENSES: Mapping[str, BinaryOperator] = {"least": "<=", "greatest": ">="}
Count: TypeAlias = Annotated[int, UNCHECKED, Rule(minimum=0)]


@dataclass(frozen=True, kw_only=True)
class Variation:
    """What is varied, from low to high."""

    name: Annotated[str, Doc("A parameter, or a limit such as POV.a_lon.min.")]
    unit: Annotated[str, Doc("Unit of all its values here.")]
    low: shared.Rational
    high: shared.Rational


@dataclass(frozen=True, kw_only=True)
class Finding:
    """Whether there is a drive at a value."""

    at: Annotated[
        tuple[shared.Rational, ...],
        Doc("Values of what is varied, in its units; of an extreme the value of the measure."),
    ]
    verdict: DriveVerdict
    formula: shared.Formula
    reason: shared.Reason = NO_REASON
    number: Annotated[int | None, UNCHECKED, Doc("Tells drives apart; null where there is none.")] = None
    drive: shared.KeptDrive = None
    certificate: shared.KeptCertificate = None
    assuming: Annotated[shared.Assuming, LEFT_OUT] = ()


@dataclass(frozen=True, kw_only=True)
class Boundary:
    """Where drives end on one side of a value."""

    held: Annotated[Finding, Doc("A value with a drive.")]
    missed: Annotated[Finding, Doc("The nearest value on one side for which none was found.")]
    surely: Annotated[
        Finding | None, Doc("The nearest value there for which it is said that there is none.")
    ] = None


@dataclass(frozen=True, kw_only=True)
class Extreme:
    """How far a measure can go."""

    sense: Literal["least", "greatest"]
    measure: Annotated[str, Rule(least=1), Doc("A term.")]
    when: Annotated[str, Doc("At a moment at which this formula holds; empty is at time 0.")]
    unit: Annotated[str, Doc("Of the measure, SI; empty where it has none.")]
    point: Annotated[tuple[shared.Rational, ...], Doc("Values of what is varied.")]
    best: Annotated[Finding | None, Doc("The value that a drive reaches; null where there is no drive.")] = (
        None
    )
    missed: Annotated[Finding | None, Doc("The nearest value for which none was found.")] = None
    surely: Annotated[Finding | None, Doc("The nearest value for which it is said that there is none.")] = (
        None
    )
    endless: Annotated[bool, UNCHECKED, Doc("Whether the drive passes any value that is asked for.")] = False
    searches: Count = 0

    @property
    def sides(self) -> dict[str, Finding | None]:
        """What was found, by name."""
        return {"best": self.best, "missed": self.missed, "surely": self.surely}


@dataclass(frozen=True, kw_only=True)
class Exploration:
    """For which values a formula has a drive, and how far measures can go."""

    scenario: shared.OneScenario
    set: shared.SetName
    formula: shared.Formula
    vary: tuple[Variation, ...]
    values: tuple[Finding, ...]
    boundaries: tuple[Boundary, ...]
    searches: Annotated[Count, Doc("How many searches it took.")] = 0
    drives: Annotated[Count, Doc("How many drives serve the values.")] = 0
    extremes: tuple[Extreme, ...]
    seconds: shared.Seconds = 0.0


@dataclass(frozen=True, kw_only=True)
class Preamble:
    """What an index says once for all explorations."""

    options: shared.Options
    parameters: Annotated[shared.Parameters, Doc("All that are not varied, in SI units.")]
    specs: shared.Specifications


@dataclass(frozen=True, kw_only=True)
class Index(Preamble, shared.OnRoad, shared.Heading):
    """For which values there is a drive."""

    schema: Literal["roadproof/explore/1"] = SCHEMA
    view: shared.Dense = "dense"
    seconds: shared.Seconds = 0.0
    explored: tuple[Exploration, ...]


@dataclass(frozen=True, kw_only=True)
class Record:
    """A kept answer."""

    exploration: Exploration


def _entries(answer: Index | Record, background: Background) -> Iterator[Entry]:
    if isinstance(answer, Record):
        yield from _one(answer.exploration, background.where, background)
        return
    for number, said in enumerate(answer.explored, 1):
        yield from _one(said, f"{background.where}, exploration {number}", background)


@dataclass(frozen=True)
class _Variable:
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

    common: Common
    base: Query
    knobs: tuple[_Variable, ...]
    fault: str

    def point(self, at: Sequence[str], where: str) -> dict[str, Fraction]:
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


def _one(said: Exploration, where: str, background: Background) -> Iterator[Entry]:
    """The entries of one exploration."""
    common = background.at(said.set)
    base = read_claim(common.specification, said.formula)
    knobs = tuple(_knob(x, where, common, base) for x in said.vary)
    fault = (
        fault_of_number(common, where, said.scenario, said.formula)
        or next((x.fault for x in knobs if x.fault), "")
        or _off_range(said, where, knobs)
    )
    one = _Exploration(common, base, knobs, fault)
    of = (said.scenario, said.set, said.formula)
    for k, finding in enumerate(said.values, 1):
        yield _at_point(one, finding, f"{where}, value {k}", (*of, "value", k))
    for k, boundary in enumerate(said.boundaries, 1):
        sides = {"held": boundary.held, "missed": boundary.missed, "surely": boundary.surely}
        for side, found in sides.items():
            if found is not None:
                yield _at_point(one, found, f"{where}, boundary {k}, {side}", (*of, "boundary", k, side))
    for k, extreme in enumerate(said.extremes, 1):
        for side, found in extreme.sides.items():
            if found is not None:
                place, key = f"{where}, extreme {k}", (*of, "extreme", k, side)
                yield _of_measure(one, extreme, found, place, f"{place}, {side}", key)


def _off_range(said: Exploration, where: str, knobs: Sequence[_Variable]) -> str:
    """Why the values are not from the least to the greatest of what is varied, or nothing."""
    for k, knob in enumerate(knobs):
        values = [rational(x.at[k], where) for x in said.values if k < len(x.at)]
        if (min(values, default=knob.low), max(values, default=knob.high)) != (knob.low, knob.high):
            return f"{where}: {knob.name} is varied from {knob.low} to {knob.high}, but its values are not"
    return ""


def _knob(said: Variation, of: str, common: Common, base: Query) -> _Variable:
    """What is varied. Raises ``InputError``."""
    where, name, unit = f"{of}, vary", said.name, said.unit
    low, high = rational(said.low, f"{where}, low"), rational(said.high, f"{where}, high")
    if name in common.library.parameters:
        known_unit = unit_text(UNITS[common.library.parameters[name].unit][1])
        return _Variable(name, low, high, fault=_other_unit(where, unit, known_unit))
    vehicle, signal, end = (*name.split("."), "", "", "")[:3]
    known = next((x for x in LIMITED if x == signal), None)
    vehicles = base.vehicles if vehicle == "vehicle" else (vehicle,)
    if (
        known is None
        or name.count(".") != 2
        or end not in ("min", "max")
        or not {*vehicles} <= {*base.vehicles}
    ):
        raise InputError(f"{where}: '{name[:60]}' is no parameter and no limit of a vehicle of the formula")
    return _Variable(name, low, high, tuple(vehicles), known, end, _other_unit(where, unit, LIMITS[known]))


def _other_unit(where: str, said: str, known: str) -> str:
    return "" if said == known else f"{where}: unit='{said[:20]}', but it is '{known}'"


def _at_point(one: _Exploration, found: Finding, where: str, key: tuple[object, ...]) -> Entry:
    """What was found at values of the knobs."""
    point = one.point(found.at, where)
    told = ", ".join(f"{name}={value}" for name, value in point.items())
    return _entry(one, found, where, told, one.values(point), one.expected(*one.limits(point)), key)


def _of_measure(
    one: _Exploration, extreme: Extreme, found: Finding, place: str, where: str, key: tuple[object, ...]
) -> Entry:
    """What was found of a measure at a point of the knobs."""
    point = one.point(extreme.point, place)
    at = [rational(x, f"{where}, at") for x in found.at]
    if len(at) > 1:
        raise InputError(f"{where}: it is no value of a measure")
    specification, given = one.common.specification, one.base.claim.given
    head = declared(given)
    term = head + extreme.measure
    left, dimension = parse_claim(term).body, read_term(specification, term, "measure")[1]
    if extreme.unit != unit_text(dimension):
        raise InputError(f"{place}: unit='{extreme.unit[:20]}', but it is '{unit_text(dimension)}'")
    bound = [comparison(specification, given, left, _SENSES[extreme.sense], x, dimension) for x in at]
    if extreme.when:
        bound = [eventually(both(read_claim(specification, head + extreme.when), *bound))]
    return _entry(one, found, where, "", one.values(point), one.expected(*one.limits(point), *bound), key)


def _entry(
    one: _Exploration,
    found: Finding,
    where: str,
    told: str,
    values: Mapping[str, Fraction] | None,
    expected: Formula,
    key: tuple[object, ...],
) -> Entry:
    shows = shows_of(found.verdict, where, "impossibility", "drive")
    fault = one.fault
    if not fault and one.common.formula(found.formula) != expected:
        fault = f"{where}: its formula is not that of its values: {found.formula[:120]}"
    return Entry(
        one.common,
        where,
        key,
        found.verdict,
        told,
        shows,
        found.formula,
        file_of(where, shows, found.certificate, found.drive),
        values=values,
        unchecked=unchecked_of(found.verdict),
        fault=fault or _other(one.common, found.verdict, values, found.assuming, where),
        assuming=found.assuming,
        expected=lambda: [f.negation(expected) if shows == "impossibility" else expected],
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


READER = Reader.of(Index, Preamble, Record, _entries)
