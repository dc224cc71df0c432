"""Assumptions of claims: motion, limits of vehicles, and values of parameters.

``assuming motion: CLAIM`` claims that CLAIM holds on every trace that is a motion (``logic.motion``).
``assuming motion, a_lon(SV) <= 3 m/s^2: CLAIM`` claims it for every motion within a limit. The prover then
proves ``axioms -> claim``. An axiom is stored as the name of its schema and the texts of its arguments, and
its formula is rebuilt from them whenever it is needed, so nothing else can be assumed.

``at minDanger = 0.6 s: CLAIM`` claims CLAIM for one value of a parameter. Such values may also follow motion
and limits. The prover then proves the claim with the value put in.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from fractions import Fraction
from typing import TYPE_CHECKING

from roadproof.errors import InputError, Position, TextError
from roadproof.library import arithmetic
from roadproof.library.assumption import (
    _VALUE,
    ALL_SCHEMAS,
    MOTION,
    Assumption,
    Axiom,
    assumes_motion,
    limits_in,
)
from roadproof.library.bind import values_with
from roadproof.library.compose import always, both, implication
from roadproof.library.elaborate import elaborate, read_claim
from roadproof.library.elaboration import Elaborator
from roadproof.library.quantity import Quantity
from roadproof.library.specification import Query, Specification, unknown_name
from roadproof.logic import formula as f
from roadproof.logic import motion, syntax
from roadproof.logic import terms as t
from roadproof.logic.formula import Formula
from roadproof.logic.initial_conditions import forced_values
from roadproof.logic.parse import parse_claim
from roadproof.logic.restore import as_syntax, term_as_syntax
from roadproof.logic.rewrite import leaves_of, map_terms, parameters_of, vehicles_of
from roadproof.logic.show import text
from roadproof.logic.terms import Term
from roadproof.runtime.records import dataclass
from roadproof.world.signals import LIMITED
from roadproof.world.units import UNITS

if TYPE_CHECKING:
    from roadproof.world.vehicle import Vehicle

_HEAD = re.compile(r"\s*(?:assuming\s+(?P<motion>motion\b[^:]*)|at\s+(?P<values>\w+\s*=[^:]*)):", re.ASCII)
_ASSUMING = re.compile(r"\s*assuming\s+(?=\w|:)", re.ASCII)
_COMPARISON = re.compile(r"[<>=]")
_START = Position(1, 1)
_SOURCE = "what is assumed"
MOST_AXIOMS = 500


@dataclass(frozen=True)
class AssumedClaim:
    """A claim with the texts of its assumptions."""

    query: Query
    texts: tuple[str, ...] = ()


# --- words ---------------------------------------------------------------------------------------


def split_claim(written: str, source: str = "claim") -> tuple[tuple[str, ...], str]:
    """Split a claim into its assumptions and the rest, in which lines and columns stay the same.

    Raises ``TextError`` for an unknown assumption.
    """
    match = _HEAD.match(written)
    if match is None:
        if assuming := _ASSUMING.match(written):
            raise _unknown_word(written, assuming.end(), "cannot be assumed", source)
        return (), written
    kind = match.lastgroup or ""  # motion or values
    stated = str(match[kind])
    begin = place = match.start(kind)
    for limit in stated.split(","):
        if place > begin and _COMPARISON.search(limit) is None:
            raise _unknown_word(written, place + len(limit) - len(limit.lstrip()), "is no limit", source)
        place += len(limit) + 1
    blank = "".join(c if c == "\n" else " " for c in match[0])
    return tuple(" ".join(x.split()) for x in stated.split(",")), blank + written[match.end() :]


def _unknown_word(written: str, place: int, what: str, source: str) -> TextError:
    """Return the error for an unknown word in the assumptions."""
    before, word = written[:place], re.match(r"\w*", written[place:])
    position = Position(before.count("\n") + 1, place - before.rfind("\n"))
    message = f"'{word[0]}' {what}" if word and word[0] else "nothing is assumed here"
    hint = f"Known: {MOTION}, and after it limits with commas, such as {MOTION}, a_lon(SV) <= 3 m/s^2: CLAIM."
    return TextError(message, position, hint).locate(source, written)


def read_assumed_claim(specification: Specification, written: str) -> AssumedClaim:
    """Parse and elaborate a claim with its assumptions. Raises ``InputError``."""
    assumptions, claim = split_claim(written)
    return with_assumptions(specification, read_claim(specification, claim), assumptions)


def with_assumptions(specification: Specification, query: Query, assumptions: Sequence[str]) -> AssumedClaim:
    """Return a claim with its assumptions in a normal form, whoever wrote them.

    Values of parameters that the claim does not use are dropped. Raises ``InputError``.
    """
    limits = (x.text for x in _limits(specification, query, assumptions))
    values = values_in(specification, assumptions)
    if values:
        used = {*parameters_of(query.formula)}
        values = {name: x for name, x in values.items() if name in used}
    texts = dict.fromkeys([*assumptions[: assumes_motion(assumptions)], *limits])
    return AssumedClaim(query, (*texts, *value_texts(specification, values)))


def at_values(
    specification: Specification, claim: AssumedClaim, values: Mapping[str, Fraction]
) -> AssumedClaim:
    """Return ``claim`` with values (SI) of parameters that it has no value of. Raises ``InputError``."""
    all_values = {**values, **values_in(specification, claim.texts)}
    texts = (*claim.texts, *value_texts(specification, all_values))
    return with_assumptions(specification, claim.query, texts)


def values_in(specification: Specification, assumptions: Sequence[str]) -> dict[str, Fraction]:
    """Return the values of parameters among assumptions, by name, in SI units. Raises ``InputError``."""
    values: dict[str, Fraction] = {}
    for written in assumptions:
        if not _VALUE.match(written):
            continue
        with _errors_located_in(written):
            equation = elaborate(specification, syntax.Claim((), _parse_assumption(written)))
        forced = forced_values(f.negation(equation.formula))
        equations = (x.formula for x in _equalities(specification, forced))
        if [_fold_constants(equation.formula)] != [*map(_fold_constants, equations)]:
            raise InputError(
                f"'{written[:80]}' is no value of a parameter: write a name, = and a number, such as "
                "minDanger = 0.6 s"
            )
        [(name, value)] = forced.items()
        if values.setdefault(name, value) != value:
            raise InputError(f"{name} cannot have two values: {', '.join(assumptions)[:200]}")
    if values:
        values_with(specification.library, values)
    return dict(sorted(values.items()))


def value_texts(specification: Specification, values: Mapping[str, Fraction]) -> tuple[str, ...]:
    """Return values of parameters (SI) as texts for ``values_in``: ``minDanger = 0.6 s``, by name."""
    return tuple(x.text for x in _equalities(specification, values))


def _fold_constants(formula: Formula) -> Formula:
    """Return the formula with each term of numbers, such as ``1/3*1 s``, replaced by its value."""

    def value_of(term: Term) -> Term:
        value = t.constant_value(term)
        return term if value is None else t.number(value)

    return map_terms(formula, value_of)


def _equalities(specification: Specification, values: Mapping[str, Fraction]) -> list[Query]:
    """Return the query ``NAME = VALUE`` for each parameter, by name."""
    known = specification.library.parameters
    return [
        elaborate(specification, syntax.Claim((), syntax.Binary("=", syntax.Name(name), number)))
        for name, value in sorted(values.items())
        for number in [term_as_syntax(t.number(value, UNITS[known[name].unit][1]))]
    ]


def limits_of(query: Query, name: str, model: Vehicle) -> Iterator[str]:
    """Yield the limits of a vehicle model for the signals of a vehicle in a claim, and for their rates."""
    signals = {x for x in leaves_of(query.formula) if isinstance(x, t.Signal)}
    used = {x.name for x in signals if x.vehicle == name}
    while rates := {motion.RATES[x] for x in used if x in motion.RATES} - used:
        used |= rates
    for signal in (x for x in LIMITED if x in used):
        low, high = getattr(model, signal)
        dimension = t.SIGNAL_DIMENSIONS[signal]
        for limit in (
            f.Compare(t.Signal(signal, name), ">=", t.Number(low, dimension)),
            f.Compare(t.Signal(signal, name), "<=", t.Number(high, dimension)),
        ):
            yield text(as_syntax(limit))


def under_limits(specification: Specification, query: Query, assumptions: Sequence[str]) -> Query:
    """Return "limits and values imply the claim"; a drive refutes it, as every drive is a motion.

    Raises ``InputError`` for other assumptions.
    """
    limits = [always(x) for x in _limits(specification, query, assumptions)]
    premises = [*limits, *_equalities(specification, values_in(specification, assumptions))]
    return implication(both(*premises), query) if premises else query


def _limits(specification: Specification, query: Query, assumptions: Sequence[str]) -> list[Query]:
    """Return the limits among assumptions as queries. Raises ``InputError`` unless motion comes first."""
    others = [x for x in assumptions if not _VALUE.match(x)]
    if not others:
        return []
    if others[0] != MOTION or assumptions[0] != MOTION:
        raise InputError(
            f"assume={assumptions[0][:40]!r}: only motion can be assumed, with limits after it, and values "
            "of parameters"
        )
    return [_limit(specification, query, x) for x in others[1:]]


def _limit(specification: Specification, query: Query, written: str) -> Query:
    """Return a limit: a signal of a vehicle of the claim, compared with a number. Raises ``InputError``."""
    limit = _elaborated(specification, query, written)
    formula = limit.formula
    if not (
        isinstance(formula, f.Compare)
        and isinstance(formula.left, t.Signal)
        and t.constant_value(formula.right) is not None
    ):
        raise InputError(
            f"'{written[:80]}' is no limit: compare a signal with a number, such as a_lon(SV) <= 3 m/s^2"
        )
    return Query(limit.claim, formula, limit.vehicles, limit.lanes)


# --- axioms --------------------------------------------------------------------------------------


def assumption(specification: Specification, query: Query, assumed: Assumption) -> Formula:
    """Return the conjunction of all premises of a proof of ``query``, rebuilt from their texts.

    Raises ``InputError`` if a premise is not true of every motion within the stated limits, or uses names
    that the claim does not have.
    """
    if with_assumptions(specification, query, assumed.texts).texts != assumed.texts:
        raise InputError(f"what is assumed is written otherwise than it is read: {', '.join(assumed.texts)}")
    if assumed.facts and not assumes_motion(assumed.texts):
        raise InputError("facts about motion are used, but the claim does not say that it assumes motion")
    if len(assumed.axioms) > MOST_AXIOMS:
        raise InputError(f"{len(assumed.axioms)} facts about motion; at most {MOST_AXIOMS} are read")
    if tuple(x for x in limits_in(assumed.texts) if x in assumed.unused) != assumed.unused:
        raise InputError(f"unused={', '.join(assumed.unused)[:200]}: the claim does not say these limits")
    axioms = (axiom_formula(specification, query, x) for x in assumed.axioms)
    return f.conjunction(*limit_formulas(specification, query, assumed).values(), *axioms)


def limit_formulas(specification: Specification, query: Query, assumed: Assumption) -> dict[str, Formula]:
    """Return the limits that are premises, as formulas for all times, by text. Raises ``InputError``."""
    pairs = zip(limits_in(assumed.texts), _limits(specification, query, assumed.texts), strict=True)
    return {x: motion.limit(y.formula) for x, y in pairs if x not in assumed.unused}


def axiom_formula(specification: Specification, query: Query, axiom: Axiom) -> Formula:
    """Return the formula of an instance of a schema. Raises ``InputError`` with the reason if it is none."""
    if axiom.schema not in ALL_SCHEMAS:
        raise InputError(unknown_name("schema of motion", axiom.schema[:40], ALL_SCHEMAS))
    names = ALL_SCHEMAS[axiom.schema]
    if len(names) != len(axiom.arguments):
        raise InputError(f"schema {axiom.schema} takes {', '.join(names)}")
    maker = axiom.schema.replace("-", "_")
    make: Callable[..., Formula] = getattr(motion, maker)
    try:
        return make(*axiom_arguments(specification, query, axiom))
    except ValueError as error:
        listing = ", ".join(f"{name}={x[:60]}" for name, x in axiom.named().items())
        raise InputError(f"schema {axiom.schema} does not take {listing}: {error}") from None


def axiom_arguments(specification: Specification, query: Query, axiom: Axiom) -> tuple[Formula | Term, ...]:
    """Return the arguments of an instance of a schema. Raises ``InputError``, ``ValueError``."""
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
    """Return a term as a bound of an interval. Raises ``InputError``, ``ValueError``."""
    bound = arithmetic.bound(_term(specification, query, written), specification.library.parameters, _START)
    arithmetic.interval(bound, None, _START)
    return bound


def _alike(one: Quantity, dimension: t.Dimension | None) -> None:
    if None not in (one.dimension, dimension) and one.dimension != dimension:
        raise ValueError("its units do not fit")


def _elaborated(specification: Specification, query: Query, written: str) -> Query:
    """Elaborate a formula that uses names of ``query`` only. Raises ``InputError``."""
    body = _parse_assumption(written)
    with _errors_located_in(written):
        result = elaborate(specification, syntax.Claim(query.claim.given, body))
    _refuse({*vehicles_of(result.formula)} - {*query.vehicles} or {*result.lanes} - {*query.lanes}, written)
    return Query(syntax.Claim((), body), result.formula, result.vehicles, result.lanes)


def _term(specification: Specification, query: Query, written: str) -> Quantity:
    """Elaborate a term that uses names of ``query`` only. Raises ``InputError``."""
    walk = Elaborator(specification)
    with _errors_located_in(written):
        quantity = walk.term(_parse_assumption(written), walk.claim_scope(query.claim))
    moving = {x.vehicle for x in t.leaves(quantity.term) if isinstance(x, t.Signal | t.Size | t.CustomSignal)}
    _refuse(moving - {*query.vehicles, ""}, written)
    return quantity


def _refuse(strangers: set[str], written: str) -> None:
    if strangers:
        raise InputError(f"'{written[:80]}' speaks of {min(strangers)}, but the claim does not")


@contextmanager
def _errors_located_in(written: str) -> Iterator[None]:
    """Locate the errors that are raised inside in ``written``."""
    try:
        yield
    except TextError as error:
        raise error.locate(_SOURCE, written) from None


def _parse_assumption(written: str) -> syntax.Expression:
    """Parse an assumption, which uses the names of its claim. Raises ``TextError``, ``InputError``."""
    claim = parse_claim(written, _SOURCE)
    if claim.given:
        raise InputError(f"'{written[:80]}' may declare nothing: it is read with the names of the claim")
    return claim.body
