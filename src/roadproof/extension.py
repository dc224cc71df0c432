"""The record by which an extension adds itself.

An extension is a package with an ``EXTENSION``: a folder of ``roadproof.extensions``, or a package of others
that an entry point of the group ``roadproof.extensions`` names. Its commands are the files of its folder
``commands``. All else is named in the record as ``module:name``, from the package on, and imported when it is
needed, so that a start reads nothing but records.
"""

import os
import sys
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from functools import cache
from importlib import import_module
from typing import Any, Final, Literal, TypeAlias

from roadproof.errors import InputError

GROUP: Final = "roadproof.extensions"
"""The folder of the extensions that come with roadproof, and the group of entry points of others."""
Label: TypeAlias = Literal["stable", "incubating"]
Audience: TypeAlias = Literal["testers", "safety cases", "researchers"]
AUDIENCES: Final[tuple[Audience, ...]] = ("testers", "safety cases", "researchers")
Entries: TypeAlias = Mapping[str, str]
"""Names, each with ``module:name`` of what it stands for."""


@dataclass(frozen=True, kw_only=True)
class Extension:
    """What an extension adds. What is incubating may be removed.

    ``needs``: the extensions that it imports; ``incubating``: parts of a stable one that may be removed.
    """

    title: str
    audience: Audience
    label: Label = "stable"
    needs: tuple[str, ...] = ()
    incubating: tuple[str, ...] = ()
    functions: Entries = field(default_factory=dict)
    """Functions and classes of ``import roadproof``."""
    questions: Entries = field(default_factory=dict)
    """Classes of questions, by their kind."""
    answers: Entries = field(default_factory=dict)
    """Classes of the answers to questions in Python, by the kind of the question."""
    evidence: Entries = field(default_factory=dict)
    """Classes of evidence (``evidence.answer_files.OwnEvidence``), by the schema of their files."""
    build_results: Entries = field(default_factory=dict)
    """Writers of files for build servers (``frontends.api.build_result.Writer``), by their format."""
    kernels: tuple[str, ...] = ()
    """Those who check evidence again (``evidence.kernels.Kernels``)."""
    modifiers: Entries = field(default_factory=dict)
    """Functions that find the modifier of a question (``engines.modifier``), by the option that says it."""
    roads: Entries = field(default_factory=dict)
    """Functions that read a road from a text that names it, by the ending of the file in it."""
    frames: tuple[str, ...] = ()
    """A function that makes a data frame of rows."""
    words: tuple[str, ...] = ()
    """Functions that say what parts of a formula mean that scenarios have no words for."""
    checked_files: Entries = field(default_factory=dict)
    """Functions that check a file for ``roadproof check``, by its ending; they return the exit code."""
    animations: Entries = field(default_factory=dict)
    """Animations of drives (``frontends.report.witness.Animation``), by the name of their format."""
    completions: Entries = field(default_factory=dict)
    """Functions that give words with descriptions, with which a shell completes a value, by flag."""
    options: Entries = field(default_factory=dict)
    """Classes of further options (``frontends.settings.option.Settings``), by the command that has them."""
    sections: Entries = field(default_factory=dict)
    """Sections of pages (``extensions.pages.page.section_kind``), by the kind of the result."""
    formats: tuple[str, ...] = ()
    """Formats of recordings (``extensions.traffic.formats.source.Format``)."""
    traces: Entries = field(default_factory=dict)
    """Readers of a file of one trace (``extensions.traffic.formats.source.ReadTrace``), by its ending."""
    drives: Entries = field(default_factory=dict)
    """Readers of a file that is a drive (``extensions.traffic.formats.source.ReadDrive``), by its ending."""
    schemas: tuple[str, ...] = ()
    """Mappings of definitions of JSON files to their titles."""


@dataclass(frozen=True)
class Installed:
    """An extension that is there: its name, its package and its record."""

    name: str
    package: str
    record: Extension

    @property
    def folder(self) -> str:
        """The folder of its package."""
        return os.path.dirname(str(sys.modules[self.package].__file__))

    def whole(self, entry: str) -> str:
        """Return an entry of the record with the whole name of its module; those of roadproof have it."""
        return entry if entry.startswith("roadproof.") else f"{self.package}.{entry}"


@cache
def installed() -> Mapping[str, Installed]:
    """The extensions that are there, by name. Raises ``InputError`` for a package without a record."""
    folder = os.path.join(os.path.dirname(__file__), "extensions")
    own = sorted(os.listdir(folder)) if os.path.isdir(folder) else []
    own = [x for x in own if os.path.exists(os.path.join(folder, x, "__init__.py"))]
    packages = {**{name: f"{GROUP}.{name}" for name in own}, **_of_others()}
    return {name: _read(name, package) for name, package in packages.items()}


def entries(slot: str) -> Mapping[str, str]:
    """Return the entries of a slot of all extensions, each as ``module:name``."""
    found = ((x, getattr(x.record, slot)) for x in installed().values())
    return {name: x.whole(entry) for x, named in found for name, entry in named.items()}


def added(slot: str, name: str) -> list[str]:
    """Return the entries that extensions have for one name in a slot, each as ``module:name``."""
    found = ((x, getattr(x.record, slot)) for x in installed().values())
    return [x.whole(named[name]) for x, named in found if name in named]


def listed(slot: str) -> list[str]:
    """Return what all extensions list in a slot, each as ``module:name``."""
    return [x.whole(entry) for x in installed().values() for entry in getattr(x.record, slot)]


def imported(entry: str) -> Any:
    """Return what ``module:name`` stands for."""
    module, _, name = entry.partition(":")
    return getattr(import_module(module), name)


def _read(name: str, package: str) -> Installed:
    record = getattr(import_module(package), "EXTENSION", None)
    if not isinstance(record, Extension):
        raise InputError(f"extension '{name}': its package {package} has no EXTENSION of the class Extension")
    return Installed(name, package, record)


def _of_others() -> Mapping[str, str]:
    """The packages of others, by the names of their entry points.

    ``importlib.metadata`` is slow to import, so it is asked only where a file mentions the group.
    """
    if not any(map(_mentions, _entry_point_files())):
        return {}
    from importlib.metadata import entry_points

    return {x.name: x.value for x in sorted(entry_points(group=GROUP), key=lambda x: x.name)}


def _entry_point_files() -> Iterator[str]:
    for place in sys.path:
        try:
            found = os.listdir(place or ".")
        except OSError:
            continue
        yield from (
            os.path.join(place, x, "entry_points.txt")
            for x in found
            if x.endswith((".dist-info", ".egg-info"))
        )


def _mentions(file: str) -> bool:
    try:
        with open(file, "rb") as content:
            return f"[{GROUP}]".encode() in content.read()
    except OSError:
        return False
