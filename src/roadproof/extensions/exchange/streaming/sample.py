"""What a sample holds: a number for each signal and size that formulas compare, a flag for each relation.

A relation is what a formula says of lanes (``atLane(SV, L)``): whoever calls the monitor decides it.
"""

import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import TypeAlias

from roadproof.errors import InputError
from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.logic.custom_names import own_of, told_range
from roadproof.logic.formula import Formula
from roadproof.logic.rewrite import leaves_of, without_names
from roadproof.logic.show import as_syntax, text
from roadproof.world.signals import KINDS, SIGNALS, SIZES
from roadproof.world.units import unit_text

Lane: TypeAlias = f.Occupies | f.Some | f.Every
Source: TypeAlias = t.Signal | t.Size | t.Own | Lane
"""What a field of a sample says."""
_RELATIONS = (f.Occupies, f.Some, f.Every, f.Not, f.And, f.Or, f.Application, f.Truth)


@dataclass(frozen=True)
class Field:
    """A member of the sample: a double, or a flag that is 0 or not. ``about`` gives its unit and meaning."""

    name: str
    flag: bool
    about: str


def fields_of(formulas: Iterable[Formula]) -> Mapping[Source, Field]:
    """The fields that formulas need, whose parameters have values: numbers first, by vehicle, then flags.

    Lanes are found without names of definitions. Raises ``InputError`` for quantifiers over lanes that say
    more than where vehicles are.
    """
    given = tuple(formulas)
    measured = {x for x in leaves_of(*given) if isinstance(x, t.Signal | t.Size)}
    order: tuple[str, ...] = (*SIGNALS, *SIZES, "kind")
    found: dict[Source, Field] = {}
    for leaf in sorted(measured, key=lambda x: (x.vehicle, order.index(x.name))):
        _add(found, leaf, f"{leaf.name}_{leaf.vehicle}", False, _about(leaf))
    for own in own_of(given):
        name = f"{own.name}_{own.vehicle}" if own.vehicle else own.name
        _add(found, own, name, own.truth, _about_own(own))
    for plain, (name, about) in sorted(_relations(given).items(), key=lambda x: x[1]):
        _add(found, plain, name, True, f"{about} holds now")
    return found


def _add(found: dict[Source, Field], source: Source, name: str, flag: bool, about: str) -> None:
    """Add a field, whose name is no keyword of C and that of no other field."""
    taken = {field.name for field in found.values()}
    while "_" not in name or name in taken:
        name += "_now"
    found[source] = Field(name, flag, about)


def _about(leaf: t.Signal | t.Size) -> str:
    if isinstance(leaf, t.Size):
        if leaf.name == "kind":
            return ", ".join(f"{k} {kind}" for k, kind in enumerate(KINDS, 1))
        return f"{SIZES[leaf.name]}: {leaf.name} of {leaf.vehicle}, greater than 0"
    about = SIGNALS[leaf.name]
    what = about.what or leaf.name
    return f"{about.unit}: {what} of {leaf.vehicle} {about.where}".rstrip()


def _about_own(own: t.Own) -> str:
    if own.truth:
        return f"{own.told} is true now"
    unit = unit_text(own.dimension) or "no unit"
    if own.low is None and own.high is None:
        return f"{unit}: {own.told}"
    return f"{unit}: {own.told}, within {told_range(own.low, own.high, own.dimension)}"


def _relations(formulas: Iterable[Formula]) -> dict[Lane, tuple[str, str]]:
    """The outermost quantifiers and ``occ``, without names of definitions, each with a name and its text.

    Raises ``InputError``.
    """
    found: dict[Lane, tuple[str, str]] = {}
    for node, name in _outermost(formulas):
        plain = without_names(node)
        if not isinstance(plain, Lane) or plain in found:
            continue
        other = next((x for x in f.subformulas(plain) if not isinstance(x, _RELATIONS)), None)
        if other is not None:
            raise InputError(
                f"{text(as_syntax(node))}: the quantifier over lanes says more than where vehicles are "
                f"({text(as_syntax(other))}); name the road of the monitor with --road"
            )
        found[plain] = re.sub(r"\W+", "_", name or text(as_syntax(node))).strip("_"), text(as_syntax(node))
    return found


def _outermost(formulas: Iterable[Formula]) -> Iterator[tuple[Lane, str]]:
    """Quantifiers and ``occ`` outside of all others, with the name of the definition that they are."""
    seen: set[Formula] = set()
    waiting = [(x, "") for x in formulas]
    while waiting:
        node, name = waiting.pop()
        if node in seen:
            continue
        seen.add(node)
        match node:
            case f.Some() | f.Every():
                yield node, name or _beside(node)
            case f.Occupies():
                yield node, name
            case f.Application(called, arguments, body):
                waiting.append((body, f"{called}_{'_'.join(arguments)}"))
            case _:
                waiting.extend((child, "") for child in reversed(f.children(node)))


def _beside(node: f.Some | f.Every) -> str:
    """A name for what a quantifier over lanes beside another says by one definition; else none."""
    if node.domain.kind != "adjacent" or not isinstance(node.body, f.Application):
        return ""
    whole = "every_" if isinstance(node, f.Every) else ""
    shown = [f"beside_{node.domain.of}" if x == node.variable else x for x in node.body.arguments]
    return f"{whole}{node.body.name}_{'_'.join(shown)}"
