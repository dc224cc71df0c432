"""What a claim may be proved under: that its vehicles move, within which limits, and at which values.

``assuming motion: CLAIM`` says that the claim holds on every trace that is a motion (``logic.motion``);
``assuming motion, a_lon(SV) <= 3 m/s^2: CLAIM`` on every one that keeps a limit. What is proved is
``axioms -> claim``. An axiom is kept as the name of its schema and the texts of its arguments, and its
formula is made of them each time it is needed: no other formula can be assumed.

``at minDanger = 0.6 s: CLAIM`` says that the claim holds where that is the value of a parameter; after motion
and limits a value is one more of what is assumed. What is proved is the claim with the value put in.
"""

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from fractions import Fraction

from roadproof.errors import InputError, Position, TextError
from roadproof.library import arithmetic
from roadproof.library.assumed_text import located, parsed
from roadproof.library.bind import values_with
from roadproof.library.compose import always, both, implication
from roadproof.library.elaborate import elaborate, read_claim
from roadproof.library.elaboration import Elaborator
from roadproof.library.quantity import Quantity
from roadproof.library.specification import Query, Specification, unknown
from roadproof.logic import formula as f
from roadproof.logic import motion, syntax
from roadproof.logic import terms as t
from roadproof.logic.formula import Formula
from roadproof.logic.initial_conditions import pins
from roadproof.logic.restore import as_syntax, term_as_syntax
from roadproof.logic.rewrite import leaves_of, map_terms, parameters_of, vehicles_of
from roadproof.logic.show import text
from roadproof.logic.terms import Term
from roadproof.runtime.records import dataclass
from roadproof.world.signals import LIMITED
from roadproof.world.units import UNITS
from roadproof.world.vehicle import Vehicle

MOTION = "motion"
_HEAD = re.compile(r"\s*(?:assuming\s+(?P<motion>motion\b[^:]*)|at\s+(?P<values>\w+\s*=[^:]*)):", re.ASCII)
_VALUE = re.compile(r"\s*\w+\s*=(?!=)", re.ASCII)
_ASSUMING = re.compile(r"\s*assuming\s+(?=\w|:)", re.ASCII)
_COMPARISON = re.compile(r"[<>=]")
_START = Position(1, 1)
MOST_AXIOMS = 500

SCHEMAS: Mapping[str, tuple[str, ...]] = {
    "at-most": ("left", "right"),
    "below": ("left", "right"),
    "meets": ("left", "right"),
    "leaves": ("inside",),
    "within": ("left", "right", "speed", "time"),
    "after": ("left", "right", "speed", "time"),
    "within-twice": ("left", "right", "speed", "growth", "time"),
    "after-twice": ("left", "right", "speed", "growth", "time"),
}
"""The schemas of motion by what makes them, and what of: terms, but for ``inside``, a formula."""
INDUCTIONS: Mapping[str, tuple[str, ...]] = {"steps": ("inside", "low", "high"), "lasts": ("inside", "time")}
"""Schemas that are true on every trace, be it a motion or not."""
ALL_SCHEMAS: Mapping[str, tuple[str, ...]] = {**SCHEMAS, **INDUCTIONS}


@dataclass(frozen=True)
class Axiom:
    """An instance of a schema: the texts of its arguments, in the order of ``ALL_SCHEMAS``."""

    schema: str
    arguments: tuple[str, ...]

    def named(self) -> dict[str, str]:
        """The arguments by name."""
        return dict(zip(ALL_SCHEMAS[self.schema], self.arguments, strict=True))

    @property
    def is_induction(self) -> bool:
        """Whether it is true on every trace."""
        return self.schema in INDUCTIONS

    def __str__(self) -> str:
        return f"{self.schema}({', '.join(self.arguments)})"


@dataclass(frozen=True)
class Assumption:
    """``said``: nothing, or motion and then limits and then values of parameters, as words; or values alone.

    ``axioms``: the facts about motion that a proof has as premises. ``unused``: limits that are said and that
    it does not have as premises; every other limit is one.
    """

    said: tuple[str, ...] = ()
    axioms: tuple[Axiom, ...] = ()
    unused: tuple[str, ...] = ()

    @property
    def limits(self) -> tuple[str, ...]:
        """The limits that are premises, in the order in which they are said."""
        return tuple(x for x in limits_said(self.said) if x not in self.unused)

    @property
    def facts(self) -> tuple[Axiom, ...]:
        """The facts about motion among the axioms."""
        return tuple(x for x in self.axioms if not x.is_induction)

    @property
    def inductions(self) -> tuple[Axiom, ...]:
        """The inductions over time among the axioms."""
        return tuple(x for x in self.axioms if x.is_induction)

    @property
    def premises(self) -> tuple[str, ...]:
        """All premises as words: limits, then facts such as ``below(s(SV), s(POV))``, then inductions."""
        return (*self.limits, *map(str, (*self.facts, *self.inductions)))


