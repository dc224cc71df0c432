"""Formulas built with operators; each is a text of the language in the end.

>>> from roadproof.frontends.api.phrases import F, POV, SV, call
>>> print(F(call("danger", SV, POV), within=(0, "3 s")) & ~(SV.v_lon > "30 km/h"))
F[0, 3 s] danger(SV, POV) and not v_lon(SV) > 30 km/h
"""

import inspect
import re
from collections.abc import Callable
from decimal import Decimal
from fractions import Fraction
from numbers import Real
from typing import Any, Literal, TypeAlias

from roadproof.errors import InputError, UsageError
from roadproof.library.bind import Number, exact
from roadproof.library.scenarios import LANE, PAIR, TRIPLE
from roadproof.logic import syntax
from roadproof.logic.show import text
from roadproof.logic.syntax import Binding, Claim, Expression
from roadproof.runtime.records import dataclass
from roadproof.world.signals import SIGNALS, SIZES
from roadproof.world.units import UNITS

_BARE = ""
_WORD = re.compile(r"[A-Za-z_]\w*")
_HELD = "held_place"  # what is quantified over, before it has its name
_NO_TERM = "is no term: give a number, '30 km/h', a name such as SV, or a formula"


def _infix(op: syntax.BinaryOperator, swapped: bool = False) -> "Callable[[Phrase, Term], Phrase]":
    """The method of a binary operator, or of the same with its sides ``swapped``."""
    return lambda own, other: _binary(op, other, own) if swapped else _binary(op, own, other)


@dataclass(frozen=True, eq=False)
class Phrase:
    """A term or a formula of the language.

    ``&`` is and, ``|`` or, ``~`` not, ``>>`` implies; terms have ``+ - * / **``, ``abs`` and
    ``< <= > >= == !=``. Numbers are exact: an int, a float (the decimal that Python shows), a ``Fraction``,
    a ``Decimal``, or a text with a unit such as ``"30 km/h"``. ``given`` are the names in it that have to be
    declared. A vehicle has its signals as attributes: ``SV.v_lon``. There is no truth value: write ``&`` for
    ``and``, and no chains such as ``a < b < c``. Raises ``UsageError``.
    """

    expression: Expression
    given: tuple[Binding, ...] = ()

    def __str__(self) -> str:
        return text(Claim(self.given, self.expression))

    def __repr__(self) -> str:
        return f"<formula {self}>"

    def __hash__(self) -> int:
        return hash(str(self))

    def __bool__(self) -> bool:
        raise UsageError(
            f"{self} has no truth value: write & | ~ for and, or, not, and no chains such as a < b < c"
        )

    def __getattr__(self, name: str) -> "Phrase":
        if name in (*SIGNALS, *SIZES) and isinstance(self.expression, syntax.Name):
            return call(name, self)
        raise AttributeError(f"{name}: a vehicle has {', '.join((*SIGNALS, *SIZES))}")

    def __and__(self, other: "Term") -> "Phrase":
        return _chain("and", self, other)

    def __or__(self, other: "Term") -> "Phrase":
        return _chain("or", self, other)

    def __invert__(self) -> "Phrase":
        return Phrase(syntax.Prefix("not", self.expression), self.given)

    def __neg__(self) -> "Phrase":
        return Phrase(syntax.Prefix("-", self.expression), self.given)

    __rshift__ = _infix("->")
    __lt__ = _infix("<")
    __le__ = _infix("<=")
    __gt__ = _infix(">")
    __ge__ = _infix(">=")
    __eq__ = _infix("=")  # type: ignore[assignment]
    __ne__ = _infix("!=")  # type: ignore[assignment]
    __add__ = _infix("+")
    __radd__ = _infix("+", swapped=True)
    __sub__ = _infix("-")
    __rsub__ = _infix("-", swapped=True)
    __mul__ = _infix("*")
    __rmul__ = _infix("*", swapped=True)
    __truediv__ = _infix("/")
    __rtruediv__ = _infix("/", swapped=True)
    __pow__ = _infix("^")

    def __abs__(self) -> "Phrase":
        return call("abs", self)

    def equivalent_to(self, other: "Term") -> "Phrase":
        """``self <-> other``."""
        return _binary("<->", self, other)


Term: TypeAlias = Phrase | Number | bool


