"""The printer of formulas for Coq, in the notations of proofs/kernel/Text.v. Trusted: it states the theorem.

Definitions stay functions of their vehicles and lanes, as in the specification. A printed function is applied
only if its body, with the arguments replaced, is what the claim means at that place.
"""

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from itertools import groupby
from typing import assert_never

from roadproof.errors import InputError
from roadproof.evidence.atoms import up_to_variables
from roadproof.extensions.kernel.names import Names, literal, zone
from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.logic.formula import Formula
from roadproof.logic.rewrite import free_roads, rename, rename_vehicles, vehicles_of
from roadproof.logic.terms import Term

# Words of Text.v, which are those of the language; a new signal has none there.
_SIGNAL_WORDS = frozenset(re.findall(r"\w+", "s d v_lon v_lat a_lon a_lat j_lon length width kind"))

# What a definition calls its arguments, with their sorts; only names depend on it.
Formals = Mapping[str, Sequence[tuple[str, str]]]


# Between a word and what it is said of: a blank at which no line is broken.
FIXED_SPACE = "\u00a0"
# How tightly terms bind.
_ATOM, _PRODUCT, _SUM, _LOOSE = 3, 2, 1, 0


@dataclass(frozen=True)
class Scope:
    """The Coq names of vehicles and lanes inside a definition or quantifier; others are the claim's."""

    vehicles: Mapping[str, str] = field(default_factory=dict)
    roads: Mapping[str, str] = field(default_factory=dict)

    @property
    def words(self) -> set[str]:
        """The Coq names in the scope."""
        return {*self.vehicles.values(), *self.roads.values()}


_OUTSIDE = Scope()


@dataclass(frozen=True)
class _Function:
    """A printed definition: its arguments, True for each vehicle, and its body over ``arguments``.

    ``is_closed``: the body mentions only the arguments, so it means the same at every application.
    """

    word: str
    arguments: tuple[str, ...]
    are_vehicles: tuple[bool, ...]
    body: Formula
    is_closed: bool