@dataclass(frozen=True)
class AssumedClaim:
    """A claim, and what it says that it assumes."""

    query: Query
    said: tuple[str, ...] = ()


NOTHING = Assumption()


# --- words ---------------------------------------------------------------------------------------


def statement(said: Sequence[str], claim: str) -> str:
    """A claim with what it assumes in front, which ``split`` takes apart."""
    head = "assuming" if is_moving(said) else "at"
    return f"{head} {', '.join(said)}: {claim}" if said else claim


def is_moving(said: Sequence[str]) -> bool:
    """Whether motion is assumed, so that only a drive refutes."""
    return MOTION in said[:1]


def limits_said(said: Sequence[str]) -> tuple[str, ...]:
    """The limits in what is assumed: neither motion nor values of parameters."""
    return tuple(x for x in said[is_moving(said) :] if not _VALUE.match(x))


def split(written: str, source: str = "claim") -> tuple[tuple[str, ...], str]:
    """What a claim says that it assumes, and the rest; its places in lines and columns stay.

    Raises ``TextError`` for a word that nothing is assumed by.
    """
    found = _HEAD.match(written)
    if found is None:
        if begun := _ASSUMING.match(written):
            raise _unknown_word(written, begun.end(), "cannot be assumed", source)
        return (), written
    kind = found.lastgroup or ""  # motion or values
    said = str(found[kind])
    begin = place = found.start(kind)
    for limit in said.split(","):
        if place > begin and _COMPARISON.search(limit) is None:
            raise _unknown_word(written, place + len(limit) - len(limit.lstrip()), "is no limit", source)
        place += len(limit) + 1
    blank = "".join(c if c == "\n" else " " for c in found[0])
    return tuple(" ".join(x.split()) for x in said.split(",")), blank + written[found.end() :]


def _unknown_word(written: str, place: int, what: str, source: str) -> TextError:
    """What is said of a word that stands where something known is assumed."""
    before, word = written[:place], re.match(r"\w*", written[place:])
    position = Position(before.count("\n") + 1, place - before.rfind("\n"))
    told = f"'{word[0]}' {what}" if word and word[0] else "nothing is assumed here"
    hint = f"Known: {MOTION}, and after it limits with commas, such as {MOTION}, a_lon(SV) <= 3 m/s^2: CLAIM."
    return TextError(told, position, hint).locate(source, written)


def read_under(specification: Specification, written: str) -> AssumedClaim:
    """A claim with what it says that it assumes. Raises ``InputError``."""
    said, claim = split(written)
    return under(specification, read_claim(specification, claim), said)


def under(specification: Specification, query: Query, said: Sequence[str]) -> AssumedClaim:
    """A claim under what is assumed, each limit and value written alike whoever wrote it.

    Values of parameters that the claim does not speak of are left out. Raises ``InputError``.
    """
    limits = (x.text for x in _limits(specification, query, said))
    values = values_said(specification, said)
    if values:
        spoken = {*parameters_of(query.formula)}
        values = {name: x for name, x in values.items() if name in spoken}
    told = dict.fromkeys([*said[: is_moving(said)], *limits])
    return AssumedClaim(query, (*told, *value_texts(specification, values)))


def at_values(
    specification: Specification, claim: AssumedClaim, values: Mapping[str, Fraction]
) -> AssumedClaim:
    """``claim`` at ``values`` (SI) as well, of which it may say others itself. Raises ``InputError``."""
    all_values = {**values, **values_said(specification, claim.said)}
    return under(specification, claim.query, (*claim.said, *value_texts(specification, all_values)))


