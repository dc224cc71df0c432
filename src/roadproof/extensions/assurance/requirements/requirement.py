"""Requirements with their links, independent of their file format, and the settings of a trace."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from pathlib import Path
from typing import Final

from roadproof.errors import InputError
from roadproof.extensions.assurance.answers.trace import LinkKind, RequirementPlace
from roadproof.library.specification import on_request, unknown_name

FIELDS: Mapping[str, LinkKind] = {
    "claims": "claim",
    "scenarios": "scenario",
    "tests": "test",
    "drivers": "driver",
    "plates": "plate",
    "evidence": "evidence",
}
"""The fields of a requirement that hold links, in the order of answers."""


SOURCE_FIELDS: Final = ("edition", "clause")
"""The fields that say where a requirement comes from."""


@dataclass(frozen=True)
class Link:
    """A link from a requirement to a claim, scenario, test, driver or plate by name, or to a file of
    evidence.
    """

    kind: LinkKind
    target: str

    def __str__(self) -> str:
        return f"{self.kind} {self.target}"


@dataclass(frozen=True)
class Requirement:
    """A requirement with its links.

    ``parents``: ids of the requirements that it is a part of or derived from; ``place``: where it is written.
    ``identifier``: the identifier of its object in ReqIF, empty for other formats. ``edition``, ``clause``:
    of the document that it comes from, empty where unknown.
    """

    id: str
    text: str
    place: RequirementPlace
    title: str = ""
    parents: tuple[str, ...] = ()
    links: tuple[Link, ...] = ()
    identifier: str = ""
    edition: str = ""
    clause: str = ""


@dataclass(frozen=True, kw_only=True)
class TraceSettings:
    """The settings of a trace.

    ``evidence``: files and folders that are checked. ``specs``, ``set_name``, ``options``, ``parameters``: as
    for any question. ``vehicles``: vehicle models by the name of the vehicle.
    """

    evidence: tuple[Path, ...] = ()
    specs: tuple[Path, ...] = ()
    set_name: str = "base"
    options: Mapping[str, str] = field(default_factory=dict)
    parameters: Mapping[str, Fraction | int | str] = field(default_factory=dict)
    vehicles: Mapping[str, str] = field(default_factory=dict)

    @property
    def evidence_specs(self) -> tuple[Path, ...]:
        """The user's own specification files; evidence itself names those that come with roadproof."""
        shipped = on_request()
        return tuple(x for x in self.specs if str(x) not in shipped)


@dataclass(frozen=True)
class RequirementSet:
    """The requirements of a file in order; ``notes``: parts of the file that were left out, with reasons."""

    file: Path
    requirements: tuple[Requirement, ...]
    settings: TraceSettings = TraceSettings()
    notes: tuple[str, ...] = ()

    def without_strange_parents(self) -> "RequirementSet":
        """Return the requirements without parents that are in other documents; each removed parent gets a
        note.
        """
        known = {x.id for x in self.requirements}
        strange = [(x, y) for x in self.requirements for y in x.parents if y not in known]
        notes = tuple(
            f"{place_text(x.place)}: {x.id} is derived from {y}, which is not here" for x, y in strange
        )
        every = tuple(
            replace(x, parents=tuple(y for y in x.parents if y in known)) for x in self.requirements
        )
        return replace(self, requirements=every, notes=(*self.notes, *notes))

    def with_specs(self, specs: Iterable[Path]) -> "RequirementSet":
        """Return the requirements with further specification files."""
        every = tuple(dict.fromkeys((*self.settings.specs, *specs)))
        return replace(self, settings=replace(self.settings, specs=every))


def check_requirements(requirements: Sequence[Requirement]) -> None:
    """Raise ``InputError`` where ids are not unique, a parent does not exist, or parents form a cycle."""
    places: dict[str, RequirementPlace] = {}
    for x in requirements:
        where = place_text(x.place)
        if not x.id:
            raise InputError(f"{where}: the requirement has no id; give it one of its own")
        if x.id in places:
            other = place_text(places[x.id])
            raise InputError(f"{where}: two requirements are called '{x.id}'; the other one is at {other}")
        places[x.id] = x.place
    parents = {x.id: x.parents for x in requirements}
    for x in requirements:
        for parent in x.parents:
            if parent not in parents:
                problem = unknown_name("requirement", parent, parents)
                raise InputError(f"{place_text(x.place)}: requirement {x.id}: {problem}")
        if x.id in ancestors_of(x.id, parents):
            raise InputError(
                f"{place_text(x.place)}: requirement {x.id} is derived from itself; remove a parent"
            )


def ancestors_of(start: str, parents: Mapping[str, Sequence[str]]) -> set[str]:
    """Return the parents of a requirement, their parents, and so on."""
    ancestors: set[str] = set()
    waiting = [*parents[start]]
    while waiting:
        name = waiting.pop()
        if name not in ancestors:
            ancestors.add(name)
            waiting += parents.get(name, ())
    return ancestors


def place_text(place: RequirementPlace) -> str:
    """Return a place as messages name it."""
    return f"{place.file}, line {place.line}"


def with_fields(requirement: Requirement, values: Mapping[str, str]) -> Requirement:
    """Return a requirement with the links, edition and clause in the fields of another format.

    A line break or ``;`` separates targets of links.
    """
    plain = {name.lower().removeprefix("roadproof").strip(" .-_"): text for name, text in values.items()}
    edition, clause = (plain.get(x, "").strip() for x in SOURCE_FIELDS)
    return replace(requirement, links=tuple(_split(plain)), edition=edition, clause=clause)


def _split(plain: Mapping[str, str]) -> Iterator[Link]:
    for name, kind in FIELDS.items():
        for word in plain.get(name, "").replace(";", "\n").splitlines():
            if word.strip():
                yield Link(kind, word.strip())
