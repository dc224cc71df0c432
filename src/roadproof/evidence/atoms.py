"""The opaque reading of a claim: state predicates become atoms, functions from time to truth.

A definition whose body compares, occupies or quantifies over lanelets is one atom (``aheadOf``,
``atLane``); definitions that only combine others (``danger``, ``accel``) are looked through, and so
are quantifiers over lanes. Two atoms are the same when their bodies are built alike, whatever they
and their bound variables are called.
"""

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Literal, TypeAlias, assert_never

from roadproof.errors import InputError
from roadproof.logic import formula as f
from roadproof.logic.formula import Application, Formula
from roadproof.logic.node import once
from roadproof.logic.restore import as_syntax
from roadproof.logic.rewrite import leaves_of, rename, road_names, without_names
from roadproof.logic.show import text
from roadproof.logic.terms import Varying

Reading: TypeAlias = Literal["states", "lanelets", "names"]


@dataclass
class Atoms:
    """The atoms met so far: what they are called, by what they mean up to bound variables; and back.

    ``reading``: by ``lanelets``, quantifiers over these are no atoms, and are looked through like all others;
    by ``names``, definitions that speak of several instants are atoms, too.
    """

    names: dict[Formula, str] = field(default_factory=dict)
    named: dict[str, Formula] = field(default_factory=dict)
    reading: Reading = "states"

    def abstract(self, formula: Formula) -> Formula:
        """``formula`` with each atom as ``Application(unique text, (), meaning)`` and no other names.

        The body of a quantifier over the road is left as it is, to be abstracted at each instance.
        """
        done: dict[Formula, Formula] = {}

        def visit(current: Formula) -> Formula:
            if current not in done:
                done[current] = self._atom(current) if self._is_atom(current) else descend(current)
            return done[current]

        def descend(current: Formula) -> Formula:
            if isinstance(current, Application):
                return visit(current.body)
            if isinstance(current, f.Some | f.Every):
                return current
            return f.with_children(current, tuple(visit(c) for c in f.children(current)))

        return visit(formula)

    def _is_atom(self, formula: Formula) -> bool:
        match self.reading:
            case "states":
                return is_atom(formula)
            case "lanelets":
                return is_atom(formula) and not has_quantifier(formula)
            case "names":
                return is_atom(formula) or is_temporal_name(formula)
            case _:
                assert_never(self.reading)

    def meaning(self, name: str) -> Formula:
        """What an atom says. Raises ``InputError`` for a name that no atom has."""
        if name not in self.named:
            raise InputError(f"'{name}' is no atom of the claim")
        return self.named[name]

    def _atom(self, formula: Formula) -> Application:
        meaning = without_names(formula)
        key = up_to_variables(meaning)
        if key not in self.names:
            shown = text(as_syntax(formula, expand=False))
            name, count = shown, 1
            while name in self.named:
                count += 1
                name = f"{shown} #{count}"
            self.names[key] = name
            self.named[name] = meaning
        return Application(self.names[key], (), self.named[self.names[key]])


@once
def is_atom(formula: Formula) -> bool:
    """Whether ``formula`` is read as one opaque state predicate."""
    match formula:
        case f.Compare() | f.Occupies():
            return True
        case f.Some() | f.Every():
            return not _is_open(formula) and f.is_state(formula)
        case Application(_, _, body):
            return (
                f.is_state(body)
                and not any(_is_open(part) for part in f.subformulas(body))
                and any(not isinstance(part, Application | f.Truth) for part in _combined(body))
            )
        case _:
            return False


def is_temporal_name(formula: Formula) -> bool:
    """Whether ``formula`` is a definition that speaks of several instants."""
    return isinstance(formula, Application) and not f.is_state(formula)


@once
def has_quantifier(formula: Formula) -> bool:
    """Whether ``formula`` quantifies over the road, through the names of definitions."""
    return isinstance(formula, f.Some | f.Every) or any(map(has_quantifier, f.children(formula)))


@once
def _is_open(formula: Formula) -> bool:
    """Whether ``formula`` quantifies over lanes, or over lanelets of which it says nothing."""
    match formula:
        case f.Some(variable, domain, body) | f.Every(variable, domain, body):
            return domain.kind in ("lanes", "adjacent") or variable not in road_names(body)
        case _:
            return False


@once
def is_rigid(formula: Formula) -> bool:
    """Whether time cannot change ``formula``: it speaks of parameters and variables only."""
    if any(isinstance(part, f.Occupies | f.Some | f.Every) for part in f.subformulas(formula)):
        return False
    return not any(isinstance(leaf, Varying) for leaf in leaves_of(formula))


def _combined(formula: Formula) -> Iterator[Formula]:
    """What ``formula`` combines with not, and, or."""
    if isinstance(formula, f.Not | f.And | f.Or):
        for child in f.children(formula):
            yield from _combined(child)
    else:
        yield formula


def up_to_variables(formula: Formula) -> Formula:
    """``formula`` without names of definitions, and with bound variables called by their depth."""
    return _with_numbers(without_names(formula))


@once
def _with_numbers(bare: Formula) -> Formula:
    if isinstance(bare, f.Some | f.Every):
        return _numbered(bare, 1)
    return f.with_children(bare, tuple(map(_with_numbers, f.children(bare))))


def _numbered(current: Formula, depth: int) -> Formula:
    match current:
        case f.Some(variable, domain, body) | f.Every(variable, domain, body):
            inner = rename(body, variable, f"#{depth}")
            return type(current)(f"#{depth}", domain, _numbered(inner, depth + 1))
        case _:
            return f.with_children(current, tuple(_numbered(c, depth) for c in f.children(current)))
