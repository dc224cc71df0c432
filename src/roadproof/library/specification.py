"""Definitions, spec sets and options of specification files, and queries that use them.

A spec set is a chain of overrides of named definitions; an option value is one more override. A
``Specification`` has the definitions in force for one set and one choice of options.
"""

import hashlib
import re
from collections.abc import Iterable, Mapping
from dataclasses import field, fields
from difflib import get_close_matches
from fractions import Fraction
from functools import cached_property
from pathlib import Path
from typing import Any

from roadproof.errors import InputError
from roadproof.extension import installed_extensions
from roadproof.logic import syntax
from roadproof.logic.custom_names import assumption_on_signal, custom_signal
from roadproof.logic.formula import Formula
from roadproof.logic.show import text
from roadproof.runtime.files import read_text, refuse_name
from roadproof.runtime.records import dataclass
from roadproof.world.signals import FIXED, SIGNALS

LARGEST_FILE = 1_000_000
_MENTION = re.compile(r"\[(\w+)\]")


@dataclass(frozen=True)
class Source:
    """A specification text and its origin, for error messages."""

    name: str
    text: str


@dataclass(frozen=True)
class Library:
    """The declarations of all specification files; names are unique in each mapping.

    ``lanes``: by scenario, the vehicle whose lane L is, if that is not SV (semantics §5). ``titles``: by
    scenario, its title and where that is declared; formulas do not depend on it. ``files``: the users' texts,
    in order. ``signals``: custom signals; a derived one is a definition, too.
    """

    parameters: Mapping[str, syntax.ParameterDeclaration] = field(default_factory=dict)
    options: Mapping[str, syntax.OptionDeclaration] = field(default_factory=dict)
    definitions: Mapping[str, syntax.Definition] = field(default_factory=dict)
    sets: Mapping[str, syntax.SetBlock] = field(default_factory=dict)
    variants: Mapping[tuple[str, str], tuple[syntax.Definition, ...]] = field(default_factory=dict)
    sources: Mapping[str, Source] = field(default_factory=dict)
    lanes: Mapping[int, syntax.LaneDeclaration] = field(default_factory=dict)
    titles: Mapping[int, tuple[syntax.TitleDeclaration, Source]] = field(default_factory=dict)
    files: tuple[Source, ...] = ()
    signals: Mapping[str, syntax.SignalDeclaration] = field(default_factory=dict)

    @property
    def bounds(self) -> dict[str, str]:
        """The declared bound of every parameter against 0: ``>``, ``>=`` or none ('')."""
        return {name: parameter.bound for name, parameter in self.parameters.items()}

    @cached_property
    def freedom(self) -> dict[str, str]:
        """The assumption of answers about each custom signal that is not derived: ``unconstrained: …``."""
        return {
            x.name: assumption_on_signal(custom_signal(x, ""))
            for x in self.signals.values()
            if x.body is None
        }

    @cached_property
    def fingerprint(self) -> str:
        """A hash of all declarations; it does not depend on their places and on titles."""
        left_out = ("sources", "titles", "files", *(() if self.signals else ("signals",)))
        parts = [x.name for x in fields(self) if x.name not in left_out]
        declared = [repr(sorted(getattr(self, part).items())) for part in parts]
        return hashlib.sha256("\0".join(declared).encode()).hexdigest()[:16]

    @cached_property
    def _selected(self) -> dict[tuple[str, tuple[tuple[str, str], ...]], "Specification"]:
        """The specifications that were selected, by set and options."""
        return {}

    def select(self, set_name: str = "base", options: Mapping[str, str] | None = None) -> "Specification":
        """Return the definitions in force for a spec set and option values (by default the first of each).

        The same choice returns the same object. Raises ``InputError`` for an unknown set, option or value.
        """
        chosen = {name: declared.values[0] for name, declared in self.options.items()}
        for name, value in (options or {}).items():
            if name not in self.options:
                raise InputError(f"option {name}={value}: {unknown_name('option', name, self.options)}")
            if value not in self.options[name].values:
                allowed = " or ".join(self.options[name].values)
                raise InputError(f"option {name}={value}: the value must be {allowed}")
            chosen[name] = value
        key = (set_name, tuple(chosen.items()))
        if key not in self._selected:
            self._selected[key] = self._specification(set_name, chosen)
        return self._selected[key]

    def _specification(self, set_name: str, chosen: Mapping[str, str]) -> "Specification":
        definitions = dict(self.definitions)
        for block in self._chain(set_name):
            definitions |= {d.name: d for d in block.definitions}
        for choice in chosen.items():
            definitions |= {d.name: d for d in self.variants.get(choice, ())}
        return Specification(self, set_name, chosen, definitions)

    def _chain(self, set_name: str) -> list[syntax.SetBlock]:
        """Return the sets from the outermost ancestor to ``set_name``."""
        if set_name not in self.sets:
            raise InputError(f"set={set_name}: {unknown_name('spec set', set_name, self.sets)}")
        chain: list[syntax.SetBlock] = []
        name = set_name
        while name:
            chain.append(self.sets[name])
            name = self.sets[name].parent
        return chain[::-1]


