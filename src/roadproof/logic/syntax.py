"""The syntax tree that the parser returns, before names and units are resolved.

Terms and formulas are one type, since a call may be either; ``library.elaborate`` tells them apart.
"""

from collections.abc import Callable, Iterator
from dataclasses import field, replace
from fractions import Fraction
from typing import Literal, TypeAlias

from roadproof.errors import Position
from roadproof.runtime.records import dataclass

BinaryOperator: TypeAlias = Literal["+", "-", "*", "/", "^", "<", "<=", ">", ">=", "=", "!=", "->", "<->"]
TemporalOperator: TypeAlias = Literal["F", "G", "O", "H", "U", "S", "W", "R"]
ParameterBound: TypeAlias = Literal["", ">", ">="]

LONGEST_NUMBER = 200
"""The largest number of characters of a number."""
LONGEST_EXPONENT = 30


def _nowhere() -> Position:
    return Position(0, 0)


@dataclass(frozen=True)
class Literal_:
    """A number with an optional unit, or ``true`` / ``false``."""

    value: Fraction | bool
    unit: str = ""
    at: Position = field(default_factory=_nowhere, compare=False, repr=False)


@dataclass(frozen=True)
class Name:
    """A name: of a parameter, vehicle, lane, signal without arguments, or kind."""

    name: str
    at: Position = field(default_factory=_nowhere, compare=False, repr=False)


@dataclass(frozen=True)
class Call:
    """An application of a definition, a signal or a built-in function."""

    name: str
    arguments: tuple["Expression", ...]
    at: Position = field(default_factory=_nowhere, compare=False, repr=False)


@dataclass(frozen=True)
class Prefix:
    op: Literal["not", "-"]
    body: "Expression"
    at: Position = field(default_factory=_nowhere, compare=False, repr=False)


@dataclass(frozen=True)
class Binary:
    op: BinaryOperator
    left: "Expression"
    right: "Expression"
    at: Position = field(default_factory=_nowhere, compare=False, repr=False)


@dataclass(frozen=True)
class Chain:
    """``and`` or ``or`` of two or more expressions."""

    op: Literal["and", "or"]
    parts: tuple["Expression", ...]
    at: Position = field(default_factory=_nowhere, compare=False, repr=False)


@dataclass(frozen=True)
class Bounds:
    """``[low, high]``; ``high`` None is written ``inf``."""

    low: "Expression"
    high: "Expression | None"
    at: Position = field(default_factory=_nowhere, compare=False, repr=False)


@dataclass(frozen=True)
class Temporal:
    """``F``, ``G`` (``left`` None) or ``U``; ``bounds`` None is [0, inf]."""

    op: TemporalOperator
    bounds: Bounds | None
    left: "Expression | None"
    right: "Expression"
    at: Position = field(default_factory=_nowhere, compare=False, repr=False)


@dataclass(frozen=True)
class Quantified:
    """``some`` or ``every`` variable ``in`` a domain.

    The domain is ``lanes``, ``lanelets(L)``, ``zone(main)``, ``adjacentLanes(L)``, the name of a group of
    vehicles, or ``{A, B}``. ``at_start``: whether it was written as ``let``, and so is about time 0.
    """

    kind: Literal["some", "every"]
    variable: str
    domain: "Name | Call | Group"
    body: "Expression"
    at: Position = field(default_factory=_nowhere, compare=False, repr=False)
    at_start: bool = field(default=False, compare=False, repr=False)


@dataclass(frozen=True)
class Group:
    """``{A, B}``: a finite set of vehicles."""

    members: tuple[Name, ...]
    at: Position = field(default_factory=_nowhere, compare=False, repr=False)


Expression: TypeAlias = Literal_ | Name | Call | Prefix | Binary | Chain | Temporal | Quantified


@dataclass(frozen=True)
class Binding:
    """A parameter of a definition: ``sort`` is vehicle, vehicles, lane, lanelet or a unit."""

    name: str
    sort: str
    at: Position = field(default_factory=_nowhere, compare=False, repr=False)


@dataclass(frozen=True)
class Claim:
    """A formula to be proved or witnessed, with the names that are declared in front of it."""

    given: tuple[Binding, ...]
    body: Expression


@dataclass(frozen=True)
class ParameterDeclaration:
    """``param name = value unit where name > 0 "doc"``; ``bound`` is one of >, >= (against 0) or ''."""

    name: str
    value: Fraction
    unit: str
    bound: ParameterBound
    doc: str
    at: Position = field(default_factory=_nowhere, compare=False, repr=False)


@dataclass(frozen=True)
class OptionDeclaration:
    """``option name = first | second "doc"``; the first value is the default."""

    name: str
    values: tuple[str, ...]
    doc: str
    at: Position = field(default_factory=_nowhere, compare=False, repr=False)


