"""Formulas and terms as the constructors of proofs/kernel/Meaning.v. Trusted with ``--kernel extracted``.

The text is that of ``proofs/kernel/ocaml/reader.ml``; Coq reads terms in this form, too. A definition with
its arguments is written once, under a name such as "danger(SV, POV)".
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import reduce
from typing import assert_never

from roadproof.errors import InputError
from roadproof.extensions.kernel.names import comment, literal, q, quoted, zone
from roadproof.extensions.kernel.world import WORDS_OF_SIGNALS
from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.logic.formula import Formula
from roadproof.logic.node import memoised
from roadproof.logic.rewrite import free_roads
from roadproof.logic.terms import Term

_SIZES = {"length": "Length", "width": "Width", "kind": "Kind"}
_COMPARISONS: Mapping[f.Comparison, str] = {"<": "LT", "<=": "LE", ">": "GT", ">=": "GE"}
_OUTSIDE: Mapping[str, int] = {}


def term(x: Term) -> str:
    """Return a term in brackets. Raises ``InputError`` if Meaning.v has no constructor for it."""
    match x:
        case t.Number(value, _):
            return f"(Num {q(value)})"
        case t.Parameter(name, _):
            return f"(Par {literal(name)})"
        case t.Variable(name, _):
            return f"(Var {literal(name)})"
        case t.Signal(name, vehicle):
            return f"(Sig {WORDS_OF_SIGNALS[name]} {literal(vehicle)})"
        case t.Size():
            return f"(Siz {size(x)})"
        case t.CustomSignal():
            return f"(Sig (Own {literal(x.name)}) {quoted(x.vehicle)})"
        case t.Sum(parts):
            return _folded("Add", parts)
        case t.Product(parts):
            return _folded("Mul", parts)
        case t.Power(base, exponent) if exponent >= 0:
            return f"(Pow {term(base)} {exponent})"
        case t.Power(_, exponent):
            raise InputError(f"exponent={exponent}: a power has a whole exponent that is not negative")
        case t.Quotient(above, below):
            return f"(Div {term(above)} {term(below)})"
        case t.Maximum(parts):
            return _folded("Max", parts)
        case t.Minimum(parts):
            return _folded("Min", parts)
        case t.Inverse():
            raise InputError("an inverse stands only alone on one side of a comparison")
        case _:
            assert_never(x)


def size(x: t.Size) -> str:
    """Return the text of a size: Length "SV"."""
    return f"{_SIZES[x.name]} {literal(x.vehicle)}"


def _folded(word: str, parts: Sequence[Term]) -> str:
    """Return a binary constructor applied from the left: max(max(x, y), z)."""
    if not parts:
        raise InputError(f"{word} of nothing is not written")
    return reduce(lambda one, other: f"({word} {one} {other})", map(term, parts))


@memoised
def _height(formula: Formula) -> int:
    """Return ``height`` of Meaning.v: the number of a quantifier is that of its body."""
    inside = max(map(_height, f.children(formula)), default=0)
    return max(inside, _height(formula.body) + 1) if isinstance(formula, f.Some | f.Every) else inside


@dataclass
class Writer:
    """A writer of formulas; ``definitions``: those that they name, each after those that it uses."""

    definitions: list[str] = field(default_factory=list)
    names: dict[Formula, str] = field(default_factory=dict)
    taken: set[str] = field(default_factory=set)

    def formula(self, formula: Formula, bound: Mapping[str, int] = _OUTSIDE) -> str:
        """Return a formula in brackets; ``bound``: the numbers of enclosing quantifiers, by variable."""
        match formula:
            case f.Truth(value):
                return f"(Truth {str(value).lower()})"
            case f.Compare(left, op, right):
                return f"(Compare {_side(left)} {_COMPARISONS[op]} {_side(right)})"
            case f.Occupies(vehicle, lanelet):
                return f"(Occupies {literal(vehicle)} {_road(lanelet, bound)})"
            case f.Some(variable, domain, body) | f.Every(variable, domain, body):
                number = _height(body)
                word = "Some_" if isinstance(formula, f.Some) else "Every"
                inside = self.formula(body, {**bound, variable: number})
                return f"({word} {number} {_domain(domain, bound)} {inside})"
            case f.Not(body):
                return f"(Not {self.formula(body, bound)})"
            case f.And(parts) | f.Or(parts):
                return self._joined(formula, parts, bound)
            case f.Until(left, interval, right):
                one, other = self.formula(left, bound), self.formula(right, bound)
                return f"(Until {one} {_interval(interval)} {other})"
            case f.Since():
                raise InputError(f.NO_PAST)
            case f.Eventually(interval, body):
                return f"(Eventually {_interval(interval)} {self.formula(body, bound)})"
            case f.Always(interval, body):
                return f"(Always {_interval(interval)} {self.formula(body, bound)})"
            case f.Application(_, _, body):
                return self.formula(body, bound) if free_roads(body) & {*bound} else self._named(formula)
            case _:
                assert_never(formula)

    def _joined(self, formula: f.And | f.Or, parts: Sequence[Formula], bound: Mapping[str, int]) -> str:
        """Return a conjunction or disjunction of two: p and q and r is p and (q and r)."""
        if not parts:
            return f"(Truth {str(isinstance(formula, f.And)).lower()})"
        word = type(formula).__name__
        shown = [self.formula(x, bound) for x in parts]
        return reduce(lambda rest, first: f"({word} {first} {rest})", reversed(shown))

    def _named(self, named: f.Application) -> str:
        """Return the name of a definition with its arguments, and write the definition if it is new."""
        if named.body not in self.names:
            body = self.formula(named.body)
            base = comment(f"{named.name}({', '.join(named.arguments)})")[:100]
            name, count = base, 1
            while name in self.taken:
                count += 1
                name = f"{base} {count}"
            self.taken.add(name)
            self.names[named.body] = quoted(name)
            self.definitions.append(f"({quoted(name)} {body})")
        return self.names[named.body]


def _side(side: Term) -> str:
    return f"(Inv {term(side.term)})" if isinstance(side, t.Inverse) else f"(Fin {term(side)})"


def _road(name: str, bound: Mapping[str, int]) -> str:
    return f"(Bound {bound[name]})" if name in bound else f"(Free {literal(name)})"


def _interval(interval: f.Interval) -> str:
    high = "None" if interval.high is None else f"(Some {term(interval.high)})"
    return f"{term(interval.low)} {high}"


def _domain(domain: f.Domain, bound: Mapping[str, int]) -> str:
    match domain.kind:
        case "lanes":
            return "Lanes"
        case "adjacent":
            return f"(Adjacent {_road(domain.of, bound)})"
        case "lanelets":
            return f"(Lanelets {_road(domain.of, bound)})"
        case "zone":
            return f"(Zone {zone(domain.of)})"
        case _:
            assert_never(domain.kind)