@dataclass(frozen=True)
class Specification:
    """The definitions of one spec set under one choice of options."""

    library: Library
    set_name: str
    options: Mapping[str, str]
    definitions: Mapping[str, syntax.Definition]

    @cached_property
    def memo(self) -> dict[tuple[object, ...], Any]:
        """A cache of values that depend on these definitions only."""
        return {}

    def in_set(self, set_name: str) -> "Specification":
        """Return the specification of another set under the same options."""
        return self if set_name == self.set_name else self.library.select(set_name, self.options)

    def describe(self, definition: syntax.Definition, depth: int = 4) -> str:
        """Return the description of a definition, with each ``[name]`` replaced by that definition's
        description.
        """

        def look_up(match: re.Match[str]) -> str:
            other = self.definitions.get(match[1])
            return match[0] if other is None or depth == 0 else self.describe(other, depth - 1)

        return _MENTION.sub(look_up, definition.doc)


def unknown_name(what: str, name: str, known: Iterable[str]) -> str:
    """Return a message for a name that does not exist, with the most similar name that does."""
    names = sorted(known)
    near = get_close_matches(name, names, n=1, cutoff=0.6)
    if near:
        return f"there is no {what} '{name}'; did you mean '{near[0]}'?"
    listed = ", ".join(names[:8]) + (", …" if len(names) > 8 else "")
    return f"there is no {what} '{name}'" + (f"; there are {listed}" if names else "")


def on_request() -> dict[str, Path]:
    """Return the specification files that are shipped but only read when they are named, by name."""
    folder = Path(__file__).parent / "sets" / "on_request"
    own = {file.stem: file for file in sorted(folder.glob("*.spec"))}
    for x in installed_extensions().values():
        for name, file in x.record.specifications.items():
            own[name] = Path(x.folder) / file
    return own


def read_specification(path: Path) -> Source:
    """Return the text of a user's file, or of a file ``on_request`` that is named without its suffix.

    Raises ``InputError`` if it cannot be read as UTF-8 text.
    """
    path = on_request().get(str(path), path)
    refuse_name(path)
    return Source(str(path), read_text(path, LARGEST_FILE, "split it, or name another file"))


# Names with a built-in meaning, which library.elaboration gives them.
BUILT_IN = frozenset(
    {*SIGNALS, *FIXED, "occ", "max", "min", "abs", "inverse", "rise", "fall"}
    | {"lanes", "lanelets", "zone", "adjacentLanes"}
)
# Names of vehicles and lanes that need no declaration; columns of recordings that are no signals.
ROLE = re.compile(r"SV|POV[0-9]?|L[0-9]?")
NOT_A_COLUMN = frozenset({"time", "vehicle"})


def satisfies_bound(bound: str, value: Fraction) -> bool:
    """Return whether a value satisfies a declared bound: ``>``, ``>=`` (both against 0) or none."""
    return value > 0 if bound == ">" else value >= 0 if bound == ">=" else True


def key_of(declared: syntax.Definition | syntax.ParameterDeclaration | syntax.SignalDeclaration) -> str:
    """Return the key of a declaration in ``Library.sources``."""
    return f"{declared.name}:{declared.at.line}:{declared.at.column}"


def source_of(
    library: Library, declared: syntax.Definition | syntax.ParameterDeclaration | syntax.SignalDeclaration
) -> Source:
    """Return the text in which a declaration was written."""
    return library.sources.get(key_of(declared), Source("", ""))


@dataclass(frozen=True)
class Query:
    """A formula with the names that are free in it, in the definitions of one specification.

    ``claim``: the syntax tree, and ``formula`` its meaning. ``written``: the user's text, empty for a
    composed query. ``vehicles``: declared ones first, then the others by name. ``lanes``: free lanes by name.
    """

    claim: syntax.Claim
    formula: Formula
    vehicles: tuple[str, ...]
    lanes: tuple[str, ...]
    written: str = ""

    @property
    def text(self) -> str:
        """The query as text, which parses to the same query."""
        return self.written or text(self.claim)