@dataclass(frozen=True)
class Definition:
    name: str
    parameters: tuple[Binding, ...]
    doc: str
    body: Expression
    at: Position = field(default_factory=_nowhere, compare=False, repr=False)


@dataclass(frozen=True)
class SignalDeclaration:
    """``signal name(a: vehicle): unit in [low, high] "doc" derived by body``: a custom signal.

    ``vehicle`` is the name of the vehicle in ``body``, empty for a signal without vehicle. ``sort`` is a unit
    or ``bool``; ``low`` and ``high`` are in that unit, None if unbounded.
    """

    name: str
    vehicle: str
    sort: str
    low: Fraction | None
    high: Fraction | None
    doc: str
    body: Expression | None
    at: Position = field(default_factory=_nowhere, compare=False, repr=False)


@dataclass(frozen=True)
class EachBlock:
    """``each i in 1..8, 12 { … }``: definitions, repeated for every index with ``{i-8}`` replaced."""

    variable: str
    indices: tuple[int, ...]
    definitions: tuple[Definition, ...]
    at: Position = field(default_factory=_nowhere, compare=False, repr=False)


@dataclass(frozen=True)
class SetBlock:
    """``set name extends parent "doc" { … }``: overrides of the parent; ``each`` is expanded."""

    name: str
    parent: str
    doc: str
    definitions: tuple[Definition, ...]
    at: Position = field(default_factory=_nowhere, compare=False, repr=False)


@dataclass(frozen=True)
class WhenBlock:
    """``when option = value { … }``: definitions for one value of an option; ``each`` is expanded."""

    option: str
    value: str
    definitions: tuple[Definition, ...]
    at: Position = field(default_factory=_nowhere, compare=False, repr=False)


@dataclass(frozen=True)
class LaneDeclaration:
    """``lane of POV for 7, 15, 23``: in these scenarios L is the lane of this vehicle at the start."""

    vehicle: str
    scenarios: tuple[int, ...]
    doc: str
    at: Position = field(default_factory=_nowhere, compare=False, repr=False)


@dataclass(frozen=True)
class TitleDeclaration:
    """``title of 4, 12, 20 "few words" "a sentence"``: the title of these scenarios."""

    scenarios: tuple[int, ...]
    title: str
    sentence: str
    at: Position = field(default_factory=_nowhere, compare=False, repr=False)


Statement: TypeAlias = (
    ParameterDeclaration
    | SignalDeclaration
    | OptionDeclaration
    | Definition
    | EachBlock
    | SetBlock
    | WhenBlock
    | LaneDeclaration
    | TitleDeclaration
)


def is_kind(expression: Expression) -> bool:
    """Return whether an expression is ``kind(a)``; a name that it is compared with is then a kind."""
    return isinstance(expression, Call) and expression.name == "kind"


def parts(expression: Expression) -> tuple[Expression, ...]:
    """Return the direct sub-expressions."""
    match expression:
        case Literal_() | Name():
            return ()
        case Call(_, arguments, _):
            return arguments
        case Prefix(_, body, _) | Quantified(_, _, _, body, _):
            return (body,)
        case Binary(_, left, right, _):
            return (left, right)
        case Chain(_, items, _):
            return items
        case Temporal(_, bounds, left, right, _):
            inner: list[Expression] = [] if left is None else [left]
            if bounds is not None:
                inner += [bounds.low] if bounds.high is None else [bounds.low, bounds.high]
            return (*inner, right)


def with_parts(expression: Expression, change: Callable[[Expression], Expression]) -> Expression:
    """Return ``expression`` with each direct sub-expression changed; bounds of intervals stay."""
    match expression:
        case Literal_() | Name():
            return expression
        case Call(_, arguments, _):
            return replace(expression, arguments=tuple(map(change, arguments)))
        case Prefix(_, body, _) | Quantified(_, _, _, body, _):
            return replace(expression, body=change(body))
        case Binary(_, left, right, _):
            return replace(expression, left=change(left), right=change(right))
        case Chain(_, items, _):
            return replace(expression, parts=tuple(map(change, items)))
        case Temporal(_, _, first, right, _):
            return replace(expression, left=None if first is None else change(first), right=change(right))


def depth(expression: Expression) -> int:
    """Return the depth of the tree; iterative, so that a tree that is too deep can be refused."""
    deepest = 0
    waiting = [(expression, 1)]
    while waiting:
        current, level = waiting.pop()
        deepest = max(deepest, level)
        waiting.extend((part, level + 1) for part in parts(current))
    return deepest


def walk(expression: Expression) -> Iterator[Expression]:
    """Yield every sub-expression, parents first."""
    waiting = [expression]
    while waiting:
        current = waiting.pop()
        yield current
        waiting.extend(reversed(parts(current)))