def vehicle(name: str) -> Phrase:
    """A vehicle of that name, declared: ``given A: vehicle``."""
    return Phrase(syntax.Name(name), (Binding(name, "vehicle"),))


def lane(name: str) -> Phrase:
    """A lane of that name, declared: ``given K: lane``."""
    return Phrase(syntax.Name(name), (Binding(name, "lane"),))


def parameter(name: str) -> Phrase:
    """A parameter of the library, such as ``minDanger``."""
    return Phrase(syntax.Name(name))


def call(name: str, *arguments: Term) -> Phrase:
    """An application of a definition, a signal or a function: ``danger(SV, POV)``, ``abs(x)``."""
    parts = [_lift(x) for x in arguments]
    return Phrase(syntax.Call(name, tuple(x.expression for x in parts)), _given(parts))


def F(body: Term, within: tuple[Number, Number | None] | None = None) -> Phrase:
    """Eventually; ``within`` seconds (low, high), the end None for no end."""
    return _temporal("F", None, body, within)


def G(body: Term, within: tuple[Number, Number | None] | None = None) -> Phrase:
    """Always, as ``F``."""
    return _temporal("G", None, body, within)


def U(left: Term, right: Term, within: tuple[Number, Number | None] | None = None) -> Phrase:
    """``left`` until ``right``, as ``F``."""
    return _temporal("U", left, right, within)


def W(left: Term, right: Term, within: tuple[Number, Number | None] | None = None) -> Phrase:
    """``left`` until ``right``, or ``left`` at all times (weak until), as ``F``."""
    return _temporal("W", left, right, within)


def R(left: Term, right: Term, within: tuple[Number, Number | None] | None = None) -> Phrase:
    """``right`` at all times, unless ``left`` held before (release), as ``F``."""
    return _temporal("R", left, right, within)


def O(body: Term, within: tuple[Number, Number | None] | None = None) -> Phrase:  # noqa: E743
    """Once; ``within`` seconds ago (low, high), the end None for the start."""
    return _temporal("O", None, body, within)


def H(body: Term, within: tuple[Number, Number | None] | None = None) -> Phrase:
    """Historically: at all times so far, as ``O``."""
    return _temporal("H", None, body, within)


def S(left: Term, right: Term, within: tuple[Number, Number | None] | None = None) -> Phrase:
    """``left`` since ``right``, as ``O``."""
    return _temporal("S", left, right, within)


_Quantifier: TypeAlias = Literal["some", "every"]
Body: TypeAlias = Phrase | Callable[[Phrase], Phrase]
"""What a quantifier says of its variable: a formula, or a function that makes one."""


def some(domain: "Phrase | str", body: Body, name: "str | Body" = "") -> Phrase:
    """Return ``some K in domain: body(K)``; ``domain`` is ``lanes``, ``lanelets(L)``, ``zone("main")``, …

    K is called ``name``, or as ``body`` calls it, and otherwise where ``body`` speaks of something else by
    that name. In the order of the text, ``some("M", lanes, body)``, ``body`` may also be a formula that
    speaks of M, such as ``call("atLane", SV, lane("M"))``. Raises ``UsageError``.

    >>> print(some(lanes, lambda K: call("laneKeep", SV, K)))
    some K in lanes: laneKeep(SV, K)
    >>> print(some("M", lanes, call("laneKeep", SV, lane("M"))))
    some M in lanes: laneKeep(SV, M)
    """
    return _quantified("some", domain, body, name)


def every(domain: "Phrase | str", body: Body, name: "str | Body" = "") -> Phrase:
    """Return ``every K in domain: body(K)``; the arguments are those of ``some``."""
    return _quantified("every", domain, body, name)


def lanelets(of: Phrase) -> Phrase:
    """The lanelets of a lane, for ``some`` and ``every``."""
    return call("lanelets", of)


def zone(name: str) -> Phrase:
    """The lanelets of a zone: main, merge or depart."""
    return Phrase(syntax.Call("zone", (syntax.Name(name),)))


def adjacent_lanes(of: Phrase) -> Phrase:
    """The lanes beside a lane."""
    return call("adjacentLanes", of)


SV, POV, POV1, POV2, L, lanes = (Phrase(syntax.Name(name)) for name in (*PAIR, *TRIPLE[1:], LANE, "lanes"))