@dataclass
class Printer:
    """A printer; ``things`` and ``definitions``: what printed formulas use, in order, as Coq."""

    formals: Formals = field(default_factory=dict)
    names: Names = field(default_factory=Names)
    things: list[str] = field(default_factory=list)
    definitions: list[str] = field(default_factory=list)
    functions: dict[str, list[_Function]] = field(default_factory=dict)
    applied: dict[tuple[f.Application, bool], tuple[_Function, tuple[str, ...]] | None] = field(
        default_factory=dict
    )

    # --- terms -------------------------------------------------------------------------------------

    def term(self, term: Term, scope: Scope = _OUTSIDE) -> str:
        """Return a term as text of Coq. Raises ``InputError`` if Text.v has no notation for it."""
        match term:
            case t.Number(value, _):
                return number(value)
            case t.Parameter(name, _):
                return self._thing("parameter", name, "term", "Par")
            case t.Variable(name, _):
                return self._thing("variable", name, "term", "Var")
            case t.Signal(name, vehicle) | t.Size(name, vehicle):
                if name not in _SIGNAL_WORDS:
                    raise InputError(f"{name}({vehicle}): proofs/kernel/Text.v has no word for it")
                return f"{name}{FIXED_SPACE}{self.vehicle(vehicle, scope)}"
            case t.CustomSignal():
                return self._custom_signal(term, scope)
            case t.Sum(terms):
                return self._sum(terms, scope)
            case t.Product((t.Number(value=minus), other)) if minus == -1 and not isinstance(other, t.Number):
                return f"-{FIXED_SPACE}{self._operand(other, scope, _ATOM)}"
            case t.Product(factors):
                if not factors:
                    raise InputError("a product of nothing is not printed")
                first, *others = factors
                shown = [self._operand(first, scope, _PRODUCT if others else _SUM)]
                return " * ".join([*shown, *(self._operand(x, scope, _ATOM) for x in others)])
            case t.Power(base, exponent):
                if exponent < 0:
                    raise InputError(
                        f"exponent={exponent}: a power has a whole exponent that is not negative"
                    )
                return f"{self._operand(base, scope, _ATOM)}^{exponent}"
            case t.Quotient(numerator, denominator):
                below = self._operand(denominator, scope, _ATOM)
                return f"{self._operand(numerator, scope, _PRODUCT)} / {below}"
            case t.Maximum(terms):
                return self._extremum("max", terms, scope)
            case t.Minimum(terms):
                return self._extremum("min", terms, scope)
            case t.Inverse():
                raise InputError("an inverse stands only alone on one side of a comparison")
            case _:
                assert_never(term)

    def _operand(self, term: Term, scope: Scope, least: int) -> str:
        """Return a term, in brackets if it binds less tightly than ``least``."""
        shown = self.term(term, scope)
        return shown if _binding(term) >= least else f"({shown})"

    def _sum(self, terms: Sequence[Term], scope: Scope) -> str:
        """Return a sum; Coq reads x + y - z as (x + y) + (-1) * z, too."""
        if not terms:
            raise InputError("a sum of nothing is not printed")
        first, *others = terms
        shown = self._operand(first, scope, _SUM)
        for other in others:
            match other:
                case t.Product((t.Number(value=minus), less)) if minus == -1 and not isinstance(
                    less, t.Number
                ):
                    shown += f" - {self._operand(less, scope, _PRODUCT)}"
                case _:  # open: any other summand
                    shown += f" + {self._operand(other, scope, _PRODUCT)}"
        return shown

    def _extremum(self, word: str, terms: Sequence[Term], scope: Scope) -> str:
        """Return nested binary extrema: max(max(x, y), z)."""
        if not terms:
            raise InputError(f"the {word} of nothing is not printed")
        shown = self.term(terms[0], scope)
        for other in terms[1:]:
            shown = f"{word}({shown}, {self.term(other, scope)})"
        return shown

    def _side(self, term: Term, scope: Scope) -> str:
        if isinstance(term, t.Inverse):
            return f"inverse({self.term(term.term, scope)})"
        return self._operand(term, scope, _SUM)

    # --- names -------------------------------------------------------------------------------------

    def vehicle(self, name: str, scope: Scope = _OUTSIDE) -> str:
        """Return the Coq name of a vehicle."""
        return scope.vehicles.get(name) or self._thing("vehicle", name, "vehicle", "")

    def road(self, name: str, scope: Scope = _OUTSIDE) -> str:
        """Return the Coq name of a lane or lanelet."""
        return scope.roads.get(name) or self._thing("lane", name, "road", "Free")

    def _thing(self, kind: str, name: str, sort: str, maker: str, end: str = "") -> str:
        """Return the name of a thing of the claim; its first use adds a definition."""
        known = (kind, name) in self.names.given
        word = self.names.of(kind, name) if sort.endswith("term") else self.names.thing(kind, name)
        if not known:
            made = f"{maker}{' ' * bool(maker)}{literal(name)}{end}"
            self.things.append(f"Definition {word} : {sort} := {made}.")
        return word

    def _custom_signal(self, signal: t.CustomSignal, scope: Scope) -> str:
        """Return a custom signal; one without a vehicle belongs to the vehicle ''."""
        if not signal.vehicle:
            return self._thing("signal of none", signal.name, "term", "Sig (Own", ') ""')
        word = self._thing("signal", signal.name, "vehicle -> term", "Sig (Own", ")")
        return f"{word}{FIXED_SPACE}{self.vehicle(signal.vehicle, scope)}"

    # --- formulas ----------------------------------------------------------------------------------

    def formula(self, formula: Formula, scope: Scope = _OUTSIDE) -> str:
        """Return a formula as text of Coq. Raises ``InputError`` if it cannot be printed."""
        match formula:
            case f.Truth(value):
                return f"Truth{FIXED_SPACE}{str(value).lower()}"
            case f.Compare(left, op, right):
                return f"{self._side(left, scope)} {op} {self._side(right, scope)}"
            case f.Occupies(vehicle, lanelet):
                return FIXED_SPACE.join(["occ", self.vehicle(vehicle, scope), self.road(lanelet, scope)])
            case f.Some(variable, domain, body) | f.Every(variable, domain, body):
                word = "some" if isinstance(formula, f.Some) else "every"
                where = self._domain(domain, scope)
                name = self.names.local(variable, scope.words)
                inside = Scope(scope.vehicles, {**scope.roads, variable: name})
                return f"{word} {name} in {where}, {self._part(body, inside)}"
            case f.Not(body):
                return f"not {self._part(body, scope)}"
            case f.And(parts):
                return self._joined("and", parts, scope)
            case f.Or((f.Not(premise), conclusion)):
                return f"{self._part(premise, scope)} -> {self._part(conclusion, scope)}"
            case f.Or(parts):
                return self._joined("or", parts, scope)
            case f.Until(left, interval, right):
                until = f"U{self._interval(interval, scope)}"
                return f"{self._part(left, scope)} {until} {self._part(right, scope)}"
            case f.Since():
                raise InputError(f.NO_PAST)
            case f.Eventually(interval, body):
                return f"F{self._interval(interval, scope)} {self._part(body, scope)}"
            case f.Always(interval, body):
                return f"G{self._interval(interval, scope)} {self._part(body, scope)}"
            case f.Application():
                return self._named(formula, scope)
            case _:
                assert_never(formula)

    def _part(self, formula: Formula, scope: Scope) -> str:
        shown = self.formula(formula, scope)
        bare = isinstance(formula, f.Truth | f.Occupies) or (
            isinstance(formula, f.Application) and self._application(formula, scope) is not None
        )
        return shown if bare else f"({shown})"

    def _joined(self, word: str, parts: Sequence[Formula], scope: Scope) -> str:
        """Return a conjunction or disjunction; Coq reads p and q and r as p and (q and r), too."""
        if len(parts) == 1:
            return self.formula(parts[0], scope)
        if not parts:
            return f"Truth{FIXED_SPACE}{'true' if word == 'and' else 'false'}"
        return f" {word} ".join(self._part(x, scope) for x in parts)

    def _interval(self, interval: f.Interval, scope: Scope) -> str:
        if interval.high is None:
            if t.constant_value(interval.low) == 0 and isinstance(interval.low, t.Number):
                return ""
            return f"[{self.term(interval.low, scope)}, inf)"
        return f"[{self.term(interval.low, scope)}, {self.term(interval.high, scope)}]"

    def _domain(self, domain: f.Domain, scope: Scope) -> str:
        match domain.kind:
            case "lanes":
                return "lanes"
            case "adjacent":
                return f"(adjacentLanes {self.road(domain.of, scope)})"
            case "lanelets":
                return f"(lanelets {self.road(domain.of, scope)})"
            case "zone":
                return f"(zone {zone(domain.of)})"
            case _:
                assert_never(domain.kind)

    # --- definitions -------------------------------------------------------------------------------

    def _named(self, named: f.Application, scope: Scope) -> str:
        application = self._application(named, scope)
        if application is None:
            return self.formula(named.body, scope)
        function, actual = application
        words = [
            self.vehicle(name, scope) if is_vehicle else self.road(name, scope)
            for name, is_vehicle in zip(actual, function.are_vehicles, strict=True)
        ]
        return FIXED_SPACE.join([function.word, *words])

    def _application(self, named: f.Application, scope: Scope) -> tuple[_Function, tuple[str, ...]] | None:
        """Return the function whose application means ``named``, printed now if it is new.

        None if the body mentions a bound variable that is no argument; then the body is printed in place.
        """
        bound = bool(scope.roads or scope.vehicles)
        if (named, bound) not in self.applied:
            self.applied[named, bound] = self._known(named, bound) or self._new(named, bound)
        return self.applied[named, bound]

    def _known(self, named: f.Application, bound: bool) -> tuple[_Function, tuple[str, ...]] | None:
        meaning = up_to_variables(named.body)
        for function in self.functions.get(named.name, ()):
            actual = _matching_arguments(named, function)
            if bound and not function.is_closed:
                continue
            if actual is not None and up_to_variables(_replaced(function, actual)) == meaning:
                return function, actual
        return None

    def _new(self, named: f.Application, bound: bool) -> tuple[_Function, tuple[str, ...]] | None:
        vehicles, roads = set(vehicles_of(named.body)), free_roads(named.body)
        formals = self.formals.get(named.name.partition("@")[0], ())
        if len(formals) != len(named.arguments):
            formals = tuple((name, "") for name in named.arguments)
        arguments: list[str] = []
        sorts: list[bool] = []
        formal_names: list[str] = []
        for name, (formal, sort) in zip(named.arguments, formals, strict=True):
            is_vehicle = name in vehicles or (name not in roads and sort in ("vehicle", "vehicles"))
            if is_vehicle or name in roads or sort == "lane":
                arguments.append(name)
                sorts.append(is_vehicle)
                formal_names.append(formal)
        if len(set(arguments)) < len(arguments) or vehicles & roads:
            arguments, sorts, formal_names = [], [], []  # what is said of one thing twice is no pattern
        is_closed = vehicles | roads <= set(arguments)
        if bound and not is_closed:
            return None
        local = Scope()
        for name, is_vehicle, formal in zip(arguments, sorts, formal_names, strict=True):
            word = self.names.argument(formal, local.words)
            if is_vehicle:
                local = Scope({**local.vehicles, name: word}, local.roads)
            else:
                local = Scope(local.vehicles, {**local.roads, name: word})
        body = self.formula(named.body, local)
        function = _Function(
            self.names.new(named.name), tuple(arguments), tuple(sorts), named.body, is_closed
        )
        words = [
            (local.vehicles if x else local.roads)[name] for name, x in zip(arguments, sorts, strict=True)
        ]
        head = " ".join([function.word, *_typed(words, sorts)])
        self.definitions.append(f"Definition {head} : formula := {body}.")
        self.functions.setdefault(named.name, []).append(function)
        return function, tuple(arguments)