def values_said(specification: Specification, said: Sequence[str]) -> dict[str, Fraction]:
    """The values of parameters in what is assumed, by name, in SI units. Raises ``InputError``."""
    values: dict[str, Fraction] = {}
    for written in said:
        if not _VALUE.match(written):
            continue
        with located(written):
            read = elaborate(specification, syntax.Claim((), parsed(written)))
        found = pins(f.negation(read.formula))
        if [_plain(read.formula)] != [_plain(x.formula) for x in _equalities(specification, found)]:
            raise InputError(
                f"'{written[:80]}' is no value of a parameter: write a name, = and a number, such as "
                "minDanger = 0.6 s"
            )
        [(name, value)] = found.items()
        if values.setdefault(name, value) != value:
            raise InputError(f"{name} cannot have two values: {', '.join(said)[:200]}")
    if values:
        values_with(specification.library, values)
    return dict(sorted(values.items()))


def value_texts(specification: Specification, values: Mapping[str, Fraction]) -> tuple[str, ...]:
    """Values of parameters (SI) as ``values_said`` reads them: ``minDanger = 0.6 s``, by name."""
    return tuple(x.text for x in _equalities(specification, values))


def _plain(formula: Formula) -> Formula:
    """The formula with its value for each term of numbers only, such as ``1/3*1 s``."""

    def value_of(term: Term) -> Term:
        value = t.constant_value(term)
        return term if value is None else t.number(value)

    return map_terms(formula, value_of)


def _equalities(specification: Specification, values: Mapping[str, Fraction]) -> list[Query]:
    """``NAME = VALUE`` for each parameter, by name."""
    known = specification.library.parameters
    return [
        elaborate(specification, syntax.Claim((), syntax.Binary("=", syntax.Name(name), number)))
        for name, value in sorted(values.items())
        for number in [term_as_syntax(t.number(value, UNITS[known[name].unit][1]))]
    ]


def limits_of(query: Query, name: str, model: Vehicle) -> Iterator[str]:
    """What a model says of the signals of a vehicle that a claim speaks of, and of their rates."""
    found = {x for x in leaves_of(query.formula) if isinstance(x, t.Signal)}
    spoken = {x.name for x in found if x.vehicle == name}
    while more := {motion.RATES[x] for x in spoken if x in motion.RATES} - spoken:
        spoken |= more
    for signal in (x for x in LIMITED if x in spoken):
        low, high = getattr(model, signal)
        dimension = t.SIGNAL_DIMENSIONS[signal]
        for said in (
            f.Compare(t.Signal(signal, name), ">=", t.Number(low, dimension)),
            f.Compare(t.Signal(signal, name), "<=", t.Number(high, dimension)),
        ):
            yield text(as_syntax(said))


def under_limits(specification: Specification, query: Query, said: Sequence[str]) -> Query:
    """The claim under the limits and values that it assumes: what a drive refutes, which is a motion anyway.

    Raises ``InputError`` for what nobody may assume.
    """
    limits = [always(x) for x in _limits(specification, query, said)]
    premises = [*limits, *_equalities(specification, values_said(specification, said))]
    return implication(both(*premises), query) if premises else query


def _limits(specification: Specification, query: Query, said: Sequence[str]) -> list[Query]:
    others = [x for x in said if not _VALUE.match(x)]
    if not others:
        return []
    if others[0] != MOTION or said[0] != MOTION:
        raise InputError(
            f"assume={said[0][:40]!r}: only motion can be assumed, with limits after it, and values of "
            "parameters"
        )
    return [_limit(specification, query, x) for x in others[1:]]


def _limit(specification: Specification, query: Query, written: str) -> Query:
    """A signal of a vehicle of the claim compared with a number."""
    read = _elaborated(specification, query, written)
    made = read.formula
    if not (
        isinstance(made, f.Compare)
        and isinstance(made.left, t.Signal)
        and t.constant_value(made.right) is not None
    ):
        raise InputError(
            f"'{written[:80]}' is no limit: compare a signal with a number, such as a_lon(SV) <= 3 m/s^2"
        )
    return Query(read.claim, made, read.vehicles, read.lanes)


# --- axioms --------------------------------------------------------------------------------------


