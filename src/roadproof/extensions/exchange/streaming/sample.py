"""The fields of a sample: a number for each signal and size that formulas compare, a flag for each relation.

A relation is what a formula says of lanes (``atLane(SV, L)``): whoever calls the monitor decides it.
"""

import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import TypeAlias, assert_never

from roadproof.errors import InputError
from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.logic.custom_names import custom_signals_of, range_text
from roadproof.logic.formula import Formula
from roadproof.logic.restore import as_syntax
from roadproof.logic.rewrite import leaves_of, without_names
from roadproof.logic.show import text
from roadproof.world.signals import KINDS, SIGNALS, SIZES
from roadproof.world.units import unit_text

Lane: TypeAlias = f.Occupies | f.Some | f.Every
Source: TypeAlias = t.Signal | t.Size | t.CustomSignal | Lane
"""What a field of a sample says."""
_RELATIONS = (f.Occupies, f.Some, f.Every, f.Not, f.And, f.Or, f.Application, f.Truth)


@dataclass(frozen=True)
class SampleField:
    """A member of the sample: a double, or a flag that is 0 or not. ``about`` gives its unit and meaning."""

    name: str
    flag: bool
    about: str


def fields_of(formulas: Iterable[Formula]) -> Mapping[Source, SampleField]:
    """The fields that formulas need, whose parameters have values: numbers first, by vehicle, then flags.

    Lanes are found without names of definitions. Raises ``InputError`` for quantifiers over lanes that say
    more than where vehicles are.
    """
    every_formula = tuple(formulas)
    measured = {x for x in leaves_of(*every_formula) if isinstance(x, t.Signal | t.Size)}
    order: tuple[str, ...] = (*SIGNALS, *SIZES, "kind")
    fields: dict[Source, SampleField] = {}
    for leaf in sorted(measured, key=lambda x: (x.vehicle, order.index(x.name))):
        _add(fields, leaf, f"{leaf.name}_{leaf.vehicle}", False, _about(leaf))
    for custom in custom_signals_of(every_formula):
        name = f"{custom.name}_{custom.vehicle}" if custom.vehicle else custom.name
        _add(fields, custom, name, custom.truth, _about_custom(custom))
    for plain, (name, about) in sorted(_relations(every_formula).items(), key=lambda x: x[1]):
        _add(fields, plain, name, True, f"{about} holds now")
    return fields


def _add(fields: dict[Source, SampleField], source: Source, name: str, flag: bool, about: str) -> None:
    """Add a field, whose name is no keyword of C and that of no other field."""
    taken = {field.name for field in fields.values()}
    while "_" not in name or name in taken:
        name += "_now"
    fields[source] = SampleField(name, flag, about)


def _about(leaf: t.Signal | t.Size) -> str:
    if isinstance(leaf, t.Size):
        if leaf.name == "kind":
            return ", ".join(f"{k} {kind}" for k, kind in enumerate(KINDS, 1))
        return f"{SIZES[leaf.name]}: {leaf.name} of {leaf.vehicle}, greater than 0"
    about = SIGNALS[leaf.name]
    what = about.what or leaf.name
    return f"{about.unit}: {what} of {leaf.vehicle} {about.where}".rstrip()


def _about_custom(custom: t.CustomSignal) -> str:
    if custom.truth:
        return f"{custom.text} is true now"
    unit = unit_text(custom.dimension) or "no unit"
    if custom.low is None and custom.high is None:
        return f"{unit}: {custom.text}"
    return f"{unit}: {custom.text}, within {range_text(custom.low, custom.high, custom.dimension)}"


def _relations(formulas: Iterable[Formula]) -> dict[Lane, tuple[str, str]]:
    """The outermost quantifiers and ``occ``, without names of definitions, each with a name and its text.

    Raises ``InputError``.
    """
    relations: dict[Lane, tuple[str, str]] = {}
    for node, name in _outermost(formulas):
        plain = without_names(node)
        if not isinstance(plain, Lane) or plain in relations:
            continue
        other = next((x for x in f.subformulas(plain) if not isinstance(x, _RELATIONS)), None)
        if other is not None:
            raise InputError(
                f"{text(as_syntax(node))}: the quantifier over lanes says more than where vehicles are "
                f"({text(as_syntax(other))}); name the road of the monitor with --road"
            )
        relations[plain] = (
            re.sub(r"\W+", "_", name or text(as_syntax(node))).strip("_"),
            text(as_syntax(node)),
        )
    return relations


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
            case (
                f.Truth()
                | f.Compare()
                | f.Not()
                | f.And()
                | f.Or()
                | f.Until()
                | f.Since()
                | f.Eventually()
                | f.Always()
            ):
                waiting.extend((child, "") for child in reversed(f.children(node)))
            case _:
                assert_never(node)


def _beside(node: f.Some | f.Every) -> str:
    """A name for what a quantifier over lanes beside another says by one definition; else none."""
    if node.domain.kind != "adjacent" or not isinstance(node.body, f.Application):
        return ""
    whole = "every_" if isinstance(node, f.Every) else ""
    shown = [f"beside_{node.domain.of}" if x == node.variable else x for x in node.body.arguments]
    return f"{whole}{node.body.name}_{'_'.join(shown)}"
