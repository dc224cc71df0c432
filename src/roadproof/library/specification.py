"""Definitions, spec sets and options: what a specification file says, and queries in its terms.

A set is a chain of overrides of named definitions; an option value is one more override. The
definitions in force for a choice of set and options are a ``Specification``.
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
from roadproof.logic import syntax
from roadproof.logic.custom_names import freedom_of, own_signal
from roadproof.logic.formula import Formula
from roadproof.logic.show import text
from roadproof.runtime.files import read_text, refuse_name
from roadproof.runtime.records import dataclass
from roadproof.world.signals import FIXED, SIGNALS

LARGEST_FILE = 1_000_000
_MENTION = re.compile(r"\[(\w+)\]")


@dataclass(frozen=True)
class Source:
    """A specification text and where it came from, for error messages."""

    name: str
    text: str


@dataclass(frozen=True)
class Library:
    """Everything that specification files declare; names are unique in each mapping.

    ``lanes``: by scenario, whose lane L is where that is not SV's (semantics §5). ``titles``: by scenario,
    what it is called, and where that is said; no reading depends on that. ``files``: the users' texts, in
    order. ``signals``: own signals; one that is derived is a definition, too.
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
        """What an answer supposes of each own signal that is not derived: ``unconstrained: …``."""
        return {x.name: freedom_of(own_signal(x, "")) for x in self.signals.values() if x.body is None}

    @cached_property
    def fingerprint(self) -> str:
        """A short text that changes with all that is declared; with places and titles it does not."""
        left_out = ("sources", "titles", "files", *(() if self.signals else ("signals",)))
        parts = [x.name for x in fields(self) if x.name not in left_out]
        declared = [repr(sorted(getattr(self, part).items())) for part in parts]
        return hashlib.sha256("\0".join(declared).encode()).hexdigest()[:16]

    @cached_property
    def _selected(self) -> dict[tuple[str, tuple[tuple[str, str], ...]], "Specification"]:
        """The specifications that were selected, by set and options."""
        return {}

    def select(self, set_name: str = "base", options: Mapping[str, str] | None = None) -> "Specification":
        """The definitions in force for a spec set and option values (defaults where not given).

        The same choice gives the same object. Raises ``InputError`` for a set, option or value that does not
        exist.
        """
        chosen = {name: declared.values[0] for name, declared in self.options.items()}
        for name, value in (options or {}).items():
            if name not in self.options:
                raise InputError(f"option {name}={value}: {unknown('option', name, self.options)}")
            if value not in self.options[name].values:
                allowed = " or ".join(self.options[name].values)
                raise InputError(f"option {name}={value}: the value must be {allowed}")
            chosen[name] = value
        key = (set_name, tuple(chosen.items()))
        if key not in self._selected:
            self._selected[key] = self._made(set_name, chosen)
        return self._selected[key]

    def _made(self, set_name: str, chosen: Mapping[str, str]) -> "Specification":
        definitions = dict(self.definitions)
        for block in self._chain(set_name):
            definitions |= {d.name: d for d in block.definitions}
        for choice in chosen.items():
            definitions |= {d.name: d for d in self.variants.get(choice, ())}
        return Specification(self, set_name, chosen, definitions)

    def _chain(self, set_name: str) -> list[syntax.SetBlock]:
        """From the outermost ancestor to ``set_name``."""
        if set_name not in self.sets:
            raise InputError(f"set={set_name}: {unknown('spec set', set_name, self.sets)}")
        chain: list[syntax.SetBlock] = []
        name = set_name
        while name:
            chain.append(self.sets[name])
            name = self.sets[name].parent
        return chain[::-1]


@dataclass(frozen=True)
class Specification:
    """One spec set under one choice of options."""

    library: Library
    set_name: str
    options: Mapping[str, str]
    definitions: Mapping[str, syntax.Definition]

    @cached_property
    def worked_out(self) -> dict[tuple[object, ...], Any]:
        """What was worked out of these definitions, which do not change, by what was asked."""
        return {}

    def in_set(self, set_name: str) -> "Specification":
        """The same options under another set."""
        return self if set_name == self.set_name else self.library.select(set_name, self.options)

    def describe(self, definition: syntax.Definition, depth: int = 4) -> str:
        """Its description, with each ``[name]`` in it replaced by the description of that definition."""

        def look_up(found: re.Match[str]) -> str:
            other = self.definitions.get(found[1])
            return found[0] if other is None or depth == 0 else self.describe(other, depth - 1)

        return _MENTION.sub(look_up, definition.doc)


def unknown(what: str, name: str, known: Iterable[str]) -> str:
    """A message for a name that does not exist, with the nearest that does."""
    names = sorted(known)
    near = get_close_matches(name, names, n=1, cutoff=0.6)
    if near:
        return f"there is no {what} '{name}'; did you mean '{near[0]}'?"
    listed = ", ".join(names[:8]) + (", …" if len(names) > 8 else "")
    return f"there is no {what} '{name}'" + (f"; there are {listed}" if names else "")


def on_request() -> dict[str, Path]:
    """The specification files that come with roadproof and are read where they are named, by name."""
    folder = Path(__file__).parent / "sets" / "on_request"
    return {file.stem: file for file in sorted(folder.glob("*.spec"))}


def read_specification(path: Path) -> Source:
    """The text of a user's file, or of one that is read ``on_request`` and is named without its ending.

    Raises ``InputError`` where it cannot be read as UTF-8 text.
    """
    path = on_request().get(str(path), path)
    refuse_name(path)
    return Source(str(path), read_text(path, LARGEST_FILE, "split it, or name another file"))


# Names that mean something without a definition; library.elaborate gives their meaning.
BUILT_IN = frozenset(
    {*SIGNALS, *FIXED, "occ"} | {"max", "min", "abs", "inverse", "lanes", "lanelets", "zone", "adjacentLanes"}
)
# Names of vehicles and lanes that need no declaration, and columns that recordings have beside signals.
ROLE = re.compile(r"SV|POV[0-9]?|L[0-9]?")
NOT_A_COLUMN = frozenset({"time", "vehicle"})


def is_within(bound: str, value: Fraction) -> bool:
    """Whether a value keeps a declared bound: ``>``, ``>=`` (both against 0) or none."""
    return value > 0 if bound == ">" else value >= 0 if bound == ">=" else True


def key_of(declared: syntax.Definition | syntax.ParameterDeclaration | syntax.SignalDeclaration) -> str:
    """Under which a library has the text that a declaration was written in."""
    return f"{declared.name}:{declared.at.line}:{declared.at.column}"


def source_of(
    library: Library, declared: syntax.Definition | syntax.ParameterDeclaration | syntax.SignalDeclaration
) -> Source:
    """Where a definition or a parameter was written."""
    return library.sources.get(key_of(declared), Source("", ""))


@dataclass(frozen=True)
class Query:
    """A formula in the definitions of one specification, with the names that are free in it.

    ``claim`` is what is said, as a tree, and ``formula`` what it means; ``written`` is how a user wrote
    it, empty where it was put together. ``vehicles``: those that are declared, then others by name;
    ``lanes``: free lanes by name.
    """

    claim: syntax.Claim
    formula: Formula
    vehicles: tuple[str, ...]
    lanes: tuple[str, ...]
    written: str = ""

    @property
    def text(self) -> str:
        """The query as text, which reads as the same query."""
        return self.written or text(self.claim)