def assumption(specification: Specification, query: Query, assumed: Assumption) -> Formula:
    """All that ``query`` is proved under, made anew from words. Raises ``InputError`` where it is not true
    of every motion within the limits that are said, or speaks of what the claim does not."""
    if under(specification, query, assumed.said).said != assumed.said:
        raise InputError(f"what is assumed is written otherwise than it is read: {', '.join(assumed.said)}")
    if assumed.facts and not is_moving(assumed.said):
        raise InputError("facts about motion are used, but the claim does not say that it assumes motion")
    if len(assumed.axioms) > MOST_AXIOMS:
        raise InputError(f"{len(assumed.axioms)} facts about motion; at most {MOST_AXIOMS} are read")
    if tuple(x for x in limits_said(assumed.said) if x in assumed.unused) != assumed.unused:
        raise InputError(f"unused={', '.join(assumed.unused)[:200]}: the claim does not say these limits")
    axioms = (axiom_formula(specification, query, x) for x in assumed.axioms)
    return f.conjunction(*limit_formulas(specification, query, assumed).values(), *axioms)


def limit_formulas(specification: Specification, query: Query, assumed: Assumption) -> dict[str, Formula]:
    """What the limits that are premises say at all times, by their texts. Raises ``InputError``."""
    made = zip(limits_said(assumed.said), _limits(specification, query, assumed.said), strict=True)
    return {x: motion.limit(y.formula) for x, y in made if x not in assumed.unused}


def axiom_formula(specification: Specification, query: Query, axiom: Axiom) -> Formula:
    """What an instance of a schema says. Raises ``InputError`` where it is none, and says why."""
    if axiom.schema not in ALL_SCHEMAS:
        raise InputError(unknown("schema of motion", axiom.schema[:40], ALL_SCHEMAS))
    names = ALL_SCHEMAS[axiom.schema]
    if len(names) != len(axiom.arguments):
        raise InputError(f"schema {axiom.schema} takes {', '.join(names)}")
    maker = axiom.schema.replace("-", "_")
    make: Callable[..., Formula] = getattr(motion, maker)
    try:
        return make(*axiom_arguments(specification, query, axiom))
    except ValueError as error:
        said = ", ".join(f"{name}={x[:60]}" for name, x in axiom.named().items())
        raise InputError(f"schema {axiom.schema} does not take {said}: {error}") from None


def axiom_arguments(specification: Specification, query: Query, axiom: Axiom) -> tuple[Formula | Term, ...]:
    """What an instance of a schema is made of. Raises ``InputError``, ``ValueError``."""
    if ALL_SCHEMAS[axiom.schema][0] == "inside":
        inside = _elaborated(specification, query, axiom.arguments[0]).formula
        return (inside, *(_time(specification, query, x) for x in axiom.arguments[1:]))
    left, right, *rates = (_term(specification, query, x) for x in axiom.arguments)
    _alike(left, right.dimension)
    if not rates:
        return (left.term, right.term)
    time = _time(specification, query, axiom.arguments[-1])
    metres, seconds = left.dimension or right.dimension or (0, 0)
    for order, rate in enumerate(rates[:-1], 1):
        _alike(rate, (metres, seconds - order))
    return (left.term, right.term, *(x.term for x in rates[:-1]), time)


def _time(specification: Specification, query: Query, written: str) -> Term:
    """A term as a bound of an interval. Raises ``InputError``, ``ValueError``."""
    bound = arithmetic.bound(_term(specification, query, written), specification.library.parameters, _START)
    arithmetic.interval(bound, None, _START)
    return bound


def _alike(one: Quantity, dimension: t.Dimension | None) -> None:
    if None not in (one.dimension, dimension) and one.dimension != dimension:
        raise ValueError("its units do not fit")


def _elaborated(specification: Specification, query: Query, written: str) -> Query:
    """A formula about what ``query`` speaks of. Raises ``InputError``."""
    body = parsed(written)
    with located(written):
        made = elaborate(specification, syntax.Claim(query.claim.given, body))
    _refuse({*vehicles_of(made.formula)} - {*query.vehicles} or {*made.lanes} - {*query.lanes}, written)
    return Query(syntax.Claim((), body), made.formula, made.vehicles, made.lanes)


def _term(specification: Specification, query: Query, written: str) -> Quantity:
    """A term about what ``query`` speaks of. Raises ``InputError``."""
    walk = Elaborator(specification)
    with located(written):
        made = walk.term(parsed(written), walk.given(query.claim))
    moving = {x.vehicle for x in t.leaves(made.term) if isinstance(x, t.Signal | t.Size | t.Own)}
    _refuse(moving - {*query.vehicles, ""}, written)
    return made


def _refuse(strangers: set[str], written: str) -> None:
    if strangers:
        raise InputError(f"'{written[:80]}' speaks of {min(strangers)}, but the claim does not")
