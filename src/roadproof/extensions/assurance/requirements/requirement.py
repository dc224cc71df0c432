"""Requirements with their links, as any of their formats says them, and the settings of a trace."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from pathlib import Path

from roadproof.errors import InputError
from roadproof.extensions.assurance.answers.trace import LinkKind, Position
from roadproof.library.specification import on_request, unknown

FIELDS: Mapping[str, LinkKind] = {
    "claims": "claim",
    "scenarios": "scenario",
    "tests": "test",
    "drivers": "driver",
    "plates": "plate",
    "evidence": "evidence",
}
"""The fields of a requirement that name links, in the order in which answers show these."""


@dataclass(frozen=True)
class Link:
    """What a requirement rests on: a claim, scenario, test, driver or plate by name, or a file."""

    kind: LinkKind
    target: str

    def __str__(self) -> str:
        return f"{self.kind} {self.target}"


@dataclass(frozen=True)
class Requirement:
    """``parents``: the requirements that it is a part of or derived from, by id; ``place``: where it is
    written. ``identifier``: that of its object in ReqIF, empty in other formats.
    """

    id: str
    text: str
    place: Position
    title: str = ""
    parents: tuple[str, ...] = ()
    links: tuple[Link, ...] = ()
    identifier: str = ""


@dataclass(frozen=True, kw_only=True)
class TraceSettings:
    """What all links are read with.

    ``evidence``: files and folders that are checked. ``specs``, ``set_name``, ``options``, ``parameters``: as
    for any question. ``vehicles``: models by the name of the vehicle.
    """

    evidence: tuple[Path, ...] = ()
    specs: tuple[Path, ...] = ()
    set_name: str = "base"
    options: Mapping[str, str] = field(default_factory=dict)
    parameters: Mapping[str, Fraction | int | str] = field(default_factory=dict)
    vehicles: Mapping[str, str] = field(default_factory=dict)

    @property
    def evidence_specs(self) -> tuple[Path, ...]:
        """The user's own files. Evidence names those that come with roadproof by itself."""
        shipped = on_request()
        return tuple(x for x in self.specs if str(x) not in shipped)


@dataclass(frozen=True)
class Requirements:
    """The requirements of a file, in order. ``notes``: what was left out, and why."""

    file: Path
    requirements: tuple[Requirement, ...]
    settings: TraceSettings = TraceSettings()
    notes: tuple[str, ...] = ()

    def without_strange_parents(self) -> "Requirements":
        """The same, without parents that are in other documents; a note names each."""
        known = {x.id for x in self.requirements}
        strange = [(x, y) for x in self.requirements for y in x.parents if y not in known]
        notes = tuple(f"{told(x.place)}: {x.id} is derived from {y}, which is not here" for x, y in strange)
        every = tuple(
            replace(x, parents=tuple(y for y in x.parents if y in known)) for x in self.requirements
        )
        return replace(self, requirements=every, notes=(*self.notes, *notes))

    def with_specs(self, specs: Iterable[Path]) -> "Requirements":
        """The same, with further specification files."""
        every = tuple(dict.fromkeys((*self.settings.specs, *specs)))
        return replace(self, settings=replace(self.settings, specs=every))


def check_requirements(found: Sequence[Requirement]) -> None:
    """Raises ``InputError`` where ids are not unique, a parent does not exist, or parents form a circle."""
    places: dict[str, Position] = {}
    for x in found:
        where = told(x.place)
        if not x.id:
            raise InputError(f"{where}: the requirement has no id; give it one of its own")
        if x.id in places:
            raise InputError(
                f"{where}: two requirements are called '{x.id}'; the other one is at {told(places[x.id])}"
            )
        places[x.id] = x.place
    parents = {x.id: x.parents for x in found}
    for x in found:
        for parent in x.parents:
            if parent not in parents:
                raise InputError(
                    f"{told(x.place)}: requirement {x.id}: {unknown('requirement', parent, parents)}"
                )
        if x.id in above(x.id, parents):
            raise InputError(f"{told(x.place)}: requirement {x.id} is derived from itself; remove a parent")


def above(start: str, parents: Mapping[str, Sequence[str]]) -> set[str]:
    """The parents of a requirement, and theirs."""
    found: set[str] = set()
    waiting = [*parents[start]]
    while waiting:
        name = waiting.pop()
        if name not in found:
            found.add(name)
            waiting += parents.get(name, ())
    return found


def told(place: Position) -> str:
    """A place as messages name it."""
    return f"{place.file}, line {place.line}"


def split_links(values: Mapping[str, str]) -> tuple[Link, ...]:
    """The links that fields of another format name: ``values`` by field; a line, or a ``;``, between them."""
    return tuple(_split(values))


def _split(values: Mapping[str, str]) -> Iterator[Link]:
    plain = {name.lower().removeprefix("roadproof").strip(" .-_"): text for name, text in values.items()}
    for name, kind in FIELDS.items():
        for word in plain.get(name, "").replace(";", "\n").splitlines():
            if word.strip():
                yield Link(kind, word.strip())
