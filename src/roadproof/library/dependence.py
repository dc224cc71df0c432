"""What an answer depends on: a digest of the definitions and parameters that its texts use."""

import hashlib
import re
from collections.abc import Iterable, Mapping
from fractions import Fraction

from roadproof.library.scenarios import TEMPLATE_NAMES, name_of
from roadproof.library.specification import Specification
from roadproof.library.uses import definitions_used, parameters_used
from roadproof.logic import syntax
from roadproof.logic.syntax import Call, Definition, ParameterDeclaration
from roadproof.runtime.records import dataclass

_NAME = re.compile(r"[A-Za-z_]\w*(?:@\w+)?")


def digest_of(
    specification: Specification, texts: Iterable[str], values: Mapping[str, Fraction] | None = None
) -> str:
    """A short text that changes with each definition that ``texts`` name, those that these use, and their
    parameters.

    ``values``: those of parameters, where an answer depends on them. What the template of the scenarios is
    made of, and the user's own signals, always count, since provers and searches use them.
    """
    library = specification.library
    names = {name for text in texts for name in _NAME.findall(text)} | {*TEMPLATE_NAMES}
    parts: dict[str, str] = {}
    for name in names:
        parts |= _parts_of(specification, name)
    given = {name: str(value) for name, value in (values or {}).items() if f"parameter {name}" in parts}
    rest = [repr(sorted(library.signals.items()))] if library.signals else []
    lanes = [repr(x) for x in sorted(library.lanes.items()) if name_of(x[0]) in parts]
    told = repr((sorted(parts.items()), sorted(given.items()), lanes, rest))
    return hashlib.sha256(told.encode()).hexdigest()[:16]


def _parts_of(specification: Specification, name: str) -> dict[str, str]:
    """The definitions and parameters below a name, each with all that it says; none for other names."""
    known = specification.worked_out.get((_parts_of, name))
    if known is None:
        below = used_below(specification, name)
        known = {x.name: repr(x) for x in below.definitions}
        known |= {f"parameter {x.name}": repr(x) for x in below.parameters}
        specification.worked_out[_parts_of, name] = known
    return dict(known)


@dataclass(frozen=True)
class Used:
    """Definitions and parameters that a text uses, and those that these use, once each."""

    definitions: tuple[Definition, ...] = ()
    parameters: tuple[ParameterDeclaration, ...] = ()

    def __or__(self, other: "Used") -> "Used":
        return Used(
            tuple({x.name: x for x in (*self.definitions, *other.definitions)}.values()),
            tuple({x.name: x for x in (*self.parameters, *other.parameters)}.values()),
        )


def used_by(specification: Specification, text: str) -> Used:
    """All that the names in a text are made of; names without a definition are passed over."""
    found = Used()
    for name in dict.fromkeys(_NAME.findall(text)):
        found |= used_below(specification, name)
    return found


def used_below(specification: Specification, name: str) -> Used:
    """The definition or parameter of a name, and what it is made of."""
    used = definitions_used(specification, Call(name, ()))
    return Used(used, parameters_used(specification.library, syntax.Name(name), used))
