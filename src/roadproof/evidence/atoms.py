"""The abstraction that proofs use: state predicates of a claim become atoms, opaque functions of time.

A definition whose body compares, occupies or quantifies over lanelets is one atom (``aheadOf``, ``atLane``).
Definitions that only combine others (``danger``, ``accel``) are expanded, and so are quantifiers over lanes.
Two atoms are the same if their bodies are equal up to the names of bound variables.
"""

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Literal, TypeAlias, assert_never

from roadproof.errors import InputError
from roadproof.logic import formula as f
from roadproof.logic.formula import Application, Formula
from roadproof.logic.node import memoised
from roadproof.logic.restore import as_syntax
from roadproof.logic.rewrite import leaves_of, rename, road_names, without_names
from roadproof.logic.show import text
from roadproof.logic.terms import Varying

Reading: TypeAlias = Literal["states", "lanelets", "names"]


@dataclass
class Atoms:
    """The atoms of a claim: ``names`` by meaning, up to bound variables, and ``named``, the meanings by name.

    ``reading``: with ``lanelets``, quantifiers over lanelets are expanded too; with ``names``, definitions
    about several instants are atoms, too.
    """

    names: dict[Formula, str] = field(default_factory=dict)
    named: dict[str, Formula] = field(default_factory=dict)
    reading: Reading = "states"

    def abstract(self, formula: Formula) -> Formula:
        """Return the formula with each atom as ``Application(unique name, (), meaning)``, others expanded.

        The body of a quantifier over the road stays as it is; it is abstracted at each instance.
        """
        abstracted: dict[Formula, Formula] = {}

        def visit(current: Formula) -> Formula:
            if current not in abstracted:
                abstracted[current] = self._atom(current) if self._is_atom(current) else descend(current)
            return abstracted[current]

        def descend(current: Formula) -> Formula:
            """Abstract the parts of a formula that is no atom itself."""
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
        """Return the formula that an atom stands for. Raises ``InputError`` for an unknown name."""
        if name not in self.named:
            raise InputError(f"'{name}' is no atom of the claim")
        return self.named[name]

    def _atom(self, formula: Formula) -> Application:
        meaning = without_names(formula)
        key = up_to_variables(meaning)
        if key not in self.names:
            text_of_atom = text(as_syntax(formula, expand=False))
            name, count = text_of_atom, 1
            while name in self.named:
                count += 1
                name = f"{text_of_atom} #{count}"
            self.names[key] = name
            self.named[name] = meaning
        return Application(self.names[key], (), self.named[self.names[key]])


@memoised
def is_atom(formula: Formula) -> bool:
    """Return whether a formula counts as one opaque state predicate."""
    match formula:
        case f.Compare() | f.Occupies():
            return True
        case f.Some() | f.Every():
            return not _is_open(formula) and f.is_state(formula)
        case Application(_, _, body):
            return (
                f.is_state(body)
                and not any(_is_open(part) for part in f.subformulas(body))
                and any(not isinstance(part, Application | f.Truth) for part in _parts_of(body))
            )
        case f.Truth() | f.Not() | f.And() | f.Or() | f.Until() | f.Since() | f.Eventually() | f.Always():
            return False


def is_temporal_name(formula: Formula) -> bool:
    """Return whether a formula is a definition about several instants."""
    return isinstance(formula, Application) and not f.is_state(formula)


@memoised
def has_quantifier(formula: Formula) -> bool:
    """Return whether a formula quantifies over the road, also inside definitions."""
    return isinstance(formula, f.Some | f.Every) or any(map(has_quantifier, f.children(formula)))


@memoised
def _is_open(formula: Formula) -> bool:
    """Return whether a formula quantifies over lanes, or over lanelets that its body does not mention."""
    if not isinstance(formula, f.Some | f.Every):
        return False
    return formula.domain.kind in ("lanes", "adjacent") or formula.variable not in road_names(formula.body)


@memoised
def is_rigid(formula: Formula) -> bool:
    """Return whether time cannot change a formula, as it mentions only parameters and variables."""
    if any(isinstance(part, f.Occupies | f.Some | f.Every) for part in f.subformulas(formula)):
        return False
    return not any(isinstance(leaf, Varying) for leaf in leaves_of(formula))


def _parts_of(formula: Formula) -> Iterator[Formula]:
    """Yield the parts that a formula combines with not, and, or."""
    if isinstance(formula, f.Not | f.And | f.Or):
        for child in f.children(formula):
            yield from _parts_of(child)
    else:
        yield formula


def up_to_variables(formula: Formula) -> Formula:
    """Return the formula with definitions expanded and bound variables named by their depth."""
    return _with_numbers(without_names(formula))


@memoised
def _with_numbers(bare: Formula) -> Formula:
    if isinstance(bare, f.Some | f.Every):
        return _numbered(bare, 1)
    return f.with_children(bare, tuple(map(_with_numbers, f.children(bare))))


def _numbered(current: Formula, depth: int) -> Formula:
    if not isinstance(current, f.Some | f.Every):
        return f.with_children(current, tuple(_numbered(c, depth) for c in f.children(current)))
    inner = rename(current.body, current.variable, f"#{depth}")
    return type(current)(f"#{depth}", current.domain, _numbered(inner, depth + 1))