def _lift(value: Term) -> Phrase:
    match value:
        case Phrase():
            return value
        case bool():
            return Phrase(syntax.Literal_(value))
        case str():
            return _number(*_with_unit(value))
        case Real() | Decimal():
            return _number(exact("number", value, "unitless"))
        case _:  # open: a user's value
            raise UsageError(f"{value!r} {_NO_TERM}")


def _number(value: Fraction, unit: str = _BARE) -> Phrase:
    """A literal, which has no sign of its own in the language."""
    literal = syntax.Literal_(abs(value), unit)
    return Phrase(syntax.Prefix("-", literal) if value < 0 else literal)


def _with_unit(value: str) -> tuple[Fraction, str]:
    """``"30 km/h"`` as the number and its unit. Raises ``UsageError``."""
    unit = next((x for x in sorted(UNITS, key=len, reverse=True) if value.strip().endswith(x)), _BARE)
    try:
        return exact("number", value.strip().removesuffix(unit), "unitless"), unit
    except InputError:
        raise UsageError(f"{value!r} {_NO_TERM}") from None


def _given(parts: "list[Phrase]") -> tuple[Binding, ...]:
    return tuple({binding.name: binding for part in parts for binding in part.given}.values())


def _binary(op: syntax.BinaryOperator, left: Term, right: Term) -> Phrase:
    parts = [_lift(left), _lift(right)]
    return Phrase(syntax.Binary(op, parts[0].expression, parts[1].expression), _given(parts))


def _chain(op: Any, left: Term, right: Term) -> Phrase:
    parts = [_lift(left), _lift(right)]
    flat: list[Expression] = []
    for part in parts:
        same = isinstance(part.expression, syntax.Chain) and part.expression.op == op
        flat += part.expression.parts if same else (part.expression,)  # type: ignore[union-attr]
    return Phrase(syntax.Chain(op, tuple(flat)), _given(parts))


def _two_bounds(within: tuple[Number, Number | None]) -> tuple[Number, Number | None]:
    if not isinstance(within, tuple | list) or len(within) != 2:
        raise UsageError(f"within={within!r}: write two bounds, such as (0, '4 s'), or (2, None) without end")
    return within[0], within[1]


def _temporal(
    op: syntax.TemporalOperator, left: Term | None, right: Term, within: tuple[Number, Number | None] | None
) -> Phrase:
    parts = [_lift(x) for x in (left, right) if x is not None]
    bounds = None
    if within is not None:
        low, high = _two_bounds(within)
        bounds = syntax.Bounds(_lift(low).expression, None if high is None else _lift(high).expression)
    first = None if left is None else parts[0].expression
    return Phrase(syntax.Temporal(op, bounds, first, parts[-1].expression), _given(parts))


def _quantified(kind: _Quantifier, domain: "Phrase | str", body: Body, name: str | Body) -> Phrase:
    match domain, body, name:
        case str(), Phrase(), _ if isinstance(name, Phrase) or callable(name):  # in the order of the text
            if not domain.isidentifier():
                raise UsageError(f"'{domain}' is not a name: write {kind}('K', lanes, formula)")
            return _over(kind, domain, body, name)
        case Phrase(), _, str() if callable(body) and not isinstance(body, Phrase):
            words = {*_WORD.findall(str(_lift(body(Phrase(syntax.Name(_HELD))))))}
            preferred = name or next(iter(inspect.signature(body).parameters), "K")
            many = (f"{preferred}{k}" for k in range(2, len(words) + 3))
            return _over(kind, next(x for x in (preferred, *many) if x not in words), domain, body)
        case _:  # open: a user's values
            raise UsageError(
                f"{kind}() needs a domain and a function, as {kind}(lanes, lambda K: ...), "
                f"or a name, a domain and a formula, as {kind}('K', lanes, formula)"
            )


def _over(kind: _Quantifier, name: str, domain: Phrase, body: Body) -> Phrase:
    """Quantify over ``name``; a formula ``body`` speaks of it by that name."""
    over = domain.expression
    if not isinstance(over, syntax.Name | syntax.Call):
        raise UsageError(
            f"{domain} is not a domain: give lanes, lanelets(L), zone('main'), adjacent_lanes(L)"
        )
    inside = _lift(body if isinstance(body, Phrase) else body(Phrase(syntax.Name(name))))
    free = tuple(x for x in inside.given if x.name != name)
    parts = [domain, Phrase(inside.expression, free)]
    return Phrase(syntax.Quantified(kind, name, over, inside.expression), _given(parts))