def number(value: Fraction) -> str:
    """Return a number in Coq: whole, or p # q."""
    return str(value.numerator) if value.denominator == 1 else f"{value.numerator} # {value.denominator}"


def _binding(term: Term) -> int:
    match term:
        case t.Number(value, _):
            return _ATOM if value >= 0 and value.denominator == 1 else _LOOSE
        case t.Sum((one,)) | t.Product((one,)):
            return _binding(one)
        case t.Sum():
            return _SUM
        case t.Product() | t.Quotient() | t.Power():
            return _PRODUCT
        case t.Maximum((one,)) | t.Minimum((one,)):
            return _binding(one)
        case t.Parameter() | t.Variable() | t.Signal() | t.Size() | t.CustomSignal():
            return _ATOM
        case t.Maximum() | t.Minimum() | t.Inverse():
            return _ATOM


def _typed(words: Sequence[str], are_vehicles: Sequence[bool]) -> Iterator[str]:
    """Yield arguments with their sorts; neighbours of one sort share a bracket: (a b : vehicle)."""
    for is_vehicle, group in groupby(zip(words, are_vehicles, strict=True), key=lambda x: x[1]):
        sort = "vehicle" if is_vehicle else "road"
        yield f"({FIXED_SPACE.join([*(word for word, _ in group), ':', sort])})"


def _matching_arguments(named: f.Application, function: _Function) -> tuple[str, ...] | None:
    """Return the arguments of an application that the function takes; None if they do not fit."""
    if len(function.arguments) == len(named.arguments):
        return named.arguments
    return () if not function.arguments else None


def _replaced(function: _Function, actual: Sequence[str]) -> Formula:
    """Return the body of a function with its arguments replaced simultaneously."""
    pairs = list(zip(function.arguments, actual, function.are_vehicles, strict=True))
    body = rename_vehicles(function.body, {old: new for old, new, is_vehicle in pairs if is_vehicle})
    lanes = [(old, new) for old, new, is_vehicle in pairs if not is_vehicle]
    for place, (old, _) in enumerate(lanes):
        body = rename(body, old, f"?{place}")
    for place, (_, new) in enumerate(lanes):
        body = rename(body, f"?{place}", new)
    return body
